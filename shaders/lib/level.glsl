// How far a mesh is simplified (src/media/mesh_levels.h), drawn or met by rays.
#ifndef LIB_LEVEL_GLSL
#define LIB_LEVEL_GLSL
#include "shared.h"

// The coarsest level whose error, by level in metres, is small enough where the mesh is nearest: seen
// from there it is `lod` pixels at most. `pixels`: of a metre at 1 m, 0: all is in full. `away`: metres
// from the eye to the middle of a ball around the mesh. All lengths may be those of the mesh's own space.
uint level_of(vec4 errors, float pixels, float lod, float away, float radius) {
    float most = lod * max(away - radius, 0.0);
    uint level = 0u;
    for (uint i = 1u; i < DRAWN_LEVELS && lod * pixels > 0.0; i++)
        if (errors[i] * pixels <= most) level = i;
    return level;
}
#endif
