// A ray into a medium, and what is at the point that is seen there. It is no part of a graph: it
// runs between frames, on what the last one left.
#pragma once
#include "pass/pass.h"

extern const pass_type pass_probe_type;
enum { PASS_PROBE_VALUES = 8 };

// Makes and builds a probe that is given a density and at most as many fields, each of one, three
// or four components. NULL with a message.
pass *pass_probe_create(pass_host *host, const field *density, const field *const *values,
                        size_t count);
// Returns whether the grids that a field samples hold what it reads of them: what no pass reads is
// not made.
bool pass_probe_sees(const pass_host *host, const field *node);
// Looks along a ray (m; `way` has length 1), and waits for the device. `out`: the point and its
// density, which is below 0 where there is nothing; then the values.
bool pass_probe_look(pass *p, const float origin[3], const float way[3],
                     float out[1 + PASS_PROBE_VALUES][4]);
