// Splits by the surface area heuristic over bins: Wald, "On fast construction of SAH-based bounding
// volume hierarchies", 2007. Nodes are laid out depth first, each with a link past its subtree, so
// that rays need no stack: Smits, "Efficiency issues for ray tracing", 1998.
#include "scene/bvh_tree.h"
#include "base/error.h"
#include "base/memory.h"
#include <float.h>
#include <math.h>

enum { BINS = 16, MAX_SAH_DEPTH = 48 }; // deeper than that, lists of pieces are just halved

typedef struct bounds {
    float low[3], high[3];
} bounds;

typedef struct piece { // a triangle
    bounds box;
    float middle[3]; // of the box
    uint32_t first;  // of its indices
    uint32_t part;
} piece;

typedef struct builder {
    bvh_forest *forest;
    const mesh_data *mesh;
    float (*colors)[3]; // per part
    piece *pieces;
    size_t piece_count, piece_capacity;
} builder;

static bounds bounds_empty(void) {
    return (bounds){{FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX}};
}

static void bounds_add(bounds *b, const bounds *other) {
    for (int a = 0; a < 3; a++) { // fminf would call a function
        b->low[a] = other->low[a] < b->low[a] ? other->low[a] : b->low[a];
        b->high[a] = other->high[a] > b->high[a] ? other->high[a] : b->high[a];
    }
}

static float bounds_area(const bounds *b) {
    float x = b->high[0] - b->low[0], y = b->high[1] - b->low[1], z = b->high[2] - b->low[2];
    return x < 0 ? 0 : x * y + y * z + z * x;
}

// ---- pieces -----------------------------------------------------------------------------------

static const float *corner(const mesh_data *mesh, uint32_t index) {
    return mesh->vertices[mesh->indices[index]].position;
}

static bool has_area(const float *a, const float *b, const float *c) {
    vec3 first, second, across;
    glm_vec3_sub((float *)b, (float *)a, first);
    glm_vec3_sub((float *)c, (float *)a, second);
    glm_vec3_cross(first, second, across);
    float squared = glm_vec3_norm2(across);
    return isfinite(squared) && squared >= FLT_MIN;
}

static void add_pieces(builder *b, uint32_t part) {
    const mesh_part *run = &b->mesh->parts[part];
    if (run->texture < 0 && run->color[3] < 0.5f) return; // clear, as when it is drawn
    for (uint32_t i = run->first; i + 2 < run->first + run->count; i += 3) {
        const float *corners[3];
        for (uint32_t c = 0; c < 3; c++) corners[c] = corner(b->mesh, i + c);
        if (!has_area(corners[0], corners[1], corners[2])) continue;
        MEM_RESERVE(b->pieces, b->piece_count + 1, b->piece_capacity);
        piece *p = &b->pieces[b->piece_count++];
        *p = (piece){.box = bounds_empty(), .first = i, .part = part};
        for (int c = 0; c < 3; c++) {
            bounds point;
            glm_vec3_copy((float *)corners[c], point.low);
            glm_vec3_copy((float *)corners[c], point.high);
            bounds_add(&p->box, &point);
        }
        for (int a = 0; a < 3; a++) p->middle[a] = 0.5f * p->box.low[a] + 0.5f * p->box.high[a];
    }
}

// Mean of a texture, linear. Rays see no more of it than that.
static void mean_color(const mesh_texture *texture, float out[3]) {
    float linear[256]; // of sRGB: IEC 61966-2-1
    for (int i = 0; i < 256; i++) {
        float v = (float)i / 255;
        linear[i] = v <= 0.04045f ? v / 12.92f : powf((v + 0.055f) / 1.055f, 2.4f);
    }
    size_t count = (size_t)texture->width * texture->height;
    double sum[3] = {0};
    for (size_t i = 0; i < count; i++)
        for (int c = 0; c < 3; c++) sum[c] += (double)linear[texture->pixels[4 * i + (size_t)c]];
    for (int c = 0; c < 3; c++) out[c] = count ? (float)(sum[c] / (double)count) : 1;
}

static void find_color(const mesh_data *mesh, const mesh_part *part, float out[3]) {
    float texture[3] = {1, 1, 1};
    if (part->texture >= 0) mean_color(&mesh->textures[part->texture], texture);
    for (int c = 0; c < 3; c++) out[c] = part->color[c] * texture[c];
}

// ---- splitting --------------------------------------------------------------------------------

typedef struct plane { // between two bins of an axis
    int axis, bin;
    float low, scale; // bin of a middle: (middle - low) * scale
    float cost;       // in ray-triangle tests
} plane;

static int bin_of(const piece *p, const plane *at) {
    int bin = (int)((p->middle[at->axis] - at->low) * at->scale);
    return bin < BINS - 1 ? bin : BINS - 1;
}

static void try_axis(const piece *pieces, size_t count, plane at, float area, plane *best) {
    struct {
        bounds box;
        size_t count;
    } bins[BINS];
    for (int i = 0; i < BINS; i++) {
        bins[i].box = bounds_empty();
        bins[i].count = 0;
    }
    for (size_t i = 0; i < count; i++) {
        int bin = bin_of(&pieces[i], &at);
        bounds_add(&bins[bin].box, &pieces[i].box);
        bins[bin].count++;
    }
    float before[BINS]; // area times count of what lies left of each plane
    bounds box = bounds_empty();
    size_t sum = 0;
    for (int i = 0; i < BINS - 1; i++) {
        bounds_add(&box, &bins[i].box);
        sum += bins[i].count;
        before[i] = bounds_area(&box) * (float)sum;
    }
    box = bounds_empty();
    sum = 0;
    for (int i = BINS - 2; i >= 0; i--) {
        bounds_add(&box, &bins[i + 1].box);
        sum += bins[i + 1].count;
        at.bin = i;
        at.cost = 1 + (before[i] + bounds_area(&box) * (float)sum) / area;
        if (sum > 0 && sum < count && at.cost < best->cost) *best = at;
    }
}

static plane best_plane(const piece *pieces, size_t count, float area) {
    plane best = {.axis = -1, .cost = INFINITY};
    bounds middles = bounds_empty();
    for (size_t i = 0; i < count; i++) {
        bounds point;
        for (int a = 0; a < 3; a++) point.low[a] = point.high[a] = pieces[i].middle[a];
        bounds_add(&middles, &point);
    }
    for (int a = 0; a < 3; a++) {
        plane at = {.axis = a, .low = middles.low[a]};
        at.scale = BINS / (middles.high[a] - middles.low[a]);
        if (isfinite(at.scale) && at.scale > 0) try_axis(pieces, count, at, area, &best);
    }
    return best;
}

static size_t partition(piece *pieces, size_t count, const plane *at) {
    size_t left = 0;
    for (size_t i = 0; i < count; i++) {
        if (bin_of(&pieces[i], at) > at->bin) continue;
        piece swap = pieces[left];
        pieces[left++] = pieces[i];
        pieces[i] = swap;
    }
    return left;
}

// How many of the pieces, then the first ones, go to the first child; 0: they are a leaf.
static size_t split(piece *pieces, size_t count, const bounds *box, int depth) {
    if (count == 1) return 0;
    plane best = {.axis = -1, .cost = INFINITY};
    if (depth < MAX_SAH_DEPTH) best = best_plane(pieces, count, bounds_area(box));
    if (count <= BVH_LEAF_SIZE && !(best.cost < (float)count)) return 0;
    return best.axis < 0 ? count / 2 : partition(pieces, count, &best);
}

// ---- nodes ------------------------------------------------------------------------------------

static void add_triangle(builder *b, const piece *p) {
    bvh_forest *f = b->forest;
    MEM_RESERVE(f->triangles, f->triangle_count + 1, f->triangle_capacity);
    MEM_RESERVE(f->origins, f->triangle_count + 1, f->origin_capacity);
    f->origins[f->triangle_count] = (bvh_origin){p->first, p->part};
    struct bvh_triangle *t = &f->triangles[f->triangle_count++];
    const float *from = corner(b->mesh, p->first), *color = b->colors[p->part];
    const float *first = corner(b->mesh, p->first + 1), *second = corner(b->mesh, p->first + 2);
    for (int a = 0; a < 3; a++) {
        t->corner.v[a] = from[a];
        t->first.v[a] = first[a] - from[a];
        t->second.v[a] = second[a] - from[a];
    }
    t->corner.v[3] = color[0];
    t->first.v[3] = color[1];
    t->second.v[3] = color[2];
}

static void add_node(builder *b, piece *pieces, size_t count, int depth) {
    bvh_forest *f = b->forest;
    bounds box = bounds_empty();
    for (size_t i = 0; i < count; i++) bounds_add(&box, &pieces[i].box);
    MEM_RESERVE(f->nodes, f->node_count + 1, f->node_capacity);
    size_t index = f->node_count++;
    struct bvh_node node = {0};
    glm_vec3_copy(box.low, node.low.v);
    glm_vec3_copy(box.high, node.high.v);
    size_t left = split(pieces, count, &box, depth);
    if (left == 0) {
        node.leaf = (uint32_t)(count << 28 | f->triangle_count);
        for (size_t i = 0; i < count; i++) add_triangle(b, &pieces[i]);
    } else {
        add_node(b, pieces, left, depth + 1);
        add_node(b, pieces + left, count - left, depth + 1);
    }
    node.next = (uint32_t)f->node_count;
    f->nodes[index] = node;
}

bool bvh_forest_add(bvh_forest *f, const mesh_data *mesh) {
    if (f->triangle_count + mesh->index_count / 3 > BVH_MAX_TRIANGLES)
        return err_set("all meshes together have more than %d triangles", BVH_MAX_TRIANGLES);
    builder b = {.forest = f, .mesh = mesh};
    b.colors = mem_alloc(mesh->part_count * sizeof *b.colors);
    for (uint32_t i = 0; i < mesh->part_count; i++) {
        find_color(mesh, &mesh->parts[i], b.colors[i]);
        add_pieces(&b, i);
    }
    if (b.piece_count > 0) add_node(&b, b.pieces, b.piece_count, 0);
    mem_free(b.colors);
    mem_free(b.pieces);
    return true;
}

void bvh_forest_free(bvh_forest *f) {
    mem_free(f->nodes);
    mem_free(f->triangles);
    mem_free(f->origins);
    *f = (bvh_forest){0};
}
