// A solver of 2D flow: the defines of its shaders, and its state on the device.
#include "sim/flow.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/swap.h"
#include "base/words.h"
#include "sim/flow_impl.h"
#include <string.h>

// ---- structure --------------------------------------------------------------------------------

static bool check_faces(const flow_desc *desc) {
    static const char *const axes[2] = {"x", "y"};
    for (int i = 0; i < 2; i++) {
        bool around = desc->faces[2 * i] == FLOW_PERIODIC;
        uint32_t n = desc->size[i];
        if (around != (desc->faces[2 * i + 1] == FLOW_PERIODIC))
            return err_set("one face along %s is periodic and the other is not", axes[i]);
        if (around && (n & (n - 1)) != 0)
            return err_set("%u cells along %s, which is periodic; a power of two is needed", n,
                           axes[i]);
    }
    return true;
}

static bool flow_check(const flow_desc *desc) {
    for (int i = 0; i < 2; i++)
        if (desc->size[i] < FLOW_LEAST_SIZE || desc->size[i] > FLOW_MOST_SIZE)
            return err_set("a slice of %u x %u cells; %d to %d along each axis are accepted",
                           desc->size[0], desc->size[1], FLOW_LEAST_SIZE, FLOW_MOST_SIZE);
    if (desc->slices < 1 || desc->slices > FLOW_MAX_SLICES)
        return err_set("%u slices; 1 to %d are accepted", desc->slices, FLOW_MAX_SLICES);
    if (desc->sweeps > 2)
        return err_set("%u sweeps of multigrid; 1 and 2 are accepted", desc->sweeps);
    if (desc->solver == FLOW_TRANSFORM && desc->size[1] > FLOW_MOST_LINE)
        return err_set("a slice of %u cells along y; a transform solves at most %d", desc->size[1],
                       FLOW_MOST_LINE);
    return check_faces(desc);
}

flow *flow_create(arena *memory, const flow_desc *desc) {
    if (!flow_check(desc)) return NULL;
    flow *f = arena_alloc(memory, sizeof *f);
    *f = (flow){.memory = memory, .desc = *desc};
    f->chooses_iterations = desc->max_iterations == 0;
    f->chooses_sweeps = desc->sweeps == 0;
    f->chooses_solver = desc->solver == FLOW_AUTO;
    return f;
}

const flow_desc *flow_get_desc(const flow *f) {
    return &f->desc;
}

static uint64_t flow_cells(const flow *f) { // of all slices
    return (uint64_t)f->desc.size[0] * f->desc.size[1] * f->desc.slices;
}

// ---- shaders ----------------------------------------------------------------------------------

static void define(flow *f, const char *name, uint32_t value) {
    f->defines[f->define_count++] = (shader_define){name, arena_format(f->memory, "%u", value)};
}

static void define_all(flow *f) {
    static const char *const faces[4] = {"FLOW_FACE_LEFT", "FLOW_FACE_RIGHT", "FLOW_FACE_BOTTOM",
                                         "FLOW_FACE_TOP"};
    const flow_desc *desc = &f->desc;
    f->define_count = 0;
    define(f, "FLOW_NX", desc->size[0]);
    define(f, "FLOW_NY", desc->size[1]);
    define(f, "FLOW_SLICES", desc->slices);
    for (int i = 0; i < 4; i++) define(f, faces[i], desc->faces[i]);
    define(f, "FLOW_WITH_SOURCES", desc->sources);
    define(f, "FLOW_WITH_OBSTACLES", desc->obstacles);
    define(f, "FLOW_WITH_TEMPLATES", desc->templates);
    define(f, "FLOW_WITH_CORRECTION", desc->advection == FLOW_MACCORMACK);
    define(f, "FLOW_TILE", f->tile);
    define(f, "FLOW_SWEEPS", desc->sweeps);
    define(f, "FLOW_GROUP", f->group);
    define(f, "FLOW_FOLDS", flow_transform_folds(desc, f->tile));
    define(f, "FLOW_COARSE_SIDE", f->coarse_side);
    define(f, "FLOW_COARSE", f->coarse);
}

size_t flow_defines(const flow *f, shader_define out[FLOW_MAX_DEFINES]) {
    memcpy(out, f->defines, f->define_count * sizeof *out);
    return f->define_count;
}

static const char *const names[] = {FLOW_NAMES(KERNEL_NAME_TEXT)};

static const char *const shaders[FLOW_KERNELS] = {
    [FLOW_DIFFUSE] = "sim/flow/diffuse.comp",   [FLOW_PREDICT] = "sim/flow/predict.comp",
    [FLOW_ADVANCE] = "sim/flow/advance.comp",   [FLOW_LOOK_AT] = "sim/flow/look.comp",
    [FLOW_BUILD] = "sim/flow/build.comp",       [FLOW_FOLLOW] = "sim/flow/follow.comp",
    [FLOW_TURN] = "sim/flow/direction.comp",    [FLOW_PROJECT] = "sim/flow/project.comp",
    [FLOW_DOWN_FINEST] = "sim/flow/down.comp",  [FLOW_DOWN] = "sim/flow/down.comp",
    [FLOW_COARSEST] = "sim/flow/coarse.comp",   [FLOW_UP] = "sim/flow/up.comp",
    [FLOW_UP_FINEST] = "sim/flow/up.comp",      [FLOW_TO_MODES] = "sim/flow/transform.comp",
    [FLOW_SOLVE_LINES] = "sim/flow/lines.comp", [FLOW_FROM_MODES] = "sim/flow/transform.comp",
    [FLOW_REPORT] = "sim/flow/report.comp",     [FLOW_REPORT_LAST] = "sim/flow/report.comp",
};

const kernel_table flow_kernel_table = {{names, COUNT_OF(names)}, shaders, COUNT_OF(shaders)};

// Returns the additional define of a kernel; NULL: none.
static const char *define_of(flow_kernel which) {
    if (which == FLOW_DOWN_FINEST || which == FLOW_UP_FINEST) return "FLOW_FINEST";
    return which == FLOW_FROM_MODES ? "FLOW_BACK" : which == FLOW_REPORT_LAST ? "LAST" : NULL;
}

static bool is_used(const flow_desc *desc, flow_kernel which) {
    if (which == FLOW_PREDICT) return desc->advection == FLOW_MACCORMACK;
    if (which == FLOW_FOLLOW) return desc->solver != FLOW_MULTIGRID;
    if (which >= FLOW_DOWN_FINEST && which <= FLOW_UP_FINEST) return desc->solver == FLOW_MULTIGRID;
    return which < FLOW_TO_MODES || which > FLOW_FROM_MODES || desc->solver == FLOW_TRANSFORM;
}

static flow_solver choose_solver(const flow_desc *desc, const gpu_profile *device) {
    const bool suits = !desc->obstacles && !desc->templates && desc->size[1] <= FLOW_MOST_LINE &&
                       desc->size[0] <= device->flow_transform;
    return suits ? FLOW_TRANSFORM : FLOW_MULTIGRID;
}

static uint64_t tiles(const flow_desc *desc, uint32_t side) {
    return (uint64_t)((desc->size[0] + side - 1) / side) * ((desc->size[1] + side - 1) / side);
}

// What suits the device.
static void choose(flow *f, const gpu_profile *device) {
    const bool few = tiles(&f->desc, FLOW_LARGE_TILE) * f->desc.slices < FLOW_FEW_TILES;
    f->tile = few && device->flow_small_tiles ? FLOW_SMALL_TILE : FLOW_LARGE_TILE;
    f->group = device->flow_group;
    f->coarse_side = device->flow_coarse_side;
    f->coarse = device->flow_coarse;
    flow_levels_find(f);
    if (f->chooses_solver) f->desc.solver = choose_solver(&f->desc, device);
    if (f->chooses_sweeps) f->desc.sweeps = device->flow_sweeps;
    if (f->chooses_iterations) flow_choose_iterations(f);
}

bool flow_build(flow *f, gpu *g, shader_library *library, const shader_reader *reader) {
    choose(f, gpu_get_profile(g));
    define_all(f);
    for (int i = 0; i < FLOW_KERNELS; i++) {
        shader_define defines[FLOW_MAX_DEFINES + 1];
        size_t count = flow_defines(f, defines);
        if (!is_used(&f->desc, (flow_kernel)i)) continue;
        if (define_of((flow_kernel)i))
            defines[count++] = (shader_define){define_of((flow_kernel)i), ""};
        const shader_compile_desc shader = {
            .name = shaders[i], .defines = defines, .define_count = count, .reader = reader};
        if (!kernel_compile_compute(&f->kernels[i], library, f->memory, &shader,
                                    flow_kernel_table.names) ||
            (g && !kernel_build(&f->kernels[i], g)))
            return false;
    }
    return true;
}

// ---- state ------------------------------------------------------------------------------------

// Returns the bytes of each buffer; 0: it is not needed.
static void find_sizes(const flow *f, uint64_t out[FLOW_MEM_COUNT]) {
    const flow_desc *desc = &f->desc;
    const flow_level *last = &f->levels[f->level_count - 1];
    const uint64_t cells = flow_cells(f), row = (desc->size[0] + 4) / 4 * 4;
    const uint64_t corners = row * (desc->size[1] + 1) * desc->slices;
    const uint64_t end = (uint64_t)last->size[0] * last->size[1] * desc->slices;
    const bool multigrid = desc->solver == FLOW_MULTIGRID;
    uint64_t parts = tiles(desc, f->tile), builds = tiles(desc, FLOW_BUILD_TILE);
    if (builds > parts) parts = builds;
    memset(out, 0, FLOW_MEM_COUNT * sizeof *out);
    for (int i = FLOW_MEM_VELOCITY; i <= FLOW_MEM_VELOCITY_HAT; i++) out[i] = corners * 8;
    for (int i = 0; i < 2; i++) {
        out[FLOW_MEM_SCALARS + i] = cells * 16;
        out[FLOW_MEM_PRESSURE + i] = out[FLOW_MEM_RESIDUAL + i] = cells * 4;
        out[FLOW_MEM_DIRECTION + i] = cells * 8;
    }
    if (desc->advection == FLOW_MACCORMACK) {
        out[FLOW_MEM_SCALARS_HAT] = cells * 16;
        out[FLOW_MEM_TRACED] = corners * 16 + cells * 8;
    }
    if (desc->sources) out[FLOW_MEM_SOURCES] = cells * 48;
    if (desc->obstacles) out[FLOW_MEM_OBSTACLES] = cells * 16;
    if (desc->templates) out[FLOW_MEM_TEMPLATES] = cells * 8;
    out[FLOW_MEM_COEFFICIENTS] = last->coefficients_at * 8ull;
    out[FLOW_MEM_COARSE_RESIDUAL] = multigrid ? (last->r_at + end) * 4 : 0;
    out[FLOW_MEM_Z] = multigrid ? (last->z_at + end) * 4 : cells * 4;
    if (desc->solver == FLOW_TRANSFORM) out[FLOW_MEM_LINES] = cells * 4;
    if (multigrid && desc->sweeps > 1) out[FLOW_MEM_SWEPT] = out[FLOW_MEM_Z];
    out[FLOW_MEM_KNOWN] = desc->slices * FLOW_KNOWN_WORDS * 4ull;
    out[FLOW_MEM_REPORT] = desc->slices * tiles(desc, f->tile) * 32;
    out[FLOW_MEM_PARTS] = desc->slices * FLOW_PART_KINDS * parts * 16;
}

bool flow_allocate(flow *f, gpu *g) {
    uint64_t sizes[FLOW_MEM_COUNT];
    find_sizes(f, sizes);
    for (int i = 0; i < FLOW_MEM_COUNT; i++)
        if (!gpu_buffer_make(g, &f->buffers[i], "flow", sizes[i])) return false;
    return flow_transform_allocate(f, g) &&
           kernel_readback_make(&f->report, g, "flow's report", FLOW_REPORT_WORDS);
}

void flow_list_memory(const flow *f, budget_list *out) {
    uint64_t sizes[FLOW_MEM_COUNT];
    find_sizes(f, sizes);
    for (int i = 0; i < FLOW_MEM_COUNT; i++)
        if (!f->buffers[i]) budget_list_add(out, "flow", sizes[i]);
    if (f->desc.solver == FLOW_TRANSFORM && !f->modes)
        budget_list_add(out, "modes of a flow", flow_transform_bytes(f));
    for (int i = 0; i < 2 * FLOW_LOOKS; i++) {
        const gpu_image_desc desc = flow_describe_look(f, (flow_look)(i % FLOW_LOOKS));
        if (!f->looks[i / FLOW_LOOKS][i % FLOW_LOOKS])
            budget_list_add(out, desc.label, gpu_image_bytes(&desc));
    }
}

void flow_destroy(flow *f, gpu *g) {
    for (int i = 0; i < FLOW_KERNELS; i++) kernel_destroy(&f->kernels[i], g);
    for (int i = 0; i < FLOW_MEM_COUNT; i++) gpu_buffer_destroy(g, f->buffers[i]);
    for (int i = 0; i < 2 * FLOW_LOOKS; i++)
        gpu_image_destroy(g, f->looks[i / FLOW_LOOKS][i % FLOW_LOOKS]);
    kernel_readback_destroy(&f->report, g);
    gpu_buffer_destroy(g, f->modes);
    f->modes = NULL;
    memset(f->buffers, 0, sizeof f->buffers);
    memset(f->looks, 0, sizeof f->looks);
}

gpu_buffer *flow_pair(const flow *f, flow_memory pair, uint32_t which) {
    return f->buffers[pair + (f->current ^ which)];
}

// ---- what is bound ----------------------------------------------------------------------------

static void list_own(const flow *f, gpu_buffer *out[FLOW_OWN]) {
    static const flow_memory where[FLOW_OWN] = {
        [N_FlowVelocity] = FLOW_MEM_VELOCITY,
        [N_FlowSources] = FLOW_MEM_SOURCES,
        [N_FlowObstacles] = FLOW_MEM_OBSTACLES,
        [N_FlowTemplates] = FLOW_MEM_TEMPLATES,
        [N_FlowCoefficients] = FLOW_MEM_COEFFICIENTS,
        [N_FlowKnown] = FLOW_MEM_KNOWN,
        [N_FlowParts] = FLOW_MEM_PARTS,
        [N_FlowZ] = FLOW_MEM_Z,
        [N_FlowSwept] = FLOW_MEM_SWEPT,
        [N_FlowReport] = FLOW_MEM_REPORT,
        [N_FlowHatVelocity] = FLOW_MEM_VELOCITY_HAT,
        [N_FlowTraced] = FLOW_MEM_TRACED,
        [N_FlowHatScalars] = FLOW_MEM_SCALARS_HAT,
    };
    for (int i = 0; i < FLOW_OWN; i++) out[i] = f->buffers[where[i]];
    out[N_FlowScalars] = flow_pair(f, FLOW_MEM_SCALARS, 0);
    out[N_FlowPressure] = flow_pair(f, FLOW_MEM_PRESSURE, 0);
}

gpu_buffer *flow_find(const flow *f, const char *name) {
    gpu_buffer *own[FLOW_OWN];
    int index = words_find(names, FLOW_OWN, name);
    list_own(f, own);
    return index < 0 ? NULL : own[index];
}

void flow_bind(const flow *f, kernel *k, const kernel_place *places) {
    gpu_buffer *own[FLOW_OWN];
    list_own(f, own);
    for (int i = 0; i < FLOW_OWN; i++)
        if (own[i]) kernel_bind_at(k, &places[i], (gpu_binding){.buffer = own[i]});
}

kernel *flow_use(flow *f, flow_kernel which) {
    kernel *k = &f->kernels[which];
    flow_bind(f, k, k->places);
    return k;
}

bool flow_run_tiles(const flow *f, gpu *g, kernel *k, const uint32_t size[2]) {
    return kernel_run(k, g, (size[0] + f->tile - 1) / f->tile * k->binaries[0].local_size[0],
                      (size[1] + f->tile - 1) / f->tile, f->desc.slices);
}

size_t flow_buffers(const flow *f, gpu_buffer *out[FLOW_STATE_BUFFERS]) {
    out[0] = f->buffers[FLOW_MEM_VELOCITY];
    out[1] = flow_pair(f, FLOW_MEM_SCALARS, 0);
    out[2] = flow_pair(f, FLOW_MEM_PRESSURE, 0);
    return FLOW_STATE_BUFFERS;
}

uint64_t flow_steps(const flow *f) {
    return f->steps;
}

static void swap_state(flow *a, flow *b) {
    static const flow_memory state[] = {FLOW_MEM_VELOCITY, FLOW_MEM_SCALARS, FLOW_MEM_SCALARS + 1,
                                        FLOW_MEM_PRESSURE, FLOW_MEM_PRESSURE + 1};
    for (size_t i = 0; i < COUNT_OF(state); i++) SWAP(a->buffers[state[i]], b->buffers[state[i]]);
    SWAP(a->looks, b->looks);
    SWAP(a->current, b->current);
    SWAP(a->kept, b->kept);
    SWAP(a->steps, b->steps);
}

bool flow_exchange(flow *a, flow *b) {
    if (memcmp(a->desc.size, b->desc.size, sizeof a->desc.size) != 0 ||
        a->desc.slices != b->desc.slices)
        return false;
    swap_state(a, b);
    return true;
}
