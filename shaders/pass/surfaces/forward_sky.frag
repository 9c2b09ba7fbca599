// What `forward` shows where nothing is.
#include "lib/frame.glsl"
#include "lib/sky.glsl"
#include "lib/night.glsl"
uniform float sky_alpha;
uniform vec2 picture;
layout(location = 0) out vec4 color;
layout(location = 1) out vec4 normal;
layout(location = 2) out vec4 depth;

void main() {
    vec3 way = normalize(frame_ray(gl_FragCoord.xy / picture));
    color = vec4(night_sky(way, 2.0 * frame.lens.y / picture.y), 1.0) * sky_alpha;
    normal = vec4(0.0);
    depth = vec4(1e9);
}
