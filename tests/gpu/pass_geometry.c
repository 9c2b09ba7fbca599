// What is solid: its depth, what hides what, and how a volume ends at it.
#include "pass_test.h"

enum { WIDTH = 32, HEIGHT = 32, PIXELS = WIDTH * HEIGHT };

typedef struct vector {
    double x, y, z;
} vector;

// Through the middle of a pixel, one metre deep, for the world's camera: it looks along +Y.
static vector pixel_ray(const pass_world *w, uint32_t x, uint32_t y) {
    double u = (x + 0.5) / WIDTH, v = (y + 0.5) / HEIGHT;
    return (vector){(2 * u - 1) * (double)w->frame.lens.v[0], 1,
                    (1 - 2 * v) * (double)w->frame.lens.v[1]};
}

static double length(vector v) {
    return sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

// Depths at which a ray from (0, -5, 0) enters and leaves a cube around the origin.
static bool hit_cube(vector ray, double half, double *near, double *far) {
    const double origin[3] = {0, -5, 0}, along[3] = {ray.x, ray.y, ray.z};
    *near = 0;
    *far = 1e9;
    for (int i = 0; i < 3; i++) {
        double a = (-half - origin[i]) / along[i], b = (half - origin[i]) / along[i];
        *near = fmax(*near, fmin(a, b));
        *far = fmin(*far, fmax(a, b));
    }
    return *near < *far;
}

static const char *way = "raster"; // in which the test that runs finds what is solid

static int by_rays(void **state) {
    (void)state;
    way = "rays";
    return 0;
}

static int drawn(void **state) {
    (void)state;
    way = "raster";
    return 0;
}

static pass *add_geometry(pass_world *w, scene_mesh *const *meshes, size_t count) {
    pass *p = world_add(w, "geometry", NULL, "geometry");
    gpu_test_ok(pass_set_option(p, "mode", way));
    for (size_t i = 0; i < count; i++) gpu_test_ok(pass_add_mesh(p, meshes[i]));
    gpu_test_ok(pass_declare(p));
    return p;
}

static pass *add_shade(pass_world *w, pass *geometry) {
    pass *p = world_add(w, "shade", NULL, "shade");
    pass_add_source(p, geometry);
    gpu_test_ok(pass_declare(p));
    return p;
}

// ---- depth ------------------------------------------------------------------------------------

static void depth_is_the_distance_along_the_view(void **state) {
    pass_world w;
    world_open(&w, *state);
    scene_mesh *plane = world_mesh(&w, "plane.obj");
    plane->position = triple(&w, 0.5f, 2, -0.25f);
    plane->rotation = triple(&w, 30, 0, 0);
    plane->scale = number(&w, 20);
    pass *p = add_geometry(&w, &plane, 1);
    graph_add_output(w.host.graph, pass_output(p, "depth"));
    world_render(&w, WIDTH, HEIGHT, pass_output(p, "albedo"));
    float *depth = world_read_depth(&w, pass_output(p, "depth"));
    // The plane faced -Y; turned by 30 degrees about X its normal is (0, -cos, -sin).
    double c = cos(GLM_PI / 6), s = sin(GLM_PI / 6);
    double least = 1e9, greatest = 0;
    for (uint32_t i = 0; i < PIXELS; i++) {
        vector ray = pixel_ray(&w, i % WIDTH, i / WIDTH);
        double want = (c * (2 + 5) + s * -0.25) / (c * ray.y + s * ray.z);
        if (!(fabs((double)depth[i] - want) < 1e-4 * want))
            fail_msg("pixel (%u, %u): %.7f, not %.7f", i % WIDTH, i / WIDTH, (double)depth[i],
                     want);
        least = fmin(least, want);
        greatest = fmax(greatest, want);
    }
    assert_true(greatest > 1.3 * least);
    mem_free(depth);
    world_close(&w);
}

static void sky_is_where_nothing_is(void **state) {
    for (int with_mesh = 0; with_mesh < 2; with_mesh++) {
        pass_world w;
        world_open(&w, *state);
        w.scene.sky.strength = number(&w, 1);
        w.scene.sky.zenith = triple(&w, 0, 0.25f, 1);
        w.scene.sky.horizon = triple(&w, 1, 0.5f, 0);
        scene_mesh *crate = world_mesh(&w, "crate.obj");
        pass *p = add_geometry(&w, &crate, (size_t)with_mesh), *shade = add_shade(&w, p);
        graph_add_output(w.host.graph, pass_output(p, "depth"));
        world_render(&w, WIDTH, HEIGHT, pass_output(shade, "color"));
        float *color = world_read(&w, pass_output(shade, "color"));
        float *depth = world_read_depth(&w, pass_output(p, "depth"));
        size_t covered = 0;
        for (uint32_t i = 0; i < PIXELS; i++) {
            vector ray = pixel_ray(&w, i % WIDTH, i / WIDTH);
            double near, far;
            assert_true(color[4 * i + 3] == 1);
            if (with_mesh && hit_cube(ray, 1, &near, &far)) {
                assert_true(fabs((double)depth[i] - near) < 1e-4 * near);
                covered++;
                continue;
            }
            double up = sqrt(fmax(ray.z / length(ray), 0));
            assert_true(depth[i] == 1e9f);
            assert_true(fabs((double)color[4 * i] - (1 - up)) < 0.002);
            assert_true(fabs((double)color[4 * i + 2] - up) < 0.002);
        }
        assert_true(with_mesh ? covered > PIXELS / 8 && covered < PIXELS : covered == 0);
        mem_free(color);
        mem_free(depth);
        world_close(&w);
    }
}

static void sky_alpha_0_leaves_the_sky_clear(void **state) {
    pass_world w;
    world_open(&w, *state);
    w.scene.sky.strength = number(&w, 1);
    scene_mesh *crate = world_mesh(&w, "crate.obj");
    pass *p = world_add(&w, "shade", NULL, "shade");
    pass_add_source(p, add_geometry(&w, &crate, 1));
    gpu_test_ok(pass_set_uniform(p, "sky_alpha", number(&w, 0)));
    gpu_test_ok(pass_declare(p));
    world_render(&w, WIDTH, HEIGHT, pass_output(p, "color"));
    float *color = world_read(&w, pass_output(p, "color"));
    const float *corner = color, *centre = color + 4 * (HEIGHT / 2 * WIDTH + WIDTH / 2);
    assert_true(corner[0] == 0 && corner[1] == 0 && corner[2] == 0 && corner[3] == 0);
    assert_true(centre[3] == 1 && centre[2] > 0);
    mem_free(color);
    world_close(&w);
}

// ---- what hides what --------------------------------------------------------------------------

static void nearer_mesh_hides_the_farther_in_either_order(void **state) {
    for (int order = 0; order < 2; order++) {
        pass_world w;
        world_open(&w, *state);
        scene_mesh *near = world_mesh(&w, "plane.obj"), *far = world_mesh(&w, "plane.obj");
        near->position = triple(&w, -1, 0, 0);
        near->color = triple(&w, 1, 0, 0);
        far->position = triple(&w, 0, 1, 0);
        far->color = triple(&w, 0, 1, 0);
        far->scale = number(&w, 3);
        scene_mesh *both[] = {order ? far : near, order ? near : far};
        pass *p = add_geometry(&w, both, 2);
        graph_add_output(w.host.graph, pass_output(p, "depth"));
        world_render(&w, WIDTH, HEIGHT, pass_output(p, "albedo"));
        float *color = world_read(&w, pass_output(p, "albedo"));
        float *depth = world_read_depth(&w, pass_output(p, "depth"));
        for (uint32_t x = 0; x < WIDTH; x++) {
            uint32_t i = HEIGHT / 2 * WIDTH + x;
            bool left = pixel_ray(&w, x, HEIGHT / 2).x < 0;
            assert_true(fabsf(depth[i] - (left ? 5 : 6)) < 1e-3f);
            const float *seen = color + 4 * i;
            assert_true(left ? seen[0] > 0 && seen[1] == 0 : seen[0] == 0 && seen[1] > 0);
        }
        mem_free(color);
        mem_free(depth);
        world_close(&w);
    }
}

static void normal_is_the_surfaces_turned_towards_the_viewer(void **state) {
    for (int side = 0; side < 2; side++) {
        pass_world w;
        world_open(&w, *state);
        scene_mesh *plane = world_mesh(&w, "plane.obj");
        plane->rotation = triple(&w, 30, 0, side ? 180 : 0); // seen from behind it is the same
        plane->scale = number(&w, 20);
        plane->color = triple(&w, 1, 0.5f, 0.25f);
        pass *p = add_geometry(&w, &plane, 1);
        graph_add_output(w.host.graph, pass_output(p, "albedo"));
        world_render(&w, WIDTH, HEIGHT, pass_output(p, "normal"));
        float *normal = world_read(&w, pass_output(p, "normal"));
        float *albedo = world_read(&w, pass_output(p, "albedo"));
        double tilt = GLM_PI / 6, want[] = {0, -cos(tilt), side ? sin(tilt) : -sin(tilt)};
        for (int c = 0; c < 3; c++) {
            assert_true(fabs((double)normal[4 * (PIXELS / 2) + (size_t)c] - want[c]) < 0.001);
            float base = plane->data.parts[0].color[c] * (c == 0 ? 1 : c == 1 ? 0.5f : 0.25f);
            assert_true(base > 0 && fabsf(albedo[4 * (PIXELS / 2) + c] - base) < 0.001f);
        }
        mem_free(normal);
        mem_free(albedo);
        world_close(&w);
    }
}

static void texture_is_decoded_from_srgb_and_multiplied(void **state) {
    static const uint8_t texels[] = {188, 0, 255, 255, 0, 188, 255, 0}; // the right half is a hole
    static const mesh_texture texture = {2, 1, texels};
    static const mesh_vertex corners[] = {{{-9, 0, -9}, 0, {0, -1, 0}, 0},
                                          {{9, 0, -9}, 1, {0, -1, 0}, 0},
                                          {{9, 0, 9}, 1, {0, -1, 0}, 1},
                                          {{-9, 0, 9}, 0, {0, -1, 0}, 1}};
    static const uint32_t indices[] = {0, 1, 2, 0, 2, 3};
    static const mesh_part part = {.first = 0, .count = 6, .color = {1, 1, 0.5f, 1}, .texture = 0};
    pass_world w;
    world_open(&w, *state);
    scene_mesh *mesh = world_mesh(&w, "plane.obj");
    mesh->data = (mesh_data){.vertices = corners,
                             .vertex_count = 4,
                             .indices = indices,
                             .index_count = 6,
                             .parts = &part,
                             .part_count = 1,
                             .textures = &texture,
                             .texture_count = 1,
                             .box = {{-9, 0, -9}, {9, 0, 9}}};
    pass *p = add_geometry(&w, &mesh, 1);
    graph_add_output(w.host.graph, pass_output(p, "depth"));
    world_render(&w, WIDTH, HEIGHT, pass_output(p, "albedo"));
    float *color = world_read(&w, pass_output(p, "albedo"));
    float *depth = world_read_depth(&w, pass_output(p, "depth"));
    // 4 m of 18 are seen; the texel's middle is at a quarter, so that all is blended near the
    // middle.
    for (uint32_t y = 0; y < HEIGHT; y += 7) {
        uint32_t left = y * WIDTH, right = left + WIDTH - 1;
        assert_true(fabsf(depth[left] - 5) < 1e-3f && depth[right] == 1e9f);
        double x = pixel_ray(&w, 0, y).x * 5 / 18, share = 0.5 - 2 * x;      // of the left texel
        assert_true(fabs((double)color[4 * left] - share * 0.5029) < 0.005); // 188 / 255 in sRGB
        assert_true(fabs((double)color[4 * left + 2] - 0.5) < 0.005);
    }
    mem_free(color);
    mem_free(depth);
    world_close(&w);
}

// ---- a volume around something solid ------------------------------------------------------------

enum { STEPS = 64 };

// Opacity of smoke of density 0.4 in a cube of half-size 1 before a crate of half-size 0.25.
static double smoke(const pass_world *w, uint32_t i, bool paper, bool *solid) {
    vector ray = pixel_ray(w, i % WIDTH, i / WIDTH);
    double near, far, front, back;
    *solid = hit_cube(ray, 0.25, &front, &back);
    if (!hit_cube(ray, 1, &near, &far)) return 0;
    double seen = *solid ? front - near : far - near;
    if (!paper) return 1 - exp(-0.4 * seen * length(ray));
    // As many of the N samples, which begin at the entry, as lie before the crate.
    double count = fmin(floor(seen / (far - near) * STEPS) + 1, STEPS);
    return 1 - pow(1 - 0.4 * 4 / STEPS, count);
}

static void crate_in_smoke(gpu *device, const char *mode) {
    pass_world w;
    world_open(&w, device);
    scene_mesh *crate = world_mesh(&w, "crate.obj");
    crate->scale = number(&w, 0.25f);
    pass *solid = add_geometry(&w, &crate, 1), *p = world_add(&w, "march", NULL, "march");
    gpu_test_ok(pass_set_option(p, "mode", mode));
    gpu_test_ok(pass_set_field(p, "density", block(&w, 1, 0.4f)));
    gpu_test_ok(pass_set_image(p, "depth", pass_output(solid, "depth")));
    gpu_test_ok(pass_set_uniform(p, "steps", number(&w, STEPS)));
    gpu_test_ok(pass_set_uniform(p, "opacity", number(&w, 4)));
    gpu_test_ok(pass_set_uniform(p, "depth_bias", number(&w, 0)));
    gpu_test_ok(pass_set_uniform(p, "early_exit", number(&w, 0)));
    gpu_test_ok(pass_declare(p));
    world_render(&w, WIDTH, HEIGHT, pass_output(p, "color"));
    float *pixels = world_read(&w, pass_output(p, "color"));
    size_t before = 0;
    bool paper = strcmp(mode, "paper") == 0;
    for (uint32_t i = 0; i < PIXELS; i++) {
        bool hidden;
        double want = smoke(&w, i, paper, &hidden), got = (double)pixels[4 * i + 3];
        // A sample lies on the face where the ray enters, and one may lie on the crate: on which
        // side, rounding says.
        double tolerance = paper ? 2.1 * 0.4 * 4 / STEPS * (1 - fmin(got, want)) : 0.002;
        if (!(fabs(got - want) <= tolerance))
            fail_msg("%s, pixel (%u, %u)%s: opacity %.5f, not %.5f", mode, i % WIDTH, i / WIDTH,
                     hidden ? " before the crate" : "", got, want);
        before += hidden;
    }
    assert_true(before > 8);
    mem_free(pixels);
    world_close(&w);
}

static void smoke_ends_at_the_crate_in_it(void **state) {
    crate_in_smoke(*state, "physical");
}

static void smoke_ends_at_the_crate_in_mode_paper_too(void **state) {
    crate_in_smoke(*state, "paper");
}

// Greatest difference of the smoke's light from that of a full-resolution march, on pixels of the
// crate. The smoke glows and all else is black, so that light is opacity.
static double halo(gpu *device, bool with_edge, float scale) {
    pass_world w;
    world_open(&w, device);
    scene_mesh *crate = world_mesh(&w, "crate.obj");
    crate->scale = number(&w, 0.5f);
    pass *solid = add_geometry(&w, &crate, 1);
    pass *volume = world_add(&w, "march", NULL, "march");
    gpu_test_ok(pass_set_field(volume, "density", block(&w, 1, 1.2f)));
    gpu_test_ok(pass_set_field(volume, "radiance", triple(&w, 1, 1, 1)));
    gpu_test_ok(pass_set_image(volume, "depth", pass_output(solid, "depth")));
    gpu_test_ok(pass_set_uniform(volume, "depth_bias", number(&w, 0)));
    gpu_test_ok(pass_set_uniform(volume, "early_exit", number(&w, 0)));
    gpu_test_ok(pass_set_scale(volume, scale));
    gpu_test_ok(pass_declare(volume));
    pass *over = world_add(&w, "over", NULL, "over");
    gpu_test_ok(pass_set_image(over, "volume", pass_output(volume, "color")));
    gpu_test_ok(pass_set_image(over, "source", pass_output(add_shade(&w, solid), "color")));
    if (with_edge) {
        gpu_test_ok(pass_set_image(over, "depth", pass_output(solid, "depth")));
        gpu_test_ok(pass_set_image(over, "edge", pass_output(volume, "edge")));
    }
    gpu_test_ok(pass_declare(over));
    world_render(&w, WIDTH, HEIGHT, pass_output(over, "color"));
    float *pixels = world_read(&w, pass_output(over, "color"));
    double worst = 0;
    for (uint32_t i = 0; i < PIXELS; i++) {
        vector ray = pixel_ray(&w, i % WIDTH, i / WIDTH);
        double near, far, front, back;
        if (!hit_cube(ray, 0.5, &front, &back) || front > 4.5001) continue;
        assert_true(hit_cube(ray, 1, &near, &far));
        double want = 1 - exp(-1.2 * (front - near) * length(ray));
        worst = fmax(worst, fabs((double)pixels[4 * i] - want));
    }
    mem_free(pixels);
    world_close(&w);
    return worst;
}

static void quarter_resolution_has_no_halo_around_the_crate(void **state) {
    double full = halo(*state, true, 1), quarter = halo(*state, true, 0.25f);
    double careless = halo(*state, false, 0.25f);
    if (full > 0.002) fail_msg("full resolution is off by %g", full);
    if (quarter > 0.01) fail_msg("quarter resolution is off by %g", quarter);
    assert_true(careless > 0.1); // what the edges are for
}

#define BOTH_WAYS(TEST) cmocka_unit_test_setup(TEST, by_rays), cmocka_unit_test_setup(TEST, drawn)

int main(void) {
    static const struct CMUnitTest tests[] = {
        BOTH_WAYS(depth_is_the_distance_along_the_view),
        BOTH_WAYS(sky_is_where_nothing_is),
        BOTH_WAYS(sky_alpha_0_leaves_the_sky_clear),
        BOTH_WAYS(nearer_mesh_hides_the_farther_in_either_order),
        BOTH_WAYS(normal_is_the_surfaces_turned_towards_the_viewer),
        BOTH_WAYS(texture_is_decoded_from_srgb_and_multiplied),
        cmocka_unit_test(smoke_ends_at_the_crate_in_it),
        cmocka_unit_test(smoke_ends_at_the_crate_in_mode_paper_too),
        cmocka_unit_test(quarter_resolution_has_no_halo_around_the_crate),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
