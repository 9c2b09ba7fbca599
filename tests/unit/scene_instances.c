// Instances on the host: places by chance, what is near, what is set and comes back, and the tree
// over all that is placed.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/memory.h"
#include "scene/bvh_impl.h"
#include "scene/scatter.h"
#include <math.h>
#include <string.h>

typedef struct world {
    arena memory;
    field_context context;
    scene_mesh cube;
    scene_mesh *kinds[2];
    scene_instances *instances;
} world;

static const field *triple(world *w, float x, float y, float z) {
    return field_constant(&w->memory, 3, (float[4]){x, y, z});
}

// A cube of half-size 0.5 around the origin.
static void make_cube(world *w) {
    static const int sides[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                                    {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
    static const mesh_part part = {.count = 36, .color = {1, 1, 1, 1}, .texture = -1};
    mesh_vertex *vertices = arena_alloc(&w->memory, 8 * sizeof *vertices);
    uint32_t *indices = arena_alloc(&w->memory, 36 * sizeof *indices);
    for (int i = 0; i < 8; i++)
        for (int a = 0; a < 3; a++) vertices[i].position[a] = (i >> a & 1) ? 0.5f : -0.5f;
    for (uint32_t i = 0; i < 36; i++) {
        static const int corner[6] = {0, 1, 2, 0, 2, 3};
        indices[i] = (uint32_t)sides[i / 6][corner[i % 6]];
    }
    w->cube = (scene_mesh){.name = "cube",
                           .data = {.vertices = vertices,
                                    .vertex_count = 8,
                                    .indices = indices,
                                    .index_count = 36,
                                    .parts = &part,
                                    .part_count = 1},
                           .position = triple(w, 0, 0, 0),
                           .rotation = triple(w, 0, 0, 0),
                           .scale = field_constant(&w->memory, 1, (float[4]){1}),
                           .color = triple(w, 1, 1, 1)};
}

// Cubes of that size at places by chance within 100 m.
static void open_cubes(world *w, uint32_t count, float size, const scene_node *parent) {
    *w = (world){0};
    make_cube(w);
    w->kinds[0] = w->kinds[1] = &w->cube;
    struct instance_entry *entries = arena_alloc(&w->memory, count * sizeof *entries);
    for (uint32_t i = 0; i < count; i++) {
        struct instance_entry *e = &entries[i];
        for (uint32_t a = 0; a < 3; a++) e->place.v[a] = 100 * scatter_chance(1, i, a);
        e->place.v[3] = size;
        e->turn.v[3] = 1;
        e->color = (shared_vec4){{1, 1, 1, 1}};
    }
    w->instances = scene_instances_create(&(scene_instances_desc){
        .name = "cubes",
        .kinds = w->kinds,
        .kind_count = 2,
        .entries = entries,
        .count = count,
        .position = triple(w, 0, 0, 0),
        .rotation = triple(w, 0, 0, 0),
        .scale = field_constant(&w->memory, 1, (float[4]){1}),
        .color = triple(w, 1, 1, 1),
        .parent = parent,
    });
}

static void close_world(world *w) {
    scene_instances_destroy(w->instances, NULL);
    arena_free(&w->memory);
}

static void set_place(world *w, uint32_t index, float x, float y, float z) {
    struct instance_entry e = scene_instances_entries(w->instances)[index];
    memcpy(e.place.v, (float[3]){x, y, z}, 3 * sizeof(float));
    scene_instances_set(w->instances, index, &e);
}

// ---- scatter ----------------------------------------------------------------------------------

static float least_distance(float (*places)[3], size_t count) {
    float least = INFINITY;
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < i; k++)
            least = fminf(least, hypotf(places[i][0] - places[k][0], places[i][1] - places[k][1]));
    return least;
}

static size_t scatter(scatter_desc desc, float (*out)[3]) {
    size_t found, cells = scatter_cells(&desc);
    assert_true(cells <= SCATTER_MAX_CELLS);
    desc.cells = mem_alloc(cells * sizeof *desc.cells);
    assert_true(scatter_places(&desc, out, &found));
    mem_free(desc.cells);
    return found;
}

static void places_keep_their_distance_and_their_number(void **state) {
    (void)state;
    float(*places)[3] = mem_alloc(2000 * sizeof *places), again[100][3];
    scatter_desc desc = {
        .count = 2000, .middle = {5, -5, 1}, .size = {120, 80}, .distance = 1.2f, .seed = 3};
    size_t found = scatter(desc, places);
    assert_int_equal(found, 2000);
    assert_true(least_distance(places, found) >= 1.2f);
    for (size_t i = 0; i < found; i++) {
        assert_true(fabsf(places[i][0] - 5) <= 60 && fabsf(places[i][1] + 5) <= 40);
        assert_true(places[i][2] == 1);
    }
    desc.count = 100; // the first of the many
    scatter(desc, again);
    assert_memory_equal(places, again, sizeof again);
    desc.seed = 4;
    scatter(desc, again);
    assert_memory_not_equal(places, again, sizeof again);
    mem_free(places);
}

static void places_are_fewer_where_there_is_no_room(void **state) {
    (void)state;
    float places[1000][3];
    size_t found =
        scatter((scatter_desc){.count = 1000, .size = {10, 10}, .distance = 1, .seed = 1}, places);
    assert_true(found > 55 && found < 100); // discs at random come to rest at 0.547 of the area: 70
    assert_true(least_distance(places, found) >= 1);
}

static bool left_only(void *user, float place[3], float chance, bool *stays) {
    (void)user, (void)chance;
    *stays = place[0] < 0;
    place[2] = 7;
    return true;
}

static void places_may_be_refused_and_lifted(void **state) {
    (void)state;
    float places[50][3];
    size_t found = scatter(
        (scatter_desc){.count = 50, .size = {10, 10}, .seed = 1, .accept = left_only}, places);
    assert_int_equal(found, 50);
    for (size_t i = 0; i < found; i++) assert_true(places[i][0] < 0 && places[i][2] == 7);
}

static void places_far_apart_need_few_cells(void **state) {
    (void)state;
    float places[100][3];
    const float sizes[][2] = {{1e6f, 1e6f}, {1e6f, 1e-3f}, {1e-3f, 1e-3f}};
    for (size_t i = 0; i < COUNT_OF(sizes); i++) {
        scatter_desc desc = {.count = 100, .distance = 1e-3f, .seed = 2};
        memcpy(desc.size, sizes[i], sizeof desc.size);
        size_t found = scatter(desc, places);
        assert_true(i == 2 ? found < 5 : found == 100);
        assert_true(found == 1 || least_distance(places, found) >= 1e-3f);
    }
}

// ---- near and set -----------------------------------------------------------------------------

static void near_finds_what_a_look_at_all_finds(void **state) {
    (void)state;
    world w;
    open_cubes(&w, 3000, 1, NULL);
    uint32_t found[3000];
    for (uint32_t k = 0; k < 40; k++) {
        const struct instance_entry *all = scene_instances_entries(w.instances);
        float point[3], radius = 40 * scatter_chance(2, k, 3);
        for (uint32_t a = 0; a < 3; a++) point[a] = 120 * scatter_chance(2, k, a) - 10;
        size_t count = scene_instances_near(w.instances, point, radius, found, 3000), want = 0;
        for (size_t i = 0; i < 3000; i++)
            want += glm_vec3_distance2((float *)all[i].place.v, point) <= radius * radius;
        assert_int_equal(count, want);
        for (size_t i = 1; i < count; i++)
            assert_true(glm_vec3_distance2((float *)all[found[i - 1]].place.v, point) <=
                        glm_vec3_distance2((float *)all[found[i]].place.v, point));
        set_place(&w, k, 50, 50, (float)k); // the grid follows
    }
    assert_int_equal(scene_instances_near(w.instances, (float[3]){50, 50, 3}, 0, found, 1), 1);
    assert_int_equal(found[0], 3);
    close_world(&w);
}

static void near_takes_places_along_a_line_and_in_one_point(void **state) {
    (void)state;
    world w;
    uint32_t found[500];
    open_cubes(&w, 500, 1, NULL);
    for (uint32_t i = 0; i < 500; i++) set_place(&w, i, (float)i, 0, 0);
    assert_int_equal(scene_instances_near(w.instances, (float[3]){100, 0, 0}, 2.5f, found, 500), 5);
    assert_int_equal(found[0], 100);
    assert_int_equal(found[1], 99);
    for (uint32_t i = 0; i < 500; i++) set_place(&w, i, 1, 1, 1);
    assert_int_equal(scene_instances_near(w.instances, (float[3]){1, 1, 1}, 0, found, 500), 500);
    assert_int_equal(found[0], 0);
    close_world(&w);
}

static void what_is_set_comes_back_with_a_reset(void **state) {
    (void)state;
    world w;
    open_cubes(&w, 40, 1, NULL);
    struct instance_entry before = scene_instances_entries(w.instances)[7], e = before;
    uint64_t version = scene_instances_version(w.instances);
    scene_instances_set(w.instances, 7, &e);
    assert_int_equal(scene_instances_version(w.instances), version);
    e.state.v[1] = 3;
    e.place.v[0] = NAN; // no number: stays
    e.kind.v[0] = INSTANCE_HIDDEN;
    e.kind.v[1] = 99; // not to be set
    scene_instances_set(w.instances, 7, &e);
    const struct instance_entry *now = &scene_instances_entries(w.instances)[7];
    assert_true(scene_instances_version(w.instances) != version);
    assert_true(now->state.v[1] == 3 && now->place.v[0] == before.place.v[0]);
    assert_true(now->kind.v[0] == INSTANCE_HIDDEN && now->kind.v[1] == 7);
    scene_instances_reset(w.instances);
    assert_memory_equal(now, &before, sizeof before);
    close_world(&w);
}

static void colors_and_states_change_no_shape(void **state) {
    (void)state;
    world w;
    open_cubes(&w, 4, 1, NULL);
    struct instance_entry e = scene_instances_entries(w.instances)[2];
    uint64_t shape = scene_instances_shape(w.instances);
    e.color.v[3] = 3;
    e.state.v[0] = 1;
    scene_instances_set(w.instances, 2, &e);
    assert_int_equal(scene_instances_shape(w.instances), shape);
    for (int i = 0; i < 3; i++) {
        if (i == 0) e.place.v[3] = 2;
        if (i == 1) e.turn.v[0] = 0.5f;
        if (i == 2) e.kind.v[0] = INSTANCE_HIDDEN;
        scene_instances_set(w.instances, 2, &e);
        assert_true(scene_instances_shape(w.instances) != shape);
        shape = scene_instances_shape(w.instances);
    }
    close_world(&w);
}

// ---- the tree ---------------------------------------------------------------------------------

// What a ray meets first: by a look at each cube alone.
static float search(world *w, const float origin[3], const float way[3], uint32_t *index) {
    const struct instance_entry *all = scene_instances_entries(w->instances);
    float best = INFINITY;
    for (uint32_t i = 0; i < scene_instances_count(w->instances); i++) {
        float near = 0, far = INFINITY;
        if (all[i].kind.v[0] == INSTANCE_HIDDEN) continue;
        for (int a = 0; a < 3; a++) {
            float half = 0.5f * fabsf(all[i].place.v[3]);
            float x = (all[i].place.v[a] - half - origin[a]) / way[a];
            float y = (all[i].place.v[a] + half - origin[a]) / way[a];
            near = fmaxf(near, fminf(x, y));
            far = fminf(far, fmaxf(x, y));
        }
        if (near > far || near >= best) continue;
        best = near;
        *index = i;
    }
    return best;
}

static void expect_picks(world *w, const scene_bvh *b) {
    size_t hits = 0;
    for (uint32_t k = 0; k < 300; k++) {
        float origin[3], way[3];
        for (uint32_t a = 0; a < 3; a++) {
            origin[a] = a == 2 ? -40 : 100 * scatter_chance(5, k, a);
            way[a] = (a == 2 ? 1 : 0.01f) + 0.3f * scatter_chance(6, k, a);
        }
        uint32_t index = 0;
        float want = search(w, origin, way, &index);
        scene_hit hit;
        bool found = scene_pick(b, origin, way, NULL, &hit);
        assert_int_equal(found, isfinite(want));
        if (!found) continue;
        hits++;
        assert_true(fabsf(hit.distance - want) < 1e-3f * (1 + want));
        assert_int_equal(hit.index, index);
        assert_ptr_equal(hit.instances, w->instances);
        assert_ptr_equal(hit.mesh, &w->cube);
        assert_true(fabsf(glm_vec3_norm(hit.normal) - 1) < 1e-4f);
        assert_true(glm_vec3_dot(hit.normal, way) < 0);
    }
    assert_true(hits > 50 && hits < 300);
}

static void picks_find_what_is_nearest(void **state) {
    (void)state;
    static const uint32_t counts[] = {3, 8, 9, 2000}; // with and without a tree over them
    static const float sizes[] = {60, 40, 40, 3};     // m; no ray begins in one
    for (size_t i = 0; i < COUNT_OF(counts); i++) {
        world w;
        open_cubes(&w, counts[i], sizes[i], NULL);
        scene_bvh *b = scene_bvh_create(NULL, 0, &w.instances, 1, false);
        assert_int_equal(scene_bvh_count(b), counts[i]);
        assert_true(scene_bvh_place(b, &w.context));
        expect_picks(&w, b);
        scene_bvh_destroy(b, NULL);
        close_world(&w);
    }
}

static void picks_follow_what_moves_hides_and_grows(void **state) {
    (void)state;
    world w;
    open_cubes(&w, 1000, 4, NULL);
    scene_bvh *b = scene_bvh_create(NULL, 0, &w.instances, 1, false);
    assert_true(scene_bvh_place(b, &w.context));
    float built = b->top_cost;
    for (uint32_t i = 0; i < 300; i++) { // a few, then so many that the tree is built anew
        struct instance_entry e = scene_instances_entries(w.instances)[i];
        if (i % 3 == 0) e.kind.v[0] = INSTANCE_HIDDEN;
        if (i % 3 == 1) e.place.v[3] = 6;
        for (uint32_t a = 0; a < 3 && i % 3 == 2; a++) e.place.v[a] = 100 * scatter_chance(9, i, a);
        scene_instances_set(w.instances, i, &e);
        if (i != 5 && i != 299) continue;
        assert_true(scene_bvh_place(b, &w.context));
        assert_true((b->top_cost == built) == (i == 5));
        expect_picks(&w, b);
    }
    scene_instances_reset(w.instances);
    assert_true(scene_bvh_place(b, &w.context));
    expect_picks(&w, b);
    scene_bvh_destroy(b, NULL);
    close_world(&w);
}

static void nodes_place_what_stands_in_them(void **state) {
    (void)state;
    world w = {0};
    arena memory = {0};
    const field *one = field_constant(&memory, 1, (float[4]){1});
    const field *none = field_constant(&memory, 3, (float[4]){0});
    scene_node outer = {.name = "outer",
                        .position = field_constant(&memory, 3, (float[4]){0, 0, 10}),
                        .rotation = field_constant(&memory, 3, (float[4]){0, 0, 90}),
                        .scale = field_constant(&memory, 1, (float[4]){2})};
    scene_node inner = {.name = "inner",
                        .position = field_constant(&memory, 3, (float[4]){1, 0, 0}),
                        .rotation = none,
                        .scale = one,
                        .parent = &outer};
    open_cubes(&w, 1, 1, &inner);
    set_place(&w, 0, 1, 0, 0);
    mat4 transform, own;
    float tint[4];
    assert_true(scene_instances_place(w.instances, &w.context, transform, tint));
    scene_instances_matrix(scene_instances_entries(w.instances), own);
    glm_mat4_mul(transform, own, own);
    // (1, 0, 0) in the inner is (2, 0, 0) in the outer, twice as far and turned to +Y.
    const float want[3] = {0, 4, 10};
    for (int a = 0; a < 3; a++) assert_true(fabsf(own[3][a] - want[a]) < 1e-5f);
    w.cube.parent = &inner;
    assert_true(scene_mesh_transform(&w.cube, &w.context, own));
    const float where[3] = {0, 2, 10};
    for (int a = 0; a < 3; a++) assert_true(fabsf(own[3][a] - where[a]) < 1e-5f);
    close_world(&w);
    arena_free(&memory);
}

static void what_is_shown_is_chosen_by_object(void **state) {
    (void)state;
    world a, b;
    uint32_t bits[SCENE_BVH_MAX_MESHES / 32];
    open_cubes(&a, 20, 2, NULL);
    open_cubes(&b, 30, 2, NULL);
    scene_mesh *mesh = &a.cube;
    scene_instances *both[] = {a.instances, b.instances};
    scene_bvh *rays = scene_bvh_create(&mesh, 1, both, 2, false);
    assert_int_equal(scene_bvh_count(rays), 51);
    scene_bvh_choose(rays, NULL, 0, &b.instances, 1, bits);
    assert_int_equal(bits[0], 4);
    scene_bvh_choose(rays, &mesh, 1, &a.instances, 1, bits);
    assert_int_equal(bits[0], 3);
    assert_true(scene_bvh_place(rays, &a.context));
    for (size_t i = 0; i < 51; i++)
        assert_int_equal(rays->items[rays->item_at[i]].what.v[0], i == 0 ? 0 : i <= 20 ? 1 : 2);
    scene_bvh_destroy(rays, NULL);
    close_world(&a);
    close_world(&b);
}

static void a_mesh_may_be_one_of_them(void **state) {
    (void)state;
    world w;
    open_cubes(&w, 5, 2, NULL);
    scene_mesh one = w.cube;
    one.instances = w.instances;
    one.index = 3;
    mat4 place;
    set_place(&w, 3, 7, 8, 9);
    assert_true(scene_mesh_transform(&one, &w.context, place));
    assert_true(place[0][0] == 2 && place[3][0] == 7 && place[3][2] == 9);
    struct instance_entry e = scene_instances_entries(w.instances)[3];
    e.kind.v[0] = 1;
    scene_instances_set(w.instances, 3, &e);
    assert_true(scene_mesh_transform(&one, &w.context, place));
    assert_true(glm_mat4_det(place) == 0);
    close_world(&w);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(places_keep_their_distance_and_their_number),
        cmocka_unit_test(places_are_fewer_where_there_is_no_room),
        cmocka_unit_test(places_may_be_refused_and_lifted),
        cmocka_unit_test(places_far_apart_need_few_cells),
        cmocka_unit_test(near_finds_what_a_look_at_all_finds),
        cmocka_unit_test(near_takes_places_along_a_line_and_in_one_point),
        cmocka_unit_test(what_is_set_comes_back_with_a_reset),
        cmocka_unit_test(colors_and_states_change_no_shape),
        cmocka_unit_test(picks_find_what_is_nearest),
        cmocka_unit_test(picks_follow_what_moves_hides_and_grows),
        cmocka_unit_test(nodes_place_what_stands_in_them),
        cmocka_unit_test(what_is_shown_is_chosen_by_object),
        cmocka_unit_test(a_mesh_may_be_one_of_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
