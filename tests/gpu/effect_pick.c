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
    gpu_test_ok(pass_declare(p) && effect_set_output(e, pass_output(p, "depth")));
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

static const struct CMUnitTest tests[] = {cmocka_unit_test(a_pixel_shows_what_its_ray_meets)};

int main(void) {
    return gpu_test_run(tests, COUNT_OF(tests));
}
