// libroil: effects, from loading to frames and what is known of them.
#include "base/error.h"
#include "base/memory.h"
#include "base/words.h"
#include "effect/events.h"
#include "roil.h"
#include "roil/roil_impl.h"
#include "script/script.h"
#include "shader/shader.h"
#include <string.h>

roil_effect *roil_load(roil *r, const char *file, const roil_setting *settings, size_t count) {
    return roil_load_inside(r, NULL, file, settings, count);
}

effect_desc roil_effect_desc(const roil *r, const roil_origin *origin, const roil_assets *assets,
                             const effect_setting *settings, size_t count) {
    return (effect_desc){
        .device = r->device,
        .file = origin->file,
        .inside = origin->inside,
        .bundle = origin->bundle,
        .assets = assets->folders,
        .asset_count = assets->count,
        .project = assets->project,
        .shader_root = r->shaders,
        .cache_dir = r->cache,
        .counters = r->counters,
        .interaction = r->interaction,
        .reference = r->reference,
        .never_waits = r->never_waits,
        .seconds = r->seconds,
        .settings = settings,
        .setting_count = count,
    };
}

static roil_effect *load(roil *r, const char *folder, const char *file,
                         const roil_setting *settings, size_t count) {
    roil_origin origin;
    if (!roil_find_origin(folder, file, &origin)) return NULL;
    effect_setting *own = mem_alloc(count * sizeof *own);
    for (size_t i = 0; i < count; i++)
        own[i] = (effect_setting){.name = settings[i].name, .text = settings[i].value};
    roil_effect *e = mem_alloc(sizeof *e);
    e->owner = r;
    roil_assets assets;
    if (roil_find_assets(r, &origin, &assets)) {
        effect_desc desc = roil_effect_desc(r, &origin, &assets, own, count);
        e->effect = effect_create(&desc);
    }
    arena_free(&assets.memory);
    mem_free(own);
    time_limit time = roil_time_limit(r), *before = time_limit_enter(&time);
    bool done = e->effect && script_load(e->effect, r->scripts) && effect_check_settings(e->effect);
    time_limit_leave(before);
    if (done) return e;
    roil_unload(e);
    return NULL;
}

roil_effect *roil_load_inside(roil *r, const char *folder, const char *file,
                              const roil_setting *settings, size_t count) {
    RETURN_MADE(roil_effect, load(r, folder, file, settings, count), roil_unload(made));
}

size_t roil_files(const roil_effect *e, const char **out, size_t capacity) {
    const char *const *files;
    size_t count = effect_files(e->effect, &files);
    for (size_t i = 0; i < count && i < capacity; i++) out[i] = files[i];
    return count;
}

void roil_unload(roil_effect *e) {
    if (!e) return;
    effect_destroy(e->effect);
    roil_free_templates(e);
    roil_keep_only(e, NULL);
    mem_free(e->kept);
    mem_free(e);
}

bool roil_check(roil_effect *e) {
    mem_enter();
    time_limit time = roil_time_limit(e->owner), *before = time_limit_enter(&time);
    bool done = effect_check(e->effect);
    time_limit_leave(before);
    return mem_leave(done);
}

roil_effect_info roil_get_info(const roil_effect *e) {
    const effect_facts *facts = effect_get_facts(e->effect);
    return (roil_effect_info){
        .name = facts->name,
        .author = facts->author,
        .licence = facts->licence,
        .fps = facts->fps,
        .first_frame = facts->first,
        .frames = facts->frames,
    };
}

static void suggest_image(roil_effect *e, const char *name) {
    graph *g = effect_graph(e->effect);
    size_t passes = effect_pass_count(e->effect), images = graph_images(g, NULL, 0);
    graph_image *handles = mem_alloc(images * sizeof *handles);
    const char **names = mem_alloc((passes + images) * sizeof *names);
    graph_images(g, handles, images);
    for (size_t i = 0; i < passes; i++) names[i] = pass_label(effect_get_pass(e->effect, i));
    for (size_t i = 0; i < images; i++) names[passes + i] = graph_get_desc(g, handles[i])->name;
    words_refuse(names, passes + images, name, "`roil info graph` shows them", "no image '%s'",
                 name);
    mem_free(handles);
    mem_free(names);
}

// Finds "march.color", or the first output of a pass by its label.
graph_image roil_find_image(roil_effect *e, const char *name) {
    graph *g = effect_graph(e->effect);
    graph_image found = graph_find_image(g, name);
    for (size_t i = 0; !found.id && i < effect_pass_count(e->effect); i++) {
        pass *p = effect_get_pass(e->effect, i);
        if (strcmp(pass_label(p), name) != 0) continue;
        const shader_interface *face = pass_interface(p);
        for (size_t k = 0; !found.id && k < face->image_count; k++)
            if (face->images[k].output) found = pass_output(p, face->images[k].name);
    }
    if (!found.id) suggest_image(e, name);
    return found;
}

static bool set_samples(roil_effect *e, uint32_t samples, double shutter) {
    if (samples < 1 || samples > 65536 || !(shutter >= 0 && shutter <= 1))
        return err_set("%u samples over %g frames; accepted: 1 to 65536, 0 to 1", samples, shutter);
    if (e->averaged) return err_set("the samples of a frame are set once");
    if (e->has_layer) return err_set("the pictures of a layer are not averaged");
    if (!effect_set_samples(e->effect, samples, shutter)) return false;
    e->averaged = samples;
    e->shutter = shutter;
    return true;
}

bool roil_set_samples(roil_effect *e, uint32_t samples, double shutter) {
    return MEM_CALL(set_samples(e, samples, shutter));
}

bool roil_prepare(roil_effect *e, uint32_t width, uint32_t height) {
    mem_enter();
    if (width < 1 || height < 1 || width > 16384 || height > 16384)
        return mem_leave(err_set("picture size %u x %u; accepted: 1 to 16384 each", width, height));
    if (!e->owner->device) return mem_leave(err_set("no device: this effect can only be checked"));
    e->width = width;
    e->height = height;
    e->frame = 0; // images may be new
    roil_apply_kept(e);
    time_limit time = roil_time_limit(e->owner), *before = time_limit_enter(&time);
    bool done = effect_build(e->effect, width, height);
    time_limit_leave(before);
    return mem_leave(done);
}

bool roil_render(roil_effect *e, double frame) {
    mem_enter();
    e->shown = frame;
    e->frame = effect_render(e->effect, frame, false);
    return mem_leave(e->frame != 0);
}

bool roil_advance(roil_effect *e, double frame) {
    mem_enter();
    e->shown = frame;
    e->frame = effect_render(e->effect, frame, true);
    return mem_leave(e->frame != 0);
}

uint32_t roil_samples(const roil_effect *e) {
    return effect_samples(e->effect);
}

const char *roil_warning(const roil_effect *e) {
    return effect_get_warning(e->effect);
}

bool roil_get_simulation(const roil_effect *e, roil_simulation *out) {
    effect_simulation now;
    bool any = effect_get_simulation(e->effect, &now);
    *out = (roil_simulation){now.waiting, now.reached, now.trouble, now.where};
    return any;
}

bool roil_catch_up(roil_effect *e, double frame, bool *more) {
    return MEM_CALL(effect_catch_up(e->effect, frame, more));
}

size_t roil_snapshots(const roil_effect *e, double *frames, size_t capacity) {
    return effect_list_snapshots(e->effect, frames, capacity);
}

struct roil_branch {
    effect_branch *snapshots;
};

static roil_branch *branch_of(effect_branch *snapshots) {
    if (!snapshots) return NULL;
    roil_branch *b = mem_alloc(sizeof *b);
    b->snapshots = snapshots;
    return b;
}

roil_branch *roil_branch_begin(roil_effect *e) {
    RETURN_MADE(roil_branch, branch_of(effect_branch_begin(e->effect)), roil_branch_destroy(made));
}

roil_branch *roil_branch_leave(roil_effect *e) {
    RETURN_MADE(roil_branch, branch_of(effect_branch_leave(e->effect)), roil_branch_destroy(made));
}

void roil_branch_enter(roil_effect *e, roil_branch *b) {
    effect_branch_enter(e->effect, b ? b->snapshots : NULL);
    mem_free(b);
}

void roil_branch_destroy(roil_branch *b) {
    if (!b) return;
    effect_branch_destroy(b->snapshots);
    mem_free(b);
}

void roil_restart(roil_effect *e) {
    effect_restart(e->effect);
}

bool roil_checkpoint(roil_effect *e, const char *file) {
    return MEM_CALL(effect_save_state(e->effect, file));
}

bool roil_restore(roil_effect *e, const char *file, double *frame) {
    mem_enter();
    double last;
    if (!effect_load_state(e->effect, file, &last)) return mem_leave(false);
    if (frame) *frame = last;
    return mem_leave(true);
}

void roil_on_progress(roil_effect *e, bool (*call)(void *user, double done, double whole),
                      void *user) {
    effect_on_progress(e->effect, call, user);
}

// Adds up the times of parts that have one label. A pass may be timed in parts, each several times.
static size_t add_up(gpu_pass_time *times, size_t count) {
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        size_t k = 0;
        while (k < kept && strcmp(times[k].label, times[i].label) != 0) k++;
        if (k < kept)
            times[k].milliseconds += times[i].milliseconds;
        else
            times[kept++] = times[i];
    }
    return kept;
}

static size_t list_times(roil_effect *e, roil_time *out, size_t capacity) {
    gpu_pass_time *times = mem_alloc(2 * GPU_MAX_PASSES * sizeof *times);
    size_t count = gpu_frame_times(e->owner->device, e->frame, times, GPU_MAX_PASSES);
    if (count) count += effect_times_ahead(e->effect, times + count, GPU_MAX_PASSES);
    count = add_up(times, count);
    for (size_t i = 0; i < count && i < capacity; i++) {
        str_copy(out[i].pass, sizeof out[i].pass, times[i].label);
        out[i].milliseconds = times[i].milliseconds;
    }
    mem_free(times);
    return count;
}

size_t roil_times(roil_effect *e, roil_time *out, size_t capacity) {
    mem_enter();
    return roil_leave_count(list_times(e, out, capacity));
}

// Returns millions of units of work per second in the last frame: `work` divided by the time of the
// pass's parts, without that of its grids.
static double rate_of(roil_effect *e, const pass *p, double work) {
    gpu_pass_time times[GPU_MAX_PASSES];
    size_t count = gpu_frame_times(e->owner->device, e->frame, times, GPU_MAX_PASSES);
    size_t length = strlen(pass_label(p));
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        const char *part = times[i].label + length;
        if (strncmp(times[i].label, pass_label(p), length) == 0 && part[0] == '.' &&
            strcmp(part, ".fields") != 0)
            sum += times[i].milliseconds;
    }
    return sum > 0 ? work / sum * 1e-3 : 0;
}

static roil_readout speed_of(roil_effect *e, const pass *p) {
    double work = pass_get_simulation(p)->work(p);
    bool known = e->frame && (!e->owner->never_waits || gpu_frame_done(e->owner->device, e->frame));
    if (work > 0 && known) e->speed = rate_of(e, p, work);
    const char *name = pass_get_simulation(p)->work_name;
    return (roil_readout){pass_label(p), name ? name : "cell updates", "million/s", e->speed};
}

size_t roil_readouts(roil_effect *e, roil_readout *out, size_t capacity) {
    size_t count = 0;
    for (size_t i = 0; i < effect_pass_count(e->effect); i++) {
        const pass *p = effect_get_pass(e->effect, i);
        const pass_simulation *simulation = pass_get_simulation(p);
        pass_readout values[16];
        size_t found = simulation && e->width ? simulation->readouts(p, values, 16) : 0;
        for (size_t k = 0; k < found && k < 16; k++, count++)
            if (count < capacity)
                out[count] =
                    (roil_readout){pass_label(p), values[k].name, values[k].unit, values[k].value};
        if (found && count++ < capacity) out[count - 1] = speed_of(e, p);
    }
    const effect_status *status;
    size_t reported = effect_statuses(e->effect, &status);
    for (size_t i = 0; i < reported; i++, count++)
        if (count < capacity)
            out[count] = (roil_readout){"effect", status[i].name, status[i].unit, status[i].value};
    return count;
}

void roil_only_simulate(roil_effect *e) {
    effect_only_simulate(e->effect);
}

bool roil_get_playback(const roil_effect *e, roil_playback *out) {
    field_playback all;
    bool any = effect_playback(e->effect, &all);
    *out = (roil_playback){
        .shown = all.shown,
        .late = all.late,
        .decoded = all.decoded,
        .uploaded = all.uploaded,
        .decoded_bytes = all.decoded_bytes,
        .uploaded_bytes = all.uploaded_bytes,
        .decode_seconds = all.decode_seconds,
        .threads = all.threads,
        .device_bytes = all.device_bytes,
        .frame_bytes = all.largest_bytes,
        .frame_voxels = all.largest_voxels,
        .waiting = all.waiting,
    };
    return any;
}

size_t roil_counters(roil_effect *e, roil_counter *out, size_t capacity) {
    size_t count = 0;
    for (size_t i = 0; i < effect_pass_count(e->effect); i++) {
        pass *p = effect_get_pass(e->effect, i);
        const shader_interface *face = pass_interface(p);
        uint64_t values[64];
        if (!face->counter_count || face->counter_count > 64 || !pass_read_counters(p, values))
            continue;
        for (size_t k = 0; k < face->counter_count; k++, count++) {
            if (count >= capacity) continue;
            str_copy(out[count].pass, sizeof out->pass, pass_label(p));
            str_copy(out[count].name, sizeof out->name, face->counters[k].name);
            out[count].value = values[k];
        }
    }
    return count;
}
