// libroil: the public functions for devices and memory, over the layers below. Effects: effect.c.
#include "roil.h"
#include "base/budget.h"
#include "base/error.h"
#include "base/file.h"
#include "base/isolate.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/str.h"
#include "roil/roil_impl.h"
#include "shader/shader.h"
#include <limits.h>
#include <stdlib.h>
#include <string.h>

const char *roil_version(void) {
    return ROIL_VERSION;
}
const char *roil_error(void) {
    return err_get();
}
void roil_free(void *text) {
    mem_free(text);
}

char *roil_leave_text(char *text) {
    if (mem_leave(text != NULL)) return text;
    mem_free(text);
    return NULL;
}

size_t roil_leave_count(size_t count) {
    return mem_leave(true) ? count : 0;
}

void roil_set_log(void (*write)(void *user, int level, const char *text), void *user,
                  roil_level least) {
    _Static_assert((int)ROIL_DEBUG == (int)LOG_DEBUG && (int)ROIL_ERROR == (int)LOG_ERROR,
                   "levels");
    log_set_target(write, user);
    if (write) log_set_level((log_level)least);
}

bool roil_set_allocator(const roil_allocator *a) {
    return mem_set_heap(a ? (mem_heap){a->allocate, a->user} : (mem_heap){0});
}

// ---- device -----------------------------------------------------------------------------------

static bool is_home(const char *folder) {
    char path[PATH_CAP];
    return path_join(path, folder, "scripts/prelude.lua") && file_exists(path) &&
           path_join(path, folder, "shaders/shared.h") && file_exists(path);
}

// Takes the folder's real path. Names below it can then be checked to lie inside it (base/file.h)
// without resolving links.
static bool take_home(char out[PATH_CAP], const char *folder) {
    char real[PATH_MAX];
    return is_home(folder) && realpath(folder, real) && str_copy(out, PATH_CAP, real);
}

// The program or library may lie in a build folder, in the home itself, in bin/, lib/ or
// lib/ARCHITECTURE/ of an installation, or beside a link, as a part of another build.
static bool find_home(char out[PATH_CAP], const char *wanted) {
    if (!wanted) wanted = getenv("ROIL_HOME");
    if (wanted && wanted[0])
        return take_home(out, wanted) ||
               err_set("%s: holds no shaders/ and scripts/ of roil", wanted);
    char own[PATH_CAP], folder[PATH_CAP];
    if (!path_own_folder(own)) return false;
    static const char *const places[] = {"..",         ".",    "../share/roil", "../../share/roil",
                                         "share/roil", "../.."};
    for (size_t i = 0; i < COUNT_OF(places); i++)
        if (path_join(folder, own, places[i]) && take_home(out, folder)) return true;
    return err_set("shaders/ and scripts/ of roil are not near %s; set ROIL_HOME", own);
}

static char *joined(const char *folder, const char *name) {
    char path[PATH_CAP];
    if (!path_join(path, folder, name)) return NULL;
    return mem_copy(path, strlen(path) + 1);
}

// The device that can show the window comes first, and the effects' is the same one.
static bool open_device(roil *r, const roil_desc *desc) {
    uint64_t limit = 0;
    if (desc->device_memory && !budget_read_amount(desc->device_memory, &limit)) return false;
    const roil_window_desc *window = desc->vulkan ? NULL : desc->window;
    gpu_window shown = {0};
    if (window)
        shown = (gpu_window){.extensions = window->extensions,
                             .extension_count = window->extension_count,
                             .create_surface = window->create_surface,
                             .user = window->user};
    r->window = window != NULL;
    gpu_desc how = {.device = desc->device,
                    .cache_dir = r->cache,
                    .memory = limit,
                    .validate = desc->validate,
                    .window = window ? &shown : NULL,
                    .timeout = desc->timeout,
                    .waiting = desc->waiting,
                    .user = desc->user};
    if (desc->vulkan) {
        r->shown = r->device = roil_open_host(&how, desc->vulkan);
        return r->device != NULL;
    }
    r->shown = r->device = gpu_create(&how);
    if (!r->device || !r->never_waits || !gpu_get_profile(r->device)->shows_apart)
        return r->device != NULL;
    how.device = gpu_get_info(r->shown)->name;
    how.window = NULL;
    how.yields = true;
    r->device = gpu_create(&how);
    return r->device != NULL;
}

// Returns whether the compiler should get ready beside the device. That takes it 100 ms of
// processor time, for nothing if all shaders are in the cache. If some are not, the first of them
// waits for it. In a window files will be edited, and the first edit should not wait.
static bool will_compile(const roil *r, const roil_desc *desc) {
    char cache[PATH_CAP];
    bool cached = r->cache && path_join(cache, r->cache, "spirv");
    return desc->window || !cached || !shader_cache_holds_any(cache);
}

static roil *create(const roil_desc *desc) {
    char home[PATH_CAP], cache[PATH_CAP];
    if ((desc->memory && !budget_set_share(desc->memory)) || !find_home(home, desc->home))
        return NULL;
    if (desc->reader && !isolate_set_reader(desc->reader)) return NULL;
    roil *r = mem_alloc(sizeof *r);
    roil_count_users(1);
    r->home = mem_copy(home, strlen(home) + 1);
    r->shaders = joined(home, "shaders");
    r->scripts = joined(home, "scripts");
    r->counters = desc->counters;
    r->reference = desc->reference;
    r->never_waits = desc->never_waits;
    r->interaction = desc->interaction;
    r->loading = desc->loading;
    r->user = desc->user;
    r->seconds = desc->time_limit > 0 ? desc->time_limit : TIME_LIMIT_LOAD_SECONDS;
    // Without a place for it (no home folder, a read-only one) roil works, only slower.
    if (!desc->no_cache && path_cache_folder(cache, "")) r->cache = joined(cache, "");
    if (will_compile(r, desc)) isolate_warm_up("glsl");
    if (roil_take_assets(r, desc) && (desc->no_device || open_device(r, desc))) return r;
    roil_destroy(r);
    return NULL;
}

roil *roil_create(const roil_desc *desc) {
    RETURN_MADE(roil, create(desc), roil_destroy(made));
}

void roil_destroy(roil *r) {
    if (!r || r->stuck) return;
    roil_free_view(r);
    if (r->shown != r->device) gpu_destroy(r->shown);
    gpu_destroy(r->device);
    mem_free(r->home);
    mem_free(r->shaders);
    mem_free(r->scripts);
    mem_free(r->cache);
    for (size_t i = 0; i < r->asset_count; i++) mem_free(r->assets[i]);
    mem_free(r);
    roil_count_users(-1);
}

bool roil_can_exit(void) {
    return !gpu_left_any();
}

const char *roil_device_name(const roil *r) {
    return r->device ? gpu_get_info(r->device)->name : "none";
}

bool roil_wants_preview(const roil *r) {
    return r->device && gpu_get_profile(r->device)->previews;
}

const char *roil_device_driver(const roil *r) {
    return r->device ? gpu_get_info(r->device)->driver : "";
}

bool roil_is_software(const roil *r) {
    return r->device && gpu_get_info(r->device)->kind == GPU_CPU;
}

const char *roil_home(const roil *r) {
    return r->home;
}

void roil_set_counters(roil *r, bool counters) {
    r->counters = counters;
}

void roil_set_reference(roil *r, uint32_t samples) {
    r->reference = samples;
}

bool roil_shows_apart(const roil *r) {
    return r->shown != r->device;
}

uint64_t roil_validation_messages(const roil *r) {
    uint64_t sum = r->device ? gpu_validation_messages(r->device) : 0;
    return roil_shows_apart(r) ? sum + gpu_validation_messages(r->shown) : sum;
}

bool roil_is_lost(const roil *r) {
    return r->device && (gpu_is_lost(r->device) || gpu_is_lost(r->shown));
}

uint64_t roil_pending(roil *r) {
    return r->device ? gpu_pending(r->device) : 0;
}

void roil_give_up(roil *r) {
    if (r->device) gpu_give_up(r->device);
}

roil_memory roil_get_memory(const roil *r) {
    budget_state state = budget_get(r->device ? gpu_get_budget(r->device) : budget_host());
    roil_memory out = {.sum = state.sum, .limit = state.limit};
    for (size_t i = 0; i < COUNT_OF(out.largest); i++) {
        memcpy(out.largest[i].label, state.largest[i].label, sizeof out.largest[i].label);
        out.largest[i].bytes = state.largest[i].bytes;
    }
    if (!r->device) return out;
    gpu *const devices[] = {r->device, r->shown};
    for (int i = 0; i < 1 + roil_shows_apart(r); i++) {
        gpu_memory_use use = gpu_get_memory_use(devices[i]);
        out.device += use.used;
        out.reserved += use.reserved;
    }
    return out;
}

time_limit roil_time_limit(const roil *r) {
    return (time_limit){
        .what = "load", .limit = r->seconds, .progress = r->loading, .user = r->user};
}
