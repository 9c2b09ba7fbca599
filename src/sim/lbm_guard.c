// A thread checks every stride-th cell, its group adds up the results of its threads, and one more
// group those of the groups: two dispatches that read each moment once, 16 bytes per cell. The
// order is fixed, and therefore the sums are. The record is copied as an image, a row of words, to
// one of as many places as frames can be in flight.
#include "sim/lbm_guard.h"
#include "base/memory.h"
#include "kernel/kernel.h"
#include <string.h>

#define NAMES(NAME)                                                                                \
    NAME(Moments), NAME(Parts), NAME(Notes), NAME(result), NAME(count), NAME(stride),              \
        NAME(spoilt_speed), NAME(spoilt_drift)
enum { NAMES(KERNEL_NAME_ID) };
static const char *const names[] = {NAMES(KERNEL_NAME_TEXT)};
static const char *const shader[] = {"sim/lbm/guard.comp"};
const kernel_table lbm_guard_kernel_table = {{names, COUNT_OF(names)}, shader, 1};

enum {
    GROUP = 256,        // threads, as in the shader
    GROUPS = 512,       // most of the first dispatch: enough to fill a large device
    CELLS_A_THREAD = 4, // least, while there are fewer groups
    RECORD = 80,        // bytes of one, as the shader lays it out
    NOTES = 17,         // words of the one that is read, before the notes
    WORDS = NOTES + LBM_NOTES,
    PLACES = GPU_FRAMES_IN_FLIGHT + 1,
};

typedef struct guard_place {
    uint64_t frame, step; // frame 0: nothing was recorded
} guard_place;

struct lbm_guard {
    uint32_t size[3], groups;
    arena *memory;
    kernel kernels[2]; // moments, records
    gpu_buffer *parts, *found, *notes;
    gpu_image *result;
    guard_place places[PLACES];
    uint32_t next;
};

static uint32_t count_cells(const lbm_guard *guard) {
    return guard->size[0] * guard->size[1] * guard->size[2];
}

lbm_guard *lbm_guard_create(arena *memory, const uint32_t size[3]) {
    lbm_guard *guard = arena_alloc(memory, sizeof *guard);
    *guard = (lbm_guard){.memory = memory};
    memcpy(guard->size, size, sizeof guard->size);
    uint32_t groups = (count_cells(guard) + GROUP * CELLS_A_THREAD - 1) / (GROUP * CELLS_A_THREAD);
    guard->groups = groups < GROUPS ? groups : GROUPS;
    return guard;
}

bool lbm_guard_compile(lbm_guard *guard, shader_library *library, const shader_reader *reader) {
    static const shader_define last = {"LAST", ""};
    for (size_t i = 0; i < 2; i++) {
        const kernel_source source = {
            .label = shader[0],
            .stages = {{.name = shader[0],
                        .stage = SHADER_COMPUTE,
                        .defines = &last,
                        .define_count = i,
                        .reader = reader}},
            .stage_count = 1,
            .names = lbm_guard_kernel_table.names,
        };
        if (!kernel_compile(&guard->kernels[i], library, guard->memory, &source)) return false;
    }
    return true;
}

bool lbm_guard_allocate(lbm_guard *guard, gpu *g) {
    if (guard->result) return true;
    for (int i = 0; i < 2; i++)
        if (!kernel_build(&guard->kernels[i], g)) return false;
    guard->parts = gpu_buffer_create(
        g, &(gpu_buffer_desc){.label = "guard", .size = (uint64_t)guard->groups * RECORD});
    guard->found = gpu_buffer_create(g, &(gpu_buffer_desc){.label = "guard's report",
                                                           .size = PLACES * WORDS * 4,
                                                           .kind = GPU_BUFFER_READBACK});
    guard->result = gpu_image_create(g, &(gpu_image_desc){.label = "guard",
                                                          .format = GPU_R32U,
                                                          .width = WORDS,
                                                          .height = 1,
                                                          .use = GPU_USE_STORAGE});
    const uint32_t none[LBM_NOTES] = {0};
    guard->notes =
        gpu_buffer_create(g, &(gpu_buffer_desc){.label = "guard's notes", .size = sizeof none});
    return guard->parts && guard->found && guard->result && guard->notes &&
           gpu_buffer_write(g, guard->notes, 0, none, sizeof none);
}

void lbm_guard_destroy(lbm_guard *guard, gpu *g) {
    for (int i = 0; i < 2; i++) kernel_destroy(&guard->kernels[i], g);
    gpu_buffer_destroy(g, guard->parts);
    gpu_buffer_destroy(g, guard->found);
    gpu_buffer_destroy(g, guard->notes);
    gpu_image_destroy(g, guard->result);
    guard->parts = guard->found = guard->notes = NULL;
    guard->result = NULL;
    lbm_guard_forget(guard);
}

static bool guard_dispatch(lbm_guard *guard, gpu *g, int which, gpu_buffer *moments) {
    kernel *k = &guard->kernels[which];
    const uint32_t groups = which == 0 ? guard->groups : 1, stride = groups * GROUP;
    kernel_bind_buffer(k, N_Moments, moments);
    kernel_bind_buffer(k, N_Parts, guard->parts);
    kernel_bind_buffer(k, N_Notes, guard->notes);
    kernel_bind_image(k, N_result, guard->result);
    kernel_set_int(k, N_count, (int32_t)(which == 0 ? count_cells(guard) : guard->groups));
    kernel_set_int(k, N_stride, (int32_t)stride);
    return kernel_run(k, g, stride, 1, 1);
}

bool lbm_guard_record(lbm_guard *guard, gpu *g, const lbm *l, lbm_guard_limits limits) {
    gpu_buffer *moments = lbm_moments(l, 0);
    if (!moments) return true;
    uint32_t place = guard->next;
    kernel_set_float(&guard->kernels[1], N_spoilt_speed, limits.speed);
    kernel_set_float(&guard->kernels[1], N_spoilt_drift, limits.drift);
    if (!guard_dispatch(guard, g, 0, moments) || !guard_dispatch(guard, g, 1, moments) ||
        !gpu_image_copy_to_buffer(g, guard->result, guard->found, place * WORDS * 4))
        return false;
    guard->places[place] = (guard_place){gpu_frame_open(g), lbm_steps(l)};
    guard->next = (place + 1) % PLACES;
    return true;
}

static void guard_unpack(const lbm_guard *guard, const uint32_t words[WORDS], lbm_report *out) {
    float values[WORDS];
    memcpy(values, words, sizeof values);
    uint32_t cell = words[3], columns = guard->size[0], good = words[0] - words[1];
    *out = (lbm_report){.cells = words[0], .bad = words[1], .spoilt = words[16]};
    memcpy(out->notes, words + NOTES, sizeof out->notes);
    if (good == 0) return;
    out->speed = values[2];
    out->where[0] = cell % columns;
    out->where[1] = cell / columns % guard->size[1];
    out->where[2] = cell / columns / guard->size[1];
    out->drift = values[4] / (float)good;
    out->least_density = values[8];
    out->most_density = values[12];
    for (int i = 0; i < LBM_MAX_SCALARS; i++) {
        out->sum[i] = values[5 + i];
        out->least[i] = values[9 + i];
        out->most[i] = values[13 + i];
    }
}

bool lbm_guard_read(lbm_guard *guard, gpu *g, lbm_report *out) {
    for (uint32_t age = 1; age <= PLACES; age++) {
        uint32_t place = (guard->next + PLACES - age) % PLACES;
        const guard_place *at = &guard->places[place];
        if (at->frame == 0 || !gpu_frame_done(g, at->frame)) continue;
        guard_unpack(guard, (const uint32_t *)gpu_buffer_map(guard->found) + place * WORDS, out);
        out->step = at->step;
        return true;
    }
    return false;
}

gpu_buffer *lbm_guard_newest(const lbm_guard *guard) {
    return guard->places[(guard->next + PLACES - 1) % PLACES].frame ? guard->parts : NULL;
}

gpu_buffer *lbm_guard_notes(const lbm_guard *guard) {
    return guard->notes;
}

void lbm_guard_forget(lbm_guard *guard) {
    memset(guard->places, 0, sizeof guard->places);
}
