// What particles meet: a signed distance, and what the picture shows. Both become one distance,
// whose zero is the surface.
#define CONTACTS (HAS_COLLIDE || HAS_DEPTH)
#if CONTACTS

#if HAS_DEPTH
// Depth of what the picture shows at a texel (m), and the ray there, one metre deep.
float contact_seen(ivec2 texel, out vec3 ray) {
    ray = frame_ray((vec2(texel) + 0.5) / vec2(textureSize(depth, 0)));
    return texelFetch(depth, texel, 0).r;
}

vec3 contact_seen_normal(ivec2 texel) {
#if HAS_NORMAL
    return texelFetch(normal, texel * textureSize(normal, 0) / textureSize(depth, 0), 0).xyz;
#else
    ivec2 last = textureSize(depth, 0) - 1;
    vec3 ray, right, down;
    float here = contact_seen(texel, ray);
    ivec2 way = ivec2(texel.x < last.x ? 1 : -1, texel.y < last.y ? 1 : -1);
    float x = contact_seen(texel + ivec2(way.x, 0), right), y = contact_seen(texel + ivec2(0, way.y), down);
    vec3 n = cross(x * right - here * ray, y * down - here * ray);
    n *= dot(n, ray) > 0.0 ? -1.0 : 1.0;
    return n / max(length(n), 1e-20);
#endif
}

// To the plane of what is seen in front of p or behind it; 1e9: nothing is, or too far in front.
float contact_picture(vec3 p, out vec3 n) {
    vec3 c = (frame.view * vec4(p, 1.0)).xyz, ray;
    n = vec3(0.0);
    if (-c.z < frame.lens.z) return 1e9;
    vec2 uv = frame_seen(c.xy, -c.z);
    if (any(lessThan(uv, vec2(0.0))) || any(greaterThanEqual(uv, vec2(1.0)))) return 1e9;
    ivec2 texel = ivec2(uv * vec2(textureSize(depth, 0)));
    float seen = contact_seen(texel, ray), gap = seen + c.z;
    if (seen > 1e8 || gap < -thickness) return 1e9;
    n = contact_seen_normal(texel);
    return gap * abs(dot(n, ray));
}
#endif

// What is left until p touches, below 0: it is inside by as much.
float contact_distance(vec3 p) {
    float d = 1e9;
#if HAS_COLLIDE
    d = field_collide(p);
#endif
#if HAS_DEPTH
    vec3 n;
    d = min(d, contact_picture(p, n));
#endif
    return d - clearance;
}

// The surface's at p, and how it moves there. The slope of a distance by four samples at the corners
// of a tetrahedron.
vec3 contact_normal(vec3 p, out vec3 motion) {
    motion = vec3(0.0);
#if HAS_DEPTH
    vec3 seen;
    float gap = contact_picture(p, seen);
#if HAS_COLLIDE
    if (gap < field_collide(p)) return seen;
#else
    return seen;
#endif
#endif
#if HAS_COLLIDE
    motion = field_collide_velocity(p);
    const vec2 k = vec2(1.0, -1.0);
    vec3 n = vec3(0.0);
    n += k.xyy * field_collide(p + contact_step * k.xyy) + k.yyx * field_collide(p + contact_step * k.yyx);
    n += k.yxy * field_collide(p + contact_step * k.yxy) + k.xxx * field_collide(p + contact_step * k.xxx);
    float steep = length(n);
    return steep > 0.0 ? n / steep : vec3(0.0, 0.0, 1.0);
#endif
}

// Speed after a blow: the part across the surface turned round, the part along it less by friction
// as Coulomb says.
vec3 contact_turn(vec3 v, vec3 n, vec3 motion) {
    vec3 relative = v - motion;
    float towards = -dot(relative, n);
    if (towards <= 0.0) return v;
    vec3 along = relative + towards * n;
    float speed = length(along), lost = friction * (1.0 + bounce) * towards;
    along *= speed > lost ? 1.0 - lost / speed : 0.0;
    return motion + along + bounce * towards * n;
}

// Where a particle that ends up inside is set, and what is left of its speed.
void contact_settle(inout vec3 p, inout vec3 v, vec3 n, vec3 motion) {
    float d = min(contact_distance(p), 0.0);
    p -= d * n;
    if (d < 0.0) v -= min(dot(v - motion, n), 0.0) * n;
}
#endif
