// Rendering of an effect: it is built once for a size, then frames are rendered one after the
// other.
#include "base/budget.h"
#include "base/clock.h"
#include "base/error.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/worker.h"
#include "effect/effect_impl.h"
#include "scene/bvh.h"
#include "scene/sky_image.h"
#include <math.h>
#include <string.h>

// Outputs are known once the script has run; they decide which passes are needed.
static bool add_outputs(effect *e) {
    if (e->unseen) return true;
    if (!e->pictures[EFFECT_OUTPUT].id)
        return err_set("%s: the effect has no output; set `output` of the effect to an image",
                       e->facts.file);
    for (int i = 0; i < 3; i++)
        if (e->pictures[i].id) graph_add_output(e->graph, e->pictures[i]);
    return true;
}

static bool check_reference(const effect *e) {
    uint32_t samples;
    for (size_t i = 0; e->reference && i < e->pass_count; i++)
        if (pass_samples(e->passes[i], &samples)) return true;
    return !e->reference || err_set("%s: a reference is traced instead of passes `march`, and the "
                                    "effect has none",
                                    e->facts.file);
}

static bool draws_mesh(const pass *p, const scene_mesh *mesh) {
    scene_mesh *const *meshes;
    size_t count = pass_draws_meshes(p) ? pass_meshes(p, &meshes) : 0;
    for (size_t i = 0; i < count; i++)
        if (meshes[i] == mesh) return true;
    return false;
}

static bool draws_instances(const pass *p, const scene_instances *instances) {
    scene_instances *const *all;
    size_t count = pass_instances(p, &all);
    for (size_t i = 0; i < count; i++)
        if (all[i] == instances) return true;
    return false;
}

// Builds the trees for rays, over everything that a pass draws.
static bool make_bvh(effect *e) {
    if (e->host.bvh) return true;
    scene_mesh **meshes = mem_alloc(e->mesh_count * sizeof *meshes);
    scene_instances **instances = mem_alloc(e->instances_count * sizeof *instances);
    size_t mesh_count = 0, instances_count = 0;
    for (size_t i = 0; i < e->mesh_count; i++) {
        bool found = false;
        for (size_t k = 0; k < e->pass_count && !found; k++)
            found = draws_mesh(e->passes[k], e->meshes[i]);
        if (found) meshes[mesh_count++] = e->meshes[i];
    }
    for (size_t i = 0; i < e->instances_count; i++) {
        bool found = false;
        for (size_t k = 0; k < e->pass_count && !found; k++)
            found = draws_instances(e->passes[k], e->instances[i]);
        if (found) instances[instances_count++] = e->instances[i];
    }
    bool levels = false;
    for (size_t k = 0; k < e->pass_count; k++) levels = levels || pass_traces_levels(e->passes[k]);
    e->host.bvh = scene_bvh_create(meshes, mesh_count, instances, instances_count, levels);
    mem_free(meshes);
    mem_free(instances);
    return e->host.bvh != NULL;
}

// Returns whether a pass of the graph is the pass `label` or a part of it, "label.name".
static bool is_part(const char *name, const char *label) {
    size_t length = strlen(label);
    return strncmp(name, label, length) == 0 && (name[length] == '\0' || name[length] == '.');
}

bool effect_runs(const effect *e, const pass *p) {
    const char *names[GPU_MAX_PASSES];
    size_t count = graph_order(e->graph, names, COUNT_OF(names));
    for (size_t i = 0; i < count && i < COUNT_OF(names); i++)
        if (is_part(names[i], pass_label(p))) return true;
    return false;
}

// Passes that only draw unwanted pictures need no shaders.
static bool is_wanted(const effect *e, const pass *p) {
    return !e->unseen || effect_runs(e, p);
}

enum { ANY_SIZE = 64 }; // of a picture: finds what is wrong with a graph whatever its size

static bool check_one(void *user, size_t index) {
    return pass_build(((effect *)user)->passes[index]);
}

static bool build_one(void *user, size_t index) {
    effect *e = user;
    return !is_wanted(e, e->passes[index]) || pass_build(e->passes[index]);
}

// A reference that replaces a march also shows the surfaces behind it. Their uniforms come from the
// first pass that lights them.
static void tell_references(effect *e) {
    size_t lights = 0;
    while (lights < e->pass_count && !pass_is(e->passes[lights], "shade") &&
           !pass_is(e->passes[lights], "forward"))
        lights++;
    for (size_t i = 0; e->reference && lights < e->pass_count && i < e->pass_count; i++)
        if (pass_is(e->passes[i], "reference"))
            pass_add_uniforms_of(e->passes[i], e->passes[lights]);
}

static bool complete(effect *e) {
    tell_references(e);
    for (size_t i = 0; i < e->pass_count; i++)
        if (!pass_complete(e->passes[i])) return false;
    return true;
}

// Warns about particles that nothing draws, since nothing else tells their author.
static bool compile_graph(effect *e) {
    if (!graph_compile(e->graph, ANY_SIZE, ANY_SIZE)) return false;
    for (size_t i = 0; i < e->pass_count && !e->unseen; i++)
        if (pass_get_simulation(e->passes[i]) && !effect_runs(e, e->passes[i]))
            log_write(LOG_WARNING, "%s: nothing draws or reads '%s', so it is left out",
                      e->facts.file, pass_label(e->passes[i]));
    if (!e->unseen) effect_tell_hints(e);
    return true;
}

bool effect_check(effect *e) {
    gpu *device = e->host.device;
    if (e->compiled) return true;
    e->host.device = NULL; // nothing is built for it
    bool done = check_reference(e) && add_outputs(e) && complete(e) && make_bvh(e) &&
                worker_each(e->pass_count, check_one, e) && compile_graph(e);
    e->host.device = device;
    return done;
}

bool effect_compile(effect *e) {
    if (!check_reference(e) || !add_outputs(e) || !complete(e) || !make_bvh(e) ||
        !compile_graph(e) || !worker_each(e->pass_count, build_one, e))
        return false;
    e->width = e->height = ANY_SIZE;
    e->compiled = true;
    return true;
}

uint64_t effect_list_memory(const effect *e, budget_list *host, budget_list *device) {
    for (size_t i = 0; i < e->pass_count; i++)
        if (effect_runs(e, pass_runner(e->passes[i]))) pass_list_memory(e->passes[i], device);
    for (size_t i = 0; i < e->instances_count; i++)
        if (budget_list_first(device, e->instances[i]))
            scene_instances_list_memory(e->instances[i], device);
    scene_bvh_list_memory(e->host.bvh, device);
    if (e->sky) sky_image_list_memory(e->sky, device);
    for (size_t i = 0; i < e->grid_count; i++) {
        const field_grid *grid = e->grids[i];
        const field_needs needs = grid->needs ? grid->needs(grid) : (field_needs){0};
        budget_list_add(host, grid->name, needs.host);
        budget_list_add(device, grid->name, needs.device);
    }
    return graph_list_memory(e->graph, device);
}

static bool fits(effect *e) {
    budget *const host = budget_host();
    const bool shared = gpu_get_budget(e->device) == host;
    budget_list lists[2] = {0};
    const uint64_t freed = effect_list_memory(e, &lists[0], &lists[shared ? 0 : 1]);
    const bool fit = gpu_memory_fits(e->device, &lists[shared ? 0 : 1], freed) &&
                     (shared || budget_ask(host, lists[0].rows, lists[0].count, 0));
    for (int i = 0; i < 2; i++) budget_list_free(&lists[i]);
    return fit || err_prefix("%s: ", e->facts.file);
}

// The graph is compiled: what it culls needs no memory.
static bool allocate(effect *e) {
    if (!fits(e)) return false;
    for (size_t i = 0; i < e->pass_count; i++)
        if (effect_runs(e, pass_runner(e->passes[i])) && !pass_allocate(e->passes[i])) return false;
    for (size_t i = 0; i < e->instances_count; i++)
        if (!scene_instances_allocate(e->instances[i], e->device)) return false;
    return scene_bvh_allocate(e->host.bvh, e->device) &&
           (!e->sky || sky_image_upload(e->sky, e->device)) && graph_allocate(e->graph, e->device);
}

bool effect_allocate(effect *e, uint32_t width, uint32_t height) {
    if (!graph_compile(e->graph, width, height) || !allocate(e)) return false;
    effect_resize_systems(e, width, height);
    e->width = width;
    e->height = height;
    return true;
}

bool effect_build(effect *e, uint32_t width, uint32_t height) {
    return (e->compiled || effect_compile(e)) && effect_allocate(e, width, height);
}

static bool update(effect *e, double frame) {
    double dt = isnan(e->updated) ? 0 : (frame - e->updated) / e->facts.fps;
    if (frame < e->updated && !e->systems) effect_reset_instances(e); // these do so themselves
    e->updated = frame;
    return effect_run_systems(e, frame) &&
           (!e->hooks.update || e->hooks.update(e->hooks.user, e->context.time, dt));
}

// Runs `update` for skipped frames, since it may set speeds of grids.
static bool run_clocks(effect *e, double frame) {
    double next;
    while (effect_aim_clocks(e, frame, &next) && next + 1 <= frame) {
        if (e->hooks.renew) e->hooks.renew(e->hooks.user);
        e->context.time = (next - e->facts.first) / e->facts.fps;
        if (!update(e, next) || !effect_tick(e)) return false;
    }
    return effect_aim_clocks(e, frame, &next);
}

// The frame itself.
static bool tick(effect *e, double frame) {
    double next;
    return effect_aim_clocks(e, frame, &next) && (isinf(next) || effect_tick(e));
}

static bool update_grids(effect *e, gpu *device) {
    for (size_t i = 0; i < e->grid_count; i++) {
        field_grid *grid = e->grids[i];
        double time;
        if (grid->update && (!effect_grid_time(e, grid, e->context.time, &time) ||
                             !grid->update(grid, device, time)))
            return false;
    }
    return true;
}

// Without a device grids only know their bounds.
bool effect_evaluate(effect *e, double frame, gpu *device, bool again) {
    double time = (frame - e->facts.first) / e->facts.fps;
    double dt = e->counter ? (frame - e->last_moment) / e->facts.fps : 0;
    if (!again && !run_clocks(e, frame)) return false;
    e->context.time = time;
    if (device && e->hooks.renew) e->hooks.renew(e->hooks.user);
    if (!again && (!update(e, frame) || !tick(e, frame))) return false;
    if (!effect_fill_frame(e, &e->frame) || !effect_fill_lights(e, &e->lights)) return false;
    e->clip = e->frame.last;
    if (e->has_last) e->frame.last = e->last_clip;
    for (int i = 0; i < 2; i++) {
        e->jitter[i] = e->frame.shift.v[2 + i];
        e->frame.shift.v[2 + i] -= e->has_last ? e->last_jitter[i] : e->jitter[i];
    }
    e->frame.time = (shared_vec4){{(float)time, (float)dt, (float)frame, 0}};
    e->frame.size = (shared_uvec4){{e->width, e->height, (uint32_t)llrint(frame), e->seed}};
    effect_move_sight(e, frame);
    if (!update_grids(e, device)) return false;
    for (size_t i = 0; device && i < e->instances_count; i++)
        if (!scene_instances_upload(e->instances[i], device)) return false;
    return true;
}

uint32_t effect_samples(const effect *e) {
    uint32_t least = 0, samples;
    for (size_t i = 0; i < e->pass_count; i++)
        if (pass_samples(e->passes[i], &samples) && effect_runs(e, e->passes[i]))
            least = least && least < samples ? least : samples;
    return least;
}

bool effect_rehearse(effect *e, double frame) {
    if (!effect_evaluate(e, frame, NULL, false)) return false;
    for (size_t i = 0; i < e->pass_count; i++) {
        if (!effect_runs(e, e->passes[i]) || pass_rehearse(e->passes[i])) continue;
        return err_prefix("pass '%s': ", pass_label(e->passes[i]));
    }
    return true;
}

static void forget(effect *e) { // the frames before
    graph_reset_history(e->graph);
    e->has_last = false;
}

// Draws a moment of a frame. Of several moments each goes on where the one before it was.
static uint64_t draw(effect *e, double moment) {
    bool again;
    if (!effect_simulate(e, moment, &again)) return 0;
    uint64_t number = gpu_frame_begin(e->device);
    if (!number) return 0;
    e->host.fresh = !e->has_last;
    bool done = (!e->given.begin || e->given.begin(e->given.user)) &&
                effect_evaluate(e, moment, e->device, again) &&
                scene_bvh_update(e->host.bvh, e->device, &e->context) &&
                (e->only_simulates ? graph_execute_simulation(e->graph, e->device)
                                   : graph_execute(e->graph, e->device));
    if (e->given.end && !e->given.end(e->given.user, done)) done = false;
    effect_give_depth(e, NULL);
    if (!gpu_frame_end(e->device)) done = false;
    if (!done) { // what it may have left in a history is of no frame
        forget(e);
        return 0;
    }
    e->has_last = true;
    e->last_clip = e->clip;
    memcpy(e->last_jitter, e->jitter, sizeof e->jitter);
    e->last_moment = moment;
    return number;
}

uint64_t effect_render(effect *e, double frame, bool jump) {
    if (e->counter && !jump && frame != e->last_frame + 1) forget(e);
    if (e->never_waits && !e->stepped && !e->behind) effect_keep_snapshot(e, e->last_frame);
    const bool follows = e->has_last;
    const uint32_t moments = e->only_simulates ? 1 : effect_moments(e);
    uint64_t number = 0;
    for (e->moment = 0; e->moment < moments; e->moment++) {
        if (e->moment > 0) effect_add_times(e, number);
        number = draw(e, effect_moment(e, frame));
        if (!number) return 0;
    }
    e->counter++;
    e->in_a_row = follows ? e->in_a_row + 1 : 0;
    e->last_frame = frame;
    e->rendered_at = clock_seconds();
    return number;
}

void effect_only_simulate(effect *e) {
    e->only_simulates = true;
}

uint32_t effect_frames_before(const effect *e) {
    return graph_has_history(e->graph) ? e->in_a_row : 0;
}

// ---- taking over from another effect ----------------------------------------------------------

static bool exchange_grid(effect *e, size_t i, effect *from, size_t k) {
    field_grid *grid = e->grids[i], *other = from->grids[k];
    return grid->exchange && grid->exchange == other->exchange && grid->exchange(grid, other);
}

static bool exchange_mesh(effect *e, size_t i, effect *from, size_t k) {
    return scene_mesh_exchange(e->meshes[i], from->meshes[k]);
}

static bool exchange_simulation(effect *e, size_t i, effect *from, size_t k) {
    const pass_simulation *kind = pass_get_simulation(e->passes[i]);
    return kind && kind->exchange && pass_get_simulation(from->passes[k]) == kind &&
           kind->exchange(e->passes[i], from->passes[k]);
}

// Exchanges each of `count` with the first of the other effect that matches and was not taken, so
// that a second call undoes it.
static void exchange_each(effect *e, size_t count, effect *from, size_t others,
                          bool (*run)(effect *e, size_t i, effect *from, size_t k)) {
    bool *taken = mem_alloc(others * sizeof *taken);
    for (size_t i = 0; i < count; i++) {
        bool done = false;
        for (size_t k = 0; k < others && !done; k++)
            if (!taken[k]) done = taken[k] = run(e, i, from, k);
    }
    mem_free(taken);
}

static void exchange(effect *e, effect *from) {
    graph_adopt(e->graph, from->graph);
    exchange_each(e, e->grid_count, from, from->grid_count, exchange_grid);
    exchange_each(e, e->pass_count, from, from->pass_count, exchange_simulation);
    exchange_each(e, e->mesh_count, from, from->mesh_count, exchange_mesh);
    if (e->sky && from->sky) sky_image_exchange(e->sky, from->sky);
}

bool effect_adopt(effect *e, effect *from, uint32_t width, uint32_t height) {
    if (!graph_compile(e->graph, width, height)) return false;
    exchange(e, from);
    graph_lend(from->graph, e->device); // what is left to the old effect goes with it
    bool allocated = allocate(e);
    gpu_lend_memory(e->device, NULL, 0);
    if (!allocated) {
        exchange(e, from);
        return false;
    }
    effect_resize_systems(e, width, height);
    e->width = width;
    e->height = height;
    e->counter = from->counter;
    e->last_frame = from->last_frame;
    e->last_moment = from->last_moment;
    e->in_a_row = from->in_a_row;
    e->updated = from->updated;
    e->has_last = from->has_last;
    e->last_clip = from->last_clip;
    memcpy(e->last_jitter, from->last_jitter, sizeof e->last_jitter);
    return true;
}
