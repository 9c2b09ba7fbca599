// The state: velocities, scalars and pressure as they are in memory, the images of the last two
// kept states, and a clock.
#include "sim/flow_state.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/str.h"
#include "sim/flow_impl.h"

typedef struct state_clock { // as it lies in the file
    uint64_t steps, kept;
} state_clock;

static const char *const buffer_names[FLOW_STATE_BUFFERS] = {"velocity", "scalars", "pressure"};
static const char *const look_names[2][FLOW_LOOKS] = {{"scalars0", "velocity0"},
                                                      {"scalars1", "velocity1"}};

static void flow_describe(const flow_desc *desc, const char *more, strbuf *out) {
    static const char *const faces[] = {"left", "right", "bottom", "top"};
    static const char *const kinds[] = {"closed", "open", "periodic"};
    strbuf_add(out, "size = %u x %u\n", desc->size[0], desc->size[1]);
    strbuf_add(out, "slices = %u\n", desc->slices);
    for (int i = 0; i < 4; i++) strbuf_add(out, "%s = %s\n", faces[i], kinds[desc->faces[i]]);
    strbuf_add(out, "%s", more);
}

static const char *name(arena *memory, const char *label, const char *part) {
    return arena_format(memory, "%s/%s", label, part);
}

static size_t list_buffers(const flow *f, arena *memory, const char *label,
                           checkpoint_part out[FLOW_STATE_BUFFERS]) {
    gpu_buffer *buffers[FLOW_STATE_BUFFERS];
    size_t count = flow_buffers(f, buffers);
    for (size_t i = 0; i < count; i++)
        out[i] = (checkpoint_part){.name = name(memory, label, buffer_names[i]),
                                   .size = gpu_buffer_size(buffers[i]),
                                   .width = 4,
                                   .buffer = buffers[i]};
    return count;
}

static size_t look_size(const flow *f, flow_look look) {
    return (size_t)flow_cells(f) * (look == FLOW_SCALARS ? 8 : 4);
}

static bool list_looks(const flow *f, gpu *g, const char *label, checkpoint_list *out) {
    for (uint32_t which = 0; which < 2 && which < f->kept; which++)
        for (flow_look look = 0; look < FLOW_LOOKS; look++) {
            size_t size = look_size(f, look);
            void *bytes = arena_alloc(&out->memory, size);
            if (!gpu_image_read(g, f->looks[which][look], bytes, size)) return false;
            checkpoint_add(
                out, &(checkpoint_part){.name = name(&out->memory, label, look_names[which][look]),
                                        .size = size,
                                        .width = 2,
                                        .bytes = bytes});
        }
    return true;
}

bool flow_state_list(const flow *f, gpu *g, const char *label, const char *more,
                     checkpoint_list *out) {
    arena *memory = &out->memory;
    strbuf text = {0};
    flow_describe(&f->desc, more, &text);
    state_clock *clock = arena_alloc(memory, sizeof *clock);
    *clock = (state_clock){f->steps, f->kept};
    checkpoint_add(out, &(checkpoint_part){.name = name(memory, label, "flow"),
                                           .size = text.length,
                                           .width = 1,
                                           .bytes = arena_string(memory, strbuf_text(&text))});
    checkpoint_add(out, &(checkpoint_part){.name = name(memory, label, "clock"),
                                           .size = sizeof *clock,
                                           .width = 8,
                                           .bytes = clock});
    strbuf_free(&text);
    checkpoint_part buffers[FLOW_STATE_BUFFERS];
    size_t count = list_buffers(f, memory, label, buffers);
    for (size_t i = 0; i < count; i++) checkpoint_add(out, &buffers[i]);
    return list_looks(f, g, label, out);
}

// ---- loading ----------------------------------------------------------------------------------

static bool flow_clear(flow *f, gpu *g) {
    if (!gpu_frame_begin(g)) return false;
    bool done = flow_reset(f, g);
    return gpu_frame_end(g) && done;
}

static bool load_look(flow *f, gpu *g, uint32_t which, flow_look look, arena *memory,
                      const char *label, checkpoint *c) {
    size_t size = look_size(f, look);
    void *bytes = mem_alloc(size);
    const checkpoint_part part = {.name = name(memory, label, look_names[which][look]),
                                  .size = size,
                                  .width = 2,
                                  .bytes = bytes};
    bool done = flow_make_look(f, g, which, look) && checkpoint_load(c, g, &part) &&
                gpu_image_write(g, f->looks[which][look], 0, bytes, size);
    mem_free(bytes);
    return done;
}

static bool flow_load(flow *f, gpu *g, arena *memory, const char *label, checkpoint *c) {
    state_clock clock;
    const checkpoint_part own = {
        .name = name(memory, label, "clock"), .size = sizeof clock, .bytes = &clock};
    checkpoint_part buffers[FLOW_STATE_BUFFERS];
    if (!checkpoint_load(c, NULL, &own)) return false;
    if (clock.steps > UINT64_C(1) << 60 || clock.kept > clock.steps + 1)
        return err_set("the checkpoint's clock is damaged");
    if (!flow_clear(f, g)) return false;
    size_t count = list_buffers(f, memory, label, buffers);
    for (size_t i = 0; i < count; i++)
        if (!checkpoint_load(c, g, &buffers[i])) return false;
    for (uint32_t which = 0; which < 2 && which < clock.kept; which++)
        for (flow_look look = 0; look < FLOW_LOOKS; look++)
            if (!load_look(f, g, which, look, memory, label, c)) return false;
    f->steps = clock.steps;
    f->kept = clock.kept;
    return true;
}

bool flow_state_load(flow *f, gpu *g, const char *label, const char *more, checkpoint *c) {
    arena memory = {0};
    strbuf text = {0};
    flow_describe(&f->desc, more, &text);
    bool done = checkpoint_require(c, name(&memory, label, "flow"), strbuf_text(&text)) &&
                flow_load(f, g, &memory, label, c);
    strbuf_free(&text);
    arena_free(&memory);
    return done;
}
