// The whole state of a solver in a checkpoint: what it goes on from as if it had never stopped.
#pragma once
#include "sim/checkpoint.h"
#include "sim/lbm.h"

// Adds the parts of `l` under "label/...". `more`: further lines "key = value" that must be the
// same where it is loaded.
void lbm_state_list(const lbm *l, const char *label, const char *more, checkpoint_list *out);
// Between frames, after lbm_allocate. A solver that does not match is left as it was; what fails
// later leaves it without a state (lbm_reset).
bool lbm_state_load(lbm *l, gpu *g, const char *label, const char *more, checkpoint *c);
