// The whole state of a solver in a checkpoint, from which it continues as if it had never stopped.
#pragma once
#include "sim/checkpoint.h"
#include "sim/lbm.h"

// Adds the parts of `l` under "label/...". `more`: further lines "key = value" that must be equal
// when the state is loaded.
void lbm_state_list(const lbm *l, const char *label, const char *more, checkpoint_list *out);
// Loads a state between frames, after lbm_allocate. False with a message. A solver that does not
// match is unchanged; after any other failure it has no state (call lbm_reset).
bool lbm_state_load(lbm *l, gpu *g, const char *label, const char *more, checkpoint *c);
