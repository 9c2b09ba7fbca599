// Bends the picture where hot air rises between the camera and what it sees.
//@ field float heat = 0 : how hot the air is at a point, 0..1
uniform sampler2D input_;          //= input : the picture
uniform float strength;            //= 0.02 [0, 0.2] : how far a ray is bent, as a part of the picture's height
uniform float reach;               //= 1.6 [0, 20] m : how far above the heat its air still bends
uniform float speed;               //= 3 [0, 20] m/s : how fast the air rises
uniform writeonly image2D color;   //= output rgba16f : the bent picture
#include "lib/frame.glsl"
#include "fields.glsl"

// Heat that reaches a point from below it.
float air(vec3 p) {
    float sum = 0.0;
    for (int i = 0; i < 4; i++) sum += field_heat(p - vec3(0.0, 0.0, reach * float(i) / 3.0));
    return min(sum, 1.0);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    vec2 uv = (vec2(pixel) + 0.5) / vec2(size);
    // The air is probed where the ray passes the target's distance.
    vec3 p = frame.eye.xyz + frame_ray(uv) * length(frame.eye.xyz - vec3(0.0, 0.0, 1.1));
    float hot = air(p);
    vec2 wave = vec2(sin(7.0 * (p.z - speed * frame.time.x) + 5.0 * p.x), sin(9.0 * (p.z - speed * frame.time.x) - 4.0 * p.x));
    imageStore(color, pixel, textureLod(input_, uv + strength * hot * wave * vec2(float(size.y) / float(size.x), 1.0), 0.0));
}
