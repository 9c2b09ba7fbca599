// From a particle to its splat: where it is seen, and what light comes from it.
#if defined(STAGE_PROJECT)

const float SMALL = 1.0;     // pixels: radius of those that are added to the four pixels around them
const float SHORT = 16.0;    // pixels: length of streaks that are added point by point
const float SMOOTH = 1.5;    // pixels: added to the radius of others (in squares), so that pixels miss nothing
const float VIEW_MOST = 1e12, FARTHEST = 1e5; // of density; of a streak's begin, pixels

float positive(float v, float most) { return v > 0.0 ? min(v, most) : 0.0; }

vec3 positive(vec3 v, float most) {
    return mix(vec3(0.0), min(v, most), greaterThan(v, vec3(0.0)));
}

// ---- light ------------------------------------------------------------------------------------

// Towards the eye, of light that falls on p and is scattered as smoke does it.
vec3 light_scattered(vec3 p, vec3 way) {
#if LIT == LIT_ON
#if HAS_LIGHTS && HAS_GLOW
    vec3 sum = lighting_scattered(p, -way, anisotropy);
    int count = lighting_declared();
#else
    vec3 sum = ambient * sky_mean();
    int count = light_count();
#endif
    for (int i = 0; i < count; i++) {
        light l = light_get(i);
        light_ray ray = light_at(l, p);
        vec3 reaches = ray.irradiance;
#if HAS_LIGHTS && HAS_SHADOW
        vec2 before = lighting_shadow(i, p);
        reaches *= before.y * exp(-lighting_extinction() * before.x);
#endif
        sum += reaches * phase_hg(dot(way, ray.direction), anisotropy);
    }
    return sum;
#else
    return vec3(1.0);
#endif
}

// What smoke between the eye and p lets through, by colour.
vec3 light_through(vec3 p, float chance) {
#if HAS_DENSITY
    vec3 way = p - frame.eye.xyz;
    float away = length(way);
    vec2 range = box_range(frame.eye.xyz, way / away, box_min, box_max);
    float span = (min(range.y, away) - range.x) / float(max(view_steps, 1)), passed = 0.0;
    if (span <= 0.0) return vec3(1.0);
    for (int i = 0; i < view_steps; i++) {
        vec3 at = frame.eye.xyz + (range.x + (float(i) + chance) * span) * way / away;
        passed += positive(field_density(at), VIEW_MOST);
    }
    return exp(-passed * span * extinction * (1.0 - (1.0 - albedo) * sqrt(absorption_color)));
#else
    return vec3(1.0);
#endif
}

// ---- place ------------------------------------------------------------------------------------

vec3 place_seen(vec3 p) { // pixels, and depth in metres
    vec3 v = (frame.view * vec4(p, 1.0)).xyz;
    return vec3(picture * frame_seen(v.xy, max(-v.z, 1e-6)), -v.z);
}

// Where the streak begins: not before the particle's birth, and no nearer than the camera sees.
vec3 place_before(particle p, float away) {
    float recedes = -(frame.view * vec4(p.velocity, 0.0)).z, back = min(streak, p.age);
    if (recedes > 0.0) back = min(back, (away - frame.lens.z) / recedes);
    return place_seen(p.position - back * p.velocity);
}

float cell_of(particle p) {
#if HAS_CELL
    return field_cell(p.position);
#else
    return particle_said.age * flipbook.x * flipbook.y;
#endif
}

// ---- splat ------------------------------------------------------------------------------------

struct looks {
    bool seen;
    splat s;     // its colour and opacity those of the middle, its radius as it is
    vec3 before; // where its streak begins
};

looks look_at(uint slot) {
    looks l;
    particle p;
    l.seen = false;
    if (slot >= particle_used || !particle_read(slot, p)) return l;
    vec3 seen = place_seen(p.position);
    if (!(seen.z >= frame.lens.z && seen.z <= frame.lens.w)) return l; // of no number, too
    particle_say(p);
    float meter = 0.5 * picture.y / (frame.lens.y * seen.z); // in pixels
    float radius = 0.5 * positive(field_size(p.position), 1e6) * meter;
    float opacity = positive(field_opacity(p.position), BLEND == BLEND_ADDITIVE ? MOST : 1.0);
    l.before = streak > 0.0 ? place_before(p, seen.z) : seen;
    if (!(distance(l.before, seen) < FARTHEST)) l.before = seen;
    vec2 around = vec2(2.0 * radius) + 4.0, low = min(seen.xy, l.before.xy), high = max(seen.xy, l.before.xy);
    if (radius <= 0.0 || opacity <= 0.0 || any(lessThan(high + around, vec2(0.0))) ||
        any(greaterThan(low - around, picture)))
        return l;
    vec3 way = normalize(p.position - frame.eye.xyz);
    vec3 through = light_through(p.position, particle_random(p.id, 65u));
    vec3 color = brightness * positive(field_color(p.position), MOST) * light_scattered(p.position, way);
    // What smoke hides of it hides nothing behind that smoke.
    float shows = (through.r + through.g + through.b) / 3.0;
    opacity *= shows;
    color *= through / max(shows, 1e-6);
    float turned = radians(field_angle(p.position));
    l.s = splat(seen.xy, seen.z, radius, vec2(cos(turned), -sin(turned)), 0.0, cell_of(p),
                positive(color, MOST), opacity, random_hash(floatBitsToUint(seen.x)) ^ floatBitsToUint(seen.y));
    l.seen = true;
    return l;
}

// Opacity or light of it all, in squares of its radius.
vec4 look_mean(splat s) {
#if HAS_SPRITE
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 16; i++) {
        vec4 c = sprite_at((vec2(i & 3, i >> 2) + 0.5) / 4.0, s.cell);
        sum += vec4(c.rgb * c.a, c.a);
    }
    return vec4(sum.rgb / max(sum.a, 1e-6), 4.0 * min(sum.a / 16.0, 1.0));
#else
    return vec4(1.0, 1.0, 1.0, ROUND_AREA);
#endif
}

// Wide enough that pixels between its middle and its end do not miss it, and drawn out along its way:
// as much fainter as it covers more.
splat look_spread(looks l) {
    splat s = l.s;
    vec2 way = s.at - l.before.xy;
    float length = length(way);
    s.radius = sqrt(l.s.radius * l.s.radius + SMOOTH * SMOOTH);
    s.reach = 0.5 * length;
    if (length > 1e-3) {
        s.along = way / length;
        s.at -= 0.5 * way;
    }
#if HAS_SPRITE
    float covers = s.radius * (s.radius + s.reach);
#else
    float covers = s.radius * (s.radius + 2.0 * s.reach * ROUND_LINE / ROUND_AREA);
#endif
    s.opacity *= l.s.radius * l.s.radius / covers;
    return splat_rounded(s);
}
#endif
