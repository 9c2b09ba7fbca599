// Shells: what of each is the same everywhere is found first (gather), then the surfaces, by a ray
// for each pixel, or by vertices that are pushed out and drawn (shell_mesh.c).
#include "pass/shell.h"
#include "base/error.h"
#include "base/memory.h"
#include "field/range.h"
#include "pass/builtin.h"
#include "pass/shell_parts.h"
#include <math.h>
#include <string.h>

static const char *const stage_defines[SHELL_STAGES] = {"STAGE_GATHER", "STAGE_VERTICES",
                                                        "STAGE_FRONT", "STAGE_RAYS"};

shell_state *shell_state_of(pass *p) {
    if (!p->state) p->state = arena_alloc(p->host->memory, sizeof(shell_state));
    return p->state;
}

void pass_shell_open(pass *p, const scene_explosions *list) {
    shell_state_of(p)->list = list;
}

// ---- declaring and building -------------------------------------------------------------------

bool shell_declare(pass *p) {
    shell_state *s = shell_state_of(p);
    s->drawn = pass_has_word(p, "mode", "mesh");
    return s->drawn ? shell_declare_mesh(p) : pass_declare_images(p) && pass_add_to_graph(p);
}

static bool is_used(const shell_state *s, shell_stage stage) {
    return stage == SHELL_GATHER || (stage != SHELL_RAYS) == s->drawn;
}

static bool compile(pass *p, shell_stage stage) {
    const shader_define defines[] = {{stage_defines[stage], "1"}, shell_corners_define(p)};
    return pass_compile(p, p->shader, SHADER_COMPUTE, defines, COUNT_OF(defines),
                        &shell_state_of(p)->binary[stage]);
}

bool shell_check(pass *p) {
    const shell_state *s = shell_state_of(p);
    for (int i = 0; i < SHELL_STAGES; i++)
        if (is_used(s, (shell_stage)i) && !compile(p, (shell_stage)i)) return false;
    return !s->drawn || shell_check_mesh(p);
}

bool shell_build(pass *p) {
    shell_state *s = shell_state_of(p);
    for (int i = 0; i < SHELL_STAGES; i++) {
        if (!is_used(s, (shell_stage)i)) continue;
        if (!compile(p, (shell_stage)i)) return false;
        s->pipeline[i] = pass_create_compute(p, &s->binary[i]);
        s->block[i] = arena_alloc(p->host->memory, pass_block_size(&s->binary[i]) + 16);
        if (!s->pipeline[i]) return false;
    }
    p->binary = s->binary[SHELL_GATHER];
    return !s->drawn || shell_build_mesh(p);
}

bool shell_allocate(pass *p) {
    shell_state *s = shell_state_of(p);
    if (!s->records)
        s->records = gpu_buffer_create(
            p->host->device,
            &(gpu_buffer_desc){.label = "ShellRecords", .size = PASS_SHELL_MOST * SHELL_RECORD});
    return s->records || err_prefix("%s: ", p->label);
}

void shell_destroy(pass *p) {
    shell_state *s = p->state;
    gpu *device = p->host->device;
    for (int i = 0; s && i < SHELL_STAGES; i++)
        if (s->pipeline[i]) gpu_pipeline_destroy(device, s->pipeline[i]);
    if (!s) return;
    if (s->draw) gpu_pipeline_destroy(device, s->draw);
    if (s->records) gpu_buffer_destroy(device, s->records);
    if (s->vertices) gpu_buffer_destroy(device, s->vertices);
}

// ---- a frame ----------------------------------------------------------------------------------

static size_t list_alive(pass *p, const scene_explosion *out[PASS_SHELL_MOST], double *life) {
    static const scene_explosion only = {.size = 1, .life = 1};
    const scene_explosions *list = shell_state_of(p)->list;
    double time = p->host->context->time;
    *life = (double)pass_evaluate(p, "life");
    if (list) return scene_explosions_alive(list, time, *life, out, PASS_SHELL_MOST);
    out[0] = &only;
    return time >= 0 && time < *life;
}

// As shell/gather.glsl has them.
static void write_shells(pass *p, const shader_binary *binary, unsigned char *block) {
    const scene_explosion *alive[PASS_SHELL_MOST];
    float shells[PASS_SHELL_MOST][3][4];
    double life;
    uint32_t count = (uint32_t)list_alive(p, alive, &life);
    for (uint32_t i = 0; i < count; i++) {
        const scene_explosion *one = alive[i];
        double age = (p->host->context->time - one->time) / (life * (double)one->life);
        const float place[4] = {one->place.x, one->place.y, one->place.z, one->size};
        const float own[4] = {(float)age};
        memcpy(shell_state_of(p)->places[i], place, sizeof(float[3]));
        memcpy(shells[i][0], place, sizeof place);
        memcpy(shells[i][1], own, sizeof own);
        scene_explosion_chance(one, shells[i][2]);
    }
    shell_state_of(p)->count = count;
    pass_write_member(binary, block, "shell_count", &count, sizeof count);
    pass_write_member(binary, block, "shells", shells, count * sizeof *shells);
}

// Between what nothing of the displacement leaves, at any place and age, and `reach`.
static bool find_bounds(pass *p, float out[2]) {
    size_t index;
    intervals all = {{{0, 0}}};
    const box3 sphere = {{-1, -1, -1}, {1, 1, 1}};
    pass_find_key(p, "displacement", &index);
    if (p->fields[index] && !field_ranges(p->fields[index], p->host->context, sphere, &all))
        return false;
    float reach = pass_evaluate(p, "reach");
    out[0] = clampf(all.c[0].low, SHELL_LEAST, reach);
    out[1] = clampf(all.c[0].high, SHELL_LEAST, reach);
    return true;
}

bool shell_fill(pass *p, const shader_binary *binary, unsigned char *block) {
    float bounds[2];
    if (!find_bounds(p, bounds)) return err_prefix("field 'displacement': ");
    pass_write_member(binary, block, "bounds", bounds, sizeof bounds);
    write_shells(p, binary, block);
    return true;
}

bool shell_run(pass *p, shell_stage stage, uint32_t x, uint32_t y) {
    shell_state *s = shell_state_of(p);
    const shader_binary *binary = &s->binary[stage];
    gpu_image *drawn = s->drawn ? graph_get_image(p->host->graph, s->drawn_front) : NULL;
    const pass_override overrides[] = {{"ShellRecords", {.buffer = s->records}},
                                       {"ShellVertices", {.buffer = s->vertices}},
                                       {"drawn_front", {.image = drawn}}};
    gpu_binding bindings[GPU_MAX_SLOTS];
    gpu_dispatch_desc desc = {
        .pipeline = s->pipeline[stage], .bindings = bindings, .threads = {x, y, 1}};
    return pass_fill_block(p, binary, s->block[stage]) &&
           pass_bind(p, binary, s->block[stage], overrides, COUNT_OF(overrides), bindings,
                     &desc.binding_count) &&
           gpu_dispatch(p->host->device, &desc);
}

bool shell_record(pass *p) {
    const shell_state *s = shell_state_of(p);
    uint32_t size[3];
    if (!pass_prepare(p)) return false; // counts them, too
    if (s->count > 0 && !shell_run(p, SHELL_GATHER, PASS_SHELL_MOST, 1)) return false;
    if (s->drawn) return shell_record_mesh(p);
    graph_get_size(p->host->graph, pass_output(p, "image"), size);
    return shell_run(p, SHELL_RAYS, size[0], size[1]);
}
