// What a field is on the GPU and on the host, where both can be one text: the functions of single
// numbers in shaders/lib/*.h, which are GLSL, compiled as C.
#pragma once
#include "base/maths.h"
#include <math.h>
#include <stdbool.h>
#include <sys/types.h>

typedef struct range1 range1; // of one component
#define range1(low, high) ((range1){low, high})

// Functions of GLSL that C has by other names, for this text alone.
#define SHARED static inline
#define abs(a) fabsf(a)
#define atan(y, x) atan2f(y, x)
#define clamp(v, low, high) clampf(v, low, high)
#define exp(a) expf(a)
#define floor(a) floorf(a)
#define fract(a) ((a)-floorf(a))
#define log(a) logf(a)
#define max(a, b) fmaxf(a, b)
#define min(a, b) fminf(a, b)
#define pow(a, b) powf(a, b)
#define sin(a) sinf(a)
#define sqrt(a) sqrtf(a)
#include "lib/range_blast.h"
#include "lib/range_noise.h"
#include "lib/range_shape.h"
#undef SHARED
#undef abs
#undef atan
#undef clamp
#undef exp
#undef floor
#undef fract
#undef log
#undef max
#undef min
#undef pow
#undef sin
#undef sqrt
