// Follows OpenVDB's file format 222 to 224 (OpenVDB 1.2 of 2013 and later), little-endian:
//   header, file metadata, grid count, then per grid a descriptor and the grid's bytes; each
//   descriptor says where the grid starts and ends, and the next descriptor follows that end.
// A grid is: compression flags, metadata, transform, topology (root, 32^3 nodes, 16^3 nodes, 8^3
// leaf masks, depth first), then the voxels of all leaves in the same order.
// Invariant: `cursor.at <= cursor.size`, and bytes are looked at only through take().
#include "media/vdb_layout.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/str.h"
#include <stdlib.h>
#include <string.h>

enum {
    VERSION_MIN = 222,
    VERSION_MAX = 224,
    GRIDS_MAX = 4096,
    NAME_MAX_BYTES = 1024,
    COMPRESS_ZIP = 1,
    COMPRESS_ACTIVE_MASK = 2,
    COMPRESS_BLOSC = 4,
    BLOSC_HEADER = 16,
    UPPER_VALUES = 32 * 32 * 32,
    LOWER_VALUES = 16 * 16 * 16,
    LEAF_VALUES = 8 * 8 * 8,
    ROOT_STEP = 4096, // voxels along a child of the root
    COORD_MAX = 1 << 24,
};
static const uint8_t MAGIC[8] = {0x20, 0x42, 0x44, 0x56, 0, 0, 0, 0};
static const uint64_t TREE_BYTES_MAX = (uint64_t)16 << 30;

typedef struct cursor {
    const uint8_t *bytes;
    size_t size, at;
} cursor;

static const uint8_t *take_bytes(cursor *c, size_t count) {
    if (count > c->size - c->at) return NULL;
    const uint8_t *p = c->bytes + c->at;
    c->at += count;
    return p;
}

static bool take_u32(cursor *c, uint32_t *out) {
    const uint8_t *p = take_bytes(c, sizeof *out);
    if (p) memcpy(out, p, sizeof *out);
    return p != NULL;
}

static bool take_i64(cursor *c, int64_t *out) {
    const uint8_t *p = take_bytes(c, sizeof *out);
    if (p) memcpy(out, p, sizeof *out);
    return p != NULL;
}

static char *take_name(cursor *c, arena *memory) {
    uint32_t length;
    if (!take_u32(c, &length) || length > NAME_MAX_BYTES) return NULL;
    const uint8_t *p = take_bytes(c, length);
    if (!p || memchr(p, 0, length)) return NULL;
    char *name = arena_alloc(memory, length + 1);
    memcpy(name, p, length);
    return name;
}

typedef struct named_size {
    const char *name;
    size_t size;
} named_size;

// Metadata whose size OpenVDB takes from their type and not from the file.
static const named_size METADATA[] = {
    {"bool", 1},   {"double", 8}, {"float", 4},  {"int32", 4},   {"int64", 8},  {"vec2d", 16},
    {"vec2i", 8},  {"vec2s", 8},  {"vec3d", 24}, {"vec3i", 12},  {"vec3s", 12}, {"vec4d", 32},
    {"vec4i", 16}, {"vec4s", 16}, {"mat4s", 64}, {"mat4d", 128},
};

// Affine transforms. Frustum maps have a variable length and do not suit boxes of voxels.
static const named_size MAPS[] = {
    {"UniformScaleMap", 120},   {"ScaleMap", 120},  {"UniformScaleTranslateMap", 144},
    {"ScaleTranslateMap", 144}, {"AffineMap", 128}, {"UnitaryMap", 128},
    {"TranslationMap", 24},
};

static const named_size *find_size(const named_size *list, size_t count, const uint8_t *name,
                                   uint32_t length) {
    for (size_t i = 0; i < count; i++)
        if (strlen(list[i].name) == length && memcmp(list[i].name, name, length) == 0)
            return &list[i];
    return NULL;
}

// Skips metadata. `half` receives whether they say that numbers have 16 bits, which is what OpenVDB
// uses.
static bool skip_metadata(cursor *c, bool *half) {
    static const char HALF[] = "is_saved_as_half_float";
    uint32_t count, name_length, length, size;
    *half = false;
    if (!take_u32(c, &count)) return false;
    for (uint32_t i = 0; i < count; i++) {
        if (!take_u32(c, &name_length)) return false;
        const uint8_t *name = take_bytes(c, name_length);
        if (!name || !take_u32(c, &length)) return false;
        const uint8_t *type = take_bytes(c, length);
        if (!type || !take_u32(c, &size)) return false;
        const named_size *known = find_size(METADATA, COUNT_OF(METADATA), type, length);
        if (known && size != known->size) return false;
        const uint8_t *value = take_bytes(c, size);
        if (!value) return false;
        if (name_length != strlen(HALF) || memcmp(name, HALF, name_length) != 0) continue;
        if (!known || strcmp(known->name, "bool") != 0) return false;
        *half = *value != 0;
    }
    return true;
}

static const struct {
    const char *tree, *name;
    vdb_value value;
    uint8_t size, components;
    bool real;
} VALUES[] = {
    {"", "", VDB_VALUE_OTHER, 0, 0, false},
    {"Tree_float_5_4_3", "float", VDB_VALUE_FLOAT, 4, 1, true},
    {"Tree_double_5_4_3", "double", VDB_VALUE_DOUBLE, 8, 1, true},
    {"Tree_int32_5_4_3", "int32", VDB_VALUE_INT32, 4, 1, false},
    {"Tree_int64_5_4_3", "int64", VDB_VALUE_INT64, 8, 1, false},
    {"Tree_bool_5_4_3", "bool", VDB_VALUE_BOOL, 1, 1, false},
    {"Tree_vec3s_5_4_3", "vec3s", VDB_VALUE_VEC3S, 12, 3, true},
    {"Tree_vec3d_5_4_3", "vec3d", VDB_VALUE_VEC3D, 24, 3, true},
    {"Tree_vec3i_5_4_3", "vec3i", VDB_VALUE_VEC3I, 12, 3, false},
};

size_t vdb_value_size(vdb_value value) {
    return VALUES[value].size;
}

int vdb_value_components(vdb_value value) {
    return VALUES[value].components;
}

// Splits "Tree_float_5_4_3_HalfFloat" into value, half, "float" and the type without the suffix.
static void name_type(vdb_layout_grid *g, char *type, arena *memory) {
    static const char HALF[] = "_HalfFloat";
    g->half = str_ends_with(type, HALF);
    if (g->half) type[strlen(type) - strlen(HALF)] = '\0';
    g->tree_type = type;
    for (size_t i = 1; i < COUNT_OF(VALUES); i++)
        if (strcmp(type, VALUES[i].tree) == 0) g->value = VALUES[i].value;
    if (g->value != VDB_VALUE_OTHER) {
        g->type = VALUES[g->value].name;
        return;
    }
    const char *begin = strncmp(type, "Tree_", 5) == 0 ? type + 5 : type;
    char *value = arena_string(memory, begin);
    char *end = strchr(value, '_');
    if (end) *end = '\0';
    g->type = value;
}

static bool read_descriptor(const vdb_layout *l, cursor *c, arena *memory, vdb_layout_grid *g) {
    *g = (vdb_layout_grid){0};
    char *unique = take_name(c, memory), *type = take_name(c, memory);
    char *parent = take_name(c, memory);
    int64_t start, block, end;
    if (!unique || !type || !parent || !take_i64(c, &start) || !take_i64(c, &block) ||
        !take_i64(c, &end))
        return err_set("%s: damaged VDB file: the table of grids breaks off at byte %zu", l->path,
                       c->at);
    g->unique = unique;
    char *name = arena_string(memory, unique);
    char *suffix = strchr(name, '\x1e');
    if (suffix) *suffix = '\0';
    g->name = name;
    g->parent = parent;
    name_type(g, type, memory);
    if (start < (int64_t)c->at || end < start || (uint64_t)end > l->size)
        return err_set("%s: damaged VDB file: grid '%s' lies outside the file (bytes %lld to %lld "
                       "of %zu)",
                       l->path, g->name, (long long)start, (long long)end, l->size);
    g->start = (size_t)start;
    g->end = (size_t)end;
    return true;
}

static bool read_grid_head(const vdb_layout *l, vdb_layout_grid *g) {
    cursor c = {l->bytes, g->end, g->start};
    bool good = take_u32(&c, &g->compression);
    g->metadata = c.at;
    bool half = false;
    good = good && skip_metadata(&c, &half);
    g->transform = c.at;
    uint32_t length;
    const uint8_t *name = NULL;
    if (good && take_u32(&c, &length)) name = take_bytes(&c, length);
    if (!name)
        return err_set("%s: damaged VDB file: the metadata of grid '%s' break off at byte %zu",
                       l->path, g->name, c.at);
    if (half != g->half)
        return err_set("%s: damaged VDB file: grid '%s' is half and is not", l->path, g->name);
    const named_size *map = find_size(MAPS, COUNT_OF(MAPS), name, length);
    if (!map) return true;
    if (!take_bytes(&c, map->size))
        return err_set("%s: damaged VDB file: the transform of grid '%s' breaks off", l->path,
                       g->name);
    g->linear = true;
    g->tree = c.at;
    return true;
}

static bool read_header(vdb_layout *l, cursor *c) {
    const uint8_t *magic = take_bytes(c, sizeof MAGIC);
    if (!magic || memcmp(magic, MAGIC, sizeof MAGIC) != 0)
        return err_set("%s: is not a VDB file", l->path);
    const uint8_t *offsets = NULL;
    if (!take_u32(c, &l->version) || !take_u32(c, &l->library_major) ||
        !take_u32(c, &l->library_minor) || !(offsets = take_bytes(c, 1)) || !take_bytes(c, 36))
        return err_set("%s: damaged VDB file: the header breaks off", l->path);
    if (l->version < VERSION_MIN || l->version > VERSION_MAX)
        return err_set("%s: VDB file format %u is not supported; %d to %d are (OpenVDB 1.2 and "
                       "later)",
                       l->path, l->version, VERSION_MIN, VERSION_MAX);
    if (*offsets != 1)
        return err_set("%s: VDB file without grid offsets (written to a stream); save it to a file "
                       "with OpenVDB",
                       l->path);
    return true;
}

bool vdb_layout_read(const char *path, const void *bytes, size_t size, arena *memory,
                     vdb_layout *out) {
    vdb_layout l = {.path = path, .bytes = bytes, .size = size};
    cursor c = {bytes, size, 0};
    if (!read_header(&l, &c)) return false;
    l.metadata = c.at;
    uint32_t count;
    bool half;
    if (!skip_metadata(&c, &half) || !take_u32(&c, &count))
        return err_set("%s: damaged VDB file: the metadata break off at byte %zu", path, c.at);
    if (count > GRIDS_MAX)
        return err_set("%s: VDB file with %u grids; at most %d are read", path, count, GRIDS_MAX);
    l.count = count;
    l.grids = arena_alloc(memory, count * sizeof *l.grids);
    for (size_t i = 0; i < count; i++) {
        if (!read_descriptor(&l, &c, memory, &l.grids[i])) return false;
        if (!read_grid_head(&l, &l.grids[i])) return false;
        c.at = l.grids[i].end;
    }
    *out = l;
    return true;
}

typedef struct walk {
    cursor c;
    vdb_value value;
    size_t value_size; // bytes of one value as the nodes' headers store it
    size_t block_size; // bytes of one value in blocks: less when stored as half
    bool half;
    uint32_t compression;
    uint64_t leaves, memory;
    const char *fault;
} walk;

static bool fault(walk *w, const char *what) {
    if (!w->fault) w->fault = what;
    return false;
}

static uint32_t count_bits(const uint8_t *mask, uint32_t bits) {
    uint32_t sum = 0;
    for (uint32_t i = 0; i < bits / 64; i++) {
        uint64_t word;
        memcpy(&word, mask + i * sizeof word, sizeof word);
        sum += (uint32_t)__builtin_popcountll(word);
    }
    return sum;
}

// Checks a block of `count` values: raw, or a signed length and then compressed (> 0) or raw (<= 0)
// data.
static bool check_block(walk *w, uint32_t count) {
    size_t expected = count * w->block_size;
    if (count == 0 && w->half) return true; // OpenVDB stores nothing at all
    if (!(w->compression & (COMPRESS_BLOSC | COMPRESS_ZIP)))
        return take_bytes(&w->c, expected) ? true : fault(w, "voxels break off");
    int64_t length;
    if (!take_i64(&w->c, &length)) return fault(w, "voxels break off");
    if (length <= 0) {
        if (length < -(int64_t)expected || (uint64_t)-length != expected)
            return fault(w, "a block of voxels has a wrong length");
        return take_bytes(&w->c, expected) ? true : fault(w, "voxels break off");
    }
    if ((uint64_t)length > w->c.size) return fault(w, "a block of voxels has a wrong length");
    const uint8_t *data = take_bytes(&w->c, (size_t)length);
    if (!data) return fault(w, "voxels break off");
    if (!(w->compression & COMPRESS_BLOSC)) return true; // zlib gets both lengths
    // Blosc believes its own header, which must therefore agree with what surrounds it.
    if (length < BLOSC_HEADER) return fault(w, "a compressed block is too short");
    uint32_t raw, packed;
    memcpy(&raw, data + 4, sizeof raw);
    memcpy(&packed, data + 12, sizeof packed);
    if (raw != expected || packed != (uint64_t)length)
        return fault(w, "a compressed block has a wrong length");
    return true;
}

// Checks the values of a node, of which those in `mask` are active.
static bool check_values(walk *w, uint32_t count, const uint8_t *mask) {
    enum { ONE_INACTIVE = 2, MASK_ONLY, MASK_ONE_INACTIVE, MASK_TWO_INACTIVE, ALL_VALUES };
    const uint8_t *kind = take_bytes(&w->c, 1);
    if (!kind) return fault(w, "a node breaks off");
    if (*kind > ALL_VALUES) return fault(w, "a node is of an unknown kind");
    size_t inactive = 0, selection = 0;
    if (*kind == ONE_INACTIVE || *kind == MASK_ONE_INACTIVE) inactive = w->value_size;
    if (*kind == MASK_TWO_INACTIVE) inactive = 2 * w->value_size;
    if (*kind >= MASK_ONLY && *kind <= MASK_TWO_INACTIVE) selection = count / 8;
    if (!take_bytes(&w->c, inactive + selection)) return fault(w, "a node breaks off");
    bool packed = (w->compression & COMPRESS_ACTIVE_MASK) && *kind != ALL_VALUES;
    return check_block(w, packed ? count_bits(mask, count) : count);
}

static bool add_memory(walk *w, uint64_t bytes) {
    w->memory += bytes;
    return w->memory <= TREE_BYTES_MAX ? true : fault(w, "more than 16 GiB of nodes");
}

static size_t slot_size(const walk *w) {
    return (w->value_size > sizeof(void *) ? w->value_size : sizeof(void *)) + 8;
}

static bool check_lower(walk *w) {
    const uint8_t *children = take_bytes(&w->c, LOWER_VALUES / 8);
    const uint8_t *active = take_bytes(&w->c, LOWER_VALUES / 8);
    if (!children || !active) return fault(w, "a node breaks off");
    if (!add_memory(w, LOWER_VALUES * slot_size(w)) || !check_values(w, LOWER_VALUES, active))
        return false;
    uint32_t count = count_bits(children, LOWER_VALUES);
    w->leaves += count;
    if (!add_memory(w, count * (LEAF_VALUES * w->value_size + 128))) return false;
    return take_bytes(&w->c, count * (size_t)(LEAF_VALUES / 8)) ? true
                                                                : fault(w, "a node breaks off");
}

static bool check_upper(walk *w) {
    const uint8_t *children = take_bytes(&w->c, UPPER_VALUES / 8);
    const uint8_t *active = take_bytes(&w->c, UPPER_VALUES / 8);
    if (!children || !active) return fault(w, "a node breaks off");
    if (!add_memory(w, UPPER_VALUES * slot_size(w)) || !check_values(w, UPPER_VALUES, active))
        return false;
    uint32_t count = count_bits(children, UPPER_VALUES);
    for (uint32_t i = 0; i < count; i++)
        if (!check_lower(w)) return false;
    return true;
}

typedef struct root_key {
    int32_t at[3];
} root_key;

static int compare_keys(const void *a, const void *b) {
    const root_key *l = a, *r = b;
    for (int i = 0; i < 3; i++)
        if (l->at[i] != r->at[i]) return l->at[i] < r->at[i] ? -1 : 1;
    return 0;
}

static bool take_key(walk *w, root_key *out) {
    const uint8_t *p = take_bytes(&w->c, sizeof *out);
    if (!p) return fault(w, "the root node breaks off");
    memcpy(out, p, sizeof *out);
    for (int i = 0; i < 3; i++) {
        if (out->at[i] < -COORD_MAX || out->at[i] > COORD_MAX - ROOT_STEP)
            return fault(w, "voxels lie beyond +-16777216 in index space");
        if (out->at[i] & (ROOT_STEP - 1)) return fault(w, "a node of the root is out of step");
    }
    return true;
}

static bool check_root_entries(walk *w, root_key *keys, uint32_t tiles, uint32_t children) {
    for (uint32_t i = 0; i < tiles; i++) {
        const uint8_t *tile;
        if (!take_key(w, &keys[i])) return false;
        if (!(tile = take_bytes(&w->c, w->value_size + 1)))
            return fault(w, "the root node breaks off");
        if (tile[w->value_size] > 1) return fault(w, "a tile is neither active nor inactive");
    }
    for (uint32_t i = 0; i < children; i++)
        if (!take_key(w, &keys[tiles + i]) || !check_upper(w)) return false;
    qsort(keys, (size_t)tiles + children, sizeof *keys, compare_keys);
    for (uint32_t i = 1; i < tiles + children; i++)
        if (compare_keys(&keys[i - 1], &keys[i]) == 0)
            return fault(w, "two nodes of the root share one place");
    return true;
}

static bool check_root(walk *w) {
    uint32_t buffers, tiles, children;
    if (!take_u32(&w->c, &buffers) || !take_bytes(&w->c, w->value_size) ||
        !take_u32(&w->c, &tiles) || !take_u32(&w->c, &children))
        return fault(w, "the root node breaks off");
    if (buffers != 1) return fault(w, "more than one buffer a voxel");
    size_t left = w->c.size - w->c.at;
    if (tiles > left / sizeof(root_key) || children > left / (UPPER_VALUES / 4))
        return fault(w, "the root node counts more nodes than the file has bytes");
    root_key *keys = mem_alloc(((size_t)tiles + children) * sizeof *keys);
    bool good = check_root_entries(w, keys, tiles, children);
    mem_free(keys);
    return good;
}

static bool check_leaf(walk *w) {
    const uint8_t *mask = take_bytes(&w->c, LEAF_VALUES / 8);
    if (!mask) return fault(w, "voxels break off");
    if (w->value != VDB_VALUE_BOOL) return check_values(w, LEAF_VALUES, mask);
    return take_bytes(&w->c, 3 * sizeof(int32_t) + LEAF_VALUES / 8) ? true
                                                                    : fault(w, "voxels break off");
}

bool vdb_layout_check_tree(const vdb_layout *layout, const vdb_layout_grid *grid,
                           uint64_t *leaves) {
    walk w = {.c = {layout->bytes, grid->end, grid->tree}, .value = grid->value};
    w.value_size = vdb_value_size(grid->value);
    w.half = grid->half && VALUES[grid->value].real;
    w.block_size = w.half ? 2 * (size_t)VALUES[grid->value].components : w.value_size;
    w.compression = grid->compression;
    bool good = check_root(&w);
    for (uint64_t i = 0; good && i < w.leaves; i++) good = check_leaf(&w);
    if (leaves) *leaves = w.leaves;
    if (good) return true;
    return err_set("%s: damaged VDB file: grid '%s', byte %zu: %s", layout->path, grid->name,
                   w.c.at, w.fault);
}
