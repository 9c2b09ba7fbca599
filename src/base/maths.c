#include "base/maths.h"
#include <string.h>

static const float EVERYWHERE = 1e30f, BEYOND = 1e29f;

box3 box3_empty(void) {
    return (box3){{1, 1, 1}, {-1, -1, -1}};
}

box3 box3_infinite(void) {
    return (box3){{-EVERYWHERE, -EVERYWHERE, -EVERYWHERE}, {EVERYWHERE, EVERYWHERE, EVERYWHERE}};
}

bool box3_is_empty(box3 a) {
    return !(a.min.x < a.max.x && a.min.y < a.max.y && a.min.z < a.max.z);
}

bool box3_is_finite(box3 a) {
    return a.min.x > -BEYOND && a.min.y > -BEYOND && a.min.z > -BEYOND && a.max.x < BEYOND &&
           a.max.y < BEYOND && a.max.z < BEYOND;
}

box3 box3_intersect(box3 a, box3 b) {
    return (box3){{fmaxf(a.min.x, b.min.x), fmaxf(a.min.y, b.min.y), fmaxf(a.min.z, b.min.z)},
                  {fminf(a.max.x, b.max.x), fminf(a.max.y, b.max.y), fminf(a.max.z, b.max.z)}};
}

box3 box3_union(box3 a, box3 b) {
    if (box3_is_empty(a)) return b;
    if (box3_is_empty(b)) return a;
    return (box3){{fminf(a.min.x, b.min.x), fminf(a.min.y, b.min.y), fminf(a.min.z, b.min.z)},
                  {fmaxf(a.max.x, b.max.x), fmaxf(a.max.y, b.max.y), fmaxf(a.max.z, b.max.z)}};
}

box3 box3_grow(box3 a, float margin) {
    if (box3_is_empty(a)) return a;
    return (box3){{a.min.x - margin, a.min.y - margin, a.min.z - margin},
                  {a.max.x + margin, a.max.y + margin, a.max.z + margin}};
}

void orbit_angles(const float eye[3], const float target[3], float *distance, float *yaw,
                  float *pitch) {
    static const float NEAR = 1e-3f, UPRIGHT = 1e-4f; // metres; of the distance
    vec3 back;
    glm_vec3_sub((float *)eye, (float *)target, back);
    *distance = glm_vec3_norm(back);
    *yaw = *pitch = 0;
    if (!(*distance >= NEAR)) return;
    *pitch = glm_deg(asinf(clampf(back[2] / *distance, -1, 1)));
    if (hypotf(back[0], back[1]) > UPRIGHT * *distance)
        *yaw = glm_deg(atan2f(back[1], back[0])) + 90;
}

uint16_t half_from_float(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    uint32_t sign = (bits >> 16) & 0x8000u, magnitude = bits & 0x7fffffffu;
    if (magnitude > 0x7f800000u) return (uint16_t)(sign | 0x7e00u);  // NaN
    if (magnitude >= 0x477ff000u) return (uint16_t)(sign | 0x7c00u); // rounds beyond 65504
    if (magnitude < 0x38800000u) {                                   // subnormal half
        float scaled; // adding 0.5 aligns the mantissa so that the FPU rounds to nearest even
        memcpy(&scaled, &magnitude, sizeof scaled);
        scaled += 0.5f;
        uint32_t rounded;
        memcpy(&rounded, &scaled, sizeof rounded);
        return (uint16_t)(sign | (rounded - 0x3f000000u));
    }
    uint32_t odd = (magnitude >> 13) & 1u;
    return (uint16_t)(sign | ((magnitude - 0x38000000u + 0xfffu + odd) >> 13));
}

float half_to_float(uint16_t value) {
    uint32_t sign = (uint32_t)(value & 0x8000u) << 16, magnitude = value & 0x7fffu;
    float result;
    if (magnitude < 0x400u) {
        result = (float)magnitude * 0x1p-24f; // exact
        uint32_t bits;
        memcpy(&bits, &result, sizeof bits);
        bits |= sign;
        memcpy(&result, &bits, sizeof result);
        return result;
    }
    uint32_t bits = magnitude >= 0x7c00u ? sign | 0x7f800000u | (magnitude & 0x3ffu) << 13
                                         : sign | ((magnitude << 13) + 0x38000000u);
    memcpy(&result, &bits, sizeof result);
    return result;
}
