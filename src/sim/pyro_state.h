// The whole state of burning gas in a checkpoint (sim/state.h).
#pragma once
#include "sim/checkpoint.h"
#include "sim/pyro.h"

// `more`: further lines "key = value" that must be equal when the state is loaded.
bool pyro_state_list(pyro *p, gpu *g, const char *label, const char *more, checkpoint_list *out);
bool pyro_state_load(pyro *p, gpu *g, const char *label, const char *more, checkpoint *c);
