// Metadata and transforms as OpenVDB writes them. Lengths are not checked again here: what is read
// has been walked over by vdb_layout.c.
#include "media/vdb_describe.h"
#include "base/error.h"
#include "base/memory.h"
#include <limits.h>
#include <math.h>
#include <string.h>

static const double COORD_MAX = 1 << 24, BOX_VOXELS_MAX = 68719476736.0; // 4096^3

// ---- metadata -----------------------------------------------------------------------------------

typedef struct text { // not ended by a zero
    const char *at;
    uint32_t length;
} text;

static uint32_t take_u32(const uint8_t **at) {
    uint32_t value;
    memcpy(&value, *at, sizeof value);
    *at += sizeof value;
    return value;
}

static text take_text(const uint8_t **at) {
    uint32_t length = take_u32(at);
    text t = {(const char *)*at, length};
    *at += length;
    return t;
}

static bool text_is(text t, const char *word) {
    return strlen(word) == t.length && memcmp(word, t.at, t.length) == 0;
}

// The value of an entry, of which the last counts; false when there is none of this type.
static bool find_entry(const vdb_layout *l, size_t metadata, const char *name, const char *type,
                       text *out) {
    const uint8_t *at = l->bytes + metadata;
    bool found = false;
    for (uint32_t left = take_u32(&at); left > 0; left--) {
        text key = take_text(&at), kind = take_text(&at), value = take_text(&at);
        if (!text_is(key, name)) continue;
        found = text_is(kind, type);
        *out = value;
    }
    return found;
}

vdb_class vdb_class_read(const vdb_layout *l, const vdb_layout_grid *g) {
    static const char *const words[] = {
        [VDB_FOG] = "fog volume", [VDB_LEVEL_SET] = "level set", [VDB_STAGGERED] = "staggered"};
    text t;
    if (!find_entry(l, g->metadata, "class", "string", &t)) return VDB_UNKNOWN;
    for (; t.length > 0 && *t.at == ' '; t.length--) t.at++;
    while (t.length > 0 && t.at[t.length - 1] == ' ') t.length--;
    for (int i = VDB_UNKNOWN + 1; i < (int)COUNT_OF(words); i++)
        if (strlen(words[i]) == t.length && strncasecmp(words[i], t.at, t.length) == 0)
            return (vdb_class)i;
    return VDB_UNKNOWN;
}

// As Blender knows such files too.
static bool has_y_up(const vdb_layout *l) {
    static const char houdini[] = "Houdini";
    text by;
    return (find_entry(l, l->metadata, "creator", "string", &by) ||
            find_entry(l, l->metadata, "Creator", "string", &by)) &&
           by.length >= strlen(houdini) && memcmp(by.at, houdini, strlen(houdini)) == 0;
}

// ---- where a grid lies --------------------------------------------------------------------------

static double length(const double v[3]) {
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Where the axes and the origin go. Numbers that follow from these stand in the file behind them.
static void read_map(const vdb_layout *l, const vdb_layout_grid *g, double rows[4][3]) {
    const uint8_t *at = l->bytes + g->transform;
    double numbers[16];
    text kind = take_text(&at);
    bool moves = text_is(kind, "TranslationMap");
    bool both = text_is(kind, "ScaleTranslateMap") || text_is(kind, "UniformScaleTranslateMap");
    bool matrix = text_is(kind, "AffineMap") || text_is(kind, "UnitaryMap");
    memcpy(numbers, at, (matrix ? 16 : both ? 6 : 3) * sizeof *numbers);
    const double *origin = matrix ? numbers + 12 : numbers, *scale = numbers + (both ? 3 : 0);
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            rows[i][k] = matrix ? numbers[4 * i + k] : i != k ? 0 : moves ? 1 : scale[i];
        rows[3][i] = matrix || both || moves ? origin[i] : 0;
    }
}

bool vdb_affine_read(const vdb_layout *l, const vdb_layout_grid *g, vdb_affine *out) {
    double rows[4][3], size = 1;
    read_map(l, g, rows);
    for (int k = 0; k < 3; k++) {
        // 0 times an infinity is not a number.
        out->origin[k] = 0 * rows[0][k] + 0 * rows[1][k] + 0 * rows[2][k] + rows[3][k];
        for (int i = 0; i < 3; i++) out->axis[i][k] = rows[i][k] + rows[3][k] - out->origin[k];
    }
    const double(*a)[3] = (const double(*)[3])out->axis;
    double volume = 0;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        size *= length(a[i]);
        volume += a[0][i] * (a[1][j] * a[2][k] - a[1][k] * a[2][j]);
    }
    if (!isfinite(volume) || !isfinite(dot(out->origin, out->origin)) || !(size > 1e-30) ||
        size > 1e30 || fabs(volume) < 1e-9 * size)
        return err_set("%s: grid '%s': the transform is singular or not finite", l->path, g->name);
    return true;
}

static bool is_axis_aligned(const vdb_affine *t) {
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            if (i != k && fabs(t->axis[i][k]) > 1e-9 * length(t->axis[i])) return false;
    return true;
}

static bool is_sheared(const vdb_affine *t) {
    for (int i = 0; i < 3; i++) {
        const double *a = t->axis[i], *b = t->axis[(i + 1) % 3];
        if (fabs(dot(a, b)) > 1e-6 * length(a) * length(b)) return true;
    }
    return false;
}

// World box of an inclusive index box, with the outer halves of its border voxels.
static box3 world_box(const vdb_affine *t, const int32_t min[3], const int32_t max[3]) {
    double low[3] = {1e300, 1e300, 1e300}, high[3] = {-1e300, -1e300, -1e300};
    for (int corner = 0; corner < 8; corner++) {
        for (int k = 0; k < 3; k++) {
            double at = t->origin[k];
            for (int i = 0; i < 3; i++)
                at += t->axis[i][k] * (corner >> i & 1 ? max[i] + 0.5 : min[i] - 0.5);
            low[k] = fmin(low[k], at);
            high[k] = fmax(high[k], at);
        }
    }
    return (box3){{(float)low[0], (float)low[1], (float)low[2]},
                  {(float)high[0], (float)high[1], (float)high[2]}};
}

// ---- what is in it ------------------------------------------------------------------------------

const vdb_layout_grid *vdb_tree_owner(const vdb_layout *l, const vdb_layout_grid *g) {
    if (g->parent[0] == '\0') return g;
    for (size_t i = 0; i < l->count; i++)
        if (strcmp(l->grids[i].unique, g->parent) == 0 && l->grids[i].parent[0] == '\0' &&
            l->grids[i].value == g->value && l->grids[i].linear)
            return &l->grids[i];
    return ERR_NULL(
        "%s: damaged VDB file: grid '%s' shares the voxels of a grid '%s' that is not there",
        l->path, g->name, g->parent);
}

// The background stands at the front of the tree, after a 32-bit count.
static void read_background(const vdb_layout *l, const vdb_layout_grid *g, float out[3]) {
    const uint8_t *p = l->bytes + g->tree + sizeof(int32_t);
    size_t components = (size_t)vdb_value_components(g->value), all = vdb_value_size(g->value);
    if (all == 0 || g->end - g->tree < sizeof(int32_t) + all) return;
    for (size_t i = 0; i < components; i++, p += all / components) {
        double number = 0;
        float real;
        int32_t whole;
        int64_t large;
        switch (g->value) {
        case VDB_VALUE_FLOAT:
        case VDB_VALUE_VEC3S:
            memcpy(&real, p, sizeof real);
            number = (double)real;
            break;
        case VDB_VALUE_DOUBLE:
        case VDB_VALUE_VEC3D:
            memcpy(&number, p, sizeof number);
            break;
        case VDB_VALUE_INT32:
        case VDB_VALUE_VEC3I:
            memcpy(&whole, p, sizeof whole);
            number = whole;
            break;
        case VDB_VALUE_INT64:
            memcpy(&large, p, sizeof large);
            number = (double)large;
            break;
        case VDB_VALUE_BOOL:
            number = *p;
            break;
        case VDB_VALUE_OTHER:
            break;
        }
        out[i] = (float)number;
    }
}

// False when the metadata do not say it.
static bool find_extent(const vdb_layout *l, const vdb_layout_grid *g, vdb_grid_info *out) {
    text min, max, count;
    if (!find_entry(l, g->metadata, "file_bbox_min", "vec3i", &min) ||
        !find_entry(l, g->metadata, "file_bbox_max", "vec3i", &max))
        return false;
    int64_t active = 0;
    if (find_entry(l, g->metadata, "file_voxel_count", "int64", &count))
        memcpy(&active, count.at, sizeof active);
    memcpy(out->index_min, min.at, sizeof out->index_min);
    memcpy(out->index_max, max.at, sizeof out->index_max);
    out->active_voxels = active > 0 ? (uint64_t)active : 0;
    return true;
}

static bool has_tree(const vdb_layout_grid *g) { // that can be read
    return g->value != VDB_VALUE_OTHER && g->linear;
}

bool vdb_tells_extents(const vdb_layout *l) {
    vdb_grid_info info;
    for (size_t i = 0; i < l->count; i++)
        if (has_tree(&l->grids[i]) && !find_extent(l, &l->grids[i], &info)) return false;
    return true;
}

static bool check_extent(const vdb_layout *l, const vdb_layout_grid *g, vdb_grid_info *out) {
    static const int32_t none[3] = {-1, -1, -1};
    double voxels = 1;
    bool empty = false;
    for (int i = 0; i < 3; i++) {
        empty = empty || out->index_min[i] > out->index_max[i];
        voxels *= (double)out->index_max[i] - out->index_min[i] + 1;
    }
    if (empty) {
        memset(out->index_min, 0, sizeof out->index_min);
        memcpy(out->index_max, none, sizeof out->index_max);
        return true;
    }
    for (int i = 0; i < 3; i++)
        if (out->index_min[i] < -COORD_MAX || out->index_max[i] > COORD_MAX)
            return err_set("%s: grid '%s': impossible active box, index %d to %d; +-%d is accepted",
                           l->path, g->name, out->index_min[i], out->index_max[i], (int)COORD_MAX);
    return voxels <= BOX_VOXELS_MAX ||
           err_set(
               "%s: grid '%s': impossible active box of %.3g voxels; at most 4096^3 is accepted",
               l->path, g->name, voxels);
}

static bool describe_grid(const vdb_layout *l, const vdb_layout_grid *g, vdb_extent_reader *read,
                          arena *memory, vdb_grid_info *out) {
    const bool half = g->half && g->value == VDB_VALUE_FLOAT;
    vdb_affine t;
    *out = (vdb_grid_info){.name = arena_string(memory, g->name),
                           .type = arena_string(memory, half ? "half" : g->type),
                           .components = vdb_value_components(g->value),
                           .grid_class = vdb_class_read(l, g),
                           .index_max = {-1, -1, -1},
                           .box = box3_empty(),
                           .saved_half = g->half,
                           .linear = g->linear};
    if (!find_extent(l, g, out) && has_tree(g) && !read(l, g, out)) return false;
    if (!check_extent(l, g, out)) return false;
    if (!g->linear) return true;
    if (!vdb_affine_read(l, g, &t)) return false;
    for (int i = 0; i < 3; i++) out->voxel_size[i] = (float)length(t.axis[i]);
    out->axis_aligned = is_axis_aligned(&t);
    out->sheared = is_sheared(&t);
    const vdb_layout_grid *owner = vdb_tree_owner(l, g);
    if (!owner) return false;
    read_background(l, owner, out->background);
    if (out->index_min[0] <= out->index_max[0])
        out->box = world_box(&t, out->index_min, out->index_max);
    return true;
}

bool vdb_describe(const vdb_layout *l, vdb_extent_reader *read, arena *memory, vdb_info *out) {
    vdb_grid_info *grids = arena_alloc(memory, l->count * sizeof *grids);
    for (size_t i = 0; i < l->count; i++)
        if (!describe_grid(l, &l->grids[i], read, memory, &grids[i])) return false;
    *out = (vdb_info){grids, l->count, "", has_y_up(l)};
    return true;
}
