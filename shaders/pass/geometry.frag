// A diffuse surface under sun and sky.
#include "lib/frame.glsl"
#include "lib/mesh.glsl"
layout(binding = 4) uniform sampler2D base;

layout(location = 0) in vec3 world;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in float depth_in;
layout(location = 0) out vec4 color;
layout(location = 1) out vec4 sun;
layout(location = 2) out float depth;

void main() {
    vec3 n = normalize(gl_FrontFacing ? normal : -normal);
    vec4 albedo = part.color;
    if (part.range.y != 0u) albedo *= texture(base, uv);
    if (albedo.a < 0.5) discard;
    vec3 direct = frame.sun_radiance.rgb * max(dot(n, frame.sun_direction.xyz), 0.0);
    vec3 sky = mix(frame.sky_horizon.rgb, frame.sky_zenith.rgb, 0.5 + 0.5 * n.z);
    sun = vec4(albedo.rgb * direct, 0.0);
    color = vec4(albedo.rgb * (direct + sky), 1.0);
    depth = depth_in;
}
