// Bake: a field evaluated at every voxel centre of a box, into a grid that other fields sample.
// effect/ makes the grid and sets size and box.
//
// A grid with levels has them as long as its sides can be halved without rest; each is the mean of
// the one before.
//
// The image is kept: while all that the values depend on is as it was when they were computed, they
// are not computed again. That is the numbers (uniforms, FieldNumbers), the content of palettes and
// of grids; the shader cannot change within the life of a pass. A shader that reads anything else
// (the block Frame, say, by a user's function) runs every frame.
#include "base/memory.h"
#include "pass/pass_impl.h"
#include <string.h>

#define NAMES(NAME) NAME(values), NAME(finer)
KERNEL_NAMES(NAMES);

enum { BAKE, LEVEL, KERNELS };
static const pass_kernel kernels[KERNELS] = {
    [LEVEL] = {.shader = "pass/grids/bake_level.comp",
               .without_fields = true}, // from the one before
};

typedef struct bake_state {
    unsigned char *now, *last; // what the values depend on: now, and when they were computed
    size_t size;
    bool known; // there is a `last`
} bake_state;

void pass_set_bake(pass *p, field_grid *grid) {
    p->baked = grid;
}

static uint32_t count_levels(const field_grid *grid) {
    uint32_t sides = grid->size[0] | grid->size[1] | grid->size[2], count = 1;
    for (; grid->levels && !(sides & 1); sides >>= 1) count++;
    return count;
}

static bool bake_declare(pass *p) {
    field_grid *grid = p->baked;
    p->state = arena_alloc(p->host->memory, sizeof(bake_state));
    // Three channels take four: there is no image of three.
    p->formats[p->names[N_values].image] = grid->channel_count == 1 ? GPU_R16F : GPU_RGBA16F;
    if (!pass_add_output(p, N_values,
                         (graph_image_desc){
                             .name = p->label,
                             .width = grid->size[0],
                             .height = grid->size[1],
                             .depth = grid->size[2],
                             .mips = count_levels(grid),
                             .keep = true,
                         }))
        return false;
    pass_host_add_grid_image(p->host, grid, 0, *pass_image(p, N_values));
    return pass_add_to_graph(p);
}

static bool bake_defines(pass *p, size_t index, pass_defines *out) {
    (void)out;
    return index == BAKE || p->baked->levels;
}

static bool bake_update(pass *p) {
    pass_set_box(p, p->baked->box);
    return true;
}

// ---- what the values depend on ----------------------------------------------------------------

// Whether everything that the shader reads can be told to be as it was.
static bool can_tell(const pass *p) {
    const field_texture *textures;
    size_t count = field_program_textures(p->program, &textures);
    for (size_t i = 0; i < count; i++)
        if (textures[i].grid && !textures[i].grid->state.content) return false;
    return !pass_reads_frame(p, BAKE);
}

static unsigned char *put(unsigned char *to, const void *data, size_t size) {
    memcpy(to, data, size);
    return to + size;
}

static void list_dependencies(pass *p, unsigned char *out) {
    const kernel *k = pass_get_kernel(p, BAKE);
    out = put(out, k->blocks[0], k->block_sizes[0]);
    out = put(out, p->numbers, field_program_block_size(p->program));
    for (size_t i = 0; i < p->palette_count; i++) {
        out = put(out, &p->palettes[i].time, sizeof p->palettes[i].time);
        out = put(out, &p->palettes[i].version, sizeof p->palettes[i].version);
    }
    const field_texture *textures;
    size_t count = field_program_textures(p->program, &textures);
    for (size_t i = 0; i < count; i++)
        if (textures[i].grid) out = put(out, &textures[i].grid->state.content, sizeof(uint64_t));
}

static void make_lists(pass *p, bake_state *s) {
    const field_texture *textures;
    s->size = pass_get_kernel(p, BAKE)->block_sizes[0] + field_program_block_size(p->program) +
              p->palette_count * (sizeof(double) + sizeof(uint32_t)) +
              field_program_textures(p->program, &textures) * sizeof(uint64_t);
    s->now = arena_alloc(p->host->memory, s->size);
    s->last = arena_alloc(p->host->memory, s->size);
}

static bool is_done(const pass *p, const bake_state *s) {
    return s->known && can_tell(p) && memcmp(s->now, s->last, s->size) == 0 &&
           graph_has_content(p->host->graph, *pass_image(p, N_values));
}

// ---- computing --------------------------------------------------------------------------------

static bool run_levels(pass *p) {
    gpu_image *image = pass_get_image(p, N_values);
    const gpu_image_desc *desc = gpu_image_get_desc(image);
    for (uint32_t level = 1; level < desc->mips; level++) {
        kernel *k = pass_use(p, LEVEL);
        if (!k) return false;
        kernel_bind(k, N_finer, (gpu_binding){.image = image, .mip = level - 1, .one_mip = true});
        kernel_bind(k, N_values, (gpu_binding){.image = image, .mip = level});
        if (!kernel_run(k, p->host->device, desc->width >> level, desc->height >> level,
                        desc->depth >> level))
            return false;
    }
    return true;
}

static bool bake_record(pass *p) {
    bake_state *s = p->state;
    if (!s->now) make_lists(p, s);
    if (!pass_prepare(p)) return false;
    list_dependencies(p, s->now);
    if (is_done(p, s)) return true;
    s->known = false;
    if (!pass_run(p) || (p->baked->levels && !run_levels(p))) return false;
    memcpy(s->last, s->now, s->size);
    s->known = true;
    p->baked->state.content++;
    return true;
}

const pass_type bake_type = {
    .name = "bake",
    .constructed = true,
    .shader = "pass/grids/bake.comp",
    PASS_KERNELS,
    .declare = bake_declare,
    .defines = bake_defines,
    .update = bake_update,
    .record = bake_record,
};
