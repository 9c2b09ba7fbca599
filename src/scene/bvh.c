// Meshes for rays: their trees and their surfaces.
#include "scene/bvh.h"
#include "base/error.h"
#include "base/memory.h"
#include "scene/bvh_impl.h"
#include "scene/runs.h"
#include "scene/surfaces.h"
#include <string.h>

_Static_assert(DRAWN_LEVELS == MESH_LEVELS + 1, "levels of shaders and of meshes");

static bool same_mesh(const mesh_data *a, const mesh_data *b) {
    return a->vertices == b->vertices && a->indices == b->indices && a->parts == b->parts;
}

static uint32_t widen(scene_bvh *b, uint32_t root) {
    size_t nodes = b->forest.node_count - root;
    if (nodes == 0) return 0;
    MEM_RESERVE(b->wide, b->wide_count + nodes / 2, b->wide_capacity);
    bvh_widening made = {
        .nodes = b->forest.nodes, .out = b->wide, .count = (uint32_t)b->wide_count};
    uint32_t below = bvh_widen(&made, root);
    b->wide_count = made.count;
    return below;
}

// Only shaders trace levels of detail, so the host's nodes of one level are replaced by those of
// the next.
static bool add_levels(scene_bvh *b, const mesh_data *data, uint32_t count,
                       struct bvh_levels *out) {
    const uint32_t end = (uint32_t)b->forest.node_count;
    for (uint32_t i = 1; i <= count; i++) {
        if (!bvh_forest_add(&b->forest, data, i)) return false;
        out->errors.v[i] = data->levels[i - 1].error;
        out->below.v[i] = widen(b, end);
        b->forest.node_count = end;
    }
    return true;
}

static bool add_tree(scene_bvh *b, size_t index, bool levels) {
    const mesh_data *data = &b->meshes[index]->data;
    tree *t = &b->trees[index];
    struct bvh_levels *l = &b->levels[index];
    for (size_t i = 0; i < index; i++) {
        if (!same_mesh(&b->meshes[i]->data, data)) continue;
        *t = b->trees[i];
        *l = b->levels[i];
        return true;
    }
    t->root = (uint32_t)b->forest.node_count;
    if (!bvh_forest_add(&b->forest, data, 0)) return err_prefix("%s: ", b->meshes[index]->name);
    t->end = (uint32_t)b->forest.node_count;
    t->below = widen(b, t->root);
    *l = (struct bvh_levels){.errors = {{0, MESH_NO_LEVEL, MESH_NO_LEVEL, MESH_NO_LEVEL}},
                             .below = {{t->below}}};
    mesh_get_ball(data, l->ball.v);
    if (!add_levels(b, data, levels ? data->level_count : 0, l))
        return err_prefix("%s: ", b->meshes[index]->name);
    t->triangles = b->forest.triangle_count;
    return true;
}

static void add_thing(scene_bvh *b, const thing *made) {
    b->things[b->thing_count++] = *made;
    b->item_count += made->count;
}

static void add_things(scene_bvh *b, scene_mesh *const *meshes, size_t count,
                       scene_instances *const *instances, size_t instances_count) {
    for (size_t i = 0; i < count; i++) {
        add_thing(b, &(thing){.mesh = meshes[i],
                              .first_mesh = b->mesh_count,
                              .first = b->item_count,
                              .count = 1});
        b->meshes[b->mesh_count++] = meshes[i];
    }
    for (size_t i = 0; i < instances_count; i++) {
        scene_mesh *const *kinds;
        size_t n = scene_instances_kinds(instances[i], &kinds);
        thing made = {.instances = instances[i],
                      .first_mesh = b->mesh_count,
                      .first = b->item_count,
                      .count = scene_instances_count(instances[i])};
        made.entries = mem_alloc(made.count * sizeof *made.entries);
        made.tints = mem_alloc(n * sizeof *made.tints);
        add_thing(b, &made);
        for (size_t k = 0; k < n; k++) b->meshes[b->mesh_count++] = kinds[k];
    }
}

static bool add_trees(scene_bvh *b, bool levels) {
    MEM_RESERVE(b->forest.nodes, bvh_top_nodes(b->item_count), b->forest.node_capacity);
    b->forest.node_count = bvh_top_nodes(b->item_count);
    memset(b->forest.nodes, 0, b->forest.node_count * sizeof *b->forest.nodes);
    b->wide_count = bvh_top_wide(b->item_count);
    MEM_RESERVE(b->wide, b->wide_count, b->wide_capacity);
    memset(b->wide, 0, b->wide_count * sizeof *b->wide);
    for (size_t i = 0; i < b->mesh_count; i++)
        if (!add_tree(b, i, levels)) return false;
    return true;
}

static uint64_t triangles_of(const mesh_data *mesh, bool levels) {
    return mesh->index_count / 3 + (levels ? mesh->level_index_count / 3 : 0);
}

// Estimates the bytes of all items, and of triangles with the nodes over them, before they are
// allocated.
static uint64_t bytes_of(scene_mesh *const *meshes, size_t count, scene_instances *const *instances,
                         size_t instances_count, bool levels) {
    const uint64_t item = sizeof(struct bvh_instance) + sizeof(struct instance_entry) +
                          2 * (sizeof(struct bvh_node) + sizeof(struct bvh_wide));
    const uint64_t triangle = sizeof(struct bvh_triangle) + sizeof(bvh_origin) + sizeof(bvh_piece) +
                              sizeof(struct bvh_node) + sizeof(struct bvh_wide);
    uint64_t items = count, triangles = 0;
    for (size_t i = 0; i < count; i++) triangles += triangles_of(&meshes[i]->data, levels);
    for (size_t i = 0; i < instances_count; i++) {
        scene_mesh *const *kinds;
        size_t n = scene_instances_kinds(instances[i], &kinds);
        items += scene_instances_count(instances[i]);
        for (size_t k = 0; k < n; k++) triangles += triangles_of(&kinds[k]->data, levels);
    }
    return items * item + triangles * triangle;
}

scene_bvh *scene_bvh_create(scene_mesh *const *meshes, size_t count,
                            scene_instances *const *instances, size_t instances_count,
                            bool levels) {
    size_t all = count;
    for (size_t i = 0; i < instances_count; i++) {
        scene_mesh *const *kinds;
        all += scene_instances_kinds(instances[i], &kinds);
    }
    if (all > SCENE_BVH_MAX_MESHES) {
        err_set("%zu meshes; at most %d are possible", all, SCENE_BVH_MAX_MESHES);
        return NULL;
    }
    budget_part *part =
        budget_take(budget_host(), bytes_of(meshes, count, instances, instances_count, levels),
                    "trees over meshes and instances");
    if (!part) return NULL;
    scene_bvh *b = mem_alloc(sizeof *b);
    b->part = part;
    b->meshes = mem_alloc(all * sizeof *b->meshes);
    b->trees = mem_alloc(all * sizeof *b->trees);
    b->levels = mem_alloc(all * sizeof *b->levels);
    b->things = mem_alloc((count + instances_count) * sizeof *b->things);
    add_things(b, meshes, count, instances, instances_count);
    b->items = mem_alloc(b->item_count * sizeof *b->items);
    b->item_at = mem_alloc(b->item_count * sizeof *b->item_at);
    b->leaf_of = mem_alloc(b->item_count * sizeof *b->leaf_of);
    b->changed = mem_alloc(run_marks(b->item_count));
    size_t nodes = bvh_top_nodes(b->item_count);
    b->parents = mem_alloc(nodes * sizeof *b->parents);
    b->stale = mem_alloc(nodes);
    b->slots = mem_alloc(nodes * sizeof *b->slots);
    b->wide_marks = mem_alloc(run_marks(bvh_top_wide(b->item_count)));
    for (uint32_t i = 0; i < b->item_count; i++) b->item_at[i] = i;
    bvh_looks_count(b);
    if (add_trees(b, levels)) return b;
    scene_bvh_destroy(b, NULL);
    return NULL;
}

void scene_bvh_destroy(scene_bvh *b, gpu *g) {
    if (!b) return;
    for (int i = 0; i < BVH_PARTS; i++)
        if (b->buffers[i]) gpu_buffer_destroy(g, b->buffers[i]);
    bvh_forest_free(&b->forest);
    for (size_t i = 0; i < b->thing_count; i++) {
        mem_free(b->things[i].entries);
        mem_free(b->things[i].tints);
    }
    mem_free(b->things);
    mem_free(b->items);
    mem_free(b->item_at);
    mem_free(b->leaf_of);
    mem_free(b->parents);
    mem_free(b->stale);
    mem_free(b->slots);
    mem_free(b->wide);
    mem_free(b->wide_marks);
    mem_free(b->changed);
    mem_free(b->materials);
    mem_free(b->looks);
    mem_free(b->meshes);
    mem_free(b->trees);
    mem_free(b->levels);
    budget_give(b->part);
    mem_free(b);
}

// ---- on the device ----------------------------------------------------------------------------

static bool make_buffer(scene_bvh *b, gpu *g, scene_bvh_part part, const char *label,
                        const void *data, size_t size) {
    size_t least = size ? size : 16; // a buffer is never empty
    uint64_t most = gpu_get_info(g)->max_storage_range;
    if (least > most)
        return err_set("meshes: %s take %zu MiB; this device can read at most %llu MiB", label,
                       least >> 20, (unsigned long long)most >> 20);
    gpu_buffer_desc desc = {.label = label, .size = least, .kind = GPU_BUFFER_DEVICE};
    b->buffers[part] = gpu_buffer_create(g, &desc);
    return b->buffers[part] &&
           (!data || size == 0 || gpu_buffer_write(g, b->buffers[part], 0, data, size));
}

static const char nodes_label[] = "boxes of meshes", triangles_label[] = "triangles of meshes",
                  instances_label[] = "placed meshes", surfaces_label[] = "surfaces of meshes",
                  vertices_label[] = "vertices of meshes", texels_label[] = "textures of meshes";

void scene_bvh_list_memory(const scene_bvh *b, budget_list *out) {
    const bvh_forest *f = &b->forest;
    if (b->buffers[BVH_INSTANCES]) return;
    budget_list_add(out, nodes_label, b->wide_count * sizeof *b->wide);
    budget_list_add(out, triangles_label, f->triangle_count * sizeof *f->triangles);
    budget_list_add(out, instances_label, BVH_HEAD + b->item_count * sizeof *b->items);
}

void scene_bvh_list_surfaces(const scene_bvh *b, budget_list *out) {
    uint64_t triangles = 0, vertices = 0, texels = 0;
    for (size_t i = 0; i < b->mesh_count && !b->buffers[BVH_LEVELS]; i++) {
        const mesh_data *mesh = &b->meshes[i]->data;
        const tree *t = &b->trees[i];
        if (t->root == t->end || t->triangles <= triangles) continue; // as bvh_looks_add does
        triangles = t->triangles;
        vertices += mesh->vertex_count;
        texels += surfaces_texels(mesh);
    }
    budget_list_add(out, surfaces_label, triangles * sizeof(shared_uvec4));
    budget_list_add(out, vertices_label, vertices * sizeof(struct surface_vertex));
    budget_list_add(out, texels_label, texels * sizeof(uint16_t[4]));
}

bool scene_bvh_allocate(scene_bvh *b, gpu *g) {
    if (b->buffers[BVH_INSTANCES]) return true;
    const bvh_forest *f = &b->forest;
    return make_buffer(b, g, BVH_NODES, nodes_label, b->wide, b->wide_count * sizeof *b->wide) &&
           make_buffer(b, g, BVH_TRIANGLES, triangles_label, f->triangles,
                       f->triangle_count * sizeof *f->triangles) &&
           make_buffer(b, g, BVH_INSTANCES, instances_label, NULL,
                       BVH_HEAD + b->item_count * sizeof *b->items) &&
           gpu_buffer_write(g, b->buffers[BVH_INSTANCES], 0, (uint32_t[4]){0}, BVH_HEAD);
}

bool scene_bvh_surfaces_fit(const scene_mesh *mesh, gpu *g) {
    return surfaces_largest(&mesh->data) <= gpu_get_info(g)->max_storage_range;
}

bool scene_bvh_allocate_surfaces(scene_bvh *b, gpu *g) {
    if (b->buffers[BVH_LEVELS]) return true;
    surfaces s = {0};
    for (size_t i = 0; i < b->mesh_count; i++) bvh_looks_add(b, &s, i);
    b->holes = s.holes;
    bool done =
        make_buffer(b, g, BVH_SURFACES, surfaces_label, s.triangles,
                    s.triangle_count * sizeof *s.triangles) &&
        make_buffer(b, g, BVH_VERTICES, vertices_label, s.vertices,
                    s.vertex_count * sizeof *s.vertices) &&
        make_buffer(b, g, BVH_MATERIALS, "materials of meshes", b->looks,
                    b->material_count * sizeof *b->looks) &&
        make_buffer(b, g, BVH_TEXELS, texels_label, s.texels, s.texel_count * sizeof *s.texels) &&
        make_buffer(b, g, BVH_LEVELS, "levels of meshes", b->levels,
                    b->mesh_count * sizeof *b->levels);
    surfaces_free(&s);
    return done;
}

uint64_t scene_bvh_version(const scene_bvh *b) {
    return b->version;
}

bool scene_bvh_has_holes(const scene_bvh *b) {
    return b->holes;
}

static void bvh_choose(const scene_bvh *b, const void *what, uint32_t *bits) {
    for (size_t i = 0; i < b->thing_count; i++)
        if (b->things[i].mesh == what || b->things[i].instances == what)
            bits[i / 32] |= 1u << i % 32;
}

void scene_bvh_choose(const scene_bvh *b, scene_mesh *const *meshes, size_t count,
                      scene_instances *const *instances, size_t instances_count,
                      uint32_t bits[SCENE_BVH_MAX_MESHES / 32]) {
    memset(bits, 0, SCENE_BVH_MAX_MESHES / 8);
    for (size_t i = 0; i < count; i++) bvh_choose(b, meshes[i], bits);
    for (size_t i = 0; i < instances_count; i++) bvh_choose(b, instances[i], bits);
}

size_t scene_bvh_count(const scene_bvh *b) {
    return b->item_count;
}

gpu_buffer *scene_bvh_buffer(const scene_bvh *b, scene_bvh_part part) {
    return b->buffers[part];
}
