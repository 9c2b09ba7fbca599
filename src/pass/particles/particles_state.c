// Particles in a checkpoint and in a reload: the arrays as they lie, as far as they are used, and
// the clock.
#include "base/error.h"
#include "base/str.h"
#include "base/swap.h"
#include "pass/particles/particles_parts.h"
#include "sim/checkpoint.h"

enum { PARTS = 2 * PARTICLES_PARTS + 1 };

static void describe(const particles_state *s, strbuf *out) {
    strbuf_add(out, "count = %u\n", s->desc.count);
    strbuf_add(out, "time_step = %.9g\n", s->desc.time_step);
    strbuf_add(out, "warm_up = %.9g\n", s->desc.warm_up);
    strbuf_add(out, "quantity = %s\n", s->carries ? "yes" : "no");
}

static const char *name(arena *memory, const particles_state *s, const char *part) {
    return arena_format(memory, "%s/%s", s->pass->label, part);
}

static size_t list_buffers(const particles_state *s, arena *memory, checkpoint_part out[PARTS]) {
    static const char *const places[] = {"positions0", "positions1"};
    static const char *const moves[] = {"velocities0", "velocities1"};
    uint64_t used = pass_particles_used(s->pass), left = used;
    size_t count = 0;
    for (int i = 0; i < PARTICLES_PARTS && left > 0; i++) {
        uint64_t here = left < PASS_PARTICLES_EACH ? left : PASS_PARTICLES_EACH;
        out[count++] = (checkpoint_part){
            .name = places[i], .size = 16 * here, .buffer = s->buffers.positions[i]};
        out[count++] = (checkpoint_part){
            .name = moves[i], .size = 16 * here, .buffer = s->buffers.velocities[i]};
        left -= here;
    }
    if (s->carries && used)
        out[count++] = (checkpoint_part){
            .name = "quantities", .size = 4 * used, .buffer = s->buffers.quantities};
    for (size_t i = 0; i < count; i++) {
        out[i].name = name(memory, s, out[i].name);
        out[i].width = 4;
    }
    return count;
}

void particles_save(const pass *p, checkpoint_list *out) {
    const particles_state *s = particles_of(p);
    strbuf text = {0};
    checkpoint_part buffers[PARTS];
    describe(s, &text);
    checkpoint_add_text(out, p->label, "shape", strbuf_text(&text));
    checkpoint_add_clock(out, p->label, &s->clock, sizeof s->clock);
    size_t count = list_buffers(s, &out->memory, buffers);
    for (size_t i = 0; i < count; i++) checkpoint_add(out, &buffers[i]);
    strbuf_free(&text);
}

static bool take_clock(particles_state *s, const particles_clock *clock) {
    const uint64_t most = UINT64_C(1) << 60;
    if (clock->steps > most || clock->born > most || !(clock->owed >= 0 && clock->owed < 1))
        return err_set("the checkpoint's clock is damaged");
    s->clock = *clock;
    s->fresh = false;
    return true;
}

bool particles_load(pass *p, checkpoint *from) {
    particles_state *s = particles_of(p);
    arena memory = {0};
    strbuf text = {0};
    particles_clock clock;
    checkpoint_part buffers[PARTS];
    describe(s, &text);
    bool done = checkpoint_require(from, name(&memory, s, "shape"), strbuf_text(&text)) &&
                checkpoint_load_clock(from, p->label, &clock, sizeof clock) &&
                take_clock(s, &clock);
    size_t count = done ? list_buffers(s, &memory, buffers) : 0;
    for (size_t i = 0; done && i < count; i++)
        done = checkpoint_load(from, p->host->device, &buffers[i]);
    strbuf_free(&text);
    arena_free(&memory);
    s->fresh = !done;
    return done;
}

bool particles_exchange(pass *p, pass *other) {
    particles_state *a = particles_of(p), *b = particles_of(other);
    if (a->desc.count != b->desc.count || a->desc.time_step != b->desc.time_step ||
        a->desc.warm_up != b->desc.warm_up || a->carries != b->carries)
        return false;
    SWAP(a->buffers, b->buffers);
    SWAP(a->clock, b->clock);
    SWAP(a->fresh, b->fresh);
    return true;
}
