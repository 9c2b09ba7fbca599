// One part of a mesh, as the shaders that draw it are told of it (src/pass/surfaces/drawn.h).
#include "shared.h"
layout(std140) uniform Part { drawn_part part; };
