// Building the pass type `lbm`: the shaders of its own and of the parts that it is made of.
#include "base/error.h"
#include "pass/air/lbm_parts.h"

bool lbm_air_build(pass *p) {
    lbm_air *a = lbm_air_of(p);
    const pass_host *host = p->host;
    if (!pass_build_kernels(p)) return false;
    if (!lbm_build(a->solver, host->device, host->library, host->reader) ||
        !lbm_guard_compile(a->guard, host->library, host->reader) || !air_build_bodies(&a->air))
        return err_prefix("%s: ", p->label);
    return air_each_source(&a->air, pass_build_part);
}

bool lbm_air_allocate(pass *p) {
    lbm_air *a = lbm_air_of(p);
    return (lbm_allocate(a->solver, p->host->device) &&
            lbm_guard_allocate(a->guard, p->host->device) && air_allocate_bodies(&a->air) &&
            air_allocate_templates(&a->air) && air_allocate_force(&a->air)) ||
           err_prefix("%s: ", p->label);
}

void lbm_air_list_memory(const pass *p, budget_list *out) {
    const lbm_air *a = lbm_air_of(p);
    lbm_list_memory(a->solver, out);
    air_list_bodies(&a->air, out);
    air_list_force(&a->air, out);
    air_list_templates(&a->air, out);
}

void lbm_air_destroy(pass *p) {
    lbm_air *a = lbm_air_of(p);
    gpu *device = p->host->device;
    if (!a) return;
    if (a->guard) lbm_guard_destroy(a->guard, device);
    if (a->solver) lbm_destroy(a->solver, device);
    air_destroy(p);
}
