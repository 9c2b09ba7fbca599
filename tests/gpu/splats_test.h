// Particles at places that a test says, drawn by the pass `splats` in a small world (pass_test.h).
// The picture is SIDE pixels wide and high; at the middle of it, 5 m away, a metre is METRE pixels.
#pragma once
#include "pass/particles/particles_parts.h"
#include "pass_test.h"

enum { SIDE = 64, METRE = 32, MOST_SPOTS = 512 };

typedef struct spot {
    float at[3], age, moves[3], lifetime;
} spot;

typedef struct spots {
    pass_world w;
    pass *particles, *splats;
    uint32_t count;
} spots;

// The splats are to be given what they are like, and declared, by the test.
static inline void spots_open(spots *s, gpu *device, uint32_t count) {
    world_open(&s->w, device);
    s->count = count;
    s->w.context.time = 1; // a step's end: what is kept is what is seen
    s->w.scene.camera.fov = number(&s->w, 2 * atanf(0.5f * SIDE / METRE / 5) * 57.29578f);
    s->particles = world_add(&s->w, "particles", NULL, "particles");
    gpu_test_ok(pass_set_uniform(s->particles, "burst", number(&s->w, (float)count)));
    gpu_test_ok(
        pass_particles_open(s->particles, &(pass_particles_desc){.count = count, .time_step = 1}));
    gpu_test_ok(pass_declare(s->particles));
    s->splats = world_add(&s->w, "splats", NULL, "splats");
    pass_add_source(s->splats, s->particles);
}

static inline void spots_set(spots *s, const char *name, float value) {
    gpu_test_ok(pass_set_uniform(s->splats, name, number(&s->w, value)));
}

static inline void spots_field(spots *s, const char *name, const field *value) {
    gpu_test_ok(pass_set_field(s->splats, name, value));
}

static inline void spots_blend(spots *s, const char *word) {
    gpu_test_ok(pass_set_option(s->splats, "blend", word));
}

// Depth of a wall across the view.
static inline void spots_wall(spots *s, float away) {
    pass *wall = world_add(&s->w, NULL, "wall.comp", "wall");
    gpu_test_ok(pass_set_uniform(wall, "distance_to", number(&s->w, away)) && pass_declare(wall));
    gpu_test_ok(pass_set_image(s->splats, "depth", pass_output(wall, "depth")));
}

static inline void spots_build(spots *s) {
    gpu_test_ok(pass_declare(s->splats));
    world_render(&s->w, SIDE, SIDE, pass_output(s->splats, "image"));
    s->w.host.hold = true; // from here on they are where the test says
}

static inline void spots_write(const spots *s, gpu_buffer *buffer, const void *data) {
    gpu_test_ok(gpu_buffer_write(s->w.host.device, buffer, 0, data, 16ull * s->count));
}

// RGBA of an image of the next frame; free with mem_free. A lifetime of 0 is one of 10 s, of which
// 5 have passed.
static inline float *spots_draw_other(spots *s, const spot *list, graph_image image) {
    static float at[MOST_SPOTS][4], moves[MOST_SPOTS][4];
    for (uint32_t i = 0; i < s->count; i++) {
        memcpy(at[i], list[i].at, sizeof list[i].at);
        memcpy(moves[i], list[i].moves, sizeof list[i].moves);
        at[i][3] = list[i].lifetime > 0 ? list[i].age : 5;
        moves[i][3] = list[i].lifetime > 0 ? list[i].lifetime : 10;
    }
    const particles_buffers *buffers = &particles_of(s->particles)->buffers;
    spots_write(s, buffers->positions[0], at);
    spots_write(s, buffers->velocities[0], moves);
    world_frame(&s->w, SIDE, SIDE, 2);
    return world_read(&s->w, image);
}

static inline float *spots_draw(spots *s, const spot *list) {
    return spots_draw_other(s, list, pass_output(s->splats, "image"));
}

static inline void spots_close(spots *s) {
    world_close(&s->w);
}

static inline double sum_of(const float *pixels, int channel) {
    double sum = 0;
    for (int i = 0; i < SIDE * SIDE; i++) sum += (double)pixels[4 * i + channel];
    return sum;
}

static inline const float *pixel_at(const float *pixels, int x, int y) {
    return pixels + 4 * (y * SIDE + x);
}

static inline void is_near(double value, double wanted, double slack, const char *what) {
    if (!(fabs(value - wanted) <= slack))
        fail_msg("%s: %.9g is not %.9g within %g", what, value, wanted, slack);
}
