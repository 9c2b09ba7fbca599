// Templates of a flow. Before each step of the solver every group's shader brings its instances on
// by the step, and one dispatch puts those of all groups into all slices. All of it is on the
// device, and depends on seeds and steps alone: what is drawn, and how often, changes nothing.
#include "base/error.h"
#include "base/hash.h"
#include "base/memory.h"
#include "pass/builtin.h"
#include "pass/slices_templates_parts.h"

static const slices_extra hooks;
enum { ROWS = 4 }; // of an instance (shaders/pass/slices/templates.glsl)

slices_templates *slices_templates_make(slices_flow *f) {
    if (!f->templates_state)
        f->templates_state = arena_alloc(f->pass->host->memory, sizeof(slices_templates));
    f->templates = &hooks;
    return f->templates_state;
}

gpu_buffer *slices_templates_buffer(const pass *p) {
    const slices_templates *t = slices_templates_of(slices_of(p));
    return t && t->total ? t->instances : NULL;
}

// ---- declaring --------------------------------------------------------------------------------

static bool pushes(const pass *group) {
    size_t index;
    return pass_find_key(group, "kind", &index) == PASS_OPTION && group->options[index] == 1;
}

static bool has_kind(const pass *p, bool pushing) {
    const slices_templates *t = slices_templates_of(slices_of(p));
    for (uint32_t i = 0; t && i < t->group_count; i++)
        if (pushes(t->groups[i]->pass) == pushing) return true;
    return t && t->hand.taken;
}

bool slices_has_pressing(const pass *p) {
    return has_kind(p, false);
}

bool slices_has_pushing(const pass *p) {
    return has_kind(p, true);
}

bool slices_add_templates(pass *p, pass *group, const picture *image, uint32_t count) {
    slices_flow *f = slices_of(p);
    slices_templates *t = slices_templates_make(f);
    if (t->group_count == SLICES_TEMPLATES_GROUPS)
        return err_set("%s: a flow has at most %d groups of templates", group->label,
                       SLICES_TEMPLATES_GROUPS);
    if (count < 1 || count > SLICES_TEMPLATES_MOST - t->total)
        return err_set("%s: 'count' is %u; a flow has 1 to %d templates in each slice, and %u are "
                       "in other groups",
                       group->label, count, SLICES_TEMPLATES_MOST, t->total);
    template_group *g = group->state = arena_alloc(p->host->memory, sizeof *g);
    *g = (template_group){group, f, image, t->group_count, t->total, count};
    t->groups[t->group_count++] = g;
    t->total += count;
    slices_add_part(f, group);
    return true;
}

// ---- tiles ------------------------------------------------------------------------------------

// Cells along a side: 16, or as many as leave at most 32 tiles along each side of a slice.
static uint32_t tile_side(const slices_flow *f) {
    const uint32_t *size = f->desc.size, most = size[0] > size[1] ? size[0] : size[1];
    return 16 * ((most + 511) / 512);
}

static uint64_t mask_bytes(const slices_flow *f) {
    const uint32_t *size = f->desc.size, side = tile_side(f);
    const uint64_t words = (slices_templates_of(f)->total + 31) / 32;
    const uint64_t tiles = (uint64_t)((size[0] + side - 1) / side) * ((size[1] + side - 1) / side);
    return 2 * 4 * tiles * (words ? words : 1) * f->desc.count;
}

size_t slices_templates_defines(const slices_flow *f, shader_define *out) {
    arena *memory = f->pass->host->memory;
    const slices_templates *t = slices_templates_of(f);
    out[0] = (shader_define){"TEMPLATES_TOTAL", arena_format(memory, "%u", t->total)};
    out[1] = (shader_define){"TEMPLATES_TILE", arena_format(memory, "%u", tile_side(f))};
    return SLICES_TEMPLATES_DEFINES;
}

// ---- building: of a group ---------------------------------------------------------------------

static bool compile_group(pass *p) {
    const template_group *g = p->state;
    shader_define defines[FLOW_MAX_DEFINES + SLICES_TEMPLATES_DEFINES];
    size_t count = flow_defines(g->flow->solver, defines);
    count += slices_templates_defines(g->flow, defines + count);
    return pass_compile(p, p->shader, SHADER_COMPUTE, defines, count, &p->binary);
}

bool slices_templates_declare_group(pass *p) {
    (void)p;
    return true; // the flow runs it
}

bool slices_templates_check_group(pass *p) {
    return compile_group(p);
}

bool slices_templates_build_group(pass *p) {
    if (!compile_group(p)) return false;
    p->pipeline = pass_create_compute(p, &p->binary);
    return p->pipeline != NULL;
}

// Where the region may be, in widths of a slice.
static bool region_box(const pass *p, float low[2], float high[2]) {
    const template_group *g = p->state;
    const uint32_t *size = g->flow->desc.size;
    size_t index;
    box3 box = box3_infinite();
    pass_find_key(p, "region", &index);
    if (p->fields[index] && !field_bounds(p->fields[index], p->host->context, &box)) return false;
    float height = (float)size[1] / (float)size[0];
    low[0] = clampf(box.min.x, 0, 1), high[0] = clampf(box.max.x, 0, 1);
    low[1] = clampf(box.min.y, 0, height), high[1] = clampf(box.max.y, 0, height);
    return true;
}

bool slices_templates_fill_group(pass *p, const shader_binary *binary, unsigned char *block) {
    const template_group *g = p->state;
    const slices_templates *t = slices_templates_of(g->flow);
    float own[4];
    if (!pass_evaluate_vector(p, "seed", own)) return false;
    const uint32_t seeds[3] = {slices_seed(g->flow), (uint32_t)own[0], g->index};
    const uint32_t key = (uint32_t)hash64(seeds, sizeof seeds);
    const float tile = (float)g->index, step = (float)g->flow->clock.step;
    float low[2], high[2];
    if (!region_box(p, low, high)) return false;
    pass_write_member(binary, block, "key", &key, sizeof key);
    pass_write_member(binary, block, "first", &g->first, sizeof g->first);
    pass_write_member(binary, block, "count", &g->count, sizeof g->count);
    pass_write_member(binary, block, "parity", &t->parity, sizeof t->parity);
    pass_write_member(binary, block, "tile", &tile, sizeof tile);
    pass_write_member(binary, block, "time_step", &step, sizeof step);
    pass_write_member(binary, block, "box_min", low, sizeof low);
    pass_write_member(binary, block, "box_max", high, sizeof high);
    return true;
}

// ---- building: of all -------------------------------------------------------------------------

static bool each_group(const slices_templates *t, bool (*call)(pass *group)) {
    for (uint32_t i = 0; i < t->group_count; i++)
        if (!call(t->groups[i]->pass)) return false;
    return true;
}

static bool check(slices_flow *f) {
    return each_group(slices_templates_of(f), pass_check_part) && slices_templates_compile_draw(f);
}

static bool build(slices_flow *f) {
    return each_group(slices_templates_of(f), pass_build_part) && slices_templates_build_draw(f);
}

static bool allocate(slices_flow *f) {
    slices_templates *t = slices_templates_of(f);
    gpu *device = f->pass->host->device;
    uint32_t count = t->total ? t->total : 1; // there are none but by hand
    if (!slices_templates_make_images(f)) return false;
    if (!t->masks)
        t->masks = gpu_buffer_create(
            device, &(gpu_buffer_desc){.label = "tiles of templates", .size = mask_bytes(f)});
    t->unmarked = true;
    if (!t->masks || t->instances) return t->masks != NULL;
    t->instances =
        gpu_buffer_create(device, &(gpu_buffer_desc){.label = "templates",
                                                     .size = 16ull * ROWS * count * f->desc.count});
    t->fresh = true;
    return t->instances != NULL;
}

static void destroy(slices_flow *f) {
    slices_templates *t = slices_templates_of(f);
    slices_templates_destroy_draw(f);
    gpu_buffer_destroy(f->pass->host->device, t->instances);
    gpu_buffer_destroy(f->pass->host->device, t->masks);
    *t = (slices_templates){0};
}

// ---- a step -----------------------------------------------------------------------------------

static bool run_group(const template_group *g) {
    pass *p = g->pass;
    gpu_dispatch_desc desc = {.pipeline = p->pipeline,
                              .threads = {g->count, g->flow->desc.count, 1}};
    if (pass_prepare(p) && slices_templates_dispatch(g->flow, p, &p->binary, p->block, &desc))
        return true;
    return err_prefix("%s: ", p->label);
}

static bool run(slices_flow *f) {
    slices_templates *t = slices_templates_of(f);
    if (t->fresh) gpu_buffer_fill(f->pass->host->device, t->instances, 0);
    if (t->unmarked) gpu_buffer_fill(f->pass->host->device, t->masks, 0);
    t->fresh = t->unmarked = false;
    t->parity = 1 - t->parity;
    for (uint32_t i = 0; i < t->group_count; i++)
        if (!run_group(t->groups[i])) return false;
    return slices_templates_draw(f);
}

static void restart(slices_flow *f) {
    slices_templates_of(f)->fresh = true;
}

static void loaded(slices_flow *f) {
    slices_templates_of(f)->fresh = false;
}

static void exchange(slices_flow *f, slices_flow *other) {
    slices_templates *a = slices_templates_of(f), *b = slices_templates_of(other), own = *a;
    bool same = a->total == b->total && a->group_count == b->group_count;
    for (uint32_t i = 0; i < a->group_count && same; i++)
        same = a->groups[i]->count == b->groups[i]->count;
    if (!same) return;
    a->instances = b->instances, a->fresh = b->fresh;
    b->instances = own.instances, b->fresh = own.fresh;
}

static bool rehearse(slices_flow *f) {
    return each_group(slices_templates_of(f), pass_rehearse);
}

static const slices_extra hooks = {
    .check = check,
    .build = build,
    .allocate = allocate,
    .rehearse = rehearse,
    .restart = restart,
    .loaded = loaded,
    .exchange = exchange,
    .run = run,
    .destroy = destroy,
};
