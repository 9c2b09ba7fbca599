// Integrals of phase functions and colours of black bodies, a pixel each, for tests.
uniform float first;             //= 0 [-1, 100000] : value of the first pixel
uniform float last;              //= 1 [-1, 100000] : value of the last
writeonly uniform image2D color; //= output rgba32f : a row for each: phase_hg and phase_schlick, medium_phase; a black body's light

#include "lib/medium.glsl"

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    float value = mix(first, last, float(pixel.x) / float(size.x - 1));
    vec4 result = vec4(blackbody_radiance(value), 0.0);
    if (pixel.y < 2) {
        result = vec4(0.0);
        const int count = 20000;
        for (int i = 0; i < count; i++) {
            float cosine = (float(i) + 0.5) / float(count) * 2.0 - 1.0;
            vec2 of = vec2(phase_hg(cosine, value), phase_schlick(cosine, value));
            if (pixel.y == 1) of = vec2(medium_phase(cosine, 1.0), cosine * medium_phase(cosine, 1.0));
            result += vec4(of, 0.0, 0.0) * (12.5663706 / float(count));
        }
        if (pixel.y == 1) result.z = medium_anisotropy();
    }
    imageStore(color, pixel, result);
}
