// The whole state of a solver of 2D flow in a checkpoint: what it goes on from as if it had never
// stopped, but for its inputs, which whoever fills them has to fill again.
#pragma once
#include "sim/checkpoint.h"
#include "sim/flow.h"

// Between frames: adds the parts of `f` under "label/...". `more`: further lines "key = value" that
// must be the same where it is loaded. False with a message.
bool flow_state_list(const flow *f, gpu *g, const char *label, const char *more,
                     checkpoint_list *out);
// Between frames, after flow_allocate. A solver that does not match is left as it was; what fails
// later leaves it without a state (flow_reset).
bool flow_state_load(flow *f, gpu *g, const char *label, const char *more, checkpoint *c);
