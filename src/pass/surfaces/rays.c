// Whether a pass shoots rays by the dozen at lights and sky, by its numbers. Its shader is compiled
// with and without the loops over them: a software device computes what it skips, so that loops for
// nothing cost three times the rest.
#include "pass/surfaces/rays.h"
#include "pass/pass_impl.h"

enum { RAYS_NAMES(KERNEL_NAME_ID) };

void pass_rays_define(pass_defines *out, size_t index) {
    pass_define_flag(out, "MANY_RAYS", index == RAYS_MANY);
}

// Whether a number can be above `limit`, or can be no more than that, as far as that is known
// before a frame: passes are built side by side, where no Lua may run.
static bool can_be(const pass *p, int name, float limit, bool above) {
    const size_t index = (size_t)p->names[name].uniform;
    const value_desc *declared = &p->face->uniforms[index];
    const field *node = p->uniforms[index];
    if (!node) node = pass_inherited_uniform(p, index, &declared);
    if (node && !field_is_constant(node)) return true; // it moves
    return ((node ? node->value[0] : declared->value[0]) > limit) == above;
}

bool pass_rays_foresee(const pass *p, size_t index) {
    if (index == RAYS_FEW)
        return can_be(p, N_shadow_samples, 1, false) && can_be(p, N_sky_samples, 0, false);
    return can_be(p, N_shadow_samples, 1, true) || can_be(p, N_sky_samples, 0, true);
}

size_t pass_rays_choose(const pass *p) {
    const bool many = pass_value(p, N_shadow_samples) > 1 || pass_value(p, N_sky_samples) > 0;
    return many ? RAYS_MANY : RAYS_FEW;
}
