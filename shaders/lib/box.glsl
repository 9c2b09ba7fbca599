// Where a ray meets a box (slab test; Kay and Kajiya 1986). Directions may have zero components.

vec2 box_range_unclamped(vec3 origin, vec3 direction, vec3 low, vec3 high) {
    vec3 inverse = 1.0 / mix(direction, vec3(1e-20), lessThan(abs(direction), vec3(1e-20)));
    vec3 a = (low - origin) * inverse, b = (high - origin) * inverse;
    vec3 near = min(a, b), far = max(a, b);
    return vec2(max(max(near.x, near.y), near.z), min(min(far.x, far.y), far.z));
}

// Distances of entry and exit, entry not before the origin; entry >= exit: the ray misses.
vec2 box_range(vec3 origin, vec3 direction, vec3 low, vec3 high) {
    vec2 range = box_range_unclamped(origin, direction, low, high);
    return vec2(max(range.x, 0.0), range.y);
}

// Distance to the exit for an origin inside the box; 0 outside of it, if the ray points away.
float box_exit(vec3 origin, vec3 direction, vec3 low, vec3 high) {
    return max(box_range_unclamped(origin, direction, low, high).y, 0.0);
}
