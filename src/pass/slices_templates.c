// Templates of a flow. Before each step of the solver every group's shader brings its instances on
// by the step, and one dispatch puts those of all groups into all slices. All of it is on the
// device, and depends on seeds and steps alone: what is drawn, and how often, changes nothing.
#include "pass/slices_templates.h"
#include "base/error.h"
#include "base/hash.h"
#include "base/memory.h"
#include "pass/builtin.h"
#include "pass/slices_parts.h"
#include "sim/flow.h"
#include <string.h>

static const slices_extra hooks;
static const char draw_shader[] = "pass/slices/templates_draw.comp";

// Cells above each other that a thread draws: more look at each template less often, fewer make
// more threads. To be measured on a GPU.
enum { CELLS = 4, ROWS = 4 /* of an instance */ };

typedef struct template_group {
    pass *pass;
    slices_flow *flow;
    const picture *image;
    uint32_t index, first, count; // in each slice
} template_group;

typedef struct slices_templates {
    template_group *groups[SLICES_TEMPLATES_GROUPS];
    uint32_t group_count, total; // templates in each slice
    shader_binary draw;
    gpu_pipeline *pipeline; // that draws
    unsigned char *block;   // of its uniforms
    gpu_image *images;      // a tile for each group
    gpu_buffer *instances;
    bool fresh; // they begin anew with the next step
} slices_templates;

static slices_templates *templates_of(const slices_flow *f) {
    return f->templates_state;
}

gpu_buffer *slices_templates_buffer(const pass *p) {
    const slices_templates *t = templates_of(slices_of(p));
    return t ? t->instances : NULL;
}

// ---- declaring --------------------------------------------------------------------------------

static bool pushes(const pass *group) {
    size_t index;
    return pass_find_key(group, "kind", &index) == PASS_OPTION && group->options[index] == 1;
}

static bool has_kind(const pass *p, bool pushing) {
    const slices_templates *t = templates_of(slices_of(p));
    for (uint32_t i = 0; t && i < t->group_count; i++)
        if (pushes(t->groups[i]->pass) == pushing) return true;
    return false;
}

bool slices_has_pressing(const pass *p) {
    return has_kind(p, false);
}

bool slices_has_pushing(const pass *p) {
    return has_kind(p, true);
}

bool slices_add_templates(pass *p, pass *group, const picture *image, uint32_t count) {
    slices_flow *f = slices_of(p);
    slices_templates *t = templates_of(f);
    arena *memory = p->host->memory;
    if (!t) t = f->templates_state = arena_alloc(memory, sizeof *t);
    f->templates = &hooks;
    if (t->group_count == SLICES_TEMPLATES_GROUPS)
        return err_set("%s: a flow has at most %d groups of templates", group->label,
                       SLICES_TEMPLATES_GROUPS);
    if (count < 1 || count > SLICES_TEMPLATES_MOST - t->total)
        return err_set("%s: 'count' is %u; a flow has 1 to %d templates in each slice, and %u are "
                       "in other groups",
                       group->label, count, SLICES_TEMPLATES_MOST, t->total);
    template_group *g = group->state = arena_alloc(memory, sizeof *g);
    *g = (template_group){group, f, image, t->group_count, t->total, count};
    t->groups[t->group_count++] = g;
    t->total += count;
    slices_add_part(f, group);
    return true;
}

// ---- building: of a group ---------------------------------------------------------------------

static bool compile_group(pass *p) {
    const template_group *g = p->state;
    shader_define defines[FLOW_MAX_DEFINES];
    size_t count = flow_defines(g->flow->solver, defines);
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
    const slices_templates *t = templates_of(g->flow);
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
    pass_write_member(binary, block, "total", &t->total, sizeof t->total);
    pass_write_member(binary, block, "tile", &tile, sizeof tile);
    pass_write_member(binary, block, "time_step", &step, sizeof step);
    pass_write_member(binary, block, "box_min", low, sizeof low);
    pass_write_member(binary, block, "box_max", high, sizeof high);
    return true;
}

// ---- building: of all -------------------------------------------------------------------------

static bool compile_draw(slices_flow *f, slices_templates *t) {
    shader_define defines[FLOW_MAX_DEFINES + 4];
    size_t count = flow_defines(f->solver, defines);
    char *cells = arena_format(f->pass->host->memory, "%d", CELLS);
    defines[count++] = (shader_define){"TEMPLATES_CELLS", cells};
    defines[count++] = (shader_define){"PRESSES", slices_has_pressing(f->pass) ? "1" : "0"};
    defines[count++] = (shader_define){"PUSHES", slices_has_pushing(f->pass) ? "1" : "0"};
    defines[count++] = (shader_define){"WITHOUT_FIELDS", ""};
    return pass_compile(f->pass, draw_shader, SHADER_COMPUTE, defines, count, &t->draw);
}

static bool each_group(const slices_templates *t, bool (*call)(pass *group)) {
    for (uint32_t i = 0; i < t->group_count; i++)
        if (!call(t->groups[i]->pass)) return false;
    return true;
}

static bool check(slices_flow *f) {
    slices_templates *t = templates_of(f);
    return each_group(t, pass_check_part) && compile_draw(f, t);
}

static bool build(slices_flow *f) {
    slices_templates *t = templates_of(f);
    if (!each_group(t, pass_build_part) || !compile_draw(f, t)) return false;
    t->block = arena_alloc(f->pass->host->memory, pass_block_size(&t->draw) + 16);
    t->pipeline = pass_create_compute(f->pass, &t->draw);
    return t->pipeline != NULL;
}

// One level of all tiles.
static bool write_level(const slices_templates *t, gpu *device, uint32_t level, uint32_t side,
                        const float *tiles) {
    size_t count = 4 * (size_t)side * side * t->group_count;
    uint16_t *halves = mem_alloc(count * sizeof *halves);
    for (size_t i = 0; i < count; i++) halves[i] = half_from_float(tiles[i]);
    bool done = gpu_image_write(device, t->images, level, halves, count * sizeof *halves);
    mem_free(halves);
    return done;
}

static bool make_images(slices_templates *t, gpu *device) {
    const size_t texels = 4 * (size_t)SLICES_TILE * SLICES_TILE;
    t->images = gpu_image_create(device, &(gpu_image_desc){.label = "templates",
                                                           .format = GPU_RGBA16F,
                                                           .width = SLICES_TILE,
                                                           .height = SLICES_TILE * t->group_count,
                                                           .mips = SLICES_TILE_LEVELS,
                                                           .use = GPU_USE_SAMPLED});
    if (!t->images) return false;
    float *tiles = mem_alloc(t->group_count * texels * sizeof *tiles);
    for (uint32_t i = 0; i < t->group_count; i++)
        slices_tile(t->groups[i]->image, tiles + i * texels);
    uint32_t side = SLICES_TILE;
    bool done = write_level(t, device, 0, side, tiles);
    for (uint32_t level = 1; level < SLICES_TILE_LEVELS && done; level++, side /= 2) {
        for (uint32_t i = 0; i < t->group_count; i++) // in place: what is read lies ahead
            slices_tile_half(tiles + i * 4 * (size_t)side * side, side,
                             tiles + i * (size_t)side * side);
        done = write_level(t, device, level, side / 2, tiles);
    }
    mem_free(tiles);
    return done;
}

static bool allocate(slices_flow *f) {
    slices_templates *t = templates_of(f);
    gpu *device = f->pass->host->device;
    if (!t->images && !make_images(t, device)) return false;
    if (t->instances) return true;
    t->instances = gpu_buffer_create(
        device,
        &(gpu_buffer_desc){.label = "templates", .size = 16ull * ROWS * t->total * f->desc.count});
    t->fresh = true;
    return t->instances != NULL;
}

static void destroy(slices_flow *f) {
    slices_templates *t = templates_of(f);
    gpu *device = f->pass->host->device;
    if (t->pipeline) gpu_pipeline_destroy(device, t->pipeline);
    gpu_image_destroy(device, t->images);
    gpu_buffer_destroy(device, t->instances);
    *t = (slices_templates){0};
}

// ---- a step -----------------------------------------------------------------------------------

static size_t override(const slices_flow *f, const shader_binary *binary,
                       pass_override out[GPU_MAX_SLOTS]) {
    const slices_templates *t = templates_of(f);
    size_t count = 0;
    for (size_t i = 0; i < binary->slot_count; i++) {
        const char *name = binary->slots[i].name;
        gpu_binding *binding = &out[count].binding;
        *binding = (gpu_binding){0};
        if (strcmp(name, "Templates") == 0)
            binding->buffer = t->instances;
        else if (strcmp(name, "TemplateImages") == 0)
            *binding = (gpu_binding){.image = t->images, .sampler = GPU_LINEAR_CLAMP};
        else
            flow_bind(f->solver, name, binding);
        out[count].name = name;
        count += binding->buffer || binding->image;
    }
    return count;
}

static bool dispatch(const slices_flow *f, pass *p, const shader_binary *binary,
                     const unsigned char *block, gpu_dispatch_desc *desc) {
    pass_override overrides[GPU_MAX_SLOTS];
    gpu_binding bindings[GPU_MAX_SLOTS];
    size_t count = override(f, binary, overrides);
    desc->bindings = bindings;
    return pass_bind(p, binary, block, overrides, count, bindings, &desc->binding_count) &&
           gpu_dispatch(p->host->device, desc);
}

static bool run_group(const template_group *g) {
    pass *p = g->pass;
    gpu_dispatch_desc desc = {.pipeline = p->pipeline,
                              .threads = {g->count, g->flow->desc.count, 1}};
    if (pass_prepare(p) && dispatch(g->flow, p, &p->binary, p->block, &desc)) return true;
    return err_prefix("%s: ", p->label);
}

// Whether others have written what the flow is given in this step.
static bool has_sources(const slices_flow *f) {
    for (size_t i = 0; i < f->part_count; i++)
        if (pass_is(f->parts[i], "slices_inflow") || pass_is(f->parts[i], "slices_force"))
            return true;
    return false;
}

static bool draw(slices_flow *f, slices_templates *t) {
    const uint32_t *size = f->desc.size, alone = !has_sources(f);
    const float step = (float)f->clock.step;
    pass_write_member(&t->draw, t->block, "alone", &alone, sizeof alone);
    pass_write_member(&t->draw, t->block, "total", &t->total, sizeof t->total);
    pass_write_member(&t->draw, t->block, "time_step", &step, sizeof step);
    gpu_dispatch_desc desc = {.pipeline = t->pipeline,
                              .threads = {size[0], (size[1] + CELLS - 1) / CELLS, f->desc.count}};
    return dispatch(f, f->pass, &t->draw, t->block, &desc);
}

static bool run(slices_flow *f) {
    slices_templates *t = templates_of(f);
    if (t->fresh) gpu_buffer_fill(f->pass->host->device, t->instances, 0);
    t->fresh = false;
    for (uint32_t i = 0; i < t->group_count; i++)
        if (!run_group(t->groups[i])) return false;
    return draw(f, t);
}

static void restart(slices_flow *f) {
    templates_of(f)->fresh = true;
}

static bool rehearse(slices_flow *f) {
    return each_group(templates_of(f), pass_rehearse);
}

static const slices_extra hooks = {
    .check = check,
    .build = build,
    .allocate = allocate,
    .rehearse = rehearse,
    .restart = restart,
    .run = run,
    .destroy = destroy,
};
