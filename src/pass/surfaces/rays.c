// Whether a pass shoots rays by the dozen at lights and sky, by its numbers. Its shader is compiled
// with and without the loops over them: a software device computes what it skips, so that loops for
// nothing cost three times the rest.
#include "pass/surfaces/rays.h"
#include "pass/pass_impl.h"

enum { RAYS_NAMES(KERNEL_NAME_ID) };

void pass_rays_define(pass_defines *out, size_t index) {
    pass_define_flag(out, "MANY_RAYS", index == RAYS_MANY);
}

bool pass_rays_foresee(const pass *p, size_t index) {
    if (index == RAYS_FEW)
        return pass_may_be(p, N_shadow_samples, 1, false) &&
               pass_may_be(p, N_sky_samples, 0, false);
    return pass_may_be(p, N_shadow_samples, 1, true) || pass_may_be(p, N_sky_samples, 0, true);
}

size_t pass_rays_choose(const pass *p) {
    const bool many = pass_value(p, N_shadow_samples) > 1 || pass_value(p, N_sky_samples) > 0;
    return many ? RAYS_MANY : RAYS_FEW;
}
