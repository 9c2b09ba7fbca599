// Directions around a direction.
#ifndef LIB_ACROSS_GLSL
#define LIB_ACROSS_GLSL

// Two unit vectors across the unit vector `n` and each other: Duff et al., "Building an orthonormal
// basis, revisited" (JCGT 6(1), 2017).
mat2x3 across(vec3 n) {
    float side = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (side + n.z), b = n.x * n.y * a;
    return mat2x3(vec3(1.0 + side * n.x * n.x * a, side * b, -side * n.x),
                  vec3(b, side + n.y * n.y * a, -n.y));
}

#endif
