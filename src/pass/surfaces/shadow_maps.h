// Passes that look into the maps of `shadow_maps`: they include lib/shadows.glsl, which declares
// the inputs, and have the option `shadows_by`.
#pragma once
#include "pass/pass.h"

// Before the pass is declared: settles `auto`. Maps that nothing is looked up in are let go, so
// that they are not drawn. False with a message: maps are asked for, and there are none.
bool pass_choose_shadows(pass *p);
