// Particles as the density of a volume: nothing is lost, whatever the order, and light is taken as
// it should be.
#include "pass/particles/deposit.h"
#include "splats_test.h"

static const double spot_area =
    3.14159265358979 / 3; // that a spot covers, in squares of its radius

typedef struct heap {
    spots s; // its splats are not drawn
    pass *deposit, *march;
    const field *density;
} heap;

// In a cube of 2 m; each takes 0.01 m^2 of the light.
static void heap_open(heap *h, gpu *device, uint32_t count, uint32_t resolution) {
    spots_open(&h->s, device, count);
    pass_world *w = &h->s.w;
    float radius = (float)sqrt(0.01 / spot_area);
    h->deposit = world_add(w, "deposit", NULL, "deposit");
    pass_add_source(h->deposit, h->s.particles);
    gpu_test_ok(pass_set_field(h->deposit, "size", number(w, 2 * radius)));
    field_grid *grid =
        pass_deposit_open(h->deposit, &(pass_deposit_desc){.box = {{-1, -1, -1}, {1, 1, 1}},
                                                           .resolution = resolution});
    gpu_test_ok(grid && pass_declare(h->deposit));
    h->density = field_grid_channel(&w->memory, grid, 0, 1);
    h->march = world_add(w, "march", NULL, "march");
    gpu_test_ok(pass_set_field(h->march, "density", h->density));
    gpu_test_ok(pass_set_uniform(h->march, "early_exit", number(w, 0)));
    gpu_test_ok(pass_set_uniform(h->march, "shadow_steps", number(w, 0)));
    gpu_test_ok(pass_declare(h->march) && pass_declare(h->s.splats));
    world_render(w, SIDE, SIDE, pass_output(h->march, "color"));
    w->host.hold = true;
}

static uint16_t *heap_draw(heap *h, const spot *list, size_t cells) {
    mem_free(spots_draw_other(&h->s, list, pass_output(h->march, "color")));
    gpu_image *image = graph_get_image(h->s.w.host.graph, pass_output(h->deposit, "density"));
    uint16_t *halves = mem_alloc(cells * sizeof *halves);
    gpu_test_ok(gpu_image_read(h->s.w.host.device, image, halves, cells * sizeof *halves));
    return halves;
}

static void nothing_is_lost_in_any_order(void **state) {
    enum { COUNT = 300, RESOLUTION = 20, CELLS = RESOLUTION * RESOLUTION * RESOLUTION };
    static spot list[COUNT], other[COUNT];
    uint32_t seed = 3;
    for (int i = 0; i < COUNT; i++)
        for (int k = 0; k < 3; k++) {
            seed = seed * 1664525 + 1013904223;
            list[i].at[k] = ((float)(seed >> 8) / (1 << 24) - 0.5f) * 1.8f;
        }
    for (int i = 0; i < COUNT; i++) other[i] = list[COUNT - 1 - i];
    heap h;
    heap_open(&h, *state, COUNT, RESOLUTION);
    uint16_t *one = heap_draw(&h, list, CELLS), *two = heap_draw(&h, other, CELLS);
    double sum = 0;
    for (int i = 0; i < CELLS; i++) sum += (double)half_to_float(one[i]) * 8 / CELLS;
    is_near(sum, 0.01 * COUNT, 0.01 * 0.01 * COUNT, "square metres");
    assert_memory_equal(one, two, CELLS * sizeof *one);
    mem_free(one);
    mem_free(two);
    spots_close(&h.s);
}

// A curtain of them, so many that they stand for 1.2 m^2 in each square metre.
static void light_is_taken_as_they_cover_it(void **state) {
    enum { ROW = 22, COUNT = ROW * ROW, CELLS = 8 * 8 * 8 };
    static spot list[COUNT];
    for (int i = 0; i < COUNT; i++) {
        list[i].at[0] = ((float)(i % ROW) + 0.5f) * 2 / ROW - 1;
        list[i].at[2] = ((float)(i / ROW) + 0.5f) * 2 / ROW - 1;
    }
    heap h;
    heap_open(&h, *state, COUNT, 8);
    mem_free(heap_draw(&h, list, CELLS));
    float *pixels = world_read(&h.s.w, pass_output(h.march, "color"));
    double wanted = 1 - exp(-0.01 * COUNT / 4);
    is_near((double)pixel_at(pixels, SIDE / 2, SIDE / 2)[3], wanted, 0.02, "opacity");
    mem_free(pixels);
    spots_close(&h.s);
}

static void a_box_is_needed(void **state) {
    pass_world w;
    world_open(&w, *state);
    pass *p = world_add(&w, "deposit", NULL, "dust");
    assert_null(pass_deposit_open(p, &(pass_deposit_desc){.resolution = 32}));
    assert_non_null(strstr(err_get(), "dust: 'box' is missing or flat"));
    const box3 box = {{0, 0, 0}, {1, 1, 1}};
    assert_null(pass_deposit_open(p, &(pass_deposit_desc){.box = box, .resolution = 2}));
    assert_non_null(strstr(err_get(), "'resolution' is 2; 4 to 512"));
    world_close(&w);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_is_lost_in_any_order),
        cmocka_unit_test(light_is_taken_as_they_cover_it),
        cmocka_unit_test(a_box_is_needed),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
