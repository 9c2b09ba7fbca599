// March: the box that rays are cut to is computed on the host, from the bounds of the density;
// where in it nothing is, bricks tell.
#include "base/memory.h"
#include "pass/bricks.h"
#include "pass/builtin.h"
#include "pass/march_around.h"
#include <math.h>

enum { GROUP_SIDE = 16, MOST_TEAM = 16 };

// Of a device, beyond which more threads make a ray no faster.
static const float ENOUGH_THREADS = 1.2e6f;

typedef struct march_state {
    bool skips;    // by bricks
    bool adaptive; // has code for a tolerance
    bool teams;    // has code for several threads a ray
    bool software; // the device is: it has no branches
    int32_t team;  // threads a ray, in this frame
    box3 box;      // that rays are cut to, in this frame
    bricks bricks;
    march_around around; // in software
} march_state;

static bool record_bricks(pass *p) {
    march_state *s = p->state;
    return pass_prepare(p) && bricks_record(p, &s->bricks);
}

bool march_declare(pass *p) {
    march_state *s = p->state = arena_alloc(p->host->memory, sizeof *s);
    s->skips = pass_has_word(p, "skipping", "on");
    if (!pass_check_density(p) || !pass_declare_images(p)) return false;
    if (!s->skips) return pass_add_to_graph(p);
    return bricks_declare(p, &s->bricks, record_bricks) &&
           pass_add_to_graph_after(p, &s->bricks.image, 1);
}

// ---- building ---------------------------------------------------------------------------------

// Whether somebody says what it is.
static bool gives(const pass *p, const char *uniform) {
    size_t index;
    const shader_uniform *declared;
    return pass_find_key(p, uniform, &index) == PASS_UNIFORM &&
           (p->uniforms[index] || pass_inherited_uniform(p, index, &declared));
}

// Steps of one length take less code and fewer registers alone: those of variable length are left
// out as long as nobody gives a tolerance. Likewise rays have one thread where they are as many as
// the pixels of the output, and where threads are few.
static void choose_code(const pass *p) {
    march_state *s = p->state;
    gpu *device = p->host->device;
    bool software = !device || gpu_get_info(device)->kind == GPU_CPU;
    s->adaptive = gives(p, "tolerance");
    s->teams =
        !pass_has_word(p, "view", "noise") && ((!software && p->scale < 1) || gives(p, "threads"));
    s->software = software;
}

static bool compile(pass *p, shader_binary *out) {
    const march_state *s = p->state;
    const shader_define defines[] = {{"ADAPTIVE", s->adaptive ? "1" : "0"},
                                     {"TEAMS", s->teams ? "1" : "0"},
                                     {"MARCH_SOFTWARE", s->software && !s->teams ? "1" : "0"}};
    return pass_compile(p, p->shader, SHADER_COMPUTE, defines, COUNT_OF(defines), out);
}

bool march_check(pass *p) {
    const march_state *s = p->state;
    choose_code(p);
    return (!s->skips || bricks_check(p)) && (!s->software || march_around_check(p)) &&
           compile(p, &p->binary);
}

bool march_build(pass *p) {
    march_state *s = p->state;
    if (s->skips && !bricks_build(p, &s->bricks)) return false;
    choose_code(p);
    if (s->software && !march_around_build(p, &s->around)) return false;
    if (!compile(p, &p->binary)) return false;
    p->pipeline = pass_create_compute(p, &p->binary);
    return p->pipeline != NULL;
}

void march_destroy(pass *p) {
    march_state *s = p->state;
    if (!s) return;
    bricks_destroy(p, &s->bricks);
    march_around_destroy(p, &s->around);
}

// ---- in a frame -------------------------------------------------------------------------------

// The paper marches the whole simulation box in every frame (section 3.5), wherever that was moved;
// otherwise the box is as tight as what burns just now.
static bool march_box(const pass *p, box3 *box) {
    if (!pass_has_word(p, "mode", "paper")) return pass_density_box(p, box);
    return pass_density_box_of_grids(p, box);
}

// A power of two; one where there are rays enough.
static int32_t team_size(pass *p, float rays) {
    const march_state *s = p->state;
    if (!s->teams || pass_evaluate(p, "tolerance") > 0) return 1;
    float asked = pass_evaluate(p, "threads");
    float most = asked > 0 ? asked : ENOUGH_THREADS / fmaxf(rays, 1);
    most = fminf(most, (float)gpu_get_info(p->host->device)->subgroup_size);
    int32_t team = 1;
    while (team < MOST_TEAM && (float)(2 * team) <= most) team *= 2;
    return team;
}

bool march_fill(pass *p, const shader_binary *binary, unsigned char *block) {
    march_state *s = p->state;
    box3 box;
    uint32_t size[3];
    if (!march_box(p, &box)) return false;
    s->box = box;
    pass_write_box(binary, block, box);
    graph_get_size(p->host->graph, pass_output(p, "color"), size);
    float rays = (float)size[0] * (float)size[1], rows = (float)size[1];
    pass_write_member(binary, block, "brick_rows", &rows, sizeof rows);
    s->team = team_size(p, rays);
    pass_write_member(binary, block, "team", &s->team, sizeof s->team);
    if (!s->skips) return true;
    bricks_fill(p, &s->bricks, binary, block, box, rays * pass_evaluate(p, "steps"));
    return true;
}

// A tolerance or threads that someone moves by hand, where the effect says nothing of them.
static bool compile_again(pass *p) {
    shader_binary binary;
    if (!compile(p, &binary)) return false;
    gpu_pipeline *pipeline = pass_create_compute(p, &binary);
    if (!pipeline) return false;
    gpu_pipeline_destroy(p->host->device, p->pipeline);
    p->pipeline = pipeline;
    p->binary = binary;
    p->block = arena_alloc(p->host->memory, pass_block_size(&binary) + 16);
    return pass_fill_block(p, &p->binary, p->block);
}

static bool follow_code(pass *p) {
    march_state *s = p->state, before = *s;
    s->adaptive = s->adaptive || pass_evaluate(p, "tolerance") > 0;
    s->teams = s->teams || (pass_evaluate(p, "threads") > 1 && !pass_has_word(p, "view", "noise"));
    return (s->adaptive == before.adaptive && s->teams == before.teams) || compile_again(p);
}

// A group is a square of pixels, or half of one, of 256 threads.
static void count_threads(const march_state *s, march_part part, uint32_t threads[3]) {
    int bits = 8;
    for (int32_t i = 1; i < s->team; i *= 2) bits--;
    const uint32_t tile[2] = {1u << (bits + 1) / 2, 1u << bits / 2};
    for (int i = 0; i < 2; i++) {
        uint32_t pixels = (uint32_t)(part.high[i] - part.low[i]);
        threads[i] = (pixels + tile[i] - 1) / tile[i] * GROUP_SIDE;
    }
}

static bool record_part(pass *p, march_part part) {
    march_state *s = p->state;
    pass_override slot = s->skips ? bricks_slot(p, &s->bricks) : (pass_override){"", {0}};
    gpu_binding bindings[GPU_MAX_SLOTS];
    gpu_dispatch_desc desc = {.pipeline = p->pipeline, .bindings = bindings};
    count_threads(s, part, desc.threads);
    if (!desc.threads[0] || !desc.threads[1]) return true;
    march_write_corner(&p->binary, p->block, part);
    return pass_bind(p, &p->binary, p->block, &slot, s->skips, bindings, &desc.binding_count) &&
           gpu_dispatch(p->host->device, &desc);
}

bool march_record(pass *p) {
    march_state *s = p->state;
    march_part inside;
    if (!s->skips && !pass_prepare(p)) return false;
    if (!follow_code(p)) return false;
    march_around *around = s->software && !s->teams ? &s->around : NULL;
    return march_around_record(p, around, s->box, &inside) && record_part(p, inside);
}
