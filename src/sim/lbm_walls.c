// Boundaries of a solver on the host: defines of its shaders, the kinds of cells, the waves that
// open faces store, and the motions of bodies.
//
// The kinds of cells are computed again (cells.comp) only when bodies have moved to other cells:
// into one of two buffers, so that a comparison with the other finds the cells that a body has
// left.
#include "base/error.h"
#include "base/memory.h"
#include "base/swap.h"
#include "sim/lbm_impl.h"
#include <string.h>

static const char shader[] = "sim/lbm/cells.comp";

static bool has_rims(const lbm_desc *desc) {
    for (int i = 0; i < 6; i++)
        if (desc->faces[i] >= LBM_SLIP) return true;
    return false;
}

void lbm_walls_define(lbm *l, void (*define)(lbm *l, const char *name, uint32_t value)) {
    static const char *const names[6] = {"LBM_FACE_0", "LBM_FACE_1", "LBM_FACE_2",
                                         "LBM_FACE_3", "LBM_FACE_4", "LBM_FACE_5"};
    bool walled = l->desc.bodies;
    for (int i = 0; i < 6; i++) {
        define(l, names[i], l->desc.faces[i]);
        walled = walled || l->desc.faces[i] != LBM_PERIODIC;
    }
    define(l, "LBM_WALLED", walled);
    define(l, "LBM_RIMS", has_rims(&l->desc));
    define(l, "LBM_BODIES", l->desc.bodies);
}

bool lbm_walls_compile(lbm *l, shader_library *library, const shader_reader *reader) {
    return !l->desc.bodies ||
           lbm_kernel_compile(l, &l->walls.kernel, shader, library, reader, NULL, 0);
}

bool lbm_walls_build(lbm *l, gpu *g) {
    return !l->desc.bodies || kernel_build(&l->walls.kernel.base, g);
}

static uint64_t waves_bytes(const lbm *l) { // as lbm_wave_at of walls.glsl counts them
    const uint64_t nx = l->desc.size[0], ny = l->desc.size[1];
    return 16 * (2 * (nx + ny) * l->layout.layers + 2 * nx * ny);
}

static uint64_t cells_bytes(const lbm *l) {
    return (uint64_t)l->layout.elements * 4;
}

static const char waves_label[] = "waves at open faces", cells_label[] = "kinds of cells";

bool lbm_walls_allocate(lbm *l, gpu *g) {
    lbm_walls *w = &l->walls;
    for (int i = 0; l->desc.bodies && i < 2; i++)
        if (!gpu_buffer_make(g, &w->cells[i], cells_label, cells_bytes(l))) return false;
    return !has_rims(&l->desc) || gpu_buffer_make(g, &w->waves, waves_label, waves_bytes(l));
}

void lbm_walls_list_memory(const lbm *l, budget_list *out) {
    const lbm_walls *w = &l->walls;
    if (has_rims(&l->desc) && !w->waves) budget_list_add(out, waves_label, waves_bytes(l));
    for (int i = 0; l->desc.bodies && i < 2; i++)
        if (!w->cells[i]) budget_list_add(out, cells_label, cells_bytes(l));
}

void lbm_walls_destroy(lbm *l, gpu *g) {
    kernel_destroy(&l->walls.kernel.base, g);
    gpu_buffer_destroy(g, l->walls.waves);
    gpu_buffer_destroy(g, l->walls.bodies);
    for (int i = 0; i < 2; i++) gpu_buffer_destroy(g, l->walls.cells[i]);
    l->walls.waves = l->walls.bodies = l->walls.cells[0] = l->walls.cells[1] = NULL;
    mem_free(l->walls.motions);
    l->walls.motions = NULL;
    l->walls.motion_count = l->walls.motion_capacity = 0;
}

void lbm_walls_reset(lbm *l, gpu *g) {
    lbm_walls *w = &l->walls;
    if (w->waves) gpu_buffer_fill(g, w->waves, 0);
    for (int i = 0; i < 2; i++)
        if (w->cells[i]) gpu_buffer_fill(g, w->cells[i], 0);
    w->known = false;
    w->filled = true;
}

// The positions of bodies must be set again afterwards.
void lbm_walls_exchange(lbm *a, lbm *b) {
    lbm_walls *x = &a->walls, *y = &b->walls;
    x->known = y->known = false;
    SWAP(x->waves, y->waves);
    if (!a->desc.bodies || !b->desc.bodies) return;
    SWAP(x->cells, y->cells);
    SWAP(x->current, y->current);
    SWAP(x->filled, y->filled);
}

void lbm_walls_list(const lbm *l, gpu_buffer *out[LBM_OWN]) {
    const lbm_walls *w = &l->walls;
    out[N_LbmWaves] = w->waves;
    out[N_LbmIds] = w->ids;
    out[N_LbmBodies] = w->bodies;
    out[N_LbmCells] = w->cells[w->current];
    out[N_LbmCellsBefore] = w->cells[!w->current];
}

void lbm_walls_set(const lbm *l, lbm_kernel *k, const lbm_numbers *n) {
    float velocity[6][4] = {0}, scalar[6][4] = {0};
    for (int i = 0; i < 6; i++) {
        memcpy(velocity[i], n->inflow[i], sizeof n->inflow[i]);
        memcpy(scalar[i], n->inflow_scalar[i], sizeof n->inflow_scalar[i]);
    }
    kernel_set(&k->base, N_lbm_face_velocity, velocity, sizeof velocity);
    kernel_set(&k->base, N_lbm_face_scalar, scalar, sizeof scalar);
    const uint32_t moved = l->walls.updated == l->steps;
    kernel_set(&k->base, N_lbm_moved, &moved, sizeof moved);
    const float most = n->max_speed > 0 ? n->max_speed : 1e6f;
    kernel_set(&k->base, N_lbm_body_speed, &most, sizeof most);
}

bool lbm_walls_ready(const lbm *l) {
    return !l->desc.bodies || l->walls.known ||
           err_set("the lattice has bodies whose cells were never set");
}

static lbm_motion motion_of(const lbm_body *body) {
    static const float still[3] = {0};
    lbm_motion out = {.moves = memcmp(body->linear, still, sizeof still) != 0 ||
                               memcmp(body->angular, still, sizeof still) != 0};
    memcpy(out.centre, body->centre, sizeof body->centre);
    memcpy(out.linear, body->linear, sizeof body->linear);
    memcpy(out.angular, body->angular, sizeof body->angular);
    return out;
}

// Sets `moves` if any body moves, and `changed` if the device has other motions.
static void note_motions(lbm_walls *w, const lbm_bodies *bodies, bool *moves, bool *changed) {
    const size_t count = (size_t)bodies->count + 1, known = w->motion_count;
    MEM_RESERVE(w->motions, count, w->motion_capacity);
    w->motions[0] = (lbm_motion){0};
    w->motion_count = count;
    *changed = known != count;
    *moves = false;
    for (size_t id = 1; id < count; id++) {
        const lbm_motion now = motion_of(&bodies->bodies[id - 1]);
        *moves = *moves || now.moves != 0;
        if (id < known && memcmp(&w->motions[id], &now, sizeof now) == 0) continue;
        w->motions[id] = now;
        *changed = true;
    }
}

static bool write_motions(lbm_walls *w, gpu *g) {
    const uint64_t size = w->motion_count * sizeof *w->motions;
    const bool fits = w->bodies && gpu_buffer_size(w->bodies) >= size;
    const bool done = (fits || gpu_buffer_make(g, &w->bodies, "motions of bodies", size)) &&
                      gpu_buffer_write(g, w->bodies, 0, w->motions, size);
    if (!done) w->motion_count = 0; // they are not there
    return done;
}

bool lbm_set_bodies(lbm *l, gpu *g, const lbm_numbers *numbers, const lbm_bodies *bodies) {
    lbm_walls *w = &l->walls;
    bool any, others;
    if (!l->desc.bodies) return err_set("the lattice was made without bodies");
    note_motions(w, bodies, &any, &others);
    if (others && !write_motions(w, g)) return false;
    const uint32_t moves = any;
    bool same = w->known && w->ids == bodies->ids && !bodies->changed && w->moves == moves;
    same = same || (w->restored && !bodies->changed);
    w->known = w->known || same;
    w->moves = moves;
    w->restored = false;
    w->ids = bodies->ids;
    if (same) return true;
    for (int i = 0; !w->filled && i < 2; i++) gpu_buffer_fill(g, w->cells[i], 0);
    w->filled = true;
    w->updated = l->steps;
    w->current = !w->current;
    kernel_set(&w->kernel.base, N_any_moves, &moves, sizeof moves);
    kernel_set(&w->kernel.base, N_ambient, numbers->ambient, sizeof numbers->ambient);
    lbm_walls_set(l, &w->kernel, numbers);
    w->known = true;
    for (uint32_t stage = 0; stage < 3 && w->known; stage++) { // see cells.comp
        kernel_set(&w->kernel.base, N_stage, &stage, sizeof stage);
        w->known = lbm_kernel_run(l, &w->kernel, g);
    }
    return w->known;
}
