// Lays a volume over the scene. A volume of lower resolution is scaled up along the edges of the
// scene: of the texels around a pixel those count whose ray would have seen the same if it had ended
// at the pixel's own depth: what lies before both, or hides both, has no edge there.
//
// over { volume, solid, from = {volume, scene} } takes depth, edge and transmittance from there.
uniform sampler2D volume;         //= input : premultiplied radiance and opacity
uniform sampler2D source;         //= input : the scene
uniform sampler2D depth;          //= input optional : depth of the scene (m)
uniform sampler2D edge;           //= input optional : depth at which the volume's rays were stopped (m), and from which on they saw no more of it; 0: they were seeing more
uniform sampler2D transmittance;  //= input optional : part of the scene that shines through the volume, by colour; without: that of its opacity, grey
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

struct layer {
    vec4 color;   // premultiplied radiance and opacity
    vec3 through; // transmittance
};

layer fetch(ivec2 texel) {
#if HAS_TRANSMITTANCE
    return layer(texelFetch(volume, texel, 0), texelFetch(transmittance, texel, 0).rgb);
#else
    return layer(texelFetch(volume, texel, 0), vec3(0.0));
#endif
}

#if HAS_DEPTH && HAS_EDGE
float inverse_depth(ivec2 pixel) {
    ivec2 size = textureSize(depth, 0);
    return 1.0 / max(texelFetch(depth, clamp(pixel, ivec2(0), size - 1), 0).r, 1e-3);
}

// How the inverse depth of the surface at a pixel changes from pixel to pixel: it is linear over a plane.
// Towards an edge of the surface it is the other side that tells.
vec2 inverse_slope(ivec2 pixel, float here) {
    vec2 before = vec2(here - inverse_depth(pixel - ivec2(1, 0)), here - inverse_depth(pixel - ivec2(0, 1)));
    vec2 after = vec2(inverse_depth(pixel + ivec2(1, 0)) - here, inverse_depth(pixel + ivec2(0, 1)) - here);
    return mix(after, before, lessThan(abs(before), abs(after)));
}
#endif

layer upsample(ivec2 pixel, vec2 uv) {
    ivec2 low = textureSize(volume, 0);
    if (low == imageSize(color)) return fetch(pixel);
    vec2 at = uv * vec2(low) - 0.5;
    ivec2 base = ivec2(floor(at));
    // Four bilinear taps see all sixteen texels: most of the picture has nothing to scale.
    vec4 taps = vec4(vec2(base), vec2(base + 2)) / vec4(low, low);
    vec4 any = textureLod(volume, taps.xy, 0.0) + textureLod(volume, taps.zy, 0.0) +
               textureLod(volume, taps.xw, 0.0) + textureLod(volume, taps.zw, 0.0);
    if (any == vec4(0.0)) return layer(vec4(0.0), vec3(1.0));
    vec4 wx = mitchell(at.x - float(base.x)), wy = mitchell(at.y - float(base.y));
#if HAS_DEPTH && HAS_EDGE
    float here = inverse_depth(pixel);
    vec2 slope = inverse_slope(pixel, here), texel_pixels = vec2(imageSize(color)) / vec2(low);
#endif
    layer sum = layer(vec4(0.0), vec3(0.0)), least = layer(vec4(1e9), vec3(1e9)), most = sum;
    layer alike = least; // the texel that is most like the pixel
    float total = 0.0, whole = 0.0, most_same = 0.0;
    for (int i = 0; i < 16; i++) {
        ivec2 offset = ivec2(i & 3, i >> 2);
        ivec2 texel = clamp(base + offset - 1, ivec2(0), low - 1);
        float w = wx[offset.x] * wy[offset.y], same = 1.0;
        layer c = fetch(texel);
#if HAS_DEPTH && HAS_EDGE
        // The depth that the pixel's surface has at the texel.
        vec2 there = (vec2(texel) + 0.5) * texel_pixels - vec2(pixel) - 0.5;
        float deep = 1.0 / max(here + dot(slope, there), 1e-9);
        // Of what was not looked for behind, no more can be seen than shines through.
        vec2 seen = texelFetch(edge, texel, 0).rg;
        float beyond = max(deep - seen.r, 0.0) * min(2.0 * (1.0 - c.color.a), 1.0);
        float apart = (beyond + max((seen.g > 0.0 ? seen.g : seen.r) - deep, 0.0)) / (edge_tolerance * deep);
        same = 1.0 / (1.0 + apart * apart) + 1e-6;
        // Across an edge the negative lobes would ring: only what is positive counts.
        w = mix(max(w, 0.0), w, same);
#endif
        sum.color += w * same * c.color;
        sum.through += w * same * c.through;
        total += w * same;
        whole += max(w, 0.0) * same;
        if (same > most_same) {
            most_same = same;
            alike = c;
        }
        if (same > 0.5) {
            least = layer(min(least.color, c.color), min(least.through, c.through));
            most = layer(max(most.color, c.color), max(most.through, c.through));
        }
    }
    layer smooth_value = layer(sum.color / max(total, 1e-9), sum.through / max(total, 1e-9));
    // Where none is at its depth, the lobes may leave next to nothing to divide by.
    if (most.color.a < least.color.a && total < 0.5 * whole) return alike;
    if (most.color.a < least.color.a) return smooth_value;
    return layer(clamp(smooth_value.color, least.color, most.color),
                 clamp(smooth_value.through, least.through, most.through));
}

// What the layer lets through. Of a grey one the opacity says it, which holds small numbers to more
// digits and may be averaged over frames.
vec4 let_through(layer front) {
    float mean = 1.0 - front.color.a;
#if HAS_TRANSMITTANCE
    vec3 t = front.through;
    if (t != t.gbr) return vec4(max(t, 0.0), mean);
#endif
    return vec4(mean);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    vec2 uv = (vec2(pixel) + 0.5) / vec2(size);
    layer front = upsample(pixel, uv);
    vec4 back = textureLod(source, uv, 0.0);
    imageStore(color, pixel, front.color + let_through(front) * back);
}
