// Maps of shadows against geometry and against rays. The scene is a wall at y = 0 that faces the
// camera, which stands at (0, -5, 0).
#include "pass_test.h"

enum { SIZE = 96, PIXELS = SIZE * SIZE };

static const float light_at_10m = 4 * GLM_PIf * GLM_PIf * 100; // W: radiance 1 of a white wall

// ---- meshes made here ---------------------------------------------------------------------------

static scene_mesh *add_mesh(pass_world *w, const mesh_data *data) {
    scene_mesh *mesh = &w->meshes[w->mesh_count++];
    *mesh = (scene_mesh){.name = "mesh",
                         .position = triple(w, 0, 0, 0),
                         .rotation = triple(w, 0, 0, 0),
                         .scale = number(w, 1),
                         .color = triple(w, 1, 1, 1),
                         .data = *data};
    return mesh;
}

static mesh_part *white_part(pass_world *w, uint32_t count) {
    mesh_part *part = arena_alloc(&w->memory, sizeof *part);
    *part = (mesh_part){.count = count, .color = {1, 1, 1, 1}, .texture = -1, .roughness = 1};
    return part;
}

// Of radius 1, fine enough to be a sphere.
static scene_mesh *add_sphere(pass_world *w, float radius, float x, float y, float z) {
    enum { AROUND = 96, DOWN = 48 };
    mesh_vertex *vertices = arena_alloc(&w->memory, (AROUND + 1) * (DOWN + 1) * sizeof *vertices);
    uint32_t *indices = arena_alloc(&w->memory, 6 * AROUND * DOWN * sizeof *indices), count = 0;
    for (uint32_t i = 0; i <= DOWN; i++) {
        for (uint32_t k = 0; k <= AROUND; k++) {
            float a = GLM_PIf * (float)i / DOWN, b = 2 * GLM_PIf * (float)k / AROUND;
            float p[3] = {sinf(a) * cosf(b), sinf(a) * sinf(b), cosf(a)};
            mesh_vertex *v = &vertices[i * (AROUND + 1) + k];
            memcpy(v->position, p, sizeof p);
            memcpy(v->normal, p, sizeof p);
        }
    }
    for (uint32_t i = 0; i < DOWN; i++) {
        for (uint32_t k = 0; k < AROUND; k++) {
            uint32_t a = i * (AROUND + 1) + k, b = a + AROUND + 1;
            const uint32_t both[] = {a, b, b + 1, a, b + 1, a + 1};
            memcpy(indices + count, both, sizeof both);
            count += 6;
        }
    }
    scene_mesh *mesh = add_mesh(w, &(mesh_data){.vertices = vertices,
                                                .vertex_count = (DOWN + 1) * (AROUND + 1),
                                                .indices = indices,
                                                .index_count = count,
                                                .parts = white_part(w, count),
                                                .part_count = 1,
                                                .box = {.min = {-1, -1, -1}, .max = {1, 1, 1}}});
    mesh->scale = number(w, radius);
    mesh->position = triple(w, x, y, z);
    return mesh;
}

static scene_mesh *add_plane(pass_world *w, float scale, float tilt, float x, float y, float z) {
    scene_mesh *plane = world_mesh(w, "plane.obj");
    plane->scale = number(w, scale);
    plane->rotation = triple(w, tilt, 0, 0);
    plane->position = triple(w, x, y, z);
    return plane;
}

// ---- pictures -----------------------------------------------------------------------------------

static pass *add_maps(pass_world *w, pass *geometry, const pass_named *settings, size_t count) {
    pass *p = world_add(w, "shadow_maps", NULL, "shadows");
    pass_add_source(p, geometry);
    for (size_t i = 0; i < count; i++)
        gpu_test_ok(settings[i].word ? pass_set_option(p, settings[i].name, settings[i].word)
                                     : pass_set_uniform(p, settings[i].name, settings[i].value));
    gpu_test_ok(pass_declare(p));
    return p;
}

static pass *add_geometry(pass_world *w) {
    pass *p = world_add(w, "geometry", NULL, "geometry");
    for (size_t i = 0; i < w->mesh_count; i++) gpu_test_ok(pass_add_mesh(p, &w->meshes[i]));
    for (size_t i = 0; i < w->instances_count; i++)
        gpu_test_ok(pass_add_instances(p, w->instances[i]));
    gpu_test_ok(pass_declare(p));
    return p;
}

// With maps of these settings; NULL: with rays.
static float *shade(pass_world *w, const pass_named *settings, size_t count) {
    pass *geometry = add_geometry(w), *maps = NULL;
    if (settings) maps = add_maps(w, geometry, settings, count);
    pass *p = world_add(w, "shade", NULL, "shade");
    pass_add_source(p, geometry);
    if (maps) pass_add_source(p, maps);
    gpu_test_ok(pass_set_option(p, "shadows_by", maps ? "maps" : "rays"));
    gpu_test_ok(pass_declare(p));
    world_render(w, SIZE, SIZE, pass_output(p, "color"));
    return world_read(w, pass_output(p, "color"));
}

#define SHADE(w, ...)                                                                              \
    shade(w, (const pass_named[]){__VA_ARGS__},                                                    \
          sizeof((const pass_named[]){__VA_ARGS__}) / sizeof(pass_named))

static void pixel_ray(const pass_world *w, size_t i, double out[3]) {
    double u = ((double)(i % SIZE) + 0.5) / SIZE, v = ((double)(i / SIZE) + 0.5) / SIZE;
    out[0] = (2 * u - 1) * (double)w->frame.lens.v[0];
    out[1] = 1;
    out[2] = (1 - 2 * v) * (double)w->frame.lens.v[1];
}

// Distance of a point from a line.
static double off_line(const double at[3], const double way[3], const double point[3]) {
    double d[3], along = 0, length = 0, squared = 0;
    for (int i = 0; i < 3; i++) {
        d[i] = point[i] - at[i];
        along += d[i] * way[i];
        length += way[i] * way[i];
    }
    for (int i = 0; i < 3; i++) squared += d[i] * d[i];
    return sqrt(fmax(squared - along * along / length, 0));
}

static void add_light(pass_world *w, scene_light_kind kind, float x, float y, float z) {
    scene_light *light = arena_alloc(&w->memory, sizeof *light);
    *light = (scene_light){
        .kind = kind,
        .position = triple(w, x, y, z),
        .color = triple(w, 1, 1, 1),
        .power = number(w, light_at_10m),
        .radius = number(w, 0),
        .target = triple(w, 0, 0, 0),
        .angle = number(w, 60),
        .softness = number(w, 0),
    };
    w->scene.lights = light;
    w->scene.light_count = 1;
}

static void shine(pass_world *w, float azimuth, float elevation) { // radiance of the sun: 1
    w->scene.sun.strength = number(w, GLM_PIf);
    w->scene.sun.azimuth = number(w, azimuth);
    w->scene.sun.elevation = number(w, elevation);
}

// ---- against geometry ---------------------------------------------------------------------------

static const double ball[3] = {0.5, -1, 0.3};
static const double radius = 0.4;

// Pixels of the wall that a light at `source` (of the sun: the way to it) shades wrongly, of all
// but those that are nearer than `edge` (m) to the edge of the shadow as seen from the light.
static size_t count_wrong(const pass_world *w, const float *c, const float *lit, bool sun,
                          const double source[3], double edge, size_t *dark) {
    size_t wrong = 0;
    *dark = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        double eye[3] = {0, -5, 0}, ray[3], p[3], way[3];
        pixel_ray(w, i, ray);
        if (off_line(eye, ray, ball) < radius + 0.02) continue;
        for (int k = 0; k < 3; k++) p[k] = eye[k] + 5 * ray[k];
        for (int k = 0; k < 3; k++) way[k] = sun ? source[k] : source[k] - p[k];
        double away = off_line(p, way, ball) - radius;
        if (fabs(away) < edge || !(lit[4 * i] > 0.01f)) continue;
        double seen = (double)(c[4 * i] / lit[4 * i]);
        wrong += fabs(seen - (away > 0)) > 0.02;
        *dark += away < 0;
    }
    return wrong;
}

// The ball before the wall under a light; lit: without the ball.
static void compare_with_geometry(gpu *device, const char *what, scene_light_kind kind,
                                  const double source[3], double texel) {
    float *pictures[2] = {NULL};
    for (int with = 0; with < 2; with++) {
        pass_world w;
        world_open(&w, device);
        add_plane(&w, 20, 0, 0, 0, 0);
        if (with) add_sphere(&w, (float)radius, (float)ball[0], (float)ball[1], (float)ball[2]);
        if (kind)
            add_light(&w, kind, (float)source[0], (float)source[1], (float)source[2]);
        else
            shine(&w, (float)(atan2(source[1], source[0]) * 180 / GLM_PI),
                  (float)(asin(source[2]) * 180 / GLM_PI));
        pictures[with] =
            SHADE(&w, WORD("cascades", "2"), WORD("size", "1024"), WORD("spot_size", "1024"),
                  WORD("point_size", "512"), SET("distance", number(&w, kind ? 20 : 12)),
                  SET("shadow_radius", number(&w, 0.5f)));
        if (with) {
            size_t dark, wrong = count_wrong(&w, pictures[1], pictures[0], !kind, source,
                                             2.5 * texel, &dark);
            if (wrong) fail_msg("%s: %zu pixels are wrong, %zu dark", what, wrong, dark);
            assert_true(dark > 150);
        }
        world_close(&w);
    }
    mem_free(pictures[0]);
    mem_free(pictures[1]);
}

static void shadow_of_a_ball_is_where_geometry_puts_it(void **state) {
    const double sun[3] = {0.48, -0.8, 0.36};
    compare_with_geometry(*state, "sun", 0, sun, 12.0 / 1024);
    const double lamp[3] = {1.5, -3, 1};
    double away = 3; // of the wall's farthest lit point, along an axis
    compare_with_geometry(*state, "spot", SCENE_SPOT, lamp,
                          2 * away * tan(GLM_PI / 6) / 1024 * 1.2);
    compare_with_geometry(*state, "point", SCENE_POINT, lamp, 2 * away / 512);
}

// ---- what must not be shaded, and what must -----------------------------------------------------

// Pixels where two pictures differ by more than a fiftieth of the light.
static size_t count_different(const float *a, const float *b) {
    size_t count = 0;
    for (size_t i = 0; i < PIXELS; i++)
        count += fabsf(a[4 * i] - b[4 * i]) > 0.02f * b[4 * i] + 1e-4f;
    return count;
}

typedef struct bare_scene {
    const char *name;
    float tilt;      // of the only plane, degrees
    float y, z;      // where it is
    float azimuth;   // of the sun
    float elevation; // 0 with the next: it does not shine
    scene_light_kind kind;
    float light[3];
} bare_scene;

// A plane by itself has no shadow, however coarse the map and low the light, and where one cascade
// or face goes over into another.
static void a_plane_does_not_shade_itself(void **state) {
    static const bare_scene scenes[] = {
        {.name = "sun, 3 degrees", .azimuth = -3, .elevation = 1},
        {.name = "sun, 20 degrees", .azimuth = -160, .elevation = 5},
        {.name = "ground", .tilt = -90, .z = -1, .azimuth = 50, .elevation = 12},
        {.name = "ground, high sun", .tilt = -90, .z = -1, .azimuth = 50, .elevation = 80},
        {.name = "slope", .tilt = -70, .z = -1, .azimuth = 200, .elevation = 35},
        {.name = "spot", .kind = SCENE_SPOT, .light = {2.2f, -0.3f, 0.4f}},
        {.name = "point", .kind = SCENE_POINT, .light = {0.9f, -0.1f, 0.4f}},
        {.name = "point, away", .kind = SCENE_POINT, .light = {1, -2, 2}},
    };
    for (size_t i = 0; i < COUNT_OF(scenes); i++) {
        const bare_scene *s = &scenes[i];
        float *pictures[2] = {NULL};
        for (int maps = 0; maps < 2; maps++) {
            pass_world w;
            world_open(&w, *state);
            // A device that draws coarsely loses what is so near a thousand times its size.
            float half = gpu_test_draws_precisely(*state) ? 200 : 20;
            add_plane(&w, half, s->tilt, 0, s->y, s->z);
            if (s->kind)
                add_light(&w, s->kind, s->light[0], s->light[1], s->light[2]);
            else
                shine(&w, s->azimuth, s->elevation);
            pictures[maps] = maps ? SHADE(&w, WORD("cascades", "4"), WORD("size", "256"),
                                          WORD("point_size", "128"), WORD("spot_size", "128"))
                                  : shade(&w, NULL, 0);
            world_close(&w);
        }
        size_t wrong = count_different(pictures[1], pictures[0]);
        if (wrong > PIXELS / 1000) fail_msg("%s: %zu of %d pixels are off", s->name, wrong, PIXELS);
        mem_free(pictures[0]);
        mem_free(pictures[1]);
    }
}

// Behind a wall without thickness, up to where it stands.
static void no_light_leaks_under_a_thin_wall(void **state) {
    pass_world w;
    world_open(&w, *state);
    add_plane(&w, 200, -90, 0, 0, -1);
    add_plane(&w, 1, 0, 0, 0, 0);
    shine(&w, 90, 45);
    float *c = SHADE(&w, WORD("cascades", "1"), SET("distance", number(&w, 10)));
    size_t dark = 0, lit = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        double ray[3];
        pixel_ray(&w, i, ray);
        double t = ray[2] < 0 ? -1 / ray[2] : 1e9, x = ray[0] * t, y = -5 + t;
        if (y > -0.02 || y < -4 || (y < -1.94 && y > -2.06) || fabs(fabs(x) - 1) < 0.06) continue;
        bool hidden = y > -2 && fabs(x) < 1;
        if (hidden ? c[4 * i] > 0.001f : c[4 * i] < 0.1f)
            fail_msg("(%.3f, %.3f) is %s: %g", x, y, hidden ? "lit" : "dark", (double)c[4 * i]);
        dark += hidden;
        lit += !hidden;
    }
    assert_true(dark > 300 && lit > 300);
    mem_free(c);
    world_close(&w);
}

// ---- against rays -------------------------------------------------------------------------------

static void add_crate(pass_world *w, float half, float x, float y, float z) {
    scene_mesh *crate = world_mesh(w, "crate.obj");
    crate->scale = number(w, half);
    crate->position = triple(w, x, y, z);
}

static const float crates[3][4] = {{0.4f, 0.8f, -1, -0.6f}, {1, -3, 9, 0}, {3, 8, 30, 2}};

static void add_crates(pass_world *w) {
    add_plane(w, 200, -90, 0, 0, -1);
    for (int i = 0; i < 3; i++)
        add_crate(w, crates[i][0], crates[i][1], crates[i][2], crates[i][3]);
}

// As many instances of one crate.
static void add_crates_as_instances(pass_world *w) {
    struct instance_entry entries[3] = {0};
    add_plane(w, 200, -90, 0, 0, -1);
    for (int i = 0; i < 3; i++) {
        const float *c = crates[i];
        entries[i] = (struct instance_entry){
            .place = {{c[1], c[2], c[3], c[0]}}, .turn = {{0, 0, 0, 1}}, .color = {{1, 1, 1, 1}}};
    }
    scene_mesh *crate = world_mesh(w, "crate.obj");
    w->mesh_count--; // the kind is no mesh of the scene
    scene_mesh *kept = arena_alloc(&w->memory, sizeof *kept);
    *kept = *crate;
    w->instances[w->instances_count++] = scene_instances_create(&(scene_instances_desc){
        .name = "crates",
        .kinds = &kept,
        .kind_count = 1,
        .entries = entries,
        .count = 3,
        .position = triple(w, 0, 0, 0),
        .rotation = triple(w, 0, 0, 0),
        .scale = number(w, 1),
        .color = triple(w, 1, 1, 1),
    });
    gpu_test_ok(w->instances[0]);
}

// Near and far, over all cascades; from faces of a cube.
static void maps_show_what_rays_find(void **state) {
    for (int lamp = 0; lamp < 2; lamp++) {
        float *pictures[3] = {NULL};
        for (int way = 0; way < 3; way++) { // rays; maps; maps of instances
            pass_world w;
            world_open(&w, *state);
            if (way == 2)
                add_crates_as_instances(&w);
            else
                add_crates(&w);
            if (lamp)
                add_light(&w, SCENE_POINT, 0, 2, 1.5f);
            else
                shine(&w, 30, 30);
            pictures[way] = way ? SHADE(&w, WORD("point_size", "1024"), WORD("cascades", "4"),
                                        SET("shadow_radius", number(&w, 0.5f)))
                                : shade(&w, NULL, 0);
            if (way == 2) {
                scene_mesh *const *kinds;
                scene_instances_kinds(w.instances[0], &kinds);
                scene_mesh_destroy(kinds[0], *state);
            }
            world_close(&w);
        }
        size_t off = count_different(pictures[1], pictures[0]);
        size_t apart = count_different(pictures[2], pictures[1]);
        if (off > PIXELS / 50 || apart)
            fail_msg("%s: %zu pixels are not as by rays, %zu not as of meshes",
                     lamp ? "lamp" : "sun", off, apart);
        for (int way = 0; way < 3; way++) mem_free(pictures[way]);
    }
}

// A lamp for which no maps are left.
static void lights_without_maps_are_asked_by_rays(void **state) {
    static const char *const ways[] = {"rays", "both", "maps"};
    float *pictures[COUNT_OF(ways)] = {NULL};
    for (size_t i = 0; i < COUNT_OF(ways); i++) {
        pass_world w;
        world_open(&w, *state);
        add_crates(&w);
        add_light(&w, SCENE_POINT, 0, 2, 1.5f);
        pass *geometry = add_geometry(&w);
        pass *maps = add_maps(&w, geometry, (const pass_named[]){WORD("points", "0")}, 1);
        pass *p = world_add(&w, "shade", NULL, "shade");
        pass_add_source(p, geometry);
        pass_add_source(p, maps);
        gpu_test_ok(pass_set_option(p, "shadows_by", ways[i]));
        gpu_test_ok(pass_declare(p));
        world_render(&w, SIZE, SIZE, pass_output(p, "color"));
        pictures[i] = world_read(&w, pass_output(p, "color"));
        world_close(&w);
    }
    assert_int_equal(count_different(pictures[1], pictures[0]), 0);
    assert_true(count_different(pictures[2], pictures[0]) > PIXELS / 100);
    for (size_t i = 0; i < COUNT_OF(ways); i++) mem_free(pictures[i]);
}

// The same maps, asked where triangles are drawn.
static void forward_shows_the_same_shadows(void **state) {
    float *pictures[2] = {NULL};
    for (int forward = 0; forward < 2; forward++) {
        pass_world w;
        world_open(&w, *state);
        add_crates(&w);
        shine(&w, 30, 30);
        if (forward) {
            pass *maps = world_add(&w, "shadow_maps", NULL, "shadows");
            pass *p = world_add(&w, "forward", NULL, "forward");
            for (size_t i = 0; i < w.mesh_count; i++)
                gpu_test_ok(pass_add_mesh(maps, &w.meshes[i]) && pass_add_mesh(p, &w.meshes[i]));
            gpu_test_ok(pass_declare(maps));
            pass_add_source(p, maps);
            gpu_test_ok(pass_set_option(p, "shadows_by", "maps"));
            gpu_test_ok(pass_declare(p));
            world_render(&w, SIZE, SIZE, pass_output(p, "color"));
            pictures[1] = world_read(&w, pass_output(p, "color"));
        } else {
            pictures[0] = SHADE(&w, WORD("cascades", "3"));
        }
        world_close(&w);
    }
    size_t off = count_different(pictures[1], pictures[0]);
    size_t edges = PIXELS / (gpu_test_draws_precisely(*state) ? 200 : 100);
    if (off > edges) fail_msg("%zu pixels are not as deferred", off);
    mem_free(pictures[0]);
    mem_free(pictures[1]);
}

// ---- holes --------------------------------------------------------------------------------------

// A square across the Y axis, 2 m wide, whose left half is clear.
static void add_half(pass_world *w, float y) {
    static const uint8_t pixels[] = {255, 255, 255, 0, 255, 255, 255, 255};
    mesh_texture *texture = arena_alloc(&w->memory, sizeof *texture);
    mesh_vertex *vertices = arena_alloc(&w->memory, 4 * sizeof *vertices);
    static const uint32_t indices[] = {0, 1, 2, 0, 2, 3};
    for (int i = 0; i < 4; i++) {
        float x = i == 1 || i == 2 ? 1.0f : -1.0f, z = i < 2 ? -1.0f : 1.0f;
        vertices[i] = (mesh_vertex){.position = {x, 0, z}, .normal = {0, -1, 0}};
        vertices[i].u = 0.5f + 0.25f * x;
    }
    *texture = (mesh_texture){.width = 2, .height = 1, .pixels = pixels};
    mesh_part *part = white_part(w, 6);
    part->texture = 0;
    add_mesh(w, &(mesh_data){.vertices = vertices,
                             .vertex_count = 4,
                             .indices = indices,
                             .index_count = 6,
                             .parts = part,
                             .part_count = 1,
                             .textures = texture,
                             .texture_count = 1,
                             .box = {.min = {-1, -0.01f, -1}, .max = {1, 0.01f, 1}}})
        ->position = triple(w, 0, y, 0);
}

static void light_shines_through_what_is_clear(void **state) {
    pass_world w;
    world_open(&w, *state);
    add_plane(&w, 200, 0, 0, 0, 0);
    add_half(&w, -7); // behind the camera
    shine(&w, -90, 0);
    float *c = SHADE(&w, WORD("cascades", "1"), SET("distance", number(&w, 20)));
    size_t dark = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        double ray[3];
        pixel_ray(&w, i, ray);
        double x = 5 * ray[0], z = 5 * ray[2];
        if (fabs(x) < 0.1 || fabs(fabs(x) - 1) < 0.1 || fabs(fabs(z) - 1) < 0.1) continue;
        bool hidden = x > 0 && x < 1 && fabs(z) < 1;
        if (hidden ? c[4 * i] > 0.01f : c[4 * i] < 0.1f)
            fail_msg("(%.3f, %.3f) is %s", x, z, hidden ? "lit" : "dark");
        dark += hidden;
    }
    assert_true(dark > 200);
    mem_free(c);
    world_close(&w);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(shadow_of_a_ball_is_where_geometry_puts_it),
        cmocka_unit_test(a_plane_does_not_shade_itself),
        cmocka_unit_test(no_light_leaks_under_a_thin_wall),
        cmocka_unit_test(maps_show_what_rays_find),
        cmocka_unit_test(lights_without_maps_are_asked_by_rays),
        cmocka_unit_test(forward_shows_the_same_shadows),
        cmocka_unit_test(light_shines_through_what_is_clear),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
