// The two variants of passes that light surfaces: with few rays, and with many.
#pragma once
#include "pass/pass.h"

extern const shader_define pass_rays_variants[2];   // with few, with many
void pass_rays_foresee(const pass *p, bool can[2]); // which of them frames may need; any thread
bool pass_rays_many(const pass *p);                 // this frame needs the second
