// Meshes in simulated air: those of sources and those that it flows around, each as cells.
#include "base/memory.h"
#include "pass/air/air_parts.h"
#include <math.h>
#include <string.h>

air_meshes *air_add_giver(air *a) {
    air_meshes *m = MEM_ADD(a->givers, a->giver_count, a->giver_capacity);
    *m = (air_meshes){.updated = (double)NAN};
    return m;
}

void air_add_body(air_meshes *m, const scene_mesh *mesh, voxels_rule rule) {
    *MEM_ADD(m->bodies, m->count, m->capacity) = (voxels_body){mesh, rule};
}

void pass_air_add_collider(pass *p, scene_mesh *mesh, voxels_rule rule) {
    air_add_body(&air_of(p)->solids, mesh, rule);
}

static bool bodies_make(air *a, air_meshes *m) {
    voxels_desc desc = {.box = a->grid.box, .bodies = m->bodies, .body_count = m->count};
    memcpy(desc.size, a->desc.size, sizeof desc.size);
    if (m->count) m->cells = voxels_create(a->pass->host->memory, &desc);
    return !m->count || m->cells;
}

static bool bodies_build(air *a, air_meshes *m) {
    const pass_host *host = a->pass->host;
    return !m->cells || voxels_build(m->cells, host->device, host->library, host->reader);
}

static bool bodies_allocate(air *a, air_meshes *m) {
    return !m->cells || voxels_allocate(m->cells, a->pass->host->device);
}

// Steps from one placing of bodies to the next: one that is as fast as the flow is expected to be
// goes half a cell meanwhile. Its motion pushes the air in all of them.
static const double farthest = 0.5;

static uint64_t stride(const air *a) {
    return (uint64_t)fmax(1, floor(farthest / sim_velocity(&a->units, a->desc.speed)));
}

static bool is_inside(const air *a, const air_meshes *m, const field_context *context) {
    box3 box;
    for (size_t i = 0; i < m->count; i++)
        if (!air_mesh_box(a, m->bodies[i].mesh, context, &box) ||
            !box3_is_empty(box3_intersect(box, a->grid.box)))
            return true;
    return false;
}

// As before a step: moved on from where they were placed last, or put there.
static bool place(air *a, air_meshes *m, uint64_t step, voxels_change *change) {
    const pass_host *host = a->pass->host;
    field_context then = *host->context;
    then.time = air_step_time(a, step);
    double passed = isnan(m->updated) ? 0 : (then.time - m->updated) * a->desc.time_scale;
    m->updated = then.time;
    m->met = m->met || is_inside(a, m, &then);
    return voxels_update(m->cells, host->device, &then, passed, change);
}

// Those of a state that was taken over go on from where they were placed before.
static bool move(air *a, air_meshes *m, voxels_change *change) {
    const uint64_t step = a->kind->steps(a), each = stride(a), last = step - step % each;
    *change = (voxels_change){false, false};
    if (!m->cells) return true;
    bool known = !isnan(m->updated), done = true;
    if (!known && last >= each) done = place(a, m, last - each, change);
    if (!known || step == last) done = done && place(a, m, last, change);
    if (step > last) *change = (voxels_change){false, false};
    return done;
}

static void bodies_destroy(air *a, air_meshes *m) {
    if (m->cells) voxels_destroy(m->cells, a->pass->host->device);
    mem_free(m->bodies);
}

static bool for_each(air *a, bool (*work)(air *a, air_meshes *m)) {
    for (size_t i = 0; i < a->giver_count; i++)
        if (!work(a, &a->givers[i])) return false;
    return work(a, &a->solids);
}

bool air_make_bodies(air *a) {
    return for_each(a, bodies_make);
}

bool air_build_bodies(air *a) {
    return for_each(a, bodies_build);
}

bool air_allocate_bodies(air *a) {
    return for_each(a, bodies_allocate);
}

void air_list_bodies(const air *a, budget_list *out) {
    const field_context *context = a->pass->host->context;
    for (size_t i = 0; i < a->giver_count; i++)
        if (a->givers[i].cells) voxels_list_memory(a->givers[i].cells, context, false, out);
    if (a->solids.cells) voxels_list_memory(a->solids.cells, context, false, out);
}

bool air_move_bodies(air *a) {
    voxels_change change;
    for (size_t i = 0; i < a->giver_count; i++)
        if (!move(a, &a->givers[i], &change)) return false;
    if (!move(a, &a->solids, &change)) return false;
    return !a->solids.cells || a->kind->move_solids(a, change.cells);
}

void air_destroy_bodies(air *a) {
    for (size_t i = 0; i < a->giver_count; i++) bodies_destroy(a, &a->givers[i]);
    mem_free(a->givers);
    bodies_destroy(a, &a->solids);
}
