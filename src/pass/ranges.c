// The texture (layout: shaders/lib/range_grid.glsl) has the format of the grid's, 2 values for each
// brick and as much again for all levels above: of a dense grid 1/16 of its memory.
#include "pass/ranges.h"
#include "base/error.h"
#include "base/memory.h"
#include <pthread.h>
#include <string.h>

#define NAMES(NAME)                                                                                \
    NAME(values), NAME(index), NAME(ranges), NAME(size), NAME(count), NAME(from), NAME(level),     \
        NAME(repeats), NAME(x), NAME(from_x)
KERNEL_NAMES(NAMES);
static const char *const shaders[] = {"pass/grids/grid_ranges.comp"};
const kernel_table ranges_kernel_table = {{names, COUNT_OF(names)}, shaders, COUNT_OF(shaders)};
enum { WHOLE_BYTES = 32004 }; // that its groups share where blocks are not packed

typedef struct ranges_kind { // of grids that one kernel does for
    gpu_format format;
    bool sparse;
    kernel kernel;
} ranges_kind;

typedef struct ranges_texture { // one for each image of each set of a grid
    const field_grid *grid;
    int set, image;
    gpu_image *made;
    const gpu_image *of; // what it was computed from
    uint64_t content;    // of the grid, then
} ranges_texture;

struct pass_ranges {
    ranges_kind kinds[6];
    size_t kind_count;
    ranges_texture *textures;
    size_t count, capacity;
};

// ---- pipelines --------------------------------------------------------------------------------

static gpu_format format_of(const field_texture *t) {
    int channels = t->grid->channel_count - 4 * t->image;
    return channels == 1 ? GPU_R16F : channels == 2 ? GPU_RG16F : GPU_RGBA16F;
}

static ranges_kind *find_kind(struct pass_ranges *r, gpu_format format, bool sparse) {
    for (size_t i = 0; i < r->kind_count; i++)
        if (r->kinds[i].format == format && r->kinds[i].sparse == sparse) return &r->kinds[i];
    return NULL;
}

static bool build_kind(pass *p, gpu_format format, bool sparse) {
    struct pass_ranges *r = p->host->ranges;
    const bool fits = gpu_get_profile(p->host->device)->limits.shared_bytes >= WHOLE_BYTES;
    const shader_define defines[] = {{"FORMAT", gpu_format_name(format)},
                                     {"BRICK", sparse ? "8" : "4"},
                                     {"PACKED", fits ? "0" : "1"},
                                     {"SPARSE", ""}};
    const shader_compile_desc shader = {.name = shaders[0],
                                        .defines = defines,
                                        .define_count = sparse ? 4 : 3,
                                        .reader = p->host->reader};
    ranges_kind *made = &r->kinds[r->kind_count];
    *made = (ranges_kind){.format = format, .sparse = sparse};
    if (!kernel_compile_compute(&made->kernel, p->host->library, p->host->memory, &shader,
                                ranges_kernel_table.names) ||
        !kernel_build(&made->kernel, p->host->device))
        return false;
    r->kind_count++;
    return true;
}

static pthread_mutex_t building = PTHREAD_MUTEX_INITIALIZER; // passes are built side by side

static bool need_kind(pass *p, const field_texture *t) {
    pthread_mutex_lock(&building);
    if (!p->host->ranges) p->host->ranges = mem_alloc(sizeof *p->host->ranges);
    gpu_format format = format_of(t);
    bool there = find_kind(p->host->ranges, format, t->grid->sparse) ||
                 build_kind(p, format, t->grid->sparse);
    pthread_mutex_unlock(&building);
    return there;
}

bool pass_ranges_build(pass *p, const shader_binary *binary) {
    const field_texture *textures;
    size_t count = field_program_textures(p->program, &textures);
    for (size_t i = 0; i < count; i++) {
        bool read = false;
        for (size_t k = 0; k < binary->slot_count && textures[i].ranges; k++)
            read = read || strcmp(binary->slots[k].name, textures[i].glsl_name) == 0;
        if (read && !need_kind(p, &textures[i])) return false;
    }
    return true;
}

// ---- textures ---------------------------------------------------------------------------------

static void count_bricks(const field_grid *grid, uint32_t out[3]) {
    uint32_t side = grid->sparse ? GRID_SPARSE_BRICK : GRID_BRICK;
    for (int i = 0; i < 3; i++) out[i] = (grid->size[i] + side - 1) / side;
}

static bool halve(uint32_t size[3]) { // false: it is a single brick already
    bool more = size[0] > 1 || size[1] > 1 || size[2] > 1;
    for (int i = 0; i < 3; i++) size[i] = (size[i] + 1) / 2;
    return more;
}

static gpu_image_desc describe_texture(const field_grid *grid, gpu_format format) {
    uint32_t size[3], level[3];
    count_bricks(grid, size);
    memcpy(level, size, sizeof level);
    uint32_t width = size[0];
    while (halve(level)) width += level[0];
    return (gpu_image_desc){.label = "ranges",
                            .format = format,
                            .width = width,
                            .height = size[1],
                            .depth = 2 * size[2],
                            .use = GPU_USE_SAMPLED | GPU_USE_STORAGE};
}

static gpu_image *make_texture(pass *p, const field_grid *grid, gpu_format format) {
    const gpu_image_desc desc = describe_texture(grid, format);
    gpu_image *made = gpu_image_create(p->host->device, &desc);
    if (!made) err_prefix("%s: ranges of '%s': ", p->label, grid->name ? grid->name : "?");
    return made;
}

static ranges_texture *find_texture(struct pass_ranges *r, const field_texture *t) {
    for (size_t i = 0; i < r->count; i++) {
        ranges_texture *known = &r->textures[i];
        if (known->grid == t->grid && known->set == t->set && known->image == t->image)
            return known;
    }
    MEM_RESERVE(r->textures, r->count + 1, r->capacity);
    r->textures[r->count] = (ranges_texture){.grid = t->grid, .set = t->set, .image = t->image};
    return &r->textures[r->count++];
}

static bool is_made(const struct pass_ranges *r, const field_texture *t) {
    for (size_t i = 0; i < r->count; i++) {
        const ranges_texture *known = &r->textures[i];
        if (known->grid == t->grid && known->set == t->set && known->image == t->image)
            return known->made;
    }
    return false;
}

void pass_ranges_list_memory(const pass *p, budget_list *out) {
    const field_texture *textures;
    if (!p->host->ranges || !p->program) return;
    size_t count = field_program_textures(p->program, &textures);
    for (size_t i = 0; i < count; i++) {
        const field_texture *t = &textures[i];
        const field_grid_state *state = t->ranges ? &t->grid->state : NULL;
        if (!state || !pass_reads_texture(p, i) || is_made(p->host->ranges, t) ||
            !budget_list_first(out, &state->images[t->set][t->image]))
            continue;
        const gpu_image_desc desc = describe_texture(t->grid, format_of(t));
        budget_list_add(out, desc.label, gpu_image_bytes(&desc));
    }
}

// ---- computing --------------------------------------------------------------------------------

typedef struct ranges_level {
    uint32_t count[3], from[3]; // bricks; those of the level before
    int32_t level, x, from_x;
} ranges_level;

static void set_size(kernel *k, int name, const uint32_t size[3]) {
    const float v[3] = {(float)size[0], (float)size[1], (float)size[2]};
    kernel_set(k, name, v, sizeof v);
}

static void set_numbers(kernel *k, const field_grid *grid, const ranges_level *at) {
    set_size(k, N_size, grid->size);
    set_size(k, N_count, at->count);
    set_size(k, N_from, at->from);
    kernel_set_int(k, N_repeats, grid->repeats);
    kernel_set_int(k, N_level, at->level);
    kernel_set_int(k, N_x, at->x);
    kernel_set_int(k, N_from_x, at->from_x);
}

// Groups of 256, for 16^3 texels each; at higher levels a thread for each brick.
static void count_threads(const field_grid *grid, const ranges_level *at, uint32_t out[3]) {
    out[0] = at->count[0] * at->count[1] * at->count[2];
    out[1] = out[2] = 1;
    if (at->level > 0) return;
    for (int i = 0; i < 3; i++) out[i] = (grid->size[i] + 15) / 16;
    out[0] *= 256;
}

static bool run_level(pass *p, kernel *k, const field_texture *t, const ranges_texture *to,
                      const ranges_level *at) {
    const gpu_binding of = {.image = pass_field_image(p, t), .sampler = GPU_NEAREST_CLAMP};
    const gpu_binding index = {.image = t->grid->state.index[t->set][t->image],
                               .sampler = GPU_NEAREST_CLAMP};
    uint32_t threads[3];
    set_numbers(k, t->grid, at);
    count_threads(t->grid, at, threads);
    kernel_bind(k, N_values, of);
    kernel_bind(k, N_index, index);
    kernel_bind_image(k, N_ranges, to->made);
    return kernel_run(k, p->host->device, threads[0], threads[1], threads[2]);
}

static bool compute(pass *p, const field_texture *t, const ranges_texture *to) {
    kernel *k = &find_kind(p->host->ranges, format_of(t), t->grid->sparse)->kernel;
    ranges_level at = {.level = 0};
    count_bricks(t->grid, at.count);
    bool more = true;
    while (more) {
        if (!run_level(p, k, t, to, &at)) return false;
        memcpy(at.from, at.count, sizeof at.from);
        at.from_x = at.x;
        at.x += (int32_t)at.count[0];
        at.level++;
        more = halve(at.count);
    }
    return true;
}

gpu_image *pass_ranges_get(pass *p, const field_texture *t) {
    gpu_image *of = pass_field_image(p, t);
    if (!of) return p->blank[1]; // not shown now: not asked either
    ranges_texture *r = find_texture(p->host->ranges, t);
    uint64_t content = t->grid->state.content;
    if (!r->made) r->made = make_texture(p, t->grid, format_of(t));
    if (!r->made) return NULL;
    if (r->of == of && r->content == content && content != 0) return r->made;
    if (!compute(p, t, r)) return NULL;
    r->of = of;
    r->content = content;
    return r->made;
}

void pass_ranges_free(pass_host *host) {
    struct pass_ranges *r = host->ranges;
    if (!r) return;
    for (size_t i = 0; i < r->count; i++) gpu_image_destroy(host->device, r->textures[i].made);
    for (size_t i = 0; i < r->kind_count; i++) kernel_destroy(&r->kinds[i].kernel, host->device);
    mem_free(r->textures);
    mem_free(r);
    host->ranges = NULL;
}
