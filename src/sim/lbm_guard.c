// A thread checks every stride-th cell, its group adds up the results of its threads, and one more
// group those of the groups: two dispatches that read each moment once, 16 bytes per cell. The
// order is fixed, and therefore the sums are.
#include "sim/lbm_guard.h"
#include "base/memory.h"
#include "kernel/kernel.h"
#include "kernel/readback.h"
#include <string.h>

#define NAMES(NAME)                                                                                \
    NAME(Moments), NAME(Parts), NAME(Notes), NAME(result), NAME(count), NAME(stride),              \
        NAME(spoilt_speed), NAME(spoilt_drift)
KERNEL_NAMES(NAMES);
static const char *const shader[] = {"sim/lbm/guard.comp"};
const kernel_table lbm_guard_kernel_table = {{names, COUNT_OF(names)}, shader, 1};

enum {
    GROUP = 256,        // threads, as in the shader
    GROUPS = 512,       // most of the first dispatch: enough to fill a large device
    CELLS_A_THREAD = 4, // least, while there are fewer groups
    RECORD = 80,        // bytes of one, as the shader lays it out
    NOTES = 17,         // words of the one that is read, before the notes
    WORDS = NOTES + LBM_NOTES,
};

struct lbm_guard {
    uint32_t size[3], groups;
    arena *memory;
    kernel kernels[2]; // moments, records
    gpu_buffer *parts, *notes;
    kernel_readback report;
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
        const shader_compile_desc desc = {
            .name = shader[0], .defines = &last, .define_count = i, .reader = reader};
        if (!kernel_compile_compute(&guard->kernels[i], library, guard->memory, &desc,
                                    lbm_guard_kernel_table.names))
            return false;
    }
    return true;
}

bool lbm_guard_allocate(lbm_guard *guard, gpu *g) {
    if (guard->report.image) return true;
    for (int i = 0; i < 2; i++)
        if (!kernel_build(&guard->kernels[i], g)) return false;
    const uint32_t none[LBM_NOTES] = {0};
    return gpu_buffer_make(g, &guard->parts, "guard", (uint64_t)guard->groups * RECORD) &&
           gpu_buffer_make(g, &guard->notes, "guard's notes", sizeof none) &&
           kernel_readback_make(&guard->report, g, "guard's report", WORDS) &&
           gpu_buffer_write(g, guard->notes, 0, none, sizeof none);
}

void lbm_guard_destroy(lbm_guard *guard, gpu *g) {
    for (int i = 0; i < 2; i++) kernel_destroy(&guard->kernels[i], g);
    gpu_buffer_destroy(g, guard->parts);
    gpu_buffer_destroy(g, guard->notes);
    kernel_readback_destroy(&guard->report, g);
    guard->parts = guard->notes = NULL;
}

static bool guard_dispatch(lbm_guard *guard, gpu *g, int which, gpu_buffer *moments) {
    kernel *k = &guard->kernels[which];
    const uint32_t groups = which == 0 ? guard->groups : 1, stride = groups * GROUP;
    kernel_bind_buffer(k, N_Moments, moments);
    kernel_bind_buffer(k, N_Parts, guard->parts);
    kernel_bind_buffer(k, N_Notes, guard->notes);
    kernel_bind_image(k, N_result, guard->report.image);
    kernel_set_int(k, N_count, (int32_t)(which == 0 ? count_cells(guard) : guard->groups));
    kernel_set_int(k, N_stride, (int32_t)stride);
    return kernel_run(k, g, stride, 1, 1);
}

bool lbm_guard_record(lbm_guard *guard, gpu *g, const lbm *l, lbm_guard_limits limits) {
    gpu_buffer *moments = lbm_moments(l, 0);
    if (!moments) return true;
    kernel_set_float(&guard->kernels[1], N_spoilt_speed, limits.speed);
    kernel_set_float(&guard->kernels[1], N_spoilt_drift, limits.drift);
    return guard_dispatch(guard, g, 0, moments) && guard_dispatch(guard, g, 1, moments) &&
           kernel_readback_send(&guard->report, g, lbm_steps(l));
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
    uint64_t step;
    const uint32_t *words = kernel_readback_newest(&guard->report, g, &step);
    if (!words) return false;
    guard_unpack(guard, words, out);
    out->step = step;
    return true;
}

gpu_buffer *lbm_guard_newest(const lbm_guard *guard) {
    return kernel_readback_sent(&guard->report) ? guard->parts : NULL;
}

gpu_buffer *lbm_guard_notes(const lbm_guard *guard) {
    return guard->notes;
}

void lbm_guard_forget(lbm_guard *guard) {
    kernel_readback_forget(&guard->report);
}
