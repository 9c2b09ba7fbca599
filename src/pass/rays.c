// Whether a pass shoots rays by the dozen at lights and sky, by its numbers. Its shader is compiled
// with and without the loops over them: a software device computes what it skips, so that loops for
// nothing cost three times the rest.
#include "pass/rays.h"
#include "pass/pass_impl.h"
#include <string.h>

const shader_define pass_rays_variants[2] = {{"MANY_RAYS", "0"}, {"MANY_RAYS", "1"}};

// Whether a number can be above `limit`, as far as that is known before a frame: passes are built
// side by side, where no Lua may run.
static void foresee(const pass *p, const char *name, float limit, bool can[2]) {
    size_t index;
    pass_find_key(p, name, &index);
    const shader_uniform *declared = &p->face->uniforms[index];
    const field *node = p->uniforms[index];
    if (!node) node = pass_inherited_uniform(p, index, &declared);
    bool moves = node && strcmp(node->kind->name, "constant") != 0;
    float value = node && !moves ? node->value[0] : declared->value[0];
    can[0] = moves || value <= limit;
    can[1] = moves || value > limit;
}

void pass_rays_foresee(const pass *p, bool can[2]) {
    bool shadow[2], sky[2];
    foresee(p, "shadow_samples", 1, shadow);
    foresee(p, "sky_samples", 0, sky);
    can[0] = shadow[0] && sky[0];
    can[1] = shadow[1] || sky[1];
}

bool pass_rays_many(const pass *p) {
    return pass_evaluate(p, "shadow_samples") > 1 || pass_evaluate(p, "sky_samples") > 0;
}
