// Bricks: a grid over the box of a medium that tells where its density may be above 0, so that a
// march takes no samples where it is not. pass/march/bricks.glsl makes them, once a frame.
//
// A word stands for a block of 3 x 3 x 3 bricks. Bit x + 3 y + 9 z: that brick may hold something.
// In a block that holds nothing, the bits from BRICKS_FREE on say how many blocks away the nearest
// is that does, along the axis where it is farthest; so one look goes past many (Sramek and Kaufman,
// "Fast ray-tracing of rectilinear volume data using distance transforms", 2000).
uniform usampler3D brick_words;
uniform vec3 brick_blocks; // along each axis of the box; 0: there are none, and all may hold something

#ifndef LIB_BRICKS_GLSL
#define LIB_BRICKS_GLSL

const uint BRICKS_FREE = 27u, BRICKS_HOLD = (1u << BRICKS_FREE) - 1u;

// True where there may be something at a point in blocks; `centre` and `half_side` of what round it
// is like that: a brick or a cube of empty blocks.
bool bricks_look(vec3 at, out vec3 centre, out float half_side) {
    vec3 block = clamp(floor(at), vec3(0.0), brick_blocks - 1.0);
    uint word = texelFetch(brick_words, ivec3(block), 0).r;
    centre = block + 0.5;
    half_side = float(word >> BRICKS_FREE) - 0.5;
    if ((word & BRICKS_HOLD) == 0u) return false;
    vec3 brick = clamp(floor((at - block) * 3.0), vec3(0.0), vec3(2.0));
    centre = block + (brick + 0.5) / 3.0;
    half_side = 0.5 / 3.0;
    return (word >> uint(brick.x + 3.0 * brick.y + 9.0 * brick.z) & 1u) != 0u;
}

// Whether there may be something at a point of the box.
bool bricks_may_hold(vec3 p, vec3 low, vec3 high) {
    if (brick_blocks.x == 0.0) return true;
    vec3 centre;
    float half_side;
    return bricks_look((p - low) * (brick_blocks / max(high - low, vec3(1e-20))), centre, half_side);
}

struct bricks_ray { // in blocks
    vec3 from, way; // where it begins, and goes in a metre
    vec3 metres;    // for each block, along each axis
};

bricks_ray bricks_begin(vec3 origin, vec3 direction, vec3 low, vec3 high) {
    vec3 scale = brick_blocks / max(high - low, vec3(1e-20));
    vec3 way = direction * scale;
    way = mix(way, vec3(1e-20), lessThan(abs(way), vec3(1e-20)));
    return bricks_ray((origin - low) * scale, way, 1.0 / way);
}

// Whether there may be something `at` metres along the ray; it is like that up to `until`.
bool bricks_hold(bricks_ray ray, float at, out float until) {
    vec3 centre;
    float half_side;
    bool held = bricks_look(ray.from + at * ray.way, centre, half_side);
    vec3 leave = (centre - ray.from) * ray.metres + half_side * abs(ray.metres);
    until = min(min(leave.x, leave.y), leave.z);
    return held;
}

#endif
