// Draws what geometry.comp finds by rays.

#include "lib/frame.glsl"
#include "lib/mesh.glsl"
layout(binding = 4) uniform sampler2D base;

layout(location = 0) in vec3 world_normal;
layout(location = 1) in vec2 uv;
layout(location = 2) in float distance;
layout(location = 0) out vec4 albedo;
layout(location = 1) out vec4 normal;
layout(location = 2) out vec4 depth;

void main() {
    vec4 color = part.color;
    if (part.range.y != 0u) color *= texture(base, uv);
    if (color.a < 0.5) discard;
    albedo = vec4(color.rgb, 1.0);
    normal = vec4(normalize(gl_FrontFacing ? world_normal : -world_normal), 0.0);
    depth = vec4(distance);
}
