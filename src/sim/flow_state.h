// The whole state of a solver of 2D flow in a checkpoint, from which it continues as if it had
// never stopped. Its inputs are not included: whoever fills them must fill them again.
#pragma once
#include "sim/checkpoint.h"
#include "sim/flow.h"

// Adds the parts of `f` under "label/...", between frames. `more`: further lines "key = value" that
// must be equal when the state is loaded. False with a message.
bool flow_state_list(flow *f, gpu *g, const char *label, const char *more, checkpoint_list *out);
// Loads a state between frames, after flow_allocate. False with a message. A solver that does not
// match is unchanged; after any other failure it has no state (call flow_reset).
bool flow_state_load(flow *f, gpu *g, const char *label, const char *more, checkpoint *c);
