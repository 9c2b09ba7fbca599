// Draws what geometry.comp finds by rays. WITH_SURFACE and WITH_EMISSION (0 or 1): what else is read.

#include "lib/frame.glsl"
#include "lib/mesh_color.glsl"

layout(location = 0) in vec3 world_normal;
layout(location = 1) in vec2 uv;
layout(location = 2) in float distance;
layout(location = 3) flat in vec4 tint;
layout(location = 0) out vec4 albedo;
layout(location = 1) out vec4 normal;
layout(location = 2) out vec4 depth;
#if WITH_SURFACE
layout(location = 3) out vec4 surface;
#endif
#if WITH_EMISSION
layout(location = 3 + WITH_SURFACE) out vec4 emission;
#endif

void main() {
    vec4 color = mesh_color(uv, tint.rgb);
    if (color.a < 0.5) discard;
    albedo = vec4(color.rgb, 1.0);
    normal = vec4(normalize(gl_FrontFacing ? world_normal : -world_normal), 0.0);
    depth = vec4(distance);
#if WITH_SURFACE
    surface = part.surface;
#endif
#if WITH_EMISSION
    emission = part.emission * tint.w;
#endif
}
