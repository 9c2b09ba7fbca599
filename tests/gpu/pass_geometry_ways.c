// The two ways of `geometry`, by rays and drawn: both show the same, and rays leave no gaps.
#include "pass_test.h"

enum { WIDTH = 96, HEIGHT = 64, PIXELS = WIDTH * HEIGHT, RINGS = 24, SECTORS = 48 };

typedef struct seen {
    float *albedo, *normal, *depth;
} seen;

typedef struct limits { // of what is shown: 0: none
    float distance, lod;
} limits;

static void set_limits(pass_world *w, pass *p, limits most) {
    gpu_test_ok(pass_set_uniform(p, "max_distance", number(w, most.distance)));
    gpu_test_ok(pass_set_uniform(p, "lod", number(w, most.lod)));
}

// `before`: limits of a frame before the one that is seen; NULL: there is none.
static seen look_after(gpu *device, const char *mode, scene_mesh *(*make)(pass_world *w),
                       const limits *before, limits most) {
    pass_world w;
    world_open(&w, device);
    scene_mesh *mesh = make(&w);
    pass *p = world_add(&w, "geometry", NULL, "geometry");
    gpu_test_ok(pass_set_option(p, "mode", mode));
    set_limits(&w, p, before ? *before : most);
    for (size_t i = 0; i < w.instances_count; i++)
        gpu_test_ok(pass_add_instances(p, w.instances[i]));
    gpu_test_ok((w.instances_count > 0 || pass_add_mesh(p, mesh)) && pass_declare(p));
    graph_add_output(w.host.graph, pass_output(p, "depth"));
    graph_add_output(w.host.graph, pass_output(p, "normal"));
    world_render(&w, WIDTH, HEIGHT, pass_output(p, "albedo"));
    if (before) {
        set_limits(&w, p, most);
        world_frame(&w, WIDTH, HEIGHT, 2);
    }
    seen s = {world_read(&w, pass_output(p, "albedo")), world_read(&w, pass_output(p, "normal")),
              world_read_depth(&w, pass_output(p, "depth"))};
    world_close(&w);
    return s;
}

static seen look(gpu *device, const char *mode, scene_mesh *(*make)(pass_world *w), limits most) {
    return look_after(device, mode, make, NULL, most);
}

static void release(seen *s) {
    mem_free(s->albedo);
    mem_free(s->normal);
    mem_free(s->depth);
}

// ---- a globe with a texture that has holes -----------------------------------------------------

static void add_quad(uint32_t *out, uint32_t first) {
    const uint32_t corners[6] = {first, first + 1,           first + SECTORS + 2,
                                 first, first + SECTORS + 2, first + SECTORS + 1};
    memcpy(out, corners, sizeof corners);
}

static scene_mesh *make_globe(pass_world *w) {
    static uint8_t texels[8 * 4 * 4];
    for (uint32_t i = 0; i < sizeof texels; i++) texels[i] = (uint8_t)(i * 2654435761u >> 24);
    for (uint32_t i = 3; i < sizeof texels; i += 4) texels[i] = i % 5 ? 255 : 0;
    static const mesh_texture texture = {8, 4, texels};
    static mesh_vertex vertices[(RINGS + 1) * (SECTORS + 1)];
    static uint32_t indices[RINGS * SECTORS * 6];
    static const mesh_part parts[] = {
        {.first = 0, .count = RINGS * SECTORS * 3, .color = {1, 0.5f, 0.25f, 1}, .texture = 0},
        {.first = RINGS * SECTORS * 3,
         .count = RINGS * SECTORS * 3,
         .color = {1, 1, 1, 1},
         .texture = -1}};
    for (uint32_t r = 0; r <= RINGS; r++) {
        for (uint32_t s = 0; s <= SECTORS; s++) {
            double up = GLM_PI * r / RINGS, around = 2 * GLM_PI * s / SECTORS;
            float n[3] = {(float)(sin(up) * cos(around)), (float)(sin(up) * sin(around)),
                          (float)cos(up)};
            mesh_vertex *v = &vertices[r * (SECTORS + 1) + s];
            *v = (mesh_vertex){.u = 3.0f * (float)s / SECTORS, .v = 2.0f * (float)r / RINGS};
            for (int c = 0; c < 3; c++) v->position[c] = 1.5f * (v->normal[c] = n[c]);
            if (r < RINGS && s < SECTORS)
                add_quad(indices + 6 * (r * SECTORS + s), r * (SECTORS + 1) + s);
        }
    }
    scene_mesh *mesh = world_mesh(w, "plane.obj");
    mesh->data = (mesh_data){.vertices = vertices,
                             .vertex_count = COUNT_OF(vertices),
                             .indices = indices,
                             .index_count = COUNT_OF(indices),
                             .parts = parts,
                             .part_count = 2,
                             .textures = &texture,
                             .texture_count = 1,
                             .box = {{-1.5f, -1.5f, -1.5f}, {1.5f, 1.5f, 1.5f}}};
    mesh->rotation = triple(w, 20, 30, 40);
    mesh->color = triple(w, 0.9f, 0.8f, 0.7f);
    return mesh;
}

static scene_mesh *make_mirrored(pass_world *w) {
    scene_mesh *mesh = make_globe(w);
    mesh->scale = number(w, -0.9f);
    return mesh;
}

// Turned, scaled, mirrored and tinted, some of them not shown, in a space that is turned and
// scaled.
static scene_mesh *make_instances(pass_world *w) {
    enum { COUNT = 40 };
    scene_mesh *globe = make_globe(w);
    struct instance_entry entries[COUNT] = {0};
    for (uint32_t i = 0; i < COUNT; i++) {
        float a = (float)i, step = a * 0.618034f - floorf(a * 0.618034f);
        vec4 turn = {sinf(a), cosf(2 * a), sinf(3 * a), 1};
        glm_vec4_normalize(turn);
        entries[i] = (struct instance_entry){
            .place = {{5 * step - 2.5f, 0.2f * a, 3 * sinf(5 * a), i % 7 == 3 ? -0.4f : 0.3f}},
            .color = {{0.5f + 0.5f * step, 1, 1 - 0.5f * step, 1}},
            .kind = {{i % 9 == 4 ? INSTANCE_HIDDEN : 0, i, 0, 0}}};
        memcpy(entries[i].turn.v, turn, sizeof turn);
    }
    w->instances[w->instances_count++] =
        scene_instances_create(&(scene_instances_desc){.name = "globes",
                                                       .kinds = &globe,
                                                       .kind_count = 1,
                                                       .entries = entries,
                                                       .count = COUNT,
                                                       .position = triple(w, 0, -1, 0.25f),
                                                       .rotation = triple(w, 10, 20, 30),
                                                       .scale = number(w, 1.25f),
                                                       .color = triple(w, 1, 0.75f, 0.5f)});
    gpu_test_ok(w->instances[0]);
    return globe;
}

// Whether depth jumps beside a pixel: at an outline, or at a hole.
static bool is_edge(const float *depth, size_t at) {
    int x = (int)(at % WIDTH), y = (int)(at / WIDTH);
    for (int j = y - 1; j <= y + 1; j++) {
        for (int i = x - 1; i <= x + 1; i++) {
            if (i < 0 || j < 0 || i >= WIDTH || j >= HEIGHT) continue;
            float other = depth[j * WIDTH + i];
            if (fabsf(other - depth[at]) > 0.05f * fminf(other, depth[at])) return true;
        }
    }
    return false;
}

static bool is_same(const seen *a, const seen *b, size_t at) {
    bool same = fabsf(a->depth[at] - b->depth[at]) <= 1e-4f * b->depth[at];
    for (size_t c = 4 * at; c < 4 * at + 3; c++) {
        same = same && fabsf(a->normal[c] - b->normal[c]) < 0.01f;
        same = same && fabsf(a->albedo[c] - b->albedo[c]) < 0.01f;
    }
    return same;
}

// Pixels whose middle lies on an edge may differ; elsewhere those between two triangles may.
// Returns how many show something.
static size_t assert_same(gpu *device, scene_mesh *(*make)(pass_world *w), limits most) {
    if (!gpu_test_draws_precisely(device)) {
        print_message("skipped: the device draws corners of triangles at places of %u bits below a "
                      "pixel; 8 are needed\n",
                      gpu_get_info(device)->subpixel_bits);
        skip();
    }
    seen rays = look(device, "rays", make, most);
    seen drawn = look(device, "raster", make, most);
    size_t covered = 0, edges = 0, on_edges = 0, inside = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        bool edge = is_edge(drawn.depth, i), same = is_same(&rays, &drawn, i);
        covered += rays.depth[i] < 1e8f;
        edges += edge;
        on_edges += edge && !same;
        inside += !edge && !same;
    }
    assert_true(covered > PIXELS / 20 && covered < PIXELS);
    if (inside > PIXELS / 500 || on_edges > edges / 10)
        fail_msg("%zu of %zu pixels on edges differ, and %zu of %d others", on_edges, edges, inside,
                 PIXELS);
    release(&rays);
    release(&drawn);
    return covered;
}

static void rays_show_what_is_drawn(void **state) {
    assert_same(*state, make_globe, (limits){0});
}

static void rays_show_what_is_drawn_of_a_mirrored_mesh(void **state) {
    assert_same(*state, make_mirrored, (limits){0});
}

static void rays_show_what_is_drawn_of_instances(void **state) {
    assert_same(*state, make_instances, (limits){0});
}

// Both leave out the same ones, and no mesh that stands by itself.
static void what_is_far_is_left_out_of_both(void **state) {
    size_t all = assert_same(*state, make_instances, (limits){0}),
           near = assert_same(*state, make_instances, (limits){.distance = 8});
    if (near >= all) fail_msg("%zu pixels are covered, and %zu without what is far", all, near);
    assert_int_equal(assert_same(*state, make_globe, (limits){0}),
                     assert_same(*state, make_globe, (limits){.distance = 0.1f}));
}

// ---- levels -----------------------------------------------------------------------------------

static scene_mesh *make_simplified(pass_world *w) {
    scene_mesh *globe = make_instances(w);
    world_make_levels(w, globe);
    assert_true(globe->data.level_count > 1);
    globe->data.box.max.x = 6; // its middle is not where the mesh begins
    return globe;
}

// The trees of levels stand beside those in full and change nothing until they are asked for.
static void rays_meet_levels_that_are_drawn(void **state) {
    assert_same(*state, make_simplified, (limits){.lod = 1});
    assert_same(*state, make_simplified, (limits){.lod = 6});
    seen full = look(*state, "rays", make_instances, (limits){0});
    seen none = look(*state, "rays", make_simplified, (limits){0});
    seen some = look(*state, "rays", make_simplified, (limits){.lod = 6});
    assert_memory_equal(none.normal, full.normal, 4 * PIXELS * sizeof *none.normal);
    assert_memory_equal(none.depth, full.depth, PIXELS * sizeof *none.depth);
    size_t other = 0;
    for (size_t i = 0; i < PIXELS; i++) other += !is_same(&some, &full, i);
    if (other < PIXELS / 50) fail_msg("levels change %zu pixels", other);
    release(&full);
    release(&none);
    release(&some);
}

// Rays with limits have a kernel of their own, which is built when the first limit is set.
static void rays_follow_limits_that_are_set_later(void **state) {
    static const limits each[] = {{0}, {.lod = 6}, {.distance = 8}};
    for (size_t i = 0; i < COUNT_OF(each); i++) {
        seen now = look(*state, "rays", make_simplified, each[i]);
        for (size_t k = 0; k < COUNT_OF(each); k++) {
            seen later = look_after(*state, "rays", make_simplified, &each[k], each[i]);
            assert_memory_equal(now.depth, later.depth, PIXELS * sizeof *now.depth);
            assert_memory_equal(now.normal, later.normal, 4 * PIXELS * sizeof *now.normal);
            release(&later);
        }
        release(&now);
    }
}

static float lit(gpu *device, const char *mode, float lod) {
    pass_world w;
    world_open(&w, device);
    make_simplified(&w);
    w.scene.sun.strength = number(&w, 3);
    w.scene.sun.azimuth = number(&w, 200);
    w.scene.sun.elevation = number(&w, 40);
    pass *p = world_add(&w, "geometry", NULL, "geometry");
    pass *shade = world_add(&w, "shade", NULL, "shade");
    gpu_test_ok(pass_set_option(p, "mode", mode) && pass_set_uniform(p, "lod", number(&w, lod)) &&
                pass_add_instances(p, w.instances[0]) && pass_declare(p));
    pass_add_source(shade, p);
    gpu_test_ok(pass_set_uniform(shade, "sky_alpha", number(&w, 0)) && pass_declare(shade));
    world_render(&w, WIDTH, HEIGHT, pass_output(shade, "color"));
    float *color = world_read(&w, pass_output(shade, "color")), sum = 0, covered = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        sum += color[4 * i] + color[4 * i + 1] + color[4 * i + 2];
        covered += color[4 * i + 3];
    }
    mem_free(color);
    world_close(&w);
    return sum / covered;
}

// Rays to lights meet meshes in full, which may stand out of what is seen of them.
static void simplified_meshes_stand_in_no_light_of_their_own(void **state) {
    const float full = lit(*state, "rays", 0), part = lit(*state, "rays", 6),
                drawn = lit(*state, "raster", 6);
    if (fabsf(part - full) > 0.08f * full || fabsf(drawn - full) > 0.08f * full)
        fail_msg("mean light %g in full, simplified %g by rays, %g drawn", (double)full,
                 (double)part, (double)drawn);
}

// ---- no gaps -----------------------------------------------------------------------------------

enum { CELLS = 256 };

// Far from the origin of the mesh, so that corners are rounded; lines of the grid run through the
// middles of pixels.
static scene_mesh *make_sheet(pass_world *w) {
    uint32_t side = CELLS + 1;
    mesh_vertex *vertices = arena_alloc(&w->memory, side * side * sizeof *vertices);
    uint32_t *indices = arena_alloc(&w->memory, CELLS * CELLS * 6 * sizeof *indices), count = 0;
    for (uint32_t y = 0; y < side; y++) {
        for (uint32_t x = 0; x < side; x++) {
            uint32_t at = y * side + x;
            vertices[at] = (mesh_vertex){
                .position = {100 + 12 * ((float)x / CELLS - 0.5f), 50, 12 * (float)y / CELLS},
                .normal = {0, -1, 0}};
            if (x == CELLS || y == CELLS) continue;
            const uint32_t corners[6] = {at, at + 1, at + side + 1, at, at + side + 1, at + side};
            memcpy(indices + count, corners, sizeof corners);
            count += 6;
        }
    }
    mesh_part *part = arena_alloc(&w->memory, sizeof *part);
    *part = (mesh_part){.first = 0, .count = count, .color = {1, 1, 1, 1}, .texture = -1};
    scene_mesh *mesh = world_mesh(w, "plane.obj");
    mesh->data = (mesh_data){.vertices = vertices,
                             .vertex_count = side * side,
                             .indices = indices,
                             .index_count = count,
                             .parts = part,
                             .part_count = 1,
                             .box = {{94, 50, 0}, {106, 50, 12}}};
    mesh->position = triple(w, -100, -50, -6);
    return mesh;
}

static void no_ray_slips_through_between_triangles(void **state) {
    seen rays = look(*state, "rays", make_sheet, (limits){0});
    for (size_t i = 0; i < PIXELS; i++)
        if (!(fabsf(rays.depth[i] - 5) < 1e-3f))
            fail_msg("pixel (%zu, %zu): %g", i % WIDTH, i / WIDTH, (double)rays.depth[i]);
    release(&rays);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays_show_what_is_drawn),
        cmocka_unit_test(rays_show_what_is_drawn_of_a_mirrored_mesh),
        cmocka_unit_test(rays_show_what_is_drawn_of_instances),
        cmocka_unit_test(what_is_far_is_left_out_of_both),
        cmocka_unit_test(rays_meet_levels_that_are_drawn),
        cmocka_unit_test(rays_follow_limits_that_are_set_later),
        cmocka_unit_test(simplified_meshes_stand_in_no_light_of_their_own),
        cmocka_unit_test(no_ray_slips_through_between_triangles),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
