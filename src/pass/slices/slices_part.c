// Parts of slices: passes of the types `slices_inflow`, `slices_force` and `slices_obstacle`, which
// the slices' own pass runs before each step. They write the solver's inputs, one after the other;
// while nothing that they depend on changes, these stay as they are.
#include "base/error.h"
#include "base/maths.h"
#include "base/memory.h"
#include "media/picture.h"
#include "pass/slices/slices_parts.h"
#include "pass/slices/slices_templates.h"
#include <string.h>

typedef struct part_state {
    slices_flow *flow;
    const struct picture *painted;
    gpu_image *image;    // of it
    bool first;          // of its kind: it writes what others add to
    bool known;          // the input holds what it wrote with
    unsigned char *last; // these numbers; NULL: none yet
    bool is_numbers;     // it depends on numbers alone
} part_state;

bool slices_is_obstacle(const pass *part) {
    return part->type == &slices_obstacle_type;
}

bool slices_is_template(const pass *part) {
    return part->type == &slices_templates_type;
}

void slices_add_part(slices_flow *f, pass *part) {
    part->runs_in = f->pass;
    *MEM_ADD(f->parts, f->part_count, f->part_capacity) = part;
}

static void note_used(slices_flow *f, const pass *part) {
    static const int names[][2] = {{PASS_FLUID_DENSITY, N_density},
                                   {PASS_FLUID_TEMPERATURE, N_temperature},
                                   {PASS_FLUID_DYE, N_dye},
                                   {PASS_FLUID_VELOCITY, N_velocity}};
    for (size_t i = 0; i < COUNT_OF(names); i++) {
        const int own = part->names[names[i][1]].field; // a force has none of them
        if (own >= 0 && part->fields[own]) f->used[names[i][0]] = true;
    }
}

bool pass_slices_add(pass *p, pass *part, const struct picture *painted) {
    slices_flow *f = slices_of(p);
    bool obstacle = slices_is_obstacle(part), first = true;
    if (obstacle && !painted && !pass_given_field(part, N_shape))
        return err_set("%s: nothing stands there; give it shape = disc { ... }, or image = "
                       "image \"obstacle.png\"",
                       part->label);
    for (size_t i = 0; i < f->part_count; i++)
        if (!slices_is_template(f->parts[i]) && slices_is_obstacle(f->parts[i]) == obstacle)
            first = false;
    part_state *s = part->state = arena_alloc(p->host->memory, sizeof *s);
    *s = (part_state){.flow = f, .painted = painted, .first = first};
    if (!obstacle) note_used(f, part);
    slices_add_part(f, part);
    return true;
}

// ---- building ---------------------------------------------------------------------------------

static bool part_defines(pass *p, size_t index, pass_defines *out) {
    const part_state *s = p->state;
    (void)index;
    out->count += flow_defines(s->flow->solver, out->items + out->count);
    pass_define_flag(out, "PICTURE", s->painted);
    return true;
}

// Texels that become one, so that four samples of a cell miss none.
static uint32_t count_merged(uint32_t pixels, uint32_t cells) {
    uint32_t merged = pixels / (2 * cells);
    return merged < 1 ? 1 : merged;
}

static void merge(const picture *p, uint32_t x, uint32_t y, const uint32_t merged[2],
                  uint16_t out[4]) {
    double sum[4] = {0};
    for (uint32_t dy = 0; dy < merged[1]; dy++)
        for (uint32_t dx = 0; dx < merged[0]; dx++) {
            size_t at = (size_t)(y * merged[1] + dy) * p->width + (x * merged[0] + dx);
            for (int c = 0; c < 4; c++) sum[c] += (double)p->rgba[4 * at + (size_t)c];
        }
    for (int c = 0; c < 4; c++)
        out[c] = half_from_float((float)(sum[c] / ((double)merged[0] * merged[1])));
}

// A picture as a texture that is not much finer than the cells which sample it. Between frames;
// NULL with a message.
static gpu_image *slices_paint(gpu *g, const picture *painted, const uint32_t cells[2]) {
    const uint32_t merged[2] = {count_merged(painted->width, cells[0]),
                                count_merged(painted->height, cells[1])};
    const uint32_t width = painted->width / merged[0], height = painted->height / merged[1];
    size_t size = (size_t)width * height * 4 * sizeof(uint16_t);
    gpu_image *image = gpu_image_create(g, &(gpu_image_desc){.label = "painted obstacle",
                                                             .format = GPU_RGBA16F,
                                                             .width = width,
                                                             .height = height,
                                                             .use = GPU_USE_SAMPLED});
    if (!image) return NULL;
    uint16_t *texels = mem_alloc(size);
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++)
            merge(painted, x, y, merged, texels + 4 * ((size_t)y * width + x));
    bool done = gpu_image_write(g, image, 0, texels, size);
    mem_free(texels);
    if (done) return image;
    gpu_image_destroy(g, image);
    return NULL;
}

static bool part_allocate(pass *p) {
    part_state *s = p->state;
    if (!s || !s->painted || s->image) return true;
    s->image = slices_paint(p->host->device, s->painted, s->flow->desc.size);
    return s->image || err_prefix("%s: ", p->label);
}

static void part_destroy(pass *p) {
    part_state *s = p->state;
    if (s && s->image) gpu_image_destroy(p->host->device, s->image);
}

// ---- a step -----------------------------------------------------------------------------------

// Time is written where something varies with it only, so that what stands still is seen to.
static bool part_update(pass *p) {
    const part_state *s = p->state;
    const slices_flow *f = s->flow;
    float variation[4];
    if (!pass_evaluate_now(f->pass, N_variation, variation)) return false;
    pass_set_float(p, N_now, variation[0] > 0 ? (float)p->host->context->time : 0);
    pass_set_float(p, N_duration, (float)f->clock.step);
    pass_set_int(p, N_is_first, s->first);
    pass_set_int(p, N_variety, (int32_t)(slices_seed(f) * (2 * PASS_SLICES_MOST)));
    pass_set_float(p, N_variation, variation[0]);
    return true;
}

void slices_forget_part(pass *part) {
    part_state *s = part->state;
    if (!slices_is_template(part)) s->known = false;
}

// Evaluates the numbers of the step; `*same`: they are those of the last.
static bool part_prepare(pass *p, bool *same) {
    part_state *s = p->state;
    const kernel *k = pass_get_kernel(p, 0);
    const field_texture *textures;
    if (!pass_prepare(p)) return false;
    const size_t block = k->block_sizes[0], numbers = field_program_block_size(p->program);
    if (!s->last) {
        s->last = arena_alloc(p->host->memory, block + numbers + 16);
        s->is_numbers =
            !pass_reads_frame(p, 0) && field_program_textures(p->program, &textures) == 0;
    }
    *same = s->known && s->is_numbers && memcmp(s->last, k->blocks[0], block) == 0 &&
            memcmp(s->last + block, p->numbers, numbers) == 0;
    memcpy(s->last, k->blocks[0], block);
    memcpy(s->last + block, p->numbers, numbers);
    s->known = true;
    return true;
}

static bool part_run(pass *p) {
    const part_state *s = p->state;
    const slices_flow *f = s->flow;
    kernel *k = pass_use(p, 0);
    if (!k) return false;
    flow_bind(f->solver, k, pass_solver_places(p, 0));
    if (s->image) kernel_bind_image(k, N_Picture, s->image);
    return kernel_run(k, p->host->device, f->desc.size[0], f->desc.size[1], f->desc.count);
}

static bool is_wanted(const pass *part, bool obstacles) {
    return !slices_is_template(part) && slices_is_obstacle(part) == obstacles;
}

bool slices_run_parts(slices_flow *f, bool obstacles) {
    // Templates push on top of what is there.
    bool same = obstacles || !f->templates || !slices_has_pushing(f->pass);
    for (size_t i = 0; i < f->part_count; i++) {
        bool one = true;
        if (is_wanted(f->parts[i], obstacles) && !part_prepare(f->parts[i], &one))
            return err_prefix("%s: ", f->parts[i]->label);
        same = same && one;
    }
    for (size_t i = 0; i < f->part_count && !same; i++)
        if (is_wanted(f->parts[i], obstacles) && !part_run(f->parts[i]))
            return err_prefix("%s: ", f->parts[i]->label);
    return true;
}

static const pass_kernel kernels[1];

#define PART(NAME)                                                                                 \
    {                                                                                              \
        .name = NAME, .shader = "pass/slices/" NAME ".comp", .kernels = kernels,                   \
        .kernel_count = 1, .names = {slices_names, SLICES_NAME_COUNT},                             \
        .solver = &flow_kernel_table, .unscaled = true, .constructed = true, .runs_inside = true,  \
        .defines = part_defines, .allocate = part_allocate, .update = part_update,                 \
        .destroy = part_destroy                                                                    \
    }

const pass_type slices_inflow_type = PART("slices_inflow");
const pass_type slices_force_type = PART("slices_force");
const pass_type slices_obstacle_type = PART("slices_obstacle");
