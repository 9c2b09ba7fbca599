// Solids as densities. C compiles this text too (src/field/glsl.h).
#ifndef LIB_SHAPE_H
#define LIB_SHAPE_H
#ifndef SHARED
#define SHARED
#endif

// Of a solid, from the signed distance to its surface: 0 outside, rising to 1 at the depth `falloff`.
SHARED float shape_density(float distance, float falloff) {
    return falloff > 0.0f ? clamp(-distance / falloff, 0.0f, 1.0f) : distance <= 0.0f ? 1.0f : 0.0f;
}

#endif
