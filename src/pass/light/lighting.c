// Lighting: one pass of the script, several of the graph, so that each part costs only when its
// output is read, and has its own GPU time: LABEL.lights, LABEL.shadow and so on. All are stages of
// one shader file.
#include "base/error.h"
#include "base/memory.h"
#include "pass/pass_impl.h"
#include "shared.h"
#include <assert.h>
#include <math.h>

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

static const pass_kernel kernels[STAGES] = {
    [STAGE_LIGHTS] = {.define = "STAGE_LIGHTS", .without_fields = true},
    [STAGE_FIRE] = {.define = "STAGE_FIRE", .without_fields = true},
    [STAGE_GATHER] = {.define = "STAGE_GATHER", .without_fields = true},
    [STAGE_SHADOW] = {.define = "STAGE_SHADOW"},
    [STAGE_MEDIUM] = {.define = "STAGE_MEDIUM"},
    [STAGE_AROUND] = {.define = "STAGE_AROUND", .without_fields = true},
    [STAGE_FIRST] = {.define = "STAGE_FIRST", .without_fields = true},
    [STAGE_SWEEP] = {.define = "STAGE_SWEEP", .without_fields = true},
    [STAGE_RESTRICT] = {.define = "STAGE_RESTRICT", .without_fields = true},
    [STAGE_PROLONG] = {.define = "STAGE_PROLONG", .without_fields = true},
    [STAGE_COARSE_SWEEP] = {.define = "STAGE_SWEEP", .without_fields = true},
    [STAGE_COARSE_REDUCE] = {.define = "STAGE_REDUCE", .without_fields = true},
};

static uint32_t level_of(lighting_stage stage) {
    return stage >= STAGE_COARSE_SWEEP;
}

#define GRID_NAMES(NAME)                                                                           \
    NAME(medium_kept), NAME(medium_made), NAME(scattering_kept), NAME(scattering_made),            \
        NAME(around_kept), NAME(around_made), NAME(fire_kept), NAME(fire_made)
#define BUFFER_NAMES(NAME)                                                                         \
    NAME(Medium), NAME(Source), NAME(Ways), NAME(First), NAME(Scattered), NAME(Last), NAME(Part)
#define COARSE_NAMES(NAME)                                                                         \
    NAME(CoarseMedium), NAME(CoarseSource), NAME(CoarseFirst), NAME(CoarseScattered),              \
        NAME(CoarsePart)
#define NAMES(NAME)                                                                                \
    GRID_NAMES(NAME), BUFFER_NAMES(NAME), COARSE_NAMES(NAME), NAME(lights_made),                   \
        NAME(shadow_made), NAME(lights), NAME(shadow), NAME(glow), NAME(albedo), NAME(sweeps),     \
        NAME(hastened), NAME(last_sweep), NAME(shadow_resolution), NAME(glow_resolution),          \
        NAME(fire_lights), NAME(rig)
KERNEL_NAMES(NAMES);

// What one stage leaves for others, besides the outputs: the shader writes NAME_kept and reads
// NAME_made, in the order of GRID_NAMES.
typedef enum lighting_grid { MEDIUM, SCATTERING, AROUND, FIRE, GRIDS } lighting_grid;

static const char *const grid_names[GRIDS] = {"medium", "scattering", "around", "fire"};

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
    int name, coarse; // as the shader names it, and that of the coarser level; -1: it reads none
    uint32_t bytes;   // a voxel
} buffers[BUFFERS] = {
    {N_Medium, N_CoarseMedium, AXES *COLORS * 4},
    {N_Source, N_CoarseSource, AXES *COLORS * 8},
    {N_Ways, -1, WAYS *COLORS * 2},
    {N_First, N_CoarseFirst, COLORS * 16},
    {N_Scattered, N_CoarseScattered, COLORS * 16},
    {N_Last, -1, COLORS * 16},
    {N_Part, N_CoarsePart, COLORS * 4},
};

typedef struct lighting_state {
    bool rig;          // has lights of its own
    uint32_t declared; // lights of the scene, its sun among them, or of the rig
    uint32_t shadow_size, glow_size, fire_count;
    uint32_t shadow_parts; // threads of a ray, in lighting/shadow.glsl
    uint32_t rays_apart;   // of threads, one traces rays to meshes
    uint32_t slices_kept;  // in shared memory, of a sweep
    graph_image grids[GRIDS];
    gpu_buffer *buffers[LEVELS][BUFFERS];
} lighting_state;

// ---- declaring --------------------------------------------------------------------------------

static bool add_image(pass *p, int name, uint32_t width, uint32_t height, uint32_t depth) {
    return pass_add_output(p, name,
                           (graph_image_desc){.width = width, .height = height, .depth = depth});
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
                .name = arena_format(p->host->memory, "%s.%s", p->label, grid_names[i]),
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
    return add_image(p, N_lights, ROW_TEXELS, s->declared + s->fire_count, 0) &&
           add_image(p, N_shadow, n, n, n * s->declared) && add_image(p, N_glow, g, g, 3 * g) &&
           add_grids(p);
}

static bool record_lights(pass *p);
static bool record_shadow(pass *p);
static bool record_medium(pass *p);
static bool record_glow(pass *p);

static bool add_parts(pass *p) {
    const lighting_state *s = p->state;
    const graph_image *own = s->grids;
    graph_image lights = *pass_image(p, N_lights), shadow = *pass_image(p, N_shadow);
    const graph_image none = {0}, lights_writes[] = {lights, own[FIRE]};
    const graph_image glow_reads[] = {lights, shadow, own[MEDIUM], own[SCATTERING]};
    const graph_image glow_writes[] = {*pass_image(p, N_glow), own[AROUND]};
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

// Threads of a ray, of which a group has 16, or 32 where they are few (lighting/shadow.glsl).
static uint32_t choose_shadow_parts(const gpu_profile *device, uint32_t size) {
    uint32_t parts = device->lighting_parts ? device->lighting_parts : size / 4;
    while (parts * (parts > 8 ? 16 : 32) > device->limits.group_threads) parts /= 2;
    return parts;
}

// That a sweep keeps in shared memory: two, where that has room for them (lighting/sweep.glsl).
static uint32_t choose_slices(const gpu_profile *device, uint32_t size) {
    const uint32_t pairs = (size + 2) * (size / 2 + 2); // of cells, with a border
    return 2 * 16 * pairs <= device->limits.shared_bytes ? 2 : 1;
}

static bool lighting_declare(pass *p) {
    const scene *around = p->host->scene;
    lighting_state *s = p->state = arena_alloc(p->host->memory, sizeof *s);
    s->rig = !pass_option_is(p, N_rig, "none");
    s->declared = s->rig ? 3 : around ? (uint32_t)around->light_count + 1 : 1;
    s->shadow_size = pass_option_number(p, N_shadow_resolution);
    const gpu_profile *device = gpu_get_profile(p->host->device);
    s->shadow_parts = choose_shadow_parts(device, s->shadow_size);
    s->rays_apart = device->lighting_apart;
    while (LOOKS / LOOK_PARTS * s->rays_apart > device->limits.group_threads) s->rays_apart /= 2;
    s->glow_size = pass_option_number(p, N_glow_resolution);
    s->slices_kept = choose_slices(device, s->glow_size);
    s->fire_count = s->rig ? 0 : pass_option_number(p, N_fire_lights);
    return pass_check_density(p) && add_images(p) && add_parts(p);
}

// ---- building ---------------------------------------------------------------------------------

static bool lighting_defines(pass *p, size_t index, pass_defines *out) {
    const lighting_state *s = p->state;
    if (s->fire_count == 0 && (index == STAGE_FIRE || index == STAGE_GATHER)) return false;
    pass_define_number(p, out, "SHADOW_SIZE", s->shadow_size);
    pass_define_number(p, out, "SHADOW_PARTS", s->shadow_parts);
    pass_define_number(p, out, "GLOW_SIZE", s->glow_size);
    pass_define_number(p, out, "RAYS_APART", s->rays_apart);
    pass_define_number(p, out, "SLICES_KEPT", s->slices_kept);
    pass_define(out, "MOST_THREADS", pass_most_threads(p));
    pass_define_number(p, out, "FIRE_COUNT", s->fire_count);
    pass_define_number(p, out, "LEVEL_SIZE", s->glow_size >> level_of((lighting_stage)index));
    return true;
}

// ---- in a frame -------------------------------------------------------------------------------

static bool lighting_update(pass *p) {
    const lighting_state *s = p->state;
    if (!s->rig && p->host->lights->count.v[0] != s->declared)
        return err_set("%s: made for %u lights (the sun is one), but the effect has %u; set "
                       "'lights' of the effect before it",
                       p->label, s->declared, p->host->lights->count.v[0]);
    box3 box;
    if (!pass_density_box(p, &box)) return false;
    pass_set_box(p, box);
    return true;
}

static void bind_image(const pass *p, kernel *k, int name, graph_image image) {
    kernel_bind(k, name,
                (gpu_binding){.image = graph_get_image(p->host->graph, image), .one_mip = true});
}

// What the shader may name, as seen from a level.
static void bind(const pass *p, kernel *k, uint32_t level) {
    const lighting_state *s = p->state;
    bind_image(p, k, N_lights_made, *pass_image(p, N_lights));
    bind_image(p, k, N_shadow_made, *pass_image(p, N_shadow));
    for (int i = 0; i < 2 * GRIDS; i++) bind_image(p, k, i, s->grids[i / 2]);
    for (int i = 0; i < BUFFERS; i++) {
        kernel_bind_buffer(k, buffers[i].name, s->buffers[level][i]);
        if (level + 1 < LEVELS && buffers[i].coarse >= 0)
            kernel_bind_buffer(k, buffers[i].coarse, s->buffers[level + 1][i]);
    }
}

static bool dispatch(pass *p, lighting_stage stage, uint32_t x, uint32_t y, uint32_t z) {
    kernel *k = pass_use(p, stage);
    if (!k) return false;
    bind(p, k, level_of(stage));
    return kernel_run(k, p->host->device, x, y, z);
}

static bool dispatch_voxels(pass *p, lighting_stage stage) {
    uint32_t n = ((const lighting_state *)p->state)->glow_size;
    return dispatch(p, stage, n, n, n);
}

// A thread for each colour.
static bool dispatch_colors(pass *p, lighting_stage stage) {
    uint32_t n = ((const lighting_state *)p->state)->glow_size >> level_of(stage);
    return dispatch(p, stage, n, n, COLORS * n);
}

static bool dispatch_groups(pass *p, lighting_stage stage, uint32_t groups) {
    const uint32_t threads = pass_get_kernel(p, stage)->binaries[0].local_size[0];
    return dispatch(p, stage, groups * threads, 1, 1);
}

static bool dispatch_sweep(pass *p, lighting_stage stage) {
    return dispatch_groups(p, stage, WAYS * COLORS);
}

// In the first of the parts of a frame pass_prepare is called: all others read what it writes.
static bool record_lights(pass *p) {
    const lighting_state *s = p->state;
    if (!s->fire_count) return pass_prepare(p) && dispatch(p, STAGE_LIGHTS, s->declared, 1, 1);
    uint32_t blocks = s->glow_size / 2;
    return dispatch(p, STAGE_LIGHTS, s->declared, 1, 1) &&
           dispatch(p, STAGE_FIRE, FIRE_SLOTS * blocks, 8 * blocks, blocks) &&
           dispatch_groups(p, STAGE_GATHER, s->fire_count);
}

static bool record_medium(pass *p) {
    const lighting_state *s = p->state;
    uint32_t points = 2 * s->glow_size;
    return (!s->fire_count || pass_prepare(p)) && dispatch(p, STAGE_MEDIUM, points, points, points);
}

static bool record_shadow(pass *p) {
    const lighting_state *s = p->state;
    uint32_t n = s->shadow_size;
    return dispatch(p, STAGE_SHADOW, n, n, s->shadow_parts * s->declared);
}

// The greatest part of the light that is scattered (as in lighting/level.glsl).
static float most_scattered(const pass *p) {
    const float *albedo = pass_vector(p, N_albedo);
    float most = 0;
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
    float most = fmaxf(most_scattered(p), 0.1f), asked = pass_value(p, N_sweeps);
    return (uint32_t)fminf(asked, ceilf(logf(0.005f) / (2 * logf(0.5f * most))));
}

static_assert((int)LEVELS * BUFFERS <= PASS_BUFFERS, "the core keeps no more");

// Of the light from all sides, which may have no reader.
static size_t lighting_buffers(const pass *p, pass_buffer out[PASS_BUFFERS]) {
    lighting_state *s = p->state;
    const bool glows = graph_is_read(p->host->graph, *pass_image(p, N_glow));
    for (uint32_t level = 0; level < LEVELS; level++) {
        const uint64_t n = glows ? s->glow_size >> level : 0;
        for (int i = 0; i < BUFFERS; i++)
            *out++ = (pass_buffer){&s->buffers[level][i], names[buffers[i].name],
                                   n * n * n * buffers[i].bytes};
    }
    return LEVELS * BUFFERS;
}

// On the coarser level sweeps are hastened (lighting/level.glsl).
static bool correct(pass *p) {
    uint32_t sweeps = coarse_sweeps(p);
    for (uint32_t i = 0; i < sweeps; i++) {
        pass_set_int(p, N_hastened, (int32_t)i);
        if (!dispatch_sweep(p, STAGE_COARSE_SWEEP) || !dispatch_colors(p, STAGE_COARSE_REDUCE))
            return false;
    }
    return dispatch_colors(p, STAGE_PROLONG);
}

// After each sweep the coarser level finds what is left to do (lighting/level.glsl).
static bool record_glow(pass *p) {
    const lighting_state *s = p->state;
    uint32_t sweeps = fine_sweeps(p);
    if (!dispatch_voxels(p, STAGE_FIRST) ||
        !dispatch(p, STAGE_AROUND, WAYS * LOOKS / LOOK_PARTS * s->rays_apart, LOOK_PARTS, 1))
        return false;
    for (uint32_t i = 0; i < sweeps || i == 0; i++) {
        if (!dispatch_sweep(p, STAGE_SWEEP) || !dispatch_colors(p, STAGE_RESTRICT)) return false;
        pass_set_int(p, N_last_sweep, i + 1 >= sweeps);
        if (sweeps && !correct(p)) return false;
    }
    return true;
}

const pass_type lighting_type = {
    .name = "lighting",
    .shader = "pass/light/lighting.comp",
    PASS_KERNELS,
    .declare = lighting_declare,
    .defines = lighting_defines,
    .update = lighting_update,
    .buffers = lighting_buffers,
};
