// Which point lights get maps of shadows, and what of a lamp's light these let through. The scene
// is a wall at y = 0 that faces the camera, which stands at (0, -5, 0).
#include "pass/light/point_lights.h"
#include "pass_test.h"

enum { SIZE = 64, PIXELS = SIZE * SIZE, FACES = 6 };

// ---- the choice ---------------------------------------------------------------------------------

typedef struct given_light {
    float position[3];
    float power; // W
} given_light;

static void add_lights(pass_world *w, const given_light *given, size_t count) {
    scene_light *lights = arena_alloc(&w->memory, count * sizeof *lights);
    for (size_t i = 0; i < count; i++)
        lights[i] = (scene_light){
            .kind = SCENE_POINT,
            .position = triple(w, given[i].position[0], given[i].position[1], given[i].position[2]),
            .color = triple(w, 1, 1, 1),
            .power = number(w, given[i].power),
            .radius = number(w, 0),
        };
    w->scene.lights = lights;
    w->scene.light_count = count;
}

// The texel of each light in `shadow_views`: first view, how many, how dark. `rows`: those of
// views.
static float *read_choice(pass_world *w, const char *points, float fade) {
    pass *p = world_add(w, "shadow_maps", NULL, "shadows");
    gpu_test_ok(pass_add_mesh(p, world_mesh(w, "plane.obj")));
    gpu_test_ok(pass_set_option(p, "cascades", "0"));
    gpu_test_ok(pass_set_option(p, "points", points));
    gpu_test_ok(pass_set_uniform(p, "point_fade", number(w, fade)));
    gpu_test_ok(pass_declare(p));
    graph_image views = pass_output(p, "shadow_views");
    world_render(w, SIZE, SIZE, views);
    gpu_image *image = graph_get_image(w->host.graph, views);
    const gpu_image_desc *desc = gpu_image_get_desc(image);
    size_t size = (size_t)desc->width * desc->height * 16;
    float *out = mem_alloc(size);
    gpu_test_ok(gpu_image_read(w->host.device, image, out, size));
    float *lights =
        mem_copy(out + (1 + (size_t)atoi(points) * FACES) * desc->width * 4, desc->width * 16);
    mem_free(out);
    return lights;
}

static void the_strongest_lights_in_sight_have_maps(void **state) {
    static const given_light given[] = {
        {{0, -1, 0}, 100},   {{1, -1, 0}, 300},  {{0, -4, 0.2f}, 90}, // near, so third
        {{0, -50, 0}, 1e3f}, {{0, 40, 0}, 1e3f}, {{0, -2, 0}, 0},
    };
    pass_world w;
    world_open(&w, *state);
    add_lights(&w, given, COUNT_OF(given));
    float *c = read_choice(&w, "2", 0); // light 0 is the sun
    const float views[COUNT_OF(given) + 1] = {0, 0, 6, 6, 0, 0, 0};
    for (size_t i = 0; i < COUNT_OF(views); i++)
        if (c[4 * i + 1] != views[i])
            fail_msg("light %zu has %g views, not %g", i, (double)c[4 * i + 1], (double)views[i]);
    assert_true(c[4 * 3] == 0 && c[4 * 2] == 6); // the nearest comes first
    assert_true(c[4 * 3 + 2] == 1 && c[4 * 2 + 2] == 1);
    mem_free(c);
    world_close(&w);
}

// No shadow appears suddenly when a light becomes stronger than another.
static void shadows_fade_where_the_choice_is_close(void **state) {
    static const float second[] = {0.5f, 0.95f, 0.999f};
    static const float want[] = {1, 0.5f, 0.01f};
    for (size_t i = 0; i < COUNT_OF(second); i++) {
        const given_light given[] = {{{0, -1, 0}, 100}, {{0, -1, 0}, 100 * second[i]}};
        pass_world w;
        world_open(&w, *state);
        add_lights(&w, given, COUNT_OF(given));
        float *c = read_choice(&w, "1", 0.1f);
        assert_true(fabsf(c[4 * 1 + 2] - want[i]) < 1e-3f && c[4 * 2 + 1] == 0);
        mem_free(c);
        world_close(&w);
    }
}

// ---- frames -------------------------------------------------------------------------------------

// A crate before the wall; the sun from the right.
static pass *open_crate(pass_world *w, gpu *device, float x, float azimuth) {
    world_open(w, device);
    world_mesh(w, "plane.obj")->scale = number(w, 200);
    scene_mesh *crate = world_mesh(w, "crate.obj");
    crate->scale = number(w, 0.2f);
    crate->position = triple(w, x, -1, 0);
    w->scene.sun.strength = number(w, GLM_PIf);
    w->scene.sun.azimuth = number(w, azimuth);
    w->scene.sun.elevation = number(w, 0);
    pass *geometry = world_add(w, "geometry", NULL, "geometry");
    for (size_t i = 0; i < w->mesh_count; i++) gpu_test_ok(pass_add_mesh(geometry, &w->meshes[i]));
    gpu_test_ok(pass_declare(geometry));
    pass *maps = world_add(w, "shadow_maps", NULL, "shadows");
    pass_add_source(maps, geometry);
    gpu_test_ok(pass_set_option(maps, "size", "512"));
    gpu_test_ok(pass_declare(maps));
    pass *p = world_add(w, "shade", NULL, "shade");
    pass_add_source(p, geometry);
    pass_add_source(p, maps);
    gpu_test_ok(pass_set_option(p, "shadows_by", "maps"));
    gpu_test_ok(pass_declare(p));
    world_render(w, SIZE, SIZE, pass_output(p, "color"));
    return p;
}

// As if it were the first frame of a world where all stands so from the beginning.
static void expect_fresh(pass_world *w, pass *shade, gpu *device, float x, float azimuth) {
    pass_world fresh;
    pass *p = open_crate(&fresh, device, x, azimuth);
    float *got = world_read(w, pass_output(shade, "color"));
    float *want = world_read(&fresh, pass_output(p, "color"));
    if (memcmp(got, want, PIXELS * 16) != 0)
        fail_msg("crate at %g, sun at %g: not as drawn anew", (double)x, (double)azimuth);
    mem_free(got);
    mem_free(want);
    world_close(&fresh);
}

// Maps that nothing has changed for are kept, others are not.
static void maps_follow_what_moves(void **state) {
    pass_world w;
    pass *p = open_crate(&w, *state, 0.3f, -60);
    world_frame(&w, SIZE, SIZE, 2);
    expect_fresh(&w, p, *state, 0.3f, -60);
    w.meshes[1].position = triple(&w, -0.5f, -1, 0);
    world_frame(&w, SIZE, SIZE, 3);
    expect_fresh(&w, p, *state, -0.5f, -60);
    w.scene.sun.azimuth = number(&w, -110);
    world_frame(&w, SIZE, SIZE, 4);
    expect_fresh(&w, p, *state, -0.5f, -110);
    world_close(&w);
}

// ---- lamps --------------------------------------------------------------------------------------

static void set(pass *p, const char *name, const field *value) {
    gpu_test_ok(pass_set_field(p, name, value));
}

// Two lamps before the wall and a crate between, lit by rays or by maps.
static float *shade_lamps(pass_world *w, bool maps) {
    world_mesh(w, "plane.obj")->scale = number(w, 200);
    scene_mesh *crate = world_mesh(w, "crate.obj");
    crate->scale = number(w, 0.2f);
    crate->position = triple(w, 0.1f, -0.7f, 0.2f);
    pass *lamps = world_add(w, "point_lights", NULL, "lamps");
    gpu_test_ok(pass_point_lights_open(lamps, 2, NULL));
    const field *args[FIELD_MAX_ARGS] = {NULL};
    const field *index = field_make(&w->memory, "light_index", args, NULL);
    const field *places[FIELD_MAX_ARGS] = {index, number(w, -1.5f), number(w, 0.5f)};
    set(lamps, "position", field_make(&w->memory, "vec", places, NULL));
    set(lamps, "power", number(w, 400));
    gpu_test_ok(pass_declare(lamps));
    pass *geometry = world_add(w, "geometry", NULL, "geometry");
    for (size_t i = 0; i < w->mesh_count; i++) gpu_test_ok(pass_add_mesh(geometry, &w->meshes[i]));
    gpu_test_ok(pass_declare(geometry));
    pass *p = world_add(w, "shade", NULL, "shade");
    pass_add_source(p, geometry);
    pass_add_source(p, lamps);
    if (maps) {
        pass *shadows = world_add(w, "shadow_maps", NULL, "shadows");
        pass_add_source(shadows, geometry);
        pass_add_source(shadows, lamps);
        gpu_test_ok(pass_set_option(shadows, "point_size", "1024"));
        gpu_test_ok(pass_set_uniform(shadows, "shadow_radius", number(w, 0.5f)));
        gpu_test_ok(pass_declare(shadows));
        pass_add_source(p, shadows);
        gpu_test_ok(pass_set_option(p, "shadows_by", "rays")); // but lamps have their maps
    } else {
        gpu_test_ok(pass_set_option(p, "point_light_shadows", "rays"));
    }
    gpu_test_ok(pass_declare(p));
    world_render(w, SIZE, SIZE, pass_output(p, "color"));
    return world_read(w, pass_output(p, "color"));
}

static void lamps_are_hidden_by_maps_as_by_rays(void **state) {
    float *pictures[2] = {NULL};
    for (int maps = 0; maps < 2; maps++) {
        pass_world w;
        world_open(&w, *state);
        pictures[maps] = shade_lamps(&w, maps);
        world_close(&w);
    }
    size_t off = 0, dark = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        off += fabsf(pictures[1][4 * i] - pictures[0][4 * i]) > 0.02f * pictures[0][4 * i];
        dark += pictures[0][4 * i] < 0.7f * pictures[0][0];
    }
    if (off > PIXELS / 50) fail_msg("%zu pixels are not as by rays", off);
    assert_true(dark > 20);
    mem_free(pictures[0]);
    mem_free(pictures[1]);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_strongest_lights_in_sight_have_maps),
        cmocka_unit_test(shadows_fade_where_the_choice_is_close),
        cmocka_unit_test(maps_follow_what_moves),
        cmocka_unit_test(lamps_are_hidden_by_maps_as_by_rays),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
