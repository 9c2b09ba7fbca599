// Rays of a shader against meshes: what they hit is what a look at every triangle finds.
#include "pass_test.h"

enum { SIZE = 64, PIXELS = SIZE * SIZE, TRIANGLES = 300 };

typedef struct found {
    double distance; // INFINITY: nothing
    double normal[3];
    size_t mesh;
} found;

typedef struct traced { // images of trace.comp
    float *origin, *way, *face, *color;
} traced;

static float *read_floats(pass_world *w, graph_image image) {
    float *out = mem_alloc(PIXELS * 4 * sizeof *out);
    gpu_image *source = graph_get_image(w->host.graph, image);
    gpu_test_ok(gpu_image_read(w->host.device, source, out, PIXELS * 4 * sizeof *out));
    return out;
}

static traced read_traced(pass_world *w, const pass *p) {
    return (traced){
        read_floats(w, pass_output(p, "origin")),
        read_floats(w, pass_output(p, "way")),
        read_floats(w, pass_output(p, "face")),
        read_floats(w, pass_output(p, "color")),
    };
}

static traced trace(pass_world *w, float near, float far) {
    pass *p = world_add(w, NULL, "trace.comp", "trace");
    gpu_test_ok(pass_set_uniform(p, "near", number(w, near)));
    gpu_test_ok(pass_set_uniform(p, "far", number(w, far)));
    gpu_test_ok(pass_declare(p));
    world_render(w, SIZE, SIZE, pass_output(p, "color"));
    return read_traced(w, p);
}

static void free_traced(traced *t) {
    mem_free(t->origin);
    mem_free(t->way);
    mem_free(t->face);
    mem_free(t->color);
}

// ---- on the host, in doubles --------------------------------------------------------------------

typedef double vector[3];

static void cross(const vector a, const vector b, vector out) {
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static double dot(const vector a, const vector b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Moves the ray's end to the triangle, if it hits it before that.
static void meet(const vector corners[3], const vector origin, const vector way, double near,
                 size_t mesh, found *best) {
    vector first, second, from, across, turned, normal;
    for (int a = 0; a < 3; a++) {
        first[a] = corners[1][a] - corners[0][a];
        second[a] = corners[2][a] - corners[0][a];
        from[a] = origin[a] - corners[0][a];
    }
    cross(way, second, across);
    cross(from, first, turned);
    cross(first, second, normal);
    double size = dot(first, across), length = sqrt(dot(normal, normal));
    double u = dot(from, across) / size, v = dot(way, turned) / size;
    double distance = dot(second, turned) / size;
    if (!(u >= 0 && v >= 0 && u + v <= 1 && distance >= near && distance < best->distance)) return;
    best->distance = distance;
    best->mesh = mesh;
    double side = dot(normal, way) > 0 ? -1 : 1;
    for (int a = 0; a < 3; a++) best->normal[a] = side * normal[a] / length;
}

static void search_mesh(pass_world *w, size_t mesh, const vector origin, const vector way,
                        double near, found *best) {
    const mesh_data *data = &w->meshes[mesh].data;
    mat4 transform;
    gpu_test_ok(scene_mesh_transform(&w->meshes[mesh], &w->context, transform));
    for (uint32_t i = 0; i < data->index_count; i += 3) {
        vector corners[3];
        for (uint32_t c = 0; c < 3; c++) {
            const float *at = data->vertices[data->indices[i + c]].position;
            for (int a = 0; a < 3; a++)
                corners[c][a] = (double)transform[0][a] * (double)at[0] +
                                (double)transform[1][a] * (double)at[1] +
                                (double)transform[2][a] * (double)at[2] + (double)transform[3][a];
        }
        meet(corners, origin, way, near, mesh, best);
    }
}

static found search(pass_world *w, const float *origin, const float *way, double near, double far) {
    found best = {.distance = far};
    vector from, to;
    for (int a = 0; a < 3; a++) {
        from[a] = (double)origin[a];
        to[a] = (double)way[a];
    }
    for (size_t i = 0; i < w->mesh_count; i++) search_mesh(w, i, from, to, near, &best);
    if (best.distance >= far) best.distance = INFINITY;
    return best;
}

// ---- tests --------------------------------------------------------------------------------------

static float chance(uint32_t i) {
    uint32_t h = i * 2654435761u + 97u;
    h = (h ^ h >> 15) * 0x846ca68bu;
    return (float)((h ^ h >> 16) >> 8) / 16777216.0f;
}

// Loose triangles in a cube around the origin, in the memory of the world.
static void scatter(pass_world *w, mesh_data *out) {
    mesh_vertex *vertices = arena_alloc(&w->memory, 3 * TRIANGLES * sizeof *vertices);
    uint32_t *indices = arena_alloc(&w->memory, 3 * TRIANGLES * sizeof *indices);
    for (uint32_t i = 0; i < 3 * TRIANGLES; i++) {
        for (uint32_t a = 0; a < 3; a++)
            vertices[i].position[a] = 4 * chance(i / 3 * 3 + a) - 2 + chance(7000 + 3 * i + a);
        indices[i] = i;
    }
    static const mesh_part part = {
        .first = 0, .count = 3 * TRIANGLES, .color = {0.5f, 0.25f, 1, 1}, .texture = -1};
    *out = (mesh_data){.vertices = vertices,
                       .vertex_count = 3 * TRIANGLES,
                       .indices = indices,
                       .index_count = 3 * TRIANGLES,
                       .parts = &part,
                       .part_count = 1};
}

// Two placings of the same triangles, one of them mirrored, and a crate.
static void open_clutter(pass_world *w, gpu *device) {
    world_open(w, device);
    scene_mesh *near = world_mesh(w, "plane.obj"), *far = world_mesh(w, "plane.obj");
    scatter(w, &near->data);
    far->data = near->data;
    near->position = triple(w, 1, 0.5f, -0.25f);
    near->rotation = triple(w, 20, -35, 70);
    near->color = triple(w, 1, 0.5f, 0.25f);
    far->position = triple(w, -3, 1, 0.5f);
    far->rotation = triple(w, -80, 15, 190);
    far->scale = number(w, -0.6f);
    scene_mesh *crate = world_mesh(w, "crate.obj");
    crate->position = triple(w, 0, 0, 4);
}

static float green_of(pass_world *w, size_t mesh) {
    mat4 transform;
    float tint[4];
    gpu_test_ok(scene_mesh_place(&w->meshes[mesh], &w->context, transform, tint));
    return tint[1] * w->meshes[mesh].data.parts[0].color[1];
}

// A ray that passes an edge closely may be seen otherwise by floats than by doubles: few may.
static void expect_same(pass_world *w, const traced *t, double near, double far) {
    size_t hits = 0, other = 0;
    for (size_t i = 0; i < 4 * PIXELS; i += 4) {
        found want = search(w, t->origin + i, t->way + i, near, far);
        double got = (double)t->way[i + 3];
        bool hit = isfinite(want.distance), occluded = t->origin[i + 3] != 0;
        hits += hit;
        if (hit != (got >= 0) || hit != occluded ||
            (hit && fabs(got - want.distance) > 1e-4 * (1 + want.distance))) {
            other++;
            continue;
        }
        if (!hit) continue;
        double cosine = 0;
        for (int a = 0; a < 3; a++) cosine += want.normal[a] * (double)t->face[i + (size_t)a];
        assert_true(fabs(cosine - 1) < 1e-3);
        assert_true(fabsf(t->color[i + 1] - green_of(w, want.mesh)) < 1e-6f);
    }
    if (other > PIXELS / 500) fail_msg("%zu of %d rays hit something else", other, PIXELS);
    assert_true(hits > PIXELS / 16 && hits < PIXELS);
}

static void rays_hit_what_is_nearest(void **state) {
    pass_world w;
    open_clutter(&w, *state);
    traced t = trace(&w, 0, 1e6f);
    expect_same(&w, &t, 0, 1e6);
    free_traced(&t);
    world_close(&w);
}

static void rays_begin_and_end_where_they_are_told(void **state) {
    pass_world w;
    open_clutter(&w, *state);
    traced t = trace(&w, 0.75f, 2);
    expect_same(&w, &t, 0.75, 2);
    free_traced(&t);
    world_close(&w);
}

static void rays_hit_nothing_where_no_mesh_can_be_seen(void **state) {
    for (int how = 0; how < 2; how++) {
        pass_world w;
        world_open(&w, *state);
        if (how == 1) world_mesh(&w, "crate.obj")->scale = number(&w, 0);
        traced t = trace(&w, 0, 1e6f);
        for (size_t i = 0; i < 4 * PIXELS; i += 4)
            assert_true(t.origin[i + 3] == 0 && t.way[i + 3] < 0);
        free_traced(&t);
        world_close(&w);
    }
}

static void meshes_that_move_are_hit_where_they_are_now(void **state) {
    pass_world w;
    world_open(&w, *state);
    scene_mesh *crate = world_mesh(&w, "crate.obj");
    traced t = trace(&w, 0, 1e6f);
    free_traced(&t);
    crate->position = triple(&w, 2, 0, 0);
    crate->scale = number(&w, 1.5f);
    world_frame(&w, SIZE, SIZE, 2);
    t = read_traced(&w, w.passes[0]);
    expect_same(&w, &t, 0, 1e6);
    free_traced(&t);
    world_close(&w);
}

// Many copies of a few meshes: a tree stands over them, and the host's twin of it finds the same.
static void instances_are_hit_as_the_host_sees_it(void **state) {
    enum { COUNT = 400 };
    pass_world w;
    world_open(&w, *state);
    scene_mesh *crate = world_mesh(&w, "crate.obj");
    scene_mesh *kinds[2] = {world_mesh(&w, "plane.obj"), crate};
    scatter(&w, &kinds[0]->data);
    struct instance_entry *entries = arena_alloc(&w.memory, COUNT * sizeof *entries);
    for (uint32_t i = 0; i < COUNT; i++) {
        struct instance_entry *e = &entries[i];
        for (uint32_t a = 0; a < 3; a++) e->place.v[a] = 12 * chance(50 * i + a) - 6;
        e->place.v[3] = 0.05f + 0.3f * chance(50 * i + 3);
        float angle = 3 * chance(50 * i + 4);
        e->turn = (shared_vec4){{0, 0.6f * sinf(angle), 0.8f * sinf(angle), cosf(angle)}};
        e->color = (shared_vec4){{1, chance(50 * i + 5), 1, 1}};
        e->kind.v[0] = i % 7 == 0 ? INSTANCE_HIDDEN : i % 2;
    }
    w.instances[w.instances_count++] =
        scene_instances_create(&(scene_instances_desc){.name = "many",
                                                       .kinds = kinds,
                                                       .kind_count = 2,
                                                       .entries = entries,
                                                       .count = COUNT,
                                                       .position = triple(&w, 0.5f, 0, 0),
                                                       .rotation = triple(&w, 10, 20, 30),
                                                       .scale = number(&w, 1),
                                                       .color = triple(&w, 1, 1, 1)});
    w.mesh_count = 1; // the crate alone, too
    traced t = trace(&w, 0, 1e6f);
    size_t hits = 0, other = 0;
    for (size_t i = 0; i < 4 * PIXELS; i += 4) {
        scene_hit want;
        bool hit = scene_pick(w.host.bvh, t.origin + i, t.way + i, NULL, &want);
        hits += hit;
        if (hit != (t.way[i + 3] >= 0) || hit != (t.origin[i + 3] != 0) ||
            (hit && fabsf(t.way[i + 3] - want.distance) > 1e-4f * (1 + want.distance))) {
            other++;
            continue;
        }
        if (!hit) continue;
        assert_true(glm_vec3_dot(want.normal, t.face + i) > 0.999f);
        float green = want.mesh->data.parts[0].color[1];
        if (want.instances) green *= entries[want.index].color.v[1];
        assert_true(fabsf(t.color[i + 1] - green) < 1e-5f);
    }
    if (other > PIXELS / 500) fail_msg("%zu of %d rays hit something else", other, PIXELS);
    assert_true(hits > PIXELS / 16 && hits < PIXELS);
    free_traced(&t);
    world_close(&w);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays_hit_what_is_nearest),
        cmocka_unit_test(rays_begin_and_end_where_they_are_told),
        cmocka_unit_test(rays_hit_nothing_where_no_mesh_can_be_seen),
        cmocka_unit_test(meshes_that_move_are_hit_where_they_are_now),
        cmocka_unit_test(instances_are_hit_as_the_host_sees_it),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
