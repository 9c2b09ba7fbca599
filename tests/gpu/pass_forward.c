// Materials from meshes to the picture: by rays and drawn, lit by `geometry` and `shade` and by
// `forward`. A ball stands before a wall at y = 0 that faces the camera, which stands at (0, -5,
// 0).
#include "pass/light/point_lights.h"
#include "pass_test.h"
#include "scene/material.h"

enum { WIDTH = 96, HEIGHT = 64, PIXELS = WIDTH * HEIGHT, AROUND = 64, DOWN = 32 };

// ---- a scene ------------------------------------------------------------------------------------

static scene_mesh *add_ball(pass_world *w, float x, float y, float z) {
    static mesh_vertex vertices[(AROUND + 1) * (DOWN + 1)];
    static uint32_t indices[6 * AROUND * DOWN];
    static const mesh_part part = {.count = 6 * AROUND * DOWN,
                                   .color = {0.9f, 0.6f, 0.3f, 1},
                                   .texture = -1,
                                   .specular = 0.5f,
                                   .roughness = 0.4f,
                                   .emission = {0.02f, 0.01f, 0}};
    for (uint32_t i = 0, count = 0; i <= DOWN; i++) {
        for (uint32_t k = 0; k <= AROUND; k++) {
            double up = GLM_PI * i / DOWN, around = 2 * GLM_PI * k / AROUND;
            uint32_t a = i * (AROUND + 1) + k, b = a + AROUND + 1;
            const float n[3] = {(float)(sin(up) * cos(around)), (float)(sin(up) * sin(around)),
                                (float)cos(up)};
            memcpy(vertices[a].position, n, sizeof n);
            memcpy(vertices[a].normal, n, sizeof n);
            if (i == DOWN || k == AROUND) continue;
            const uint32_t corners[] = {a, b, b + 1, a, b + 1, a + 1};
            memcpy(&indices[count], corners, sizeof corners);
            count += COUNT_OF(corners);
        }
    }
    scene_mesh *ball = world_mesh(w, "plane.obj");
    ball->data = (mesh_data){.vertices = vertices,
                             .vertex_count = COUNT_OF(vertices),
                             .indices = indices,
                             .index_count = COUNT_OF(indices),
                             .parts = &part,
                             .part_count = 1,
                             .box = {.min = {-1, -1, -1}, .max = {1, 1, 1}}};
    ball->position = triple(w, x, y, z);
    return ball;
}

static scene_mesh *add_wall(pass_world *w) {
    scene_mesh *wall = world_mesh(w, "plane.obj");
    wall->scale = number(w, 40);
    wall->position = triple(w, 0, 2, 0);
    return wall;
}

static scene_material *give(pass_world *w, scene_mesh *mesh, scene_material values) {
    scene_material *made = arena_copy(&w->memory, &values, sizeof values);
    scene_mesh_set_material(mesh, made, &w->memory);
    return made;
}

// Two balls and a wall, under sun, sky and a lamp that glows.
static void open_scene(pass_world *w, gpu *device) {
    world_open(w, device);
    add_wall(w);
    add_ball(w, -0.9f, 0, 0.1f);
    scene_mesh *metal = add_ball(w, 1.2f, -0.2f, 0);
    give(w, metal,
         (scene_material){.color = triple(w, 0.8f, 0.7f, 0.2f),
                          .metallic = number(w, 0.8f),
                          .roughness = number(w, 0.3f),
                          .no_toon = true});
    w->scene.sun.strength = number(w, 3);
    w->scene.sun.azimuth = number(w, 230);
    w->scene.sky.strength = number(w, 0.4f);
    static scene_light light;
    light = (scene_light){.kind = SCENE_POINT,
                          .position = triple(w, 1, -3, 2),
                          .color = triple(w, 1, 0.5f, 0.2f),
                          .power = number(w, 150),
                          .radius = number(w, 0.1f)};
    w->scene.lights = &light;
    w->scene.light_count = 1;
}

static pass *add_meshes(pass_world *w, const char *type) {
    pass *p = world_add(w, type, NULL, type);
    for (size_t i = 0; i < w->mesh_count; i++) gpu_test_ok(pass_add_mesh(p, &w->meshes[i]));
    return p;
}

// ---- one picture, two ways ----------------------------------------------------------------------

typedef struct setup {
    const char *model;
    float samples; // rays to each light
    bool lamps, maps;
} setup;

static const field *spread(pass_world *w) { // of lamps: {-2, -1, -2} to {2, -1, 2}
    const field *args[FIELD_MAX_ARGS] = {0};
    const field *random = field_make(&w->memory, "light_random", args, NULL);
    args[0] = random;
    args[1] = triple(w, 4, 0, 4);
    const field *scaled = field_make(&w->memory, "mul", args, NULL);
    args[0] = scaled;
    args[1] = triple(w, -2, -1, -2);
    const field *moved = scaled ? field_make(&w->memory, "add", args, NULL) : NULL;
    gpu_test_ok(random && scaled && moved);
    return moved;
}

static pass *add_lamps(pass_world *w) {
    pass *lamps = world_add(w, "point_lights", NULL, "lamps");
    gpu_test_ok(pass_point_lights_open(lamps, 20, NULL));
    gpu_test_ok(pass_set_field(lamps, "position", spread(w)));
    gpu_test_ok(pass_set_field(lamps, "power", number(w, 4)));
    gpu_test_ok(pass_set_field(lamps, "range", number(w, 2)));
    gpu_test_ok(pass_declare(lamps));
    return lamps;
}

// Color of `forward`, or of `geometry` and `shade`.
static float *draw(gpu *device, const setup *s, bool forward) {
    pass_world w;
    open_scene(&w, device);
    pass *lamps = s->lamps ? add_lamps(&w) : NULL, *maps = NULL, *geometry = NULL;
    if (s->maps) {
        maps = add_meshes(&w, "shadow_maps");
        if (lamps) pass_add_source(maps, lamps);
        gpu_test_ok(pass_declare(maps));
    }
    if (!forward) gpu_test_ok(pass_declare(geometry = add_meshes(&w, "geometry")));
    pass *p = forward ? add_meshes(&w, "forward") : world_add(&w, "shade", NULL, "shade");
    pass *const sources[] = {geometry, lamps, maps};
    for (size_t i = 0; i < COUNT_OF(sources); i++)
        if (sources[i]) pass_add_source(p, sources[i]);
    gpu_test_ok(pass_set_option(p, "model", s->model));
    gpu_test_ok(pass_set_option(p, "shadows_by", s->maps ? "maps" : "rays"));
    gpu_test_ok(pass_set_uniform(p, "shadow_samples", number(&w, s->samples)));
    gpu_test_ok(pass_declare(p));
    world_render(&w, WIDTH, HEIGHT, pass_output(p, "color"));
    float *out = world_read(&w, pass_output(p, "color"));
    world_close(&w);
    return out;
}

// At the edges of bands, and of meshes, rounding chooses.
static void assert_same(gpu *device, const setup *s) {
    float *deferred = draw(device, s, false), *forward = draw(device, s, true);
    size_t wrong = 0, lit = 0;
    for (size_t i = 0; i < 4 * PIXELS; i++) {
        float a = deferred[i], b = forward[i];
        wrong += fabsf(a - b) > 0.004f * fmaxf(a, 0.05f);
        lit += a > 0.1f;
    }
    if (wrong > 4 * PIXELS / 200 || lit < PIXELS)
        fail_msg("%s, %g rays%s%s: %zu of %d values differ, %zu are lit", s->model,
                 (double)s->samples, s->lamps ? ", lamps" : "", s->maps ? ", maps" : "", wrong,
                 4 * PIXELS, lit);
    mem_free(deferred);
    mem_free(forward);
}

static void forward_is_as_deferred(void **state) {
    static const setup setups[] = {{.model = "physical", .samples = 1},
                                   {.model = "lambert", .samples = 0},
                                   {.model = "blinn_phong", .samples = 1, .lamps = true},
                                   {.model = "toon", .samples = 1, .lamps = true},
                                   {.model = "physical", .samples = 2, .lamps = true},
                                   {.model = "toon", .samples = 1, .lamps = true, .maps = true}};
    for (size_t i = 0; i < COUNT_OF(setups); i++) assert_same(*state, &setups[i]);
}

// ---- what geometry tells ------------------------------------------------------------------------

typedef struct seen {
    float *surface, *emission;
} seen;

static seen look(gpu *device, const char *mode, bool both) {
    pass_world w;
    open_scene(&w, device);
    pass *p = add_meshes(&w, "geometry");
    gpu_test_ok(pass_set_option(p, "mode", mode) && pass_declare(p));
    if (both) graph_add_output(w.host.graph, pass_output(p, "surface"));
    world_render(&w, WIDTH, HEIGHT, pass_output(p, "emission"));
    assert_true((graph_get_image(w.host.graph, pass_output(p, "surface")) != NULL) == both);
    seen s = {both ? world_read(&w, pass_output(p, "surface")) : NULL,
              world_read(&w, pass_output(p, "emission"))};
    world_close(&w);
    return s;
}

static bool is(const float *pixel, float x, float y, float z, float w) {
    const float want[] = {x, y, z, w};
    for (int i = 0; i < 4; i++)
        if (fabsf(pixel[i] - want[i]) > 1e-3f) return false;
    return true;
}

static void rays_and_triangles_tell_the_same_of_materials(void **state) {
    seen rays = look(*state, "rays", true), drawn = look(*state, "raster", true);
    seen alone = look(*state, "raster", false);
    size_t balls = 0, metals = 0, walls = 0, differ = 0;
    for (size_t i = 0; i < 4 * PIXELS; i += 4) {
        const float *s = &rays.surface[i], *e = &rays.emission[i];
        bool ball = is(s, 0.5f, 0.4f, 0, 1) && is(e, 0.02f, 0.01f, 0, 0);
        bool metal = is(s, 0.5f, 0.3f, 0.8f, 0) && is(e, 0.02f, 0.01f, 0, 0);
        bool wall = is(s, 0, 1, 0, 1) && is(e, 0, 0, 0, 0);
        assert_true(ball || metal || wall);
        balls += ball, metals += metal, walls += wall;
        differ += memcmp(s, &drawn.surface[i], 16) != 0 || memcmp(e, &drawn.emission[i], 16) != 0;
        differ += memcmp(&alone.emission[i], &drawn.emission[i], 16) != 0;
    }
    assert_true(balls > 300 && metals > 300 && walls > 1000);
    if (differ > PIXELS / 100) fail_msg("%zu of %d pixels differ", differ, PIXELS);
    const seen all[] = {rays, drawn, alone};
    for (size_t i = 0; i < COUNT_OF(all); i++) {
        mem_free(all[i].surface);
        mem_free(all[i].emission);
    }
}

static void a_material_that_moves_is_followed(void **state) {
    static const char *const modes[] = {"rays", "raster"};
    for (size_t m = 0; m < COUNT_OF(modes); m++) {
        pass_world w;
        world_open(&w, *state);
        scene_mesh *ball = add_ball(&w, 0, 0, 0);
        scene_material *skin = give(
            &w, ball, (scene_material){.emission = triple(&w, 1, 2, 3), .color = number(&w, 0.5f)});
        pass *p = add_meshes(&w, "geometry");
        gpu_test_ok(pass_set_option(p, "mode", modes[m]) && pass_declare(p));
        graph_add_output(w.host.graph, pass_output(p, "albedo"));
        world_render(&w, WIDTH, HEIGHT, pass_output(p, "emission"));
        size_t middle = 4 * (PIXELS / 2 + WIDTH / 2);
        for (uint32_t frame = 1; frame <= 2; frame++) {
            float *e = world_read(&w, pass_output(p, "emission"));
            float *a = world_read(&w, pass_output(p, "albedo")), k = (float)frame;
            assert_true(is(&e[middle], k, 2 * k, 3 * k, 0));
            assert_true(is(&a[middle], 0.5f / k, 0.5f / k, 0.5f / k, 1));
            mem_free(e);
            mem_free(a);
            skin->emission = triple(&w, 2, 4, 6);
            skin->color = number(&w, 0.25f);
            world_frame(&w, WIDTH, HEIGHT, 2);
        }
        world_close(&w);
    }
}

// What is matte is not asked about, and costs nothing.
static void matte_scenes_have_no_images_of_materials(void **state) {
    pass_world w;
    world_open(&w, *state);
    add_wall(&w);
    pass *geometry = add_meshes(&w, "geometry");
    gpu_test_ok(pass_declare(geometry));
    pass *p = world_add(&w, "shade", NULL, "shade");
    pass_add_source(p, geometry);
    gpu_test_ok(pass_declare(p));
    world_render(&w, WIDTH, HEIGHT, pass_output(p, "color"));
    assert_null(graph_get_image(w.host.graph, pass_output(geometry, "surface")));
    assert_null(graph_get_image(w.host.graph, pass_output(geometry, "emission")));
    world_close(&w);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(forward_is_as_deferred),
        cmocka_unit_test(rays_and_triangles_tell_the_same_of_materials),
        cmocka_unit_test(a_material_that_moves_is_followed),
        cmocka_unit_test(matte_scenes_have_no_images_of_materials),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
