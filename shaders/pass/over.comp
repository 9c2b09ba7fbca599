// Lays a volume over the scene. A volume of lower resolution is scaled up along the edges of the
// scene: of its four nearest texels those count whose ray ended at the pixel's own depth.
uniform sampler2D volume;         //= input : premultiplied radiance and opacity
uniform sampler2D source;         //= input : the scene
uniform sampler2D depth;          //= input optional : depth of the scene (m)
uniform sampler2D edge;           //= input optional : depth at which the volume's rays were stopped (m)
uniform float edge_tolerance;     //= 0.05 [0.001, 1] : relative difference in depth that counts as an edge
writeonly uniform image2D color;  //= output rgba16f : premultiplied radiance and opacity

vec4 upsample(ivec2 pixel, vec2 uv) {
    ivec2 low = textureSize(volume, 0);
    if (low == imageSize(color)) return texelFetch(volume, pixel, 0);
#if HAS_DEPTH && HAS_EDGE
    float here = texelFetch(depth, pixel, 0).r;
    vec2 at = uv * vec2(low) - 0.5;
    ivec2 base = ivec2(floor(at));
    vec2 f = at - vec2(base);
    vec4 sum = vec4(0.0);
    float total = 0.0;
    bool mixed = false;
    for (int i = 0; i < 4; i++) {
        ivec2 offset = ivec2(i & 1, i >> 1);
        ivec2 texel = clamp(base + offset, ivec2(0), low - 1);
        vec2 w2 = mix(1.0 - f, f, vec2(offset));
        float there = texelFetch(edge, texel, 0).r;
        float apart = abs(there - here) / (edge_tolerance * max(here, 1e-3));
        mixed = mixed || apart > 1.0;
        float w = w2.x * w2.y / (1.0 + apart * apart) + 1e-6;
        sum += w * texelFetch(volume, texel, 0);
        total += w;
    }
    if (mixed) return sum / total;
#endif
    // No edge: a smooth (quadratic B-spline) filter by four bilinear taps hides the coarse raster.
    vec4 smooth_sum = vec4(0.0);
    for (int i = 0; i < 4; i++) {
        vec2 corner = (vec2(i & 1, i >> 1) - 0.5) * 0.75;
        smooth_sum += textureLod(volume, uv + corner / vec2(low), 0.0);
    }
    return 0.25 * smooth_sum;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    vec2 uv = (vec2(pixel) + 0.5) / vec2(size);
    vec4 front = upsample(pixel, uv);
    vec4 back = textureLod(source, uv, 0.0);
    imageStore(color, pixel, front + (1.0 - front.a) * back);
}
