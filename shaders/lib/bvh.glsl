// Rays against the meshes of the scene (src/scene/bvh.h makes the trees).
#ifndef LIB_BVH_GLSL
#define LIB_BVH_GLSL

struct bvh_hit {
    float distance; // metres; negative: nothing was hit
    vec3 normal;    // unit, of the face, towards the ray's origin
    vec3 albedo;    // material colour times the mesh's, without textures
};

// Nearest hit of a ray of unit direction between `near` and `far` metres.
bvh_hit bvh_trace(vec3 origin, vec3 direction, float near, float far);

// Whether anything lies between `near` and `far` metres.
bool bvh_occluded(vec3 origin, vec3 direction, float near, float far);

#endif
