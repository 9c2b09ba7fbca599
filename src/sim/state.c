#include "sim/state.h"
#include "base/error.h"
#include "base/memory.h"
#include <string.h>

typedef struct state_clock { // as it lies in the file
    uint64_t steps, kept;
} state_clock;

static const char *name(arena *memory, const char *label, const char *part) {
    return arena_format(memory, "%s/%s", label, part);
}

static checkpoint_part buffer_part(const sim_state *s, size_t i, arena *memory, const char *label) {
    return (checkpoint_part){.name = name(memory, label, s->buffer_names[i]),
                             .size = gpu_buffer_size(s->buffers[i]),
                             .width = 4,
                             .buffer = s->buffers[i]};
}

static checkpoint_part image_part(const sim_state *s, size_t which, size_t i, arena *memory,
                                  const char *label, void *bytes) {
    return (checkpoint_part){
        .name = arena_format(memory, "%s/%s%d", label, s->image_names[i], (int)which),
        .size = gpu_image_bytes(&s->image_descs[i]),
        .width = 2,
        .bytes = bytes};
}

static bool list_images(const sim_state *s, gpu *g, const char *label, checkpoint_list *out) {
    for (size_t which = 0; which < 2 && which < *s->kept; which++)
        for (size_t i = 0; i < s->image_count; i++) {
            const size_t size = gpu_image_bytes(&s->image_descs[i]);
            void *bytes = arena_alloc(&out->memory, size);
            const checkpoint_part part = image_part(s, which, i, &out->memory, label, bytes);
            if (!gpu_image_read(g, *s->images[which][i], bytes, size)) return false;
            checkpoint_add(out, &part);
        }
    return true;
}

static char *describe(const sim_state_kind *kind, const void *solver, const char *more,
                      arena *memory) {
    strbuf lines = {0};
    kind->describe(solver, &lines);
    strbuf_add(&lines, "%s", more);
    char *text = arena_string(memory, strbuf_text(&lines));
    strbuf_free(&lines);
    return text;
}

bool sim_state_list(const sim_state_kind *kind, void *solver, gpu *g, const char *label,
                    const char *more, checkpoint_list *out) {
    arena *memory = &out->memory;
    sim_state s = {0};
    kind->find(solver, &s);
    const state_clock clock = {*s.steps, *s.kept};
    checkpoint_add_text(out, label, kind->name, describe(kind, solver, more, memory));
    checkpoint_add_clock(out, label, &clock, sizeof clock);
    for (size_t i = 0; i < s.buffer_count; i++) {
        const checkpoint_part part = buffer_part(&s, i, memory, label);
        checkpoint_add(out, &part);
    }
    return list_images(&s, g, label, out);
}

// ---- loading ----------------------------------------------------------------------------------

static bool state_clear(const sim_state_kind *kind, void *solver, gpu *g) {
    if (!gpu_frame_begin(g)) return false;
    bool done = kind->reset(solver, g);
    return gpu_frame_end(g) && done;
}

static bool load_image(const sim_state *s, gpu *g, size_t which, size_t i, arena *memory,
                       const char *label, checkpoint *c) {
    const size_t size = gpu_image_bytes(&s->image_descs[i]);
    gpu_image **image = s->images[which][i];
    void *bytes = mem_alloc(size);
    const checkpoint_part part = image_part(s, which, i, memory, label, bytes);
    if (!*image) *image = gpu_image_create(g, &s->image_descs[i]);
    bool done =
        *image && checkpoint_load(c, g, &part) && gpu_image_write(g, *image, 0, bytes, size);
    mem_free(bytes);
    return done;
}

static bool load_parts(const sim_state *s, const state_clock *clock, gpu *g, arena *memory,
                       const char *label, checkpoint *c) {
    for (size_t i = 0; i < s->buffer_count; i++) {
        const checkpoint_part part = buffer_part(s, i, memory, label);
        if (!checkpoint_load(c, g, &part)) return false;
    }
    for (size_t which = 0; which < 2 && which < clock->kept; which++)
        for (size_t i = 0; i < s->image_count; i++)
            if (!load_image(s, g, which, i, memory, label, c)) return false;
    *s->steps = clock->steps;
    *s->kept = clock->kept;
    return true;
}

static bool state_load(const sim_state_kind *kind, void *solver, gpu *g, arena *memory,
                       const char *label, checkpoint *c) {
    state_clock clock;
    sim_state s = {0};
    if (!checkpoint_load_clock(c, label, &clock, sizeof clock)) return false;
    if (clock.steps > UINT64_C(1) << 60 || clock.kept > clock.steps + 1)
        return err_set("the checkpoint's clock is damaged");
    if (!state_clear(kind, solver, g)) return false;
    kind->find(solver, &s);
    return load_parts(&s, &clock, g, memory, label, c);
}

bool sim_state_load(const sim_state_kind *kind, void *solver, gpu *g, const char *label,
                    const char *more, checkpoint *c) {
    arena memory = {0};
    bool done = checkpoint_require(c, name(&memory, label, kind->name),
                                   describe(kind, solver, more, &memory)) &&
                state_load(kind, solver, g, &memory, label, c);
    arena_free(&memory);
    return done;
}
