// All small levels in one work group, in shared memory: `color` is the finest of them. A dispatch for
// each would take longer to begin than to end.
#define THREADS MOST_THREADS
layout(local_size_x = THREADS) in;
uniform int tail_levels; // how many times to halve
shared uvec2 tail_texels[TAIL_ROOM]; // half floats, of all levels together

struct tail_level {
    ivec2 size;
    int first; // of its texels
};

tail_level level_of(int index) {
    tail_level l = tail_level(imageSize(color), 0);
    for (int i = 0; i < index; i++) l = tail_level(max(l.size / 2, 1), l.first + l.size.x * l.size.y);
    return l;
}

vec3 tail_get(tail_level l, ivec2 at) {
    at = clamp(at, ivec2(0), l.size - 1);
    uvec2 texel = tail_texels[l.first + at.y * l.size.x + at.x];
    return vec3(unpackHalf2x16(texel.x), unpackHalf2x16(texel.y).x);
}

void tail_put(int index, vec3 c) {
    tail_texels[index] = uvec2(packHalf2x16(c.rg), packHalf2x16(vec2(c.b, 0.0)));
}

vec3 tail_halved(tail_level from, ivec2 pixel) {
    vec3 wx = halving(pixel.x, from.size.x), wy = halving(pixel.y, from.size.y), sum = vec3(0.0);
    ivec2 count = min(from.size, 2 + (from.size & 1)); // texels that have a share, along each edge
    for (int y = 0; y < count.y; y++)
        for (int x = 0; x < count.x; x++) sum += wx[x] * wy[y] * tail_get(from, 2 * pixel + ivec2(x, y));
    return sum;
}

// Of a level that is `wide` along an edge, for pixel i of `size`: the first of three texels, and the
// weights of these: linear samples half a texel before and behind, or, in mode paper, one.
vec3 tent(int i, int size, int wide, out int first) {
    float at = (float(i) + 0.5) * float(wide) / float(size) - 1.0, part = at - floor(at);
    first = int(floor(at));
#if MODE == MODE_PAPER
    return max(vec3(0.5 - part, min(0.5 + part, 1.5 - part), part - 0.5), 0.0);
#else
    return vec3(0.5 - 0.5 * part, 0.5, 0.5 * part);
#endif
}

vec3 tail_wide(tail_level wide, ivec2 size, ivec2 pixel) {
    ivec2 first;
    vec3 wx = tent(pixel.x, size.x, wide.size.x, first.x), wy = tent(pixel.y, size.y, wide.size.y, first.y);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 9; i++)
        sum += wx[i % 3] * wy[i / 3] * tail_get(wide, first + ivec2(i % 3, i / 3));
    return sum;
}

void main() {
    int thread = int(gl_LocalInvocationIndex);
    tail_level finest = level_of(0);
    int count = finest.size.x * finest.size.y;
    for (int i = thread; i < count; i += THREADS)
        tail_put(i, imageLoad(color, ivec2(i % finest.size.x, i / finest.size.x)).rgb);
    for (int k = 1; k <= tail_levels; k++) {
        barrier();
        tail_level l = level_of(k), finer = level_of(k - 1);
        for (int i = thread; i < l.size.x * l.size.y; i += THREADS)
            tail_put(l.first + i, tail_halved(finer, ivec2(i % l.size.x, i / l.size.x)));
    }
    for (int k = tail_levels - 1; k >= 0; k--) {
        barrier();
        tail_level l = level_of(k), wide = level_of(k + 1);
        for (int i = thread; i < l.size.x * l.size.y; i += THREADS) {
            ivec2 pixel = ivec2(i % l.size.x, i / l.size.x);
            tail_put(l.first + i, blend(tail_get(l, pixel), tail_wide(wide, l.size, pixel)));
        }
    }
    for (int i = thread; i < count; i += THREADS) { // each its own texels: no barrier
        ivec2 pixel = ivec2(i % finest.size.x, i / finest.size.x);
        imageStore(color, pixel, vec4(tail_get(finest, pixel), 1.0));
    }
}
