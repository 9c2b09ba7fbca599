// Lays a volume over the scene. A volume of lower resolution is scaled up along the edges of the
// scene: of the texels around a pixel those count whose ray ended at the pixel's own depth.
uniform sampler2D volume;         //= input : premultiplied radiance and opacity
uniform sampler2D source;         //= input : the scene
uniform sampler2D depth;          //= input optional : depth of the scene (m)
uniform sampler2D edge;           //= input optional : depth at which the volume's rays were stopped (m)
uniform sampler2D sun;            //= input optional : the sun's part of the scene
uniform sampler2D shadow;         //= input optional : how much of it reaches each point
uniform float edge_tolerance;     //= 0.05 [0.001, 1] : relative difference in depth that counts as an edge
writeonly uniform image2D color;  //= output rgba16f : premultiplied radiance and opacity

// A quadratic B-spline over three by three texels hides the coarse raster.
vec4 upsample(ivec2 pixel, vec2 uv) {
    ivec2 low = textureSize(volume, 0);
    if (low == imageSize(color)) return texelFetch(volume, pixel, 0);
    vec2 at = uv * vec2(low) - 0.5;
    ivec2 middle = ivec2(floor(at + 0.5));
    vec2 f = at - vec2(middle);
    vec2 weights[3] = vec2[](0.5 * (0.5 - f) * (0.5 - f), 0.75 - f * f, 0.5 * (0.5 + f) * (0.5 + f));
#if HAS_DEPTH && HAS_EDGE
    float here = texelFetch(depth, pixel, 0).r;
#endif
    vec4 sum = vec4(0.0);
    float total = 0.0;
    for (int i = 0; i < 9; i++) {
        ivec2 offset = ivec2(i % 3, i / 3);
        ivec2 texel = clamp(middle + offset - 1, ivec2(0), low - 1);
        float w = weights[offset.x].x * weights[offset.y].y;
#if HAS_DEPTH && HAS_EDGE
        float apart = (texelFetch(edge, texel, 0).r - here) / (edge_tolerance * max(here, 1e-3));
        w = w / (1.0 + apart * apart) + 1e-9;
#endif
        sum += w * texelFetch(volume, texel, 0);
        total += w;
    }
    return sum / total;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    vec2 uv = (vec2(pixel) + 0.5) / vec2(size);
    vec4 front = upsample(pixel, uv);
    vec4 back = textureLod(source, uv, 0.0);
#if HAS_SUN && HAS_SHADOW
    back.rgb -= (1.0 - textureLod(shadow, uv, 0.0).r) * textureLod(sun, uv, 0.0).rgb;
#endif
    imageStore(color, pixel, front + (1.0 - front.a) * back);
}
