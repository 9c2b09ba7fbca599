// Building the pass type `lbm`: the shaders of its own and of the parts that it is made of.
#include "base/error.h"
#include "base/memory.h"
#include "pass/air/lbm_parts.h"

static bool each_source(const lbm_air *a, bool (*call)(pass *source)) {
    for (size_t i = 0; i < a->source_count; i++)
        if (!call(a->sources[i])) return false;
    return true;
}

bool lbm_air_check(pass *p) {
    lbm_air *a = lbm_air_of(p);
    const pass_host *host = p->host;
    if (!pass_compile_kernels(p)) return false;
    if (!lbm_compile(a->solver, host->library, host->reader) ||
        !lbm_guard_compile(a->guard, host->library, host->reader) || !lbm_air_check_bodies(a))
        return err_prefix("%s: ", p->label);
    return each_source(a, pass_check_part);
}

bool lbm_air_build(pass *p) {
    lbm_air *a = lbm_air_of(p);
    const pass_host *host = p->host;
    if (!pass_build_kernels(p)) return false;
    if (!lbm_build(a->solver, host->device, host->library, host->reader) ||
        !lbm_guard_compile(a->guard, host->library, host->reader) || !lbm_air_build_bodies(a))
        return err_prefix("%s: ", p->label);
    return each_source(a, pass_build_part);
}

bool lbm_air_allocate(pass *p) {
    lbm_air *a = lbm_air_of(p);
    return (lbm_allocate(a->solver, p->host->device) &&
            lbm_guard_allocate(a->guard, p->host->device) && lbm_air_allocate_bodies(a) &&
            lbm_air_allocate_force(a)) ||
           err_prefix("%s: ", p->label);
}

void lbm_air_list_memory(const pass *p, budget_list *out) {
    const lbm_air *a = lbm_air_of(p);
    lbm_list_memory(a->solver, out);
    lbm_air_list_bodies(a, out);
    lbm_air_list_force(a, out);
}

void lbm_air_destroy(pass *p) {
    lbm_air *a = lbm_air_of(p);
    gpu *device = p->host->device;
    if (!a) return;
    lbm_air_destroy_force(a);
    if (a->guard) lbm_guard_destroy(a->guard, device);
    lbm_air_destroy_bodies(a);
    if (a->solver) lbm_destroy(a->solver, device);
    mem_free(a->sources);
}
