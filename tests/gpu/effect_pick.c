// A ray through a pixel meets what the pixel shows: meshes, instances, the ground beside them.
#include "effect/events.h"
#include "effect_test.h"
#include "shared.h"

enum { WIDTH = 96, HEIGHT = 54, COPIES = 5 };

// Crates in a ring, leaning and of several sizes, and one by itself in the middle.
static scene_instances *add_ring(effect *e, scene_mesh *mesh) {
    struct instance_entry entries[COPIES] = {0};
    for (int i = 0; i < COPIES; i++) {
        float a = 1.2566371f * (float)i;
        entries[i].place = (shared_vec4){{3 * cosf(a), 3 * sinf(a), 0.6f, 0.4f + 0.1f * (float)i}};
        entries[i].turn = (shared_vec4){{0.1f, 0, sinf(a), cosf(a)}};
        glm_quat_normalize(entries[i].turn.v);
        entries[i].color = (shared_vec4){{1, 1, 1, 1}};
    }
    scene_instances_desc desc = {.name = "ring",
                                 .kinds = &mesh,
                                 .kind_count = 1,
                                 .entries = entries,
                                 .count = COPIES,
                                 .position = triple(e, 0.3f, 0, 0),
                                 .rotation = triple(e, 0, 0, 20),
                                 .scale = number(e, 1),
                                 .color = triple(e, 1, 1, 1)};
    scene_instances *ring = effect_add_instances(e, &desc);
    gpu_test_ok(ring);
    return ring;
}

static void a_pixel_shows_what_its_ray_meets(void **state) {
    effect *e = open_effect(&(effect_desc){.device = *state});
    effect_scene(e)->camera.eye = triple(e, 1, -7, 6);
    pass *p = add(e, "geometry", NULL);
    scene_mesh *alone = effect_add_mesh(e, "crate.obj"), *kind = effect_add_mesh(e, "crate.obj");
    gpu_test_ok(alone && kind);
    scene_instances *ring = add_ring(e, kind);
    gpu_test_ok(pass_add_mesh(p, alone) && pass_add_instances(p, ring));
    gpu_test_ok(pass_declare(p) && effect_set_picture(e, EFFECT_OUTPUT, pass_output(p, "depth")));
    gpu_test_ok(effect_check_settings(e) && effect_build(e, WIDTH, HEIGHT));
    gpu_test_ok(effect_render(e, 1, false));
    gpu_image *image = graph_get_image(effect_graph(e), effect_get_picture(e, EFFECT_OUTPUT));
    float *depth = mem_alloc(WIDTH * HEIGHT * sizeof *depth);
    gpu_test_ok(
        gpu_image_read(effect_pass_host(e)->device, image, depth, WIDTH * HEIGHT * sizeof *depth));

    float origin[3], ahead[3], way[3];
    int of_ring = 0, of_mesh = 0, of_ground = 0, wrong = 0;
    bool seen[COPIES] = {false};
    gpu_test_ok(effect_camera_ray(e, 0.5f, 0.5f, origin, ahead));
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        float x = ((float)(i % WIDTH) + 0.5f) / WIDTH, y = ((float)(i / WIDTH) + 0.5f) / HEIGHT;
        gpu_test_ok(effect_camera_ray(e, x, y, origin, way));
        scene_hit hit;
        bool met = effect_pick(e, origin, way, &hit), solid = depth[i] < 1e8f;
        of_ground += met && !hit.mesh;
        float far = met ? hit.distance * glm_vec3_dot(way, ahead) : 0;
        wrong += solid ? !met || fabsf(far - depth[i]) > 1e-3f * depth[i] : met && hit.mesh;
        if (!met || !hit.mesh) continue;
        assert_true(hit.instances ? hit.mesh == kind && hit.instances == ring && hit.index < COPIES
                                  : hit.mesh == alone);
        if (hit.instances) seen[hit.index] = true;
        of_ring += hit.instances != NULL;
        of_mesh += !hit.instances;
        assert_true(glm_vec3_dot(hit.normal, way) < 0);
    }
    mem_free(depth);
    for (int i = 0; i < COPIES; i++) assert_true(seen[i]);
    if (of_ring < 100 || of_mesh < 100 || of_ground < 1000)
        fail_msg("%d, %d, %d pixels", of_ring, of_mesh, of_ground);
    if (wrong > 8) fail_msg("%d pixels show something else", wrong); // edges, by rounding
    effect_destroy(e);
}

// A floor of 40 m by 40 m at z = 0.5, that faces up or down; on it a crate, and beside it another
// one in the air; a roof over the floor at x = 8, that faces down; crates in a ring.
static effect *open_yard(gpu *device, float turn) {
    effect *e = open_effect(&(effect_desc){.device = device});
    pass *p = add(e, "geometry", NULL);
    scene_mesh *floor = effect_add_mesh(e, "plane.obj"), *roof = effect_add_mesh(e, "plane.obj");
    scene_mesh *crate = effect_add_mesh(e, "crate.obj"), *lone = effect_add_mesh(e, "crate.obj");
    scene_mesh *kind = effect_add_mesh(e, "crate.obj");
    gpu_test_ok(floor && roof && crate && lone && kind);
    floor->rotation = triple(e, turn, 0, 0);
    floor->scale = number(e, 20);
    floor->position = triple(e, 0, 0, 0.5f);
    roof->rotation = triple(e, 90, 0, 0);
    roof->position = triple(e, 8, 0, 5);
    crate->position = triple(e, 0, 0, 1.5f);
    lone->position = triple(e, 30, 0, 5);
    gpu_test_ok(pass_add_mesh(p, floor) && pass_add_mesh(p, roof) && pass_add_mesh(p, crate) &&
                pass_add_mesh(p, lone) && pass_add_instances(p, add_ring(e, kind)));
    gpu_test_ok(pass_declare(p) && effect_set_picture(e, EFFECT_OUTPUT, pass_output(p, "depth")));
    gpu_test_ok(effect_check_settings(e) && effect_build(e, WIDTH, HEIGHT));
    gpu_test_ok(effect_render(e, 1, false));
    return e;
}

static void ground_is_what_is_above_as_its_back(void **state) {
    static const struct {
        float at[3];
        bool under;
    } points[] = {
        {{-9, 0, 1}, false},           // above the floor
        {{-9, 0, 0.4f}, true},         // under it
        {{-9, 0, -50}, true},          // however far
        {{0, 0, 1}, false},            // in the crate
        {{0, 0, -1}, true},            // under the floor that the crate is on
        {{8, 0, 2}, false},            // under the roof
        {{30, 0, -1}, false},          // under a crate in the air, beside the floor
        {{30, 0, 5}, false},           // in it
        {{3.12f, 1.03f, 0.7f}, false}, // in one of the instances
        {{60, 0, -1}, false},          // beside everything
    };
    effect *e = open_yard(*state, -90);
    for (size_t i = 0; i < COUNT_OF(points); i++) {
        float height = -1;
        const bool under = effect_is_under_ground(e, points[i].at, &height);
        if (under != points[i].under || (under && fabsf(height - 0.5f) > 1e-4f))
            fail_msg("point %zu: %d, %g m", i, under, (double)height);
    }
    effect_destroy(e);
    e = open_yard(*state, 90); // a ceiling
    assert_false(effect_is_under_ground(e, (float[]){-9, 0, 0.4f}, &(float){0}));
    effect_destroy(e);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_pixel_shows_what_its_ray_meets),
    cmocka_unit_test(ground_is_what_is_above_as_its_back),
};

int main(void) {
    return gpu_test_run(tests, COUNT_OF(tests));
}
