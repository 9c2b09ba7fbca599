// Particles of an effect that shows nothing else, for tests: their state read back. Frame f is at f
// / 60 s, and a step is as long.
#pragma once
#include "effect_test.h"
#include "pass/particles/particles_parts.h"

enum { RATE_OF_FRAMES = 60 };

typedef struct swarm {
    effect *e;
    pass *pass;
    uint32_t used;              // slots
    float (*at)[4], (*move)[4]; // position and age, velocity and lifetime
} swarm;

static inline swarm swarm_open_as(const effect_desc *desc, uint32_t count, double step) {
    swarm s = {.e = open_effect(desc)};
    gpu_test_ok(effect_set_timeline(s.e, RATE_OF_FRAMES, 100000, 0));
    s.pass = add(s.e, "particles", NULL);
    gpu_test_ok(pass_particles_open(
        s.pass, &(pass_particles_desc){.count = count,
                                       .time_step = step > 0 ? step : 1.0 / RATE_OF_FRAMES}));
    return s;
}

static inline swarm swarm_open(gpu *device, uint32_t count, double step) {
    return swarm_open_as(&(effect_desc){.device = device}, count, step);
}

static inline void swarm_set(const swarm *s, const char *name, float value) {
    gpu_test_ok(pass_set_uniform(s->pass, name, number(s->e, value)));
}

static inline void swarm_set3(const swarm *s, const char *name, float x, float y, float z) {
    gpu_test_ok(pass_set_uniform(s->pass, name, triple(s->e, x, y, z)));
}

static inline void swarm_live(const swarm *s, float shortest, float longest) {
    swarm_set(s, "lifetime_min", shortest);
    swarm_set(s, "lifetime_max", longest);
}

static inline void swarm_field(const swarm *s, const char *name, const field *value) {
    gpu_test_ok(pass_set_field(s->pass, name, value));
}

static inline void swarm_declare(const swarm *s) {
    gpu_test_ok(pass_declare(s->pass));
    gpu_test_ok(effect_set_picture(s->e, EFFECT_OUTPUT, pass_output(s->pass, "particles")));
    gpu_test_ok(effect_check_settings(s->e));
}

static inline void swarm_build(const swarm *s) {
    swarm_declare(s);
    gpu_test_ok(effect_build(s->e, 16, 16));
}

static inline float (*swarm_buffer(const swarm *s, gpu_buffer *buffer))[4] {
    size_t size = (size_t)s->used * 4 * sizeof(float);
    float(*out)[4] = mem_alloc(size + 1);
    gpu_test_ok(gpu_buffer_read(effect_pass_host(s->e)->device, buffer, 0, out, size));
    return out;
}

static inline void swarm_forget(swarm *s) {
    mem_free(s->at);
    mem_free(s->move);
    s->at = s->move = NULL;
}

// Draws the frame and reads the state.
static inline void swarm_run(swarm *s, double frame) {
    swarm_forget(s);
    gpu_test_ok(effect_render(s->e, frame, true));
    s->used = pass_particles_used(s->pass);
    const particles_buffers *buffers = &particles_of(s->pass)->buffers;
    s->at = swarm_buffer(s, buffers->positions[0]);
    s->move = swarm_buffer(s, buffers->velocities[0]);
}

static inline bool swarm_lives(const swarm *s, uint32_t i) {
    return s->at[i][3] >= 0 && s->at[i][3] < s->move[i][3];
}

static inline void swarm_close(swarm *s) {
    swarm_forget(s);
    effect_destroy(s->e);
}

static inline void is_near(double value, double wanted, double slack, const char *what) {
    if (!(fabs(value - wanted) <= slack))
        fail_msg("%s: %.9g is not %.9g within %g", what, value, wanted, slack);
}
