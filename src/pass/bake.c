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
#include "base/error.h"
#include "pass/builtin.h"
#include "pass/pass_impl.h"
#include <string.h>

static const char level_shader[] = "pass/bake_level.comp";

typedef struct bake_state {
    shader_binary level; // of one level from the one before
    gpu_pipeline *level_pipeline;
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

bool bake_declare(pass *p) {
    field_grid *grid = p->baked;
    int output = pass_find_image(p, "values");
    // Three channels take four: there is no image of three.
    p->formats[output] = grid->channel_count == 1 ? GPU_R16F : GPU_RGBA16F;
    p->images[output] = graph_add_image(p->host->graph, &(graph_image_desc){
                                                            .name = p->label,
                                                            .format = p->formats[output],
                                                            .width = grid->size[0],
                                                            .height = grid->size[1],
                                                            .depth = grid->size[2],
                                                            .mips = count_levels(grid),
                                                            .keep = true,
                                                        });
    if (!p->images[output].id) return false;
    pass_host_add_grid_image(p->host, grid, 0, p->images[output]);
    return pass_add_to_graph(p);
}

bool bake_fill(pass *p, const shader_binary *binary, unsigned char *block) {
    const field_grid *grid = p->baked;
    pass_write_member(binary, block, "box_min", &grid->box.min, sizeof grid->box.min);
    pass_write_member(binary, block, "box_max", &grid->box.max, sizeof grid->box.max);
    return true;
}

static bool compile(pass *p, shader_binary *level) {
    return pass_compile(p, p->shader, SHADER_COMPUTE, NULL, 0, &p->binary) &&
           (!p->baked->levels || pass_compile(p, level_shader, SHADER_COMPUTE, NULL, 0, level));
}

bool bake_check(pass *p) {
    shader_binary level;
    return compile(p, &level);
}

bool bake_build(pass *p) {
    bake_state *s = p->state = arena_alloc(p->host->memory, sizeof *s);
    if (!compile(p, &s->level)) return false;
    p->pipeline = pass_create_compute(p, &p->binary);
    if (p->pipeline && p->baked->levels) s->level_pipeline = pass_create_compute(p, &s->level);
    return p->pipeline && (!p->baked->levels || s->level_pipeline);
}

void bake_destroy(pass *p) {
    bake_state *s = p->state;
    if (s && s->level_pipeline) gpu_pipeline_destroy(p->host->device, s->level_pipeline);
}

// ---- what the values depend on ----------------------------------------------------------------

static const field_texture *find_texture(const pass *p, const char *name) {
    const field_texture *textures;
    size_t count = field_program_textures(p->program, &textures);
    for (size_t i = 0; i < count; i++)
        if (strcmp(textures[i].glsl_name, name) == 0) return &textures[i];
    return NULL;
}

// Whether everything that the shader reads can be told to be as it was.
static bool can_tell(const pass *p) {
    for (size_t i = 0; i < p->binary.slot_count; i++) {
        const shader_slot *slot = &p->binary.slots[i];
        const field_texture *texture = find_texture(p, slot->name);
        if (texture
                ? texture->grid && !texture->grid->state.content
                : strcmp(slot->name, "Uniforms") != 0 && strcmp(slot->name, "FieldNumbers") != 0 &&
                      strcmp(slot->name, "values") != 0)
            return false;
    }
    return true;
}

static unsigned char *put(unsigned char *to, const void *data, size_t size) {
    memcpy(to, data, size);
    return to + size;
}

static void list_dependencies(const pass *p, unsigned char *out) {
    out = put(out, p->block, pass_block_size(&p->binary));
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
    s->size = pass_block_size(&p->binary) + field_program_block_size(p->program) +
              p->palette_count * (sizeof(double) + sizeof(uint32_t)) +
              field_program_textures(p->program, &textures) * sizeof(uint64_t);
    s->now = arena_alloc(p->host->memory, s->size);
    s->last = arena_alloc(p->host->memory, s->size);
}

static bool is_done(const pass *p, const bake_state *s) {
    graph_image values = p->images[pass_find_image(p, "values")];
    return s->known && can_tell(p) && memcmp(s->now, s->last, s->size) == 0 &&
           graph_has_content(p->host->graph, values);
}

// ---- computing --------------------------------------------------------------------------------

static bool run_levels(pass *p) {
    bake_state *s = p->state;
    gpu_image *image = graph_get_image(p->host->graph, p->images[pass_find_image(p, "values")]);
    const gpu_image_desc *desc = gpu_image_get_desc(image);
    for (uint32_t level = 1; level < desc->mips; level++) {
        const pass_override overrides[] = {
            {"finer",
             {.image = image, .mip = level - 1, .one_mip = true, .sampler = GPU_LINEAR_CLAMP}},
            {"values", {.image = image, .mip = level}},
        };
        gpu_dispatch_desc dispatch = {
            .pipeline = s->level_pipeline,
            .threads = {desc->width >> level, desc->height >> level, desc->depth >> level},
        };
        gpu_binding bindings[GPU_MAX_SLOTS];
        if (!pass_bind(p, &s->level, p->block, overrides, 2, bindings, &dispatch.binding_count))
            return false;
        dispatch.bindings = bindings;
        if (!gpu_dispatch(p->host->device, &dispatch)) return false;
    }
    return true;
}

bool bake_record(pass *p) {
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
