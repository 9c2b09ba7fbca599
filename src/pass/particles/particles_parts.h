// The inside of the pass type `particles`, for its own files only.
#pragma once
#include "kernel/readback.h"
#include "pass/particles/particles.h"
#include "pass/pass_impl.h"

// ---- particles_birth.c: whose turn it is to be born; knows numbers only ------------------------

typedef struct particles_rates { // of a step
    double begin, step;          // s
    double rate;                 // 1/s
    double burst;                // how many at once
    double burst_time, burst_period;
} particles_rates;

typedef struct particles_births { // of a step, in the order of their numbers
    uint64_t first;               // number of the first
    uint32_t burst, steady;       // how many at once, then one after the other
    double burst_rest;            // seconds of the step that are left to the burst,
    double steady_rest;           // to the first of the others,
    double every;                 // to each after it less by this
} particles_births;

typedef struct particles_clock { // as it lies in a checkpoint
    uint64_t steps, born;
    double owed; // of a birth, in [0, 1)
} particles_clock;

// The births of the next step, at most `most`: of more the first are left out, as the last would
// push them out. `clock` goes on by the step.
particles_births particles_next(particles_clock *clock, const particles_rates *rates,
                                uint32_t most);

// ---- particles_mesh.c: places on a surface -----------------------------------------------------

typedef struct particles_triangle { // as BirthTriangles has it
    float corner[3], chance;
    float first[3];
    uint32_t other;
    float second[3], unused;
} particles_triangle;

// Triangles that have an area, so that a random one is each as often as its area says: one of them
// evenly, then it with `chance`, else its `other`. Returns the count, 0 with a message; `out` has
// room for all.
uint32_t particles_list_triangles(const mesh_data *mesh, particles_triangle *out);

// ---- the pass ---------------------------------------------------------------------------------

enum { PARTICLES_PARTS = 2 }; // pairs of buffers

typedef struct particles_buffers {
    gpu_buffer *positions[PARTICLES_PARTS], *velocities[PARTICLES_PARTS], *quantities;
} particles_buffers;

typedef struct particles_lost { // births without a place; zero: there is no shape
    kernel_readback count;
    uint64_t births; // of the record
} particles_lost;

typedef struct particles_at { // births at instances; zero: anywhere
    float *sums;              // of the shares up to each
    float (*shares)[4];       // the last ones, in the first components
    uint32_t count;
    double total;
    bool written; // to the buffer
    gpu_buffer *buffer;
} particles_at;

typedef struct particles_state {
    pass *pass;
    pass_particles_desc desc;
    bool carried, carries; // they go as `velocity` says; a quantity goes with them
    particles_buffers buffers;
    gpu_buffer *triangles; // of the mesh; NULL: none, or not yet
    uint32_t triangle_count;
    particles_clock clock;
    bool fresh;              // begins anew with the next record
    particles_births births; // of the step being recorded
    box3 box;                // around the shape then
    mat4 places[2];          // of the mesh, at the begin and the end of it
    particles_lost lost;
    particles_at at;
    uint64_t last_steps; // that the last record took
    char trouble[256];   // "": none
} particles_state;

enum { PARTICLES_MOVE, PARTICLES_BIRTH, PARTICLES_KERNELS }; // birth before a step that has some

#define PARTICLES_NAMES(NAME)                                                                      \
    NAME(rate), NAME(burst), NAME(burst_time), NAME(burst_period), NAME(lifetime_min),             \
        NAME(lifetime_max), NAME(gravity), NAME(drag), NAME(drag_square), NAME(outward),           \
        NAME(seed), NAME(motion), NAME(shape), NAME(force), NAME(speed), NAME(quantity),           \
        NAME(depth), NAME(normal), NAME(particles), NAME(lost), NAME(time_step),                   \
        NAME(birth_first), NAME(birth_count), NAME(birth_burst), NAME(birth_burst_rest),           \
        NAME(birth_first_rest), NAME(birth_every), NAME(birth_group), NAME(birth_instances),       \
        NAME(mesh_triangles), NAME(mesh_from), NAME(mesh_to), NAME(BirthTriangles),                \
        NAME(BirthShares), NAME(Instances)
enum { PARTICLES_NAMES(KERNEL_NAME_ID) };
extern const pass_type particles_type;

static inline particles_state *particles_of(const pass *p) {
    return p->state;
}
double particles_reached(const particles_state *s); // seconds

// particles_time.c
extern const pass_simulation particles_simulation;
bool particles_rates_of(const pass *p, particles_rates *out); // as of the host's time
bool particles_find_places(const pass *p); // where the shape and the mesh are then
bool particles_advance(pass *p);           // to the host's time, as far as one submit goes

// particles_lost.c
bool particles_make_lost(pass *p, particles_state *s);
bool particles_begin_lost(pass *p, particles_state *s); // around the steps of a record
bool particles_end_lost(pass *p, particles_state *s);
double particles_lost_share(const pass *p); // of the births of a frame some frames ago

// particles_at.c; all do nothing where there are no instances
bool particles_open_at(pass *p, particles_state *s);
bool particles_make_at(pass *p, particles_state *s);
bool particles_sum_shares(const pass *p); // as of the host's time
bool particles_write_shares(const pass *p);
bool particles_set_at(pass *p);

// particles_state.c
void particles_save(const pass *p, struct checkpoint_list *out);
bool particles_load(pass *p, struct checkpoint *from);
bool particles_exchange(pass *p, pass *other);
