// Trees of boxes over meshes: every triangle is in them once, every box holds what is below it, and
// the links lead through all nodes, whatever the triangles are like.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/error.h"
#include "base/memory.h"
#include "scene/bvh.h"
#include "scene/bvh_tree.h"
#include "scene/bvh_wide.h"
#include <math.h>
#include <string.h>

typedef struct soup { // a mesh of loose triangles
    mesh_vertex *vertices;
    uint32_t *indices;
    mesh_part part;
    mesh_data data;
} soup;

// `count` triangles; place() says where triangle i is and how large.
static soup make_soup(uint32_t count, void (*place)(uint32_t i, float middle[3], float *size)) {
    soup s = {
        .vertices = mem_alloc(3 * count * sizeof *s.vertices),
        .indices = mem_alloc(3 * count * sizeof *s.indices),
        .part = {.first = 0, .count = 3 * count, .color = {1, 1, 1, 1}, .texture = -1},
    };
    for (uint32_t i = 0; i < count; i++) {
        float middle[3], size;
        place(i, middle, &size);
        for (uint32_t c = 0; c < 3; c++) {
            float *at = s.vertices[3 * i + c].position;
            memcpy(at, middle, sizeof middle);
            at[c] += size;
            s.indices[3 * i + c] = 3 * i + c;
        }
    }
    s.data = (mesh_data){.vertices = s.vertices,
                         .vertex_count = 3 * count,
                         .indices = s.indices,
                         .index_count = 3 * count,
                         .part_count = 1};
    return s;
}

static void free_soup(soup *s) {
    mem_free(s->vertices);
    mem_free(s->indices);
}

static float chance(uint32_t i, uint32_t of) {
    uint32_t h = (i * 4 + of) * 2654435761u + 12345u;
    h = (h ^ h >> 15) * 0x846ca68bu;
    h ^= h >> 13;
    return (float)(h >> 8) / 16777216.0f;
}

// ---- checking a tree ----------------------------------------------------------------------------

typedef struct checked {
    const bvh_forest *forest;
    uint32_t *seen; // per triangle of the forest
    int deepest;
    size_t nodes;
} checked;

static void assert_inside(const struct bvh_node *outer, const float low[3], const float high[3]) {
    for (int a = 0; a < 3; a++)
        assert_true(low[a] >= outer->low.v[a] && high[a] <= outer->high.v[a]);
}

// All corners of a leaf's triangles lie in its box.
static void check_corners(const checked *c, const struct bvh_node *node) {
    for (uint32_t i = bvh_leaf_first(node->below); i < bvh_leaf_end(node->below); i++) {
        const struct bvh_triangle *t = &c->forest->triangles[i];
        for (int corner = 0; corner < 3; corner++) {
            float at[3], slack = 0;
            for (int a = 0; a < 3; a++) {
                at[a] = t->corner.v[a] + (corner == 1   ? t->first.v[a]
                                          : corner == 2 ? t->second.v[a]
                                                        : 0);
                slack = fmaxf(slack, 1e-6f * (fabsf(node->low.v[a]) + fabsf(node->high.v[a])));
            }
            for (int a = 0; a < 3; a++)
                assert_true(at[a] >= node->low.v[a] - slack && at[a] <= node->high.v[a] + slack);
        }
    }
}

static void check_leaf(checked *c, const struct bvh_node *node) {
    uint32_t first = bvh_leaf_first(node->below), end = bvh_leaf_end(node->below);
    assert_true(end > first && end - first <= BVH_LEAF_SIZE);
    assert_true(end <= c->forest->triangle_count);
    for (uint32_t i = first; i < end; i++) c->seen[i]++;
    check_corners(c, node);
}

static struct bvh_node wide_child(const struct bvh_wide *node, int child) {
    struct bvh_node made = {.below = node->below.v[child]};
    for (int a = 0; a < 3; a++) {
        made.low.v[a] = node->low[a].v[child];
        made.high.v[a] = node->high[a].v[child];
    }
    return made;
}

// `next`: the node behind the subtree, as a walk enters nodes.
static void check_node(checked *c, uint32_t index, uint32_t next, int depth) {
    assert_true(index < c->forest->node_count);
    c->nodes++;
    const struct bvh_node *node = &c->forest->nodes[index];
    if (depth > c->deepest) c->deepest = depth;
    assert_int_equal(node->next, next);
    if (node->below >> 28) {
        check_leaf(c, node);
        return;
    }
    uint32_t first = node->below;
    assert_true(first > index);
    for (uint32_t child = first; child < first + 2; child++) {
        const struct bvh_node *inner = &c->forest->nodes[child];
        assert_inside(node, inner->low.v, inner->high.v);
        check_node(c, child, child == first ? first + 1 : next, depth + 1);
    }
}

// Checks that the forest is one tree of `count` triangles; returns how many nodes lead to a leaf.
static int check_tree(const bvh_forest *f, size_t count) {
    assert_int_equal(f->triangle_count, count);
    checked c = {.forest = f, .seen = mem_alloc(count * sizeof *c.seen)};
    check_node(&c, 0, BVH_DONE, 1);
    assert_int_equal(c.nodes, f->node_count);
    for (size_t i = 0; i < count; i++) assert_int_equal(c.seen[i], 1);
    mem_free(c.seen);
    return c.deepest;
}

// What shaders walk: every triangle is in it once, in boxes that hold it; returns how many nodes a
// walk may keep for later.
static uint32_t check_wide(checked *c, const struct bvh_wide *wide, uint32_t below) {
    uint32_t kept = 0, children = 0;
    for (uint32_t i = bvh_leaf_first(below); i < bvh_leaf_end(below); i++) c->seen[i]++;
    if (bvh_is_leaf(below)) return 0;
    for (int i = 0; i < 4; i++) {
        const struct bvh_node box = wide_child(&wide[below], i);
        if (box.below == 0) continue;
        if (bvh_is_leaf(box.below)) check_corners(c, &box);
        for (int k = 0; k < 4 && !bvh_is_leaf(box.below); k++) {
            const struct bvh_node inner = wide_child(&wide[box.below], k);
            if (inner.below) assert_inside(&box, inner.low.v, inner.high.v);
        }
        uint32_t more = check_wide(c, wide, box.below);
        kept = more > kept ? more : kept;
        children++;
    }
    assert_true(children >= 2);
    return kept + children - 1;
}

static void check_widened(const bvh_forest *f, size_t count) {
    checked c = {.forest = f, .seen = mem_alloc(count * sizeof *c.seen)};
    bvh_widening w = {.nodes = f->nodes,
                      .out = mem_alloc((1 + f->node_count / 2) * sizeof *w.out),
                      .count = 1,
                      .slots = mem_alloc(f->node_count * sizeof *w.slots)};
    uint32_t below = bvh_widen(&w, 0);
    assert_true(w.count <= 1 + f->node_count / 2);
    assert_true(check_wide(&c, w.out, below) < BVH_KEPT);
    for (size_t i = 0; i < count; i++) assert_int_equal(c.seen[i], 1);
    mem_free(w.slots);
    mem_free(w.out);
    mem_free(c.seen);
}

static int depth_of(uint32_t count, void (*place)(uint32_t, float[3], float *)) {
    soup s = make_soup(count, place);
    s.data.parts = &s.part;
    bvh_forest f = {0};
    assert_true(bvh_forest_add(&f, &s.data, 0));
    int depth = check_tree(&f, count);
    check_widened(&f, count);
    bvh_forest_free(&f);
    free_soup(&s);
    return depth;
}

// ---- tests --------------------------------------------------------------------------------------

static void scattered(uint32_t i, float middle[3], float *size) {
    for (uint32_t a = 0; a < 3; a++) middle[a] = 10 * chance(i, a);
    *size = 0.01f + 0.3f * chance(i, 3);
}

static void scattered_triangles_make_a_flat_tree(void **state) {
    (void)state;
    for (uint32_t count = 1; count < 40; count++) depth_of(count, scattered);
    int depth = depth_of(20000, scattered);
    assert_true(depth >= 14 && depth <= 25); // 20000 / 4 leaves need 14
}

static void in_one_place(uint32_t i, float middle[3], float *size) {
    (void)i;
    middle[0] = middle[1] = middle[2] = 1;
    *size = 1;
}

static void ever_smaller(uint32_t i, float middle[3], float *size) {
    middle[0] = ldexpf(1, -(int)(i % 28));
    middle[1] = middle[2] = 0;
    *size = 0.25f * middle[0];
}

static void huge(uint32_t i, float middle[3], float *size) {
    for (uint32_t a = 0; a < 3; a++) middle[a] = (chance(i, a) - 0.5f) * 1e8f;
    *size = 1e6f;
}

static void hard_triangles_make_trees_of_bounded_depth(void **state) {
    (void)state;
    assert_true(depth_of(1000, in_one_place) <= 11);
    assert_true(depth_of(6000, ever_smaller) <= BVH_DEPTH);
    assert_true(depth_of(1000, huge) <= BVH_DEPTH);
}

static void without_area(uint32_t i, float middle[3], float *size) {
    scattered(i, middle, size);
    if (i % 2) *size = 0;
}

static void triangles_without_area_are_left_out(void **state) {
    (void)state;
    soup s = make_soup(100, without_area);
    s.data.parts = &s.part;
    s.vertices[0].position[0] = NAN;
    s.vertices[6].position[1] = INFINITY;
    bvh_forest f = {0};
    assert_true(bvh_forest_add(&f, &s.data, 0));
    check_tree(&f, 48);
    // Nothing of the second mesh is left: it has no tree, and the first is as it was.
    for (uint32_t i = 0; i < 300; i++) s.indices[i] = 3;
    size_t nodes = f.node_count;
    assert_true(bvh_forest_add(&f, &s.data, 0));
    assert_int_equal(f.node_count, nodes);
    check_tree(&f, 48);
    bvh_forest_free(&f);
    free_soup(&s);
}

static void a_level_has_a_tree_of_its_own_triangles(void **state) {
    (void)state;
    soup s = make_soup(100, scattered);
    const mesh_run run = {.first = 40 * 3, .count = 25 * 3};
    s.data.parts = &s.part;
    s.data.levels[0] = (mesh_level){.error = 1, .runs = &run};
    s.data.level_count = 1;
    bvh_forest f = {0};
    assert_true(bvh_forest_add(&f, &s.data, 1));
    check_tree(&f, 25);
    for (size_t i = 0; i < 25; i++)
        assert_in_range(f.origins[i].first, run.first, run.first + run.count - 3);
    bvh_forest_free(&f);
    free_soup(&s);
}

static void colors_are_those_of_parts_and_textures(void **state) {
    (void)state;
    soup s = make_soup(12, scattered);
    static const uint8_t texels[] = {255, 0, 188, 255, 0, 0, 188, 0};
    static const mesh_texture texture = {2, 1, texels};
    const mesh_part parts[] = {
        {.first = 0, .count = 12, .color = {0.1f, 0.2f, 0.3f, 1}, .texture = -1},
        {.first = 12,
         .count = 12,
         .color = {0.1f, 0.2f, 0.3f, 0.4f},
         .texture = -1}, // clear: not drawn
        {.first = 24, .count = 12, .color = {1, 1, 0.5f, 1}, .texture = 0}};
    s.data.parts = parts;
    s.data.part_count = 3;
    s.data.textures = &texture;
    s.data.texture_count = 1;
    bvh_forest f = {0};
    assert_true(bvh_forest_add(&f, &s.data, 0));
    check_tree(&f, 8);
    int plain = 0, textured = 0;
    for (size_t i = 0; i < 8; i++) {
        const struct bvh_triangle *t = &f.triangles[i];
        float red = t->corner.v[3], green = t->first.v[3], blue = t->second.v[3];
        plain += red == 0.1f && green == 0.2f && blue == 0.3f;
        textured += red == 0.5f && green == 0 && fabsf(blue - 0.5f * 0.5029f) < 1e-3f;
    }
    assert_int_equal(plain, 4);
    assert_int_equal(textured, 4);
    bvh_forest_free(&f);
    free_soup(&s);
}

static void more_meshes_than_can_be_placed_are_refused(void **state) {
    (void)state;
    soup s = make_soup(1, scattered);
    s.data.parts = &s.part;
    scene_mesh mesh = {.name = "one", .data = s.data};
    scene_mesh *meshes[SCENE_BVH_MAX_MESHES + 1];
    for (size_t i = 0; i < COUNT_OF(meshes); i++) meshes[i] = &mesh;
    scene_bvh *b = scene_bvh_create(meshes, SCENE_BVH_MAX_MESHES, NULL, 0, false);
    assert_non_null(b);
    scene_bvh_destroy(b, NULL);
    assert_null(scene_bvh_create(meshes, COUNT_OF(meshes), NULL, 0, false));
    assert_string_equal(err_get(), "257 meshes; at most 256 are possible");
    free_soup(&s);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(scattered_triangles_make_a_flat_tree),
        cmocka_unit_test(hard_triangles_make_trees_of_bounded_depth),
        cmocka_unit_test(triangles_without_area_are_left_out),
        cmocka_unit_test(a_level_has_a_tree_of_its_own_triangles),
        cmocka_unit_test(colors_are_those_of_parts_and_textures),
        cmocka_unit_test(more_meshes_than_can_be_placed_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
