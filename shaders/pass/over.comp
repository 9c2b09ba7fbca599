// Lays a volume over the scene. A volume of lower resolution is scaled up along the edges of the
// scene: of the texels around a pixel those count whose ray ended at the pixel's own depth.
uniform sampler2D volume;         //= input : premultiplied radiance and opacity
uniform sampler2D source;         //= input : the scene
uniform sampler2D depth;          //= input optional : depth of the scene (m)
uniform sampler2D edge;           //= input optional : depth at which the volume's rays were stopped (m)
uniform float edge_tolerance;     //= 0.05 [0.001, 1] : relative difference in depth that counts as an edge
writeonly uniform image2D color;  //= output rgba16f : premultiplied radiance and opacity

// Weights of four texels at distances 1 + f, f, 1 - f, 2 - f (Mitchell and Netravali 1988, with B and C
// of a third: between blur, blocks and ringing).
vec4 mitchell(float f) {
    vec4 x = vec4(1.0 + f, f, 1.0 - f, 2.0 - f), x2 = x * x, x3 = x2 * x;
    vec4 near = (21.0 * x3 - 36.0 * x2 + 16.0) / 18.0;
    vec4 far = (-7.0 * x3 + 36.0 * x2 - 60.0 * x + 32.0) / 18.0;
    return vec4(far.x, near.yz, far.w);
}

vec4 upsample(ivec2 pixel, vec2 uv) {
    ivec2 low = textureSize(volume, 0);
    if (low == imageSize(color)) return texelFetch(volume, pixel, 0);
    vec2 at = uv * vec2(low) - 0.5;
    ivec2 base = ivec2(floor(at));
    // Four bilinear taps see all sixteen texels: most of the picture has nothing to scale.
    vec4 taps = vec4(vec2(base), vec2(base + 2)) / vec4(low, low);
    float any_alpha = textureLod(volume, taps.xy, 0.0).a + textureLod(volume, taps.zy, 0.0).a +
                      textureLod(volume, taps.xw, 0.0).a + textureLod(volume, taps.zw, 0.0).a;
    if (any_alpha == 0.0) return vec4(0.0);
    vec4 wx = mitchell(at.x - float(base.x)), wy = mitchell(at.y - float(base.y));
#if HAS_DEPTH && HAS_EDGE
    float here = texelFetch(depth, pixel, 0).r;
#endif
    vec4 sum = vec4(0.0), least = vec4(1e9), most = vec4(0.0);
    float total = 0.0;
    for (int i = 0; i < 16; i++) {
        ivec2 offset = ivec2(i & 3, i >> 2);
        ivec2 texel = clamp(base + offset - 1, ivec2(0), low - 1);
        float w = wx[offset.x] * wy[offset.y], same = 1.0;
#if HAS_DEPTH && HAS_EDGE
        float apart = (texelFetch(edge, texel, 0).r - here) / (edge_tolerance * max(here, 1e-3));
        same = 1.0 / (1.0 + apart * apart) + 1e-6;
        // Across an edge the negative lobes would ring: only what is positive counts.
        w = mix(max(w, 0.0), w, same);
#endif
        vec4 c = texelFetch(volume, texel, 0);
        sum += w * same * c;
        total += w * same;
        if (same > 0.5) {
            least = min(least, c);
            most = max(most, c);
        }
    }
    vec4 smooth_value = sum / max(total, 1e-9);
    return most.a >= least.a ? clamp(smooth_value, least, most) : smooth_value;
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
