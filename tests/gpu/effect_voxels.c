// Meshes as cells, as fields of an effect: what they show, and when they are computed.
#include "effect_test.h"
#include "pass/grids/voxels.h"
#include "scene/voxels.h"

enum { SIZE = 45, PIXELS = SIZE * SIZE };

typedef struct body {
    pass *pass;
    field_grid *grid;
    scene_mesh *mesh;
} body;

// A crate, 2 m wide, in a box of 40 cells a side. Pictures show z = 0.4 from 0 to 3 m.
static body add_body(effect *e, const pass_voxels_desc *desc) {
    body b = {.pass = add(e, "voxels", NULL), .mesh = effect_add_mesh(e, "crate.obj")};
    gpu_test_ok(b.mesh);
    b.mesh->position = triple(e, 1.5f, 1.5f, 0);
    gpu_test_ok(pass_add_mesh(b.pass, b.mesh));
    const field_context context = {.time = 0};
    b.grid = pass_voxels_open(b.pass, desc, &context);
    gpu_test_ok(b.grid);
    effect_add_grid(e, b.grid);
    return b;
}

static const pass_voxels_desc usual = {.box = {{0.25f, 0.25f, -1.25f}, {2.75f, 2.75f, 1.25f}},
                                       .size = {40, 40, 40}};

static void show(effect *e, const field *value) {
    pass *p = add(e, NULL, "plane.comp");
    gpu_test_ok(value && pass_set_field(p, "value", value));
    finish(e, p, SIZE, SIZE);
}

typedef struct place {
    float x, y;
} place;

static place place_of(int pixel) {
    return (place){3 * ((float)(pixel % SIZE) + 0.5f) / SIZE,
                   3 * ((float)(pixel / SIZE) + 0.5f) / SIZE};
}

// Of the crate at the height of the picture.
static float to_crate(place at) {
    float x = fabsf(at.x - 1.5f) - 1, y = fabsf(at.y - 1.5f) - 1;
    float a = fmaxf(x, 0), b = fmaxf(y, 0);
    return sqrtf(a * a + b * b) + fminf(fmaxf(fmaxf(x, y), 0.4f - 1), 0);
}

static float *draw(effect *e, double frame) {
    gpu_test_ok(effect_render(e, frame, true));
    return read_picture(e);
}

static void inside_and_distance_are_those_of_the_mesh(void **state) {
    for (int i = 0; i < 2; i++) {
        effect *e = open_effect(&(effect_desc){.device = *state});
        body b = add_body(e, &usual);
        gpu_test_ok(pass_declare(b.pass));
        show(e, pass_voxels_field(b.pass, i ? "distance" : "inside"));
        float *pixels = draw(e, 1);
        for (int k = 0; k < PIXELS; k++) {
            float far = to_crate(place_of(k)), got = pixels[4 * k];
            // Between texels distances are mixed; beyond the box they go around by way of it.
            float most = far < 0.2f ? 0.022f : 0.06f; // at the edges
            bool right = i ? fabsf(got - far) < most : fabsf(got - (far < 0)) < 1e-3f;
            if (!right && (i || fabsf(far) > 2.5f / 40))
                fail_msg("%s at pixel %d %d: %g, %g m from it", i ? "distance" : "inside", k % SIZE,
                         k / SIZE, (double)got, (double)far);
        }
        mem_free(pixels);
        effect_destroy(e);
    }
}

static void box_is_that_of_the_meshes_and_a_margin(void **state) {
    effect *e = open_effect(&(effect_desc){.device = *state});
    body b = add_body(e, &(pass_voxels_desc){.resolution = 24});
    gpu_test_ok(pass_declare(b.pass));
    assert_int_equal(b.grid->size[0], 24);
    assert_int_equal(b.grid->size[2], 24);
    float cell = 2.0f / 20;
    assert_true(fabsf(b.grid->box.min.x - (0.5f - 2 * cell)) < 1e-3f);
    assert_true(fabsf(b.grid->box.max.z - (1 + 2 * cell)) < 1e-3f);
    assert_null(pass_voxels_field(b.pass, "insid"));
    assert_non_null(strstr(err_get(), "did you mean 'inside'"));
    effect_destroy(e);
}

static void velocity_is_that_of_the_mesh_and_stops_with_it(void **state) {
    static const curve_key keys[] = {{0, {0.9f, 1.5f, 0}}, {0.2, {1.1f, 1.5f, 0}}};
    effect *e = open_effect(&(effect_desc){.device = *state});
    gpu_test_ok(effect_set_timeline(e, 10, 11, 1));
    body b = add_body(e, &usual);
    const curve *c = curve_create(effect_memory(e), &(curve){CURVE_LINEAR, 3, keys, 2, 0});
    b.mesh->position = field_curve(effect_memory(e), c);
    gpu_test_ok(pass_declare(b.pass));
    const field *velocity = pass_voxels_field(b.pass, "velocity");
    show(e, field_swizzle(effect_memory(e), velocity, "x"));
    static const float want[] = {0, 1, 1, 0, 0};
    for (int i = 0; i < 5; i++) {
        float *pixels = draw(e, i + 1);
        float middle = pixels[4 * (SIZE / 2 * SIZE + SIZE / 2)];
        if (fabsf(middle - want[i]) > 0.01f) fail_msg("frame %d: %g m/s", i + 1, (double)middle);
        assert_true(pixels[4 * (SIZE / 2 * SIZE + SIZE - 1)] == 0);
        mem_free(pixels);
    }
    assert_int_equal(b.grid->state.content, 4); // the last frame has nothing new
    assert_int_equal(voxels_get_work(pass_voxels_get(b.pass)).updates, 3);
    effect_destroy(e);
}

static void what_stands_still_is_computed_once(void **state) {
    effect *e = open_effect(&(effect_desc){.device = *state});
    gpu_test_ok(effect_set_timeline(e, 10, 11, 1));
    body b = add_body(e, &usual);
    gpu_test_ok(pass_declare(b.pass));
    const field *inside = pass_voxels_field(b.pass, "inside");
    const field *distance = pass_voxels_field(b.pass, "distance");
    show(e, make(e, "add", inside, distance));
    float *first = draw(e, 1);
    for (int i = 2; i < 5; i++) {
        float *pixels = draw(e, i);
        assert_memory_equal(pixels, first, 4 * PIXELS * sizeof *pixels);
        mem_free(pixels);
    }
    assert_int_equal(b.grid->state.content, 2);
    gpu_test_ok(effect_allocate(e, SIZE + 2, SIZE + 2)); // another size of the picture
    mem_free(draw(e, 9));
    assert_int_equal(b.grid->state.content, 2);
    assert_int_equal(voxels_get_work(pass_voxels_get(b.pass)).updates, 1);
    mem_free(first);
    effect_destroy(e);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(inside_and_distance_are_those_of_the_mesh),
        cmocka_unit_test(box_is_that_of_the_meshes_and_a_margin),
        cmocka_unit_test(velocity_is_that_of_the_mesh_and_stops_with_it),
        cmocka_unit_test(what_stands_still_is_computed_once),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
