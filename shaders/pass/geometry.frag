// Draws what is solid (Raseta et al. 2025, section 3.3) and tells of each pixel what the surface in
// it is like; `shade` lights it.

#include "lib/frame.glsl"
#include "lib/mesh.glsl"
layout(binding = 4) uniform sampler2D base;

layout(location = 0) in vec3 world_normal;
layout(location = 1) in vec2 uv;
layout(location = 2) in float distance;
layout(location = 0) out vec4 albedo; //= output rgba16f : base colour of the surface; alpha 0 where nothing is
layout(location = 1) out vec4 normal; //= output rgba16f : its normal in the world, towards the viewer
layout(location = 2) out vec4 depth;  //= output r32f : distance along the view axis (m); 1e9 where nothing is

void main() {
    vec4 color = part.color;
    if (part.range.y != 0u) color *= texture(base, uv);
    if (color.a < 0.5) discard;
    albedo = vec4(color.rgb, 1.0);
    normal = vec4(normalize(gl_FrontFacing ? world_normal : -world_normal), 0.0);
    depth = vec4(distance);
}
