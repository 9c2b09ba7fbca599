// The meshes as rays see them: their trees, and where they stand in this frame.
#include "scene/bvh.h"
#include "base/error.h"
#include "base/memory.h"
#include "scene/bvh_tree.h"
#include <math.h>
#include <string.h>

typedef struct tree { // nodes of the forest
    uint32_t root, end;
} tree;

typedef struct placement { // the buffer "BvhInstances"
    shared_uvec4 count;
    struct bvh_instance instances[SCENE_BVH_MAX_MESHES];
} placement;

struct scene_bvh {
    scene_mesh *const *meshes;
    tree *trees; // per mesh
    size_t mesh_count;
    bvh_forest forest;
    placement now; // as on the device, once there
    bool written;
    gpu_buffer *buffers[BVH_PARTS];
};

static bool same_mesh(const mesh_data *a, const mesh_data *b) {
    return a->vertices == b->vertices && a->indices == b->indices && a->parts == b->parts;
}

static bool add_tree(scene_bvh *b, size_t index) {
    const mesh_data *data = &b->meshes[index]->data;
    for (size_t i = 0; i < index; i++) {
        if (!same_mesh(&b->meshes[i]->data, data)) continue;
        b->trees[index] = b->trees[i];
        return true;
    }
    b->trees[index].root = (uint32_t)b->forest.node_count;
    if (!bvh_forest_add(&b->forest, data)) return err_prefix("%s: ", b->meshes[index]->name);
    b->trees[index].end = (uint32_t)b->forest.node_count;
    return true;
}

scene_bvh *scene_bvh_create(scene_mesh *const *meshes, size_t count) {
    if (count > SCENE_BVH_MAX_MESHES) {
        err_set("%zu meshes; at most %d are possible", count, SCENE_BVH_MAX_MESHES);
        return NULL;
    }
    scene_bvh *b = mem_alloc(sizeof *b);
    *b = (scene_bvh){
        .meshes = mem_copy(meshes, count * sizeof(scene_mesh *)),
        .trees = mem_alloc(count * sizeof(tree)),
        .mesh_count = count,
    };
    for (size_t i = 0; i < count; i++) {
        if (add_tree(b, i)) continue;
        scene_bvh_destroy(b, NULL);
        return NULL;
    }
    return b;
}

void scene_bvh_destroy(scene_bvh *b, gpu *g) {
    if (!b) return;
    for (int i = 0; i < BVH_PARTS; i++)
        if (b->buffers[i]) gpu_buffer_destroy(g, b->buffers[i]);
    bvh_forest_free(&b->forest);
    mem_free((void *)b->meshes);
    mem_free(b->trees);
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
    return b->buffers[part] && (size == 0 || gpu_buffer_write(g, b->buffers[part], 0, data, size));
}

bool scene_bvh_allocate(scene_bvh *b, gpu *g) {
    if (b->buffers[BVH_INSTANCES]) return true;
    const bvh_forest *f = &b->forest;
    return make_buffer(b, g, BVH_NODES, "boxes of meshes", f->nodes,
                       f->node_count * sizeof *f->nodes) &&
           make_buffer(b, g, BVH_TRIANGLES, "triangles of meshes", f->triangles,
                       f->triangle_count * sizeof *f->triangles) &&
           make_buffer(b, g, BVH_INSTANCES, "placed meshes", &b->now, sizeof b->now);
}

gpu_buffer *scene_bvh_buffer(const scene_bvh *b, scene_bvh_part part) {
    return b->buffers[part];
}

// ---- placed -----------------------------------------------------------------------------------

// The box of a tree's root, moved into the world: all eight corners, and a little more for
// rounding.
static void world_box(const struct bvh_node *root, mat4 transform, struct bvh_instance *out) {
    vec3 box[2];
    for (int i = 0; i < 8; i++) {
        vec3 at;
        for (int a = 0; a < 3; a++) at[a] = i >> a & 1 ? root->high.v[a] : root->low.v[a];
        glm_mat4_mulv3(transform, at, 1, at);
        for (int a = 0; a < 3; a++) {
            box[0][a] = i ? fminf(box[0][a], at[a]) : at[a];
            box[1][a] = i ? fmaxf(box[1][a], at[a]) : at[a];
        }
    }
    for (int a = 0; a < 3; a++) {
        float margin = 1e-5f * fmaxf(fabsf(box[0][a]), fabsf(box[1][a]));
        out->low.v[a] = box[0][a] - margin;
        out->high.v[a] = box[1][a] + margin;
    }
}

// False where nothing would be seen of it: scaled to nothing, or out of all numbers.
static bool invert(mat4 transform, struct bvh_instance *out) {
    mat4 inverse;
    float size = glm_mat4_det(transform);
    if (!isfinite(size) || size == 0) return false;
    glm_mat4_inv(transform, inverse);
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 4; column++) {
            if (!isfinite(inverse[column][row])) return false;
            out->inverse[row].v[column] = inverse[column][row];
        }
    }
    return true;
}

static bool place(const scene_bvh *b, const field_context *context, placement *out) {
    for (size_t i = 0; i < b->mesh_count; i++) {
        const tree *t = &b->trees[i];
        mat4 transform;
        float tint[4];
        if (!scene_mesh_place(b->meshes[i], context, transform, tint)) return false;
        struct bvh_instance made = {.root = t->root, .end = t->end};
        if (t->root == t->end || !invert(transform, &made)) continue;
        world_box(&b->forest.nodes[t->root], transform, &made);
        memcpy(made.color.v, tint, 3 * sizeof *tint);
        out->instances[out->count.v[0]++] = made;
    }
    return true;
}

bool scene_bvh_update(scene_bvh *b, gpu *g, const field_context *context) {
    placement now = {0};
    if (!place(b, context, &now)) return false;
    size_t used = offsetof(placement, instances) + now.count.v[0] * sizeof *now.instances;
    if (b->written && memcmp(&b->now, &now, used) == 0) return true;
    b->now = now;
    b->written = gpu_buffer_write(g, b->buffers[BVH_INSTANCES], 0, &now, used);
    return b->written;
}
