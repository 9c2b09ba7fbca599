// Small vectors, boxes and half floats. Matrices come from cglm, column-major, as GLSL has them.
#pragma once
#include <cglm/cglm.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct float3 {
    float x, y, z;
} float3;

typedef struct box3 {
    float3 min, max; // empty when any min >= max
} box3;

box3 box3_empty(void);
box3 box3_infinite(void); // +-1e30: "everywhere"
box3 box3_intersect(box3 a, box3 b);
box3 box3_union(box3 a, box3 b); // an empty box adds nothing
box3 box3_grow(box3 a, float margin);
bool box3_is_empty(box3 a);
bool box3_is_finite(box3 a); // false when any side is beyond 1e29

// Where `eye` is as seen from `target`: the distance, and degrees around Z (0: along -Y) and above
// the ground. Angles are 0 where both are one point.
void orbit_angles(const float eye[3], const float target[3], float *distance, float *yaw,
                  float *pitch);

uint16_t half_from_float(float value); // round to nearest even, NaN kept, overflow to infinity
float half_to_float(uint16_t value);

static inline float clampf(float v, float lo, float hi) {
    return v < lo ? lo : v > hi ? hi : v;
}
static inline float mixf(float a, float b, float t) {
    return a + (b - a) * t;
}
