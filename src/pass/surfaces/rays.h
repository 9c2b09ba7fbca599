// Of passes that light surfaces: their kernels RAYS_FEW and RAYS_MANY are one shader, compiled for
// few rays and for many, and their names begin with RAYS_NAMES.
#pragma once
#include "pass/pass.h"

enum { RAYS_FEW, RAYS_MANY, RAYS_VARIANTS };

#define RAYS_NAMES(NAME) NAME(shadow_samples), NAME(sky_samples)

void pass_rays_define(pass_defines *out, size_t index);
// Whether frames may need the kernel, as far as that is known before the first; any thread.
bool pass_rays_foresee(const pass *p, size_t index);
size_t pass_rays_choose(const pass *p); // the kernel of this frame, after pass_prepare
