// Spreads the bright picture: halved level by level, then added back up (Raseta et al. 2025, section 3.8).
//
// In mode normal every level weighs what `radius` says and the weights sum to one: the bloom has
// the energy of the bright picture. In mode paper C_i += alpha U(C_{i+1}), which adds energy with
// every level.
//@ option mode = normal {normal, paper} : normal keeps the energy; paper as published
uniform sampler2D source;      //= input : the bright picture
uniform float radius;          //= 0.7 [0, 1] : how much of the light goes to the wider levels
uniform float alpha;           //= 0.8 [0, 4] : weight of each wider level in mode paper
uniform int levels;            //= 0 [0, 16] : how many halvings; 0: down to one pixel
uniform image2D color;         //= output rgba16f : the bloom

// Halving an odd size n = 2 m + 1: three texels by their share of the texel that they make, so that
// the mean of the picture stays what it was.
vec3 odd_weights(int i, int n) {
    if (n == 1) return vec3(1.0, 0.0, 0.0);
    if ((n & 1) == 0) return vec3(0.5, 0.5, 0.0);
    int m = n / 2;
    return vec3(m - i, m, i + 1) / float(n);
}

vec3 halve_odd(ivec2 pixel, ivec2 from) {
    vec3 wx = odd_weights(pixel.x, from.x), wy = odd_weights(pixel.y, from.y);
    vec3 sum = vec3(0.0);
    for (int y = 0; y < 3; y++)
        for (int x = 0; x < 3; x++)
            sum += wx[x] * wy[y] * texelFetch(source, min(2 * pixel + ivec2(x, y), from - 1), 0).rgb;
    return sum;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    vec2 uv = (vec2(pixel) + 0.5) / vec2(size);
    vec2 texel = 1.0 / vec2(textureSize(source, 0));
#if DIRECTION_UP
    // A 3x3 tent over the wider level by four bilinear taps: weights 1 2 1 in each direction.
    vec3 wide = vec3(0.0);
    for (int i = 0; i < 4; i++) {
        vec2 corner = vec2(i & 1, i >> 1) - 0.5;
        wide += textureLod(source, uv + corner * texel, 0.0).rgb;
    }
    wide *= 0.25;
    vec3 own = imageLoad(color, pixel).rgb;
#if MODE == MODE_PAPER
    vec3 sum = own + alpha * textureLod(source, uv, 0.0).rgb;
#else
    vec3 sum = mix(own, wide, radius);
#endif
    imageStore(color, pixel, vec4(sum, 1.0));
#else
    ivec2 from = textureSize(source, 0);
    vec3 sum;
    if (size == from)
        sum = texelFetch(source, pixel, 0).rgb;
    else if (((from.x | from.y) & 1) == 0)
        sum = textureLod(source, uv, 0.0).rgb; // the mean of the four texels beneath
    else
        sum = halve_odd(pixel, from);
    imageStore(color, pixel, vec4(sum, 1.0));
#endif
}
