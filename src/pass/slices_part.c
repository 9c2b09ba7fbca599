// Parts of slices: passes of the types `slices_inflow`, `slices_force` and `slices_obstacle`, which
// the slices' own pass runs before each step. They write the solver's inputs, one after the other;
// while nothing that they depend on changes, these stay as they are.
#include "base/error.h"
#include "base/memory.h"
#include "pass/builtin.h"
#include "pass/slices_paint.h"
#include "pass/slices_parts.h"
#include "pass/slices_templates.h"
#include <string.h>

typedef struct part_state {
    slices_flow *flow;
    const struct picture *painted;
    gpu_image *image;    // of it
    bool first;          // of its kind: it writes what others add to
    bool known;          // the input holds what it wrote with
    unsigned char *last; // these numbers
} part_state;

bool slices_is_obstacle(const pass *part) {
    return pass_is(part, "slices_obstacle");
}

bool slices_is_template(const pass *part) {
    return pass_is(part, "slices_templates");
}

void slices_add_part(slices_flow *f, pass *part) {
    part->runs_in = f->pass;
    MEM_RESERVE(f->parts, f->part_count + 1, f->part_capacity);
    f->parts[f->part_count++] = part;
}

static void note_used(slices_flow *f, const pass *part) {
    for (int i = 0; i < PASS_SLICES_NAMES; i++) {
        size_t index;
        if (pass_find_key(part, pass_slices_names[i], &index) == PASS_FIELD && part->fields[index])
            f->used[i] = true;
    }
}

bool pass_slices_add(pass *p, pass *part, const struct picture *painted) {
    slices_flow *f = slices_of(p);
    size_t shape;
    bool obstacle = slices_is_obstacle(part), first = true;
    if (obstacle && !painted && pass_find_key(part, "shape", &shape) == PASS_FIELD &&
        !part->fields[shape])
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

static bool compile(pass *p) {
    const part_state *s = p->state;
    shader_define defines[FLOW_MAX_DEFINES + 1];
    size_t count = flow_defines(s->flow->solver, defines);
    defines[count++] = (shader_define){"PICTURE", s->painted ? "1" : "0"};
    return pass_compile(p, p->shader, SHADER_COMPUTE, defines, count, &p->binary);
}

bool slices_part_declare(pass *p) {
    (void)p;
    return true;
}

bool slices_part_check(pass *p) {
    return compile(p);
}

bool slices_part_build(pass *p) {
    part_state *s = p->state;
    if (!compile(p)) return false;
    p->pipeline = pass_create_compute(p, &p->binary);
    s->last = arena_alloc(p->host->memory,
                          pass_block_size(&p->binary) + field_program_block_size(p->program) + 16);
    return p->pipeline != NULL;
}

bool slices_part_allocate(pass *p) {
    part_state *s = p->state;
    if (!s || !s->painted || s->image) return true;
    s->image = slices_paint(p->host->device, s->painted, s->flow->desc.size);
    return s->image || err_prefix("%s: ", p->label);
}

void slices_part_destroy(pass *p) {
    part_state *s = p->state;
    if (s && s->image) gpu_image_destroy(p->host->device, s->image);
}

// ---- a step -----------------------------------------------------------------------------------

// Time is written where something varies with it only, so that what stands still is seen to.
bool slices_part_fill(pass *p, const shader_binary *binary, unsigned char *block) {
    const part_state *s = p->state;
    const slices_flow *f = s->flow;
    float variation[4];
    if (!pass_evaluate_vector(f->pass, "variation", variation)) return false;
    const float now = variation[0] > 0 ? (float)p->host->context->time : 0;
    const float duration = (float)f->clock.step;
    const uint32_t first = s->first, variety = slices_seed(f) * (2 * PASS_SLICES_MOST);
    pass_write_member(binary, block, "now", &now, sizeof now);
    pass_write_member(binary, block, "duration", &duration, sizeof duration);
    pass_write_member(binary, block, "is_first", &first, sizeof first);
    pass_write_member(binary, block, "variety", &variety, sizeof variety);
    pass_write_member(binary, block, "variation", variation, sizeof *variation);
    return true;
}

void slices_forget_part(pass *part) {
    part_state *s = part->state;
    if (!slices_is_template(part)) s->known = false;
}

// Whether it depends on numbers alone.
static bool is_numbers(const pass *p) {
    const field_texture *textures;
    for (size_t i = 0; i < p->binary.slot_count; i++)
        if (strcmp(p->binary.slots[i].name, "Frame") == 0) return false;
    return field_program_textures(p->program, &textures) == 0;
}

// Evaluates the numbers of the step; `*same`: they are those of the last.
static bool prepare(pass *p, bool *same) {
    part_state *s = p->state;
    size_t block = pass_block_size(&p->binary), numbers = field_program_block_size(p->program);
    if (!pass_prepare(p)) return false;
    *same = s->known && is_numbers(p) && memcmp(s->last, p->block, block) == 0 &&
            memcmp(s->last + block, p->numbers, numbers) == 0;
    memcpy(s->last, p->block, block);
    memcpy(s->last + block, p->numbers, numbers);
    s->known = true;
    return true;
}

static bool run(pass *p) {
    part_state *s = p->state;
    const slices_flow *f = s->flow;
    pass_override overrides[GPU_MAX_SLOTS];
    size_t count = 0;
    for (size_t i = 0; i < p->binary.slot_count; i++) {
        overrides[count] = (pass_override){.name = p->binary.slots[i].name};
        count += flow_bind(f->solver, overrides[count].name, &overrides[count].binding);
    }
    if (s->image)
        overrides[count++] =
            (pass_override){"Picture", {.image = s->image, .sampler = GPU_LINEAR_CLAMP}};
    gpu_binding bindings[GPU_MAX_SLOTS];
    gpu_dispatch_desc dispatch = {
        .pipeline = p->pipeline,
        .bindings = bindings,
        .threads = {f->desc.size[0], f->desc.size[1], f->desc.count},
    };
    return pass_bind(p, &p->binary, p->block, overrides, count, bindings,
                     &dispatch.binding_count) &&
           gpu_dispatch(p->host->device, &dispatch);
}

static bool is_wanted(const pass *part, bool obstacles) {
    return !slices_is_template(part) && slices_is_obstacle(part) == obstacles;
}

bool slices_run_parts(slices_flow *f, bool obstacles) {
    // Templates push on top of what is there.
    bool same = obstacles || !f->templates || !slices_has_pushing(f->pass);
    for (size_t i = 0; i < f->part_count; i++) {
        bool one = true;
        if (is_wanted(f->parts[i], obstacles) && !prepare(f->parts[i], &one))
            return err_prefix("%s: ", f->parts[i]->label);
        same = same && one;
    }
    for (size_t i = 0; i < f->part_count && !same; i++)
        if (is_wanted(f->parts[i], obstacles) && !run(f->parts[i]))
            return err_prefix("%s: ", f->parts[i]->label);
    return true;
}
