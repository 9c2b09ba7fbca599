// Lighting: one pass of the script, several of the graph, so that each part costs only when its
// output is read, and has its own GPU time: LABEL.lights, LABEL.shadow and so on. All are stages of
// one shader file.
#include "base/error.h"
#include "base/memory.h"
#include "base/worker.h"
#include "pass/builtin.h"
#include "pass/pass_impl.h"
#include "shared.h"
#include <math.h>
#include <string.h>

enum {
    ROW_TEXELS = 11,       // of a light in `lights`: SHADOW_MAP_TEXELS of lib/shadow_map.glsl
    GREATEST_DEPTH = 2048, // of a 3D image, on any device
    WAYS = 48,             // directions that light is swept in, in lighting/ways.glsl
    AXES = 3,
    COLORS = 3,
    LEVELS = 2,      // of the buffers, in lighting/level.glsl
    LOOKS = 64,      // into each direction, in lighting/ways.glsl
    LOOK_PARTS = 4,  // groups that do them, in lighting/ways.glsl
    FIRE_SLOTS = 16, // threads for each of 2 x 2 x 2 voxels, in lighting/fire.glsl
};

typedef enum lighting_stage {
    STAGE_LIGHTS,
    STAGE_FIRE,
    STAGE_GATHER,
    STAGE_SHADOW,
    STAGE_MEDIUM,
    STAGE_AROUND,
    STAGE_FIRST,
    STAGE_SWEEP,
    STAGE_RESTRICT,
    STAGE_PROLONG,
    STAGE_COARSE_SWEEP,
    STAGE_COARSE_REDUCE,
    STAGES
} lighting_stage;

static const struct {
    const char *define;
    uint32_t level;
} stages[STAGES] = {
    [STAGE_LIGHTS] = {"STAGE_LIGHTS", 0},      [STAGE_FIRE] = {"STAGE_FIRE", 0},
    [STAGE_GATHER] = {"STAGE_GATHER", 0},      [STAGE_SHADOW] = {"STAGE_SHADOW", 0},
    [STAGE_MEDIUM] = {"STAGE_MEDIUM", 0},      [STAGE_AROUND] = {"STAGE_AROUND", 0},
    [STAGE_FIRST] = {"STAGE_FIRST", 0},        [STAGE_SWEEP] = {"STAGE_SWEEP", 0},
    [STAGE_RESTRICT] = {"STAGE_RESTRICT", 0},  [STAGE_PROLONG] = {"STAGE_PROLONG", 0},
    [STAGE_COARSE_SWEEP] = {"STAGE_SWEEP", 1}, [STAGE_COARSE_REDUCE] = {"STAGE_REDUCE", 1},
};

// What one stage leaves for others, besides the outputs: the shader writes NAME_kept and reads
// NAME_made.
typedef enum lighting_grid { MEDIUM, SCATTERING, AROUND, FIRE, GRIDS } lighting_grid;

static const struct {
    const char *name, *kept, *made; // and as the shader names it
} grids[GRIDS] = {
    {"medium", "medium_kept", "medium_made"},
    {"scattering", "scattering_kept", "scattering_made"},
    {"around", "around_kept", "around_made"},
    {"fire", "fire_kept", "fire_made"},
};

// What the stages of the glow keep for each voxel of a level (lighting/state.glsl).
typedef enum lighting_buffer {
    SLICES_OF_MEDIUM,
    SLICES_OF_SOURCE,
    LIGHT_OF_WAYS,
    FIRST,
    SCATTERED,
    LAST,
    PART,
    BUFFERS
} lighting_buffer;

static const struct {
    const char *name, *coarse; // as the shader names it, and that of the coarser level
    uint32_t bytes;            // a voxel
} buffers[BUFFERS] = {
    {"Medium", "CoarseMedium", AXES *COLORS * 4},
    {"Source", "CoarseSource", AXES *COLORS * 8},
    {"Ways", NULL, WAYS *COLORS * 2},
    {"First", "CoarseFirst", COLORS * 16},
    {"Scattered", "CoarseScattered", COLORS * 16},
    {"Last", NULL, COLORS * 16},
    {"Part", "CoarsePart", COLORS * 4},
};

typedef struct lighting_state {
    uint32_t declared; // lights of the scene, its sun among them
    uint32_t shadow_size, glow_size, fire_count;
    uint32_t shadow_parts; // threads of a ray, in lighting/shadow.glsl
    uint32_t rays_apart;   // of threads, one traces rays to meshes
    shader_binary binary[STAGES];
    gpu_pipeline *pipeline[STAGES];
    unsigned char *block[STAGES];
    graph_image grids[GRIDS];
    gpu_buffer *buffers[LEVELS][BUFFERS];
} lighting_state;

// ---- declaring --------------------------------------------------------------------------------

static bool add_image(pass *p, const char *name, const uint32_t size[3]) {
    int index = pass_find_image(p, name);
    p->images[index] = graph_add_image(
        p->host->graph, &(graph_image_desc){
                            .name = arena_format(p->host->memory, "%s.%s", p->label, name),
                            .format = p->formats[index],
                            .width = size[0],
                            .height = size[1],
                            .depth = size[2],
                        });
    return p->images[index].id != 0;
}

static graph_image image_of(const pass *p, const char *name) {
    return p->images[pass_find_image(p, name)];
}

static bool add_grids(pass *p) {
    lighting_state *s = p->state;
    uint32_t n = s->glow_size;
    const uint32_t sizes[GRIDS][3] = {
        [MEDIUM] = {n, n, n},
        [SCATTERING] = {n, n, n},
        [AROUND] = {WAYS, LOOK_PARTS, 1},
        [FIRE] = {n, n, 2 * n},
    };
    for (int i = 0; i < GRIDS; i++) {
        s->grids[i] = graph_add_image(
            p->host->graph,
            &(graph_image_desc){
                .name = arena_format(p->host->memory, "%s.%s", p->label, grids[i].name),
                .format = GPU_RGBA32F,
                .width = sizes[i][0],
                .height = sizes[i][1],
                .depth = sizes[i][2],
            });
        if (!s->grids[i].id) return false;
    }
    return true;
}

static bool add_images(pass *p) {
    const lighting_state *s = p->state;
    uint32_t n = s->shadow_size, g = s->glow_size;
    if (n * s->declared > GREATEST_DEPTH)
        return err_set("%s: shadows of %u lights (the sun is one) do not fit at a "
                       "shadow_resolution of %u; at most %u is possible with so many",
                       p->label, s->declared, n, GREATEST_DEPTH / s->declared);
    return add_image(p, "lights", (uint32_t[3]){ROW_TEXELS, s->declared + s->fire_count, 0}) &&
           add_image(p, "shadow", (uint32_t[3]){n, n, n * s->declared}) &&
           add_image(p, "glow", (uint32_t[3]){g, g, 3 * g}) && add_grids(p);
}

static bool record_lights(pass *p);
static bool record_shadow(pass *p);
static bool record_medium(pass *p);
static bool record_glow(pass *p);

static bool add_parts(pass *p) {
    const lighting_state *s = p->state;
    const graph_image *own = s->grids;
    graph_image lights = image_of(p, "lights"), shadow = image_of(p, "shadow");
    const graph_image none = {0}, lights_writes[] = {lights, own[FIRE]};
    const graph_image glow_reads[] = {lights, shadow, own[MEDIUM], own[SCATTERING]};
    const graph_image glow_writes[] = {image_of(p, "glow"), own[AROUND]};
    const pass_part parts[] = {
        {.name = "lights",
         .reads = s->fire_count ? &own[MEDIUM] : &none,
         .read_count = 1,
         .writes = lights_writes,
         .write_count = COUNT_OF(lights_writes),
         .record = record_lights},
        {.name = "shadow",
         .reads = &lights,
         .read_count = 1,
         .writes = &shadow,
         .write_count = 1,
         .fields = true,
         .record = record_shadow},
        {.name = "medium",
         .reads = s->fire_count ? &none : &lights, // of the two, one is the first in a frame
         .read_count = 1,
         .writes = &own[MEDIUM], // and the next
         .write_count = 2,
         .fields = true,
         .record = record_medium},
        {.name = "glow",
         .reads = glow_reads,
         .read_count = COUNT_OF(glow_reads),
         .writes = glow_writes,
         .write_count = COUNT_OF(glow_writes),
         .record = record_glow},
    };
    for (size_t i = 0; i < COUNT_OF(parts); i++)
        if (!pass_add_part(p, &parts[i])) return false;
    return true;
}

// A GPU wants many threads, each with little to do; on a processor each thread costs by itself.
static uint32_t choose_shadow_parts(const gpu *device, uint32_t size) {
    return device && gpu_get_info(device)->kind == GPU_CPU ? 8 : size / 4;
}

// Rays of one subgroup wait for each other; on a processor threads that wait for one cost the same.
static uint32_t choose_rays_apart(const gpu *device) {
    return device && gpu_get_info(device)->kind == GPU_CPU ? 1 : 32;
}

bool lighting_declare(pass *p) {
    const scene *around = p->host->scene;
    lighting_state *s = p->state = arena_alloc(p->host->memory, sizeof *s);
    s->declared = around ? (uint32_t)around->light_count + 1 : 1;
    s->shadow_size = pass_number(p, "shadow_resolution");
    s->shadow_parts = choose_shadow_parts(p->host->device, s->shadow_size);
    s->rays_apart = choose_rays_apart(p->host->device);
    s->glow_size = pass_number(p, "glow_resolution");
    s->fire_count = pass_number(p, "fire_lights");
    return pass_check_density(p) && add_images(p) && add_parts(p);
}

// ---- building ---------------------------------------------------------------------------------

static bool compile(pass *p, lighting_stage stage, shader_binary *out) {
    const lighting_state *s = p->state;
    arena *memory = p->host->memory;
    const shader_define defines[] = {
        {stages[stage].define, "1"},
        {"SHADOW_SIZE", arena_format(memory, "%u", s->shadow_size)},
        {"SHADOW_PARTS", arena_format(memory, "%u", s->shadow_parts)},
        {"GLOW_SIZE", arena_format(memory, "%u", s->glow_size)},
        {"RAYS_APART", arena_format(memory, "%u", s->rays_apart)},
        {"MOST_THREADS", pass_most_threads(p)},
        {"FIRE_COUNT", arena_format(memory, "%u", s->fire_count)},
        {"LEVEL_SIZE", arena_format(memory, "%u", s->glow_size >> stages[stage].level)},
        {"WITHOUT_FIELDS", "1"}, // last: not of these two
    };
    bool fields = stage == STAGE_MEDIUM || stage == STAGE_SHADOW;
    return pass_compile(p, p->shader, SHADER_COMPUTE, defines, COUNT_OF(defines) - fields, out);
}

static bool is_used(const lighting_state *s, lighting_stage stage) {
    return s->fire_count > 0 || (stage != STAGE_FIRE && stage != STAGE_GATHER);
}

static bool check_stage(void *user, size_t index) {
    pass *p = user;
    lighting_stage stage = (lighting_stage)index;
    shader_binary binary;
    return !is_used(p->state, stage) || compile(p, stage, &binary);
}

bool lighting_check(pass *p) {
    return worker_each(STAGES, check_stage, p);
}

static bool build_stage(void *user, size_t index) {
    pass *p = user;
    lighting_state *s = p->state;
    if (!is_used(s, (lighting_stage)index)) return true;
    if (!compile(p, (lighting_stage)index, &s->binary[index])) return false;
    s->pipeline[index] = pass_create_compute(p, &s->binary[index]);
    s->block[index] = arena_alloc(p->host->memory, pass_block_size(&s->binary[index]) + 16);
    return s->pipeline[index] != NULL;
}

bool lighting_build(pass *p) {
    lighting_state *s = p->state;
    if (!worker_each(STAGES, build_stage, p)) return false;
    p->binary = s->binary[STAGE_LIGHTS];
    return true;
}

void lighting_destroy(pass *p) {
    lighting_state *s = p->state;
    for (int i = 0; s && i < STAGES; i++)
        if (s->pipeline[i]) gpu_pipeline_destroy(p->host->device, s->pipeline[i]);
    for (int i = 0; s && i < LEVELS * BUFFERS; i++)
        gpu_buffer_destroy(p->host->device, s->buffers[i / BUFFERS][i % BUFFERS]);
}

// ---- in a frame -------------------------------------------------------------------------------

bool lighting_fill(pass *p, const shader_binary *binary, unsigned char *block) {
    const lighting_state *s = p->state;
    if (p->host->lights->count.v[0] != s->declared)
        return err_set("%s: made for %u lights (the sun is one), but the effect has %u; set "
                       "'lights' of the effect before it",
                       p->label, s->declared, p->host->lights->count.v[0]);
    box3 box;
    if (!pass_density_box(p, &box)) return false;
    pass_write_box(binary, block, box);
    return true;
}

static pass_override slot(const pass *p, const char *name, graph_image image) {
    return (pass_override){name,
                           {.image = graph_get_image(p->host->graph, image),
                            .one_mip = true,
                            .sampler = GPU_LINEAR_CLAMP}};
}

enum { MOST_OVERRIDES = 2 + 2 * GRIDS + 2 * BUFFERS };

// What the shader may name, as seen from a level.
static size_t list_slots(const pass *p, uint32_t level, pass_override out[MOST_OVERRIDES]) {
    const lighting_state *s = p->state;
    size_t count = 0;
    out[count++] = slot(p, "lights_made", image_of(p, "lights"));
    out[count++] = slot(p, "shadow_made", image_of(p, "shadow"));
    for (int i = 0; i < GRIDS; i++) {
        out[count++] = slot(p, grids[i].kept, s->grids[i]);
        out[count++] = slot(p, grids[i].made, s->grids[i]);
    }
    for (int i = 0; i < BUFFERS; i++) {
        out[count++] = (pass_override){buffers[i].name, {.buffer = s->buffers[level][i]}};
        if (level + 1 < LEVELS && buffers[i].coarse)
            out[count++] = (pass_override){buffers[i].coarse, {.buffer = s->buffers[level + 1][i]}};
    }
    return count;
}

static bool dispatch(pass *p, lighting_stage stage, uint32_t x, uint32_t y, uint32_t z) {
    const lighting_state *s = p->state;
    pass_override overrides[MOST_OVERRIDES];
    size_t override_count = list_slots(p, stages[stage].level, overrides), count;
    gpu_binding bindings[GPU_MAX_SLOTS];
    return pass_bind(p, &s->binary[stage], s->block[stage], overrides, override_count, bindings,
                     &count) &&
           gpu_dispatch(p->host->device,
                        &(gpu_dispatch_desc){s->pipeline[stage], bindings, count, {x, y, z}});
}

static bool dispatch_voxels(pass *p, lighting_stage stage) {
    uint32_t n = ((const lighting_state *)p->state)->glow_size;
    return dispatch(p, stage, n, n, n);
}

// A thread for each colour.
static bool dispatch_colors(pass *p, lighting_stage stage) {
    uint32_t n = ((const lighting_state *)p->state)->glow_size >> stages[stage].level;
    return dispatch(p, stage, n, n, COLORS * n);
}

static bool dispatch_groups(pass *p, lighting_stage stage, uint32_t groups) {
    const lighting_state *s = p->state;
    return dispatch(p, stage, groups * s->binary[stage].local_size[0], 1, 1);
}

static bool dispatch_sweep(pass *p, lighting_stage stage) {
    return dispatch_groups(p, stage, WAYS * COLORS);
}

// In the first of the parts of a frame: all others read what it writes.
static bool prepare(pass *p) {
    const lighting_state *s = p->state;
    if (!pass_prepare(p)) return false;
    for (int i = 0; i < STAGES; i++)
        if (is_used(s, (lighting_stage)i) && !pass_fill_block(p, &s->binary[i], s->block[i]))
            return false;
    return true;
}

static bool record_lights(pass *p) {
    const lighting_state *s = p->state;
    if (!s->fire_count) return prepare(p) && dispatch(p, STAGE_LIGHTS, s->declared, 1, 1);
    uint32_t blocks = s->glow_size / 2;
    return dispatch(p, STAGE_LIGHTS, s->declared, 1, 1) &&
           dispatch(p, STAGE_FIRE, FIRE_SLOTS * blocks, 8 * blocks, blocks) &&
           dispatch_groups(p, STAGE_GATHER, s->fire_count);
}

static bool record_medium(pass *p) {
    const lighting_state *s = p->state;
    uint32_t points = 2 * s->glow_size;
    return (!s->fire_count || prepare(p)) && dispatch(p, STAGE_MEDIUM, points, points, points);
}

static bool record_shadow(pass *p) {
    const lighting_state *s = p->state;
    uint32_t n = s->shadow_size;
    return dispatch(p, STAGE_SHADOW, n, n, s->shadow_parts * s->declared);
}

// The greatest part of the light that is scattered (as in lighting/level.glsl).
static float most_scattered(const pass *p) {
    const lighting_state *s = p->state;
    float albedo[3] = {0}, most = 0;
    shader_member member;
    if (pass_find_member(&s->binary[STAGE_COARSE_REDUCE], "albedo", &member))
        memcpy(albedo, s->block[STAGE_COARSE_REDUCE] + member.offset, sizeof albedo);
    for (int i = 0; i < 3; i++) most = fmaxf(most, fminf(albedo[i], 0.98f));
    return most;
}

// About as many as Chebyshev's combination takes to leave a tenth of what is wrong.
static uint32_t coarse_sweeps(const pass *p) {
    return (uint32_t)fmaxf(1.7f / sqrtf(1 - most_scattered(p)) - 0.7f, 1);
}

// A sweep with its correction leaves about (most / 2)^2 of what is wrong: no more than half a
// percent needs to be.
static uint32_t fine_sweeps(pass *p) {
    float most = fmaxf(most_scattered(p), 0.1f), asked = pass_evaluate(p, "sweeps");
    return (uint32_t)fminf(asked, ceilf(logf(0.005f) / (2 * logf(0.5f * most))));
}

static bool make_buffers(pass *p) {
    lighting_state *s = p->state;
    for (uint32_t level = 0; level < LEVELS; level++) {
        uint64_t n = s->glow_size >> level;
        for (int i = 0; i < BUFFERS; i++) {
            if (s->buffers[level][i]) continue;
            gpu_buffer_desc desc = {.label = buffers[i].name, .size = n * n * n * buffers[i].bytes};
            s->buffers[level][i] = gpu_buffer_create(p->host->device, &desc);
            if (!s->buffers[level][i]) return false;
        }
    }
    return true;
}

static void tell(pass *p, lighting_stage stage, const char *uniform, int32_t value) {
    lighting_state *s = p->state;
    pass_write_member(&s->binary[stage], s->block[stage], uniform, &value, sizeof value);
}

// On the coarser level sweeps are hastened (lighting/level.glsl).
static bool correct(pass *p) {
    uint32_t sweeps = coarse_sweeps(p);
    for (uint32_t i = 0; i < sweeps; i++) {
        tell(p, STAGE_COARSE_REDUCE, "hastened", (int32_t)i);
        if (!dispatch_sweep(p, STAGE_COARSE_SWEEP) || !dispatch_colors(p, STAGE_COARSE_REDUCE))
            return false;
    }
    return dispatch_colors(p, STAGE_PROLONG);
}

// After each sweep the coarser level finds what is left to do (lighting/level.glsl).
static bool record_glow(pass *p) {
    const lighting_state *s = p->state;
    uint32_t sweeps = fine_sweeps(p);
    if (!make_buffers(p) || !dispatch_voxels(p, STAGE_FIRST) ||
        !dispatch(p, STAGE_AROUND, WAYS * LOOKS / LOOK_PARTS * s->rays_apart, LOOK_PARTS, 1))
        return false;
    for (uint32_t i = 0; i < sweeps || i == 0; i++) {
        if (!dispatch_sweep(p, STAGE_SWEEP) || !dispatch_colors(p, STAGE_RESTRICT)) return false;
        tell(p, STAGE_PROLONG, "last_sweep", i + 1 >= sweeps);
        if (sweeps && !correct(p)) return false;
    }
    return true;
}
