// The sum along a ray.
#if !defined(WITHOUT_RAYS)
#include "team.glsl"

float pixel_width = 0.0; // of the ray, at a distance of a metre

struct ray_state {
    vec3 light;         // radiance so far
    vec3 transmittance; // what still shines through
    vec2 reach;         // opacities times distances, opacities
    float until;        // metres to the end of the last step in which there was anything
};

ray_state ray_begin() { return ray_state(vec3(0.0), vec3(1.0), vec2(0.0), 0.0); }

struct node { // the medium at a point of the ray
    float density;
    vec3 own;        // radiance that it adds in a metre
    vec3 scattering; // 1/m
};

float look_for_density(vec3 p, float at) { // metres along the ray
    grid_width = pixel_width * at;
    return medium_density(p);
}

node look(vec3 p, float at) {
    node n = node(look_for_density(p, at), vec3(0.0), vec3(0.0));
    if (n.density > 0.0) {
        n.own = medium_emission(p, n.density);
        n.scattering = n.density * medium_scattering(p);
    }
    return n;
}

node halfway(node a, node b) {
    return node(0.5 * (a.density + b.density), 0.5 * (a.own + b.own),
                0.5 * (a.scattering + b.scattering));
}

// The integral of exp(-x s) over s from 0 to 1, without cancellation.
vec3 held(vec3 x) {
    return mix((1.0 - exp(-x)) / max(x, 1e-6), 1.0 - x * (0.5 - x / 6.0), lessThan(x, vec3(1e-2)));
}

#if MAPS
#include "maps.glsl"
#endif

// A stretch of `length` metres that is everywhere as `n`, around the point `at` metres along.
void add_stretch(inout ray_state ray, node n, vec3 lit, float length, float at) {
    vec3 x = n.density * length * medium_extinction();
    vec3 whole = held(x);
    float gained = mean(ray.transmittance * x * whole);
    ray.light += ray.transmittance * whole * length * (n.own + n.scattering * lit);
#if MAPS
    maps_add(ray.transmittance * whole * length, n, lit, gained, length, at);
#endif
    ray.transmittance *= exp(-x);
    ray.reach += gained * vec2(at, 1.0);
    if (n.density > 0.0) ray.until = at + 0.5 * length;
}

void add_paper(inout ray_state ray, vec3 p, float part, float at) {
    ray.until = at;
    ray.reach += ray.transmittance.x * part * vec2(at, 1.0);
    ray.light += ray.transmittance * part * field_radiance(p);
#if MAPS
    maps_add(ray.transmittance * part, node(0.0, field_radiance(p), vec3(0.0)), vec3(0.0),
             ray.transmittance.x * part, 0.0, at);
#endif
    ray.transmittance *= 1.0 - part;
}

// ---- steps of one length ----------------------------------------------------------------------

struct walk {
    vec2 range;   // where the ray enters and leaves
    float last;   // how far samples may lie
    float usual;  // length of a step; the last may be shorter
    float offset; // where in a step its sample lies, in 0..1
    float held;   // as far as this there may be something
    int next;     // step, of the team's first thread
#if SKIPPING == SKIPPING_ON
    bricks_ray bricks;
#endif
};

float usual_step(float span) {
    return step_size > 0.0 ? max(step_size, span / 4096.0) : span / float(steps);
}

walk walk_begin(vec3 origin, vec3 direction, vec2 range, float last, float offset) {
    walk w;
    w.range = range;
    w.last = last;
    w.usual = usual_step(range.y - range.x);
    w.offset = offset;
    w.held = -1.0;
    w.next = 0;
#if SKIPPING == SKIPPING_ON
    if (brick_blocks.x == 0.0) w.held = 1e30;
    w.bricks = bricks_begin(origin, direction, box_min, box_max);
#endif
    return w;
}

struct site { // where a sample is taken
    bool taken;   // by this thread, if it is there at all
    float at;     // metres along the ray
    float width; // of its step (m)
};

site walk_step(walk w, int index) {
    float from = w.range.x + float(index) * w.usual;
    float length = min(w.usual, w.range.y - from), at = from + w.offset * length;
    return site(length > 1e-6 * (w.range.y - w.range.x) && at <= w.last, at, length);
}

// The team's next run of samples of which one or more may hold something; false at the end of the
// ray. The loop is around the search alone, so that neighbouring rays look for their next samples
// together, and then take them together.
bool walk_on(inout walk w, out site s) {
    while (walk_step(w, w.next).taken) {
        s = walk_step(w, w.next + team_place());
        w.next += team;
#if SKIPPING == SKIPPING_ON
        float until = w.held;
        if (s.taken && s.at >= w.held) {
            s.taken = bricks_hold(w.bricks, s.at, until);
            if (s.taken) w.held = until;
        }
        if (team_greatest(float(s.taken)) > 0.0) return true;
        float free = (max(until, s.at) - w.range.x) / w.usual - w.offset;
        w.next = max(w.next, int(ceil(team_greatest(free))));
#else
        return true;
#endif
    }
    return false;
}

#if MARCH_SOFTWARE
// A software device has no branches, only loops: it computes light for all rays of a subgroup where
// one of them asks for it, and where none does. So each looks for smoke first, in a loop of its own.
bool walk_to_smoke(inout walk w, vec3 origin, vec3 direction, inout int taken, out site s,
                   out float density) {
    density = 0.0;
    while (walk_on(w, s)) {
        density = look_for_density(origin + s.at * direction, s.at);
        taken++;
        if (density > 0.0) return true;
    }
    return false;
}

ray_state march_even(vec3 origin, vec3 direction, vec2 range, float offset) {
    ray_state ray = ray_begin();
    if (range.x >= range.y) return ray;
    walk w = walk_begin(origin, direction, range, range.y, offset);
    site s;
    float density;
    int taken = 0, dense = 0;
    while (walk_to_smoke(w, origin, direction, taken, s, density)) {
        vec3 p = origin + s.at * direction;
        node n = node(density, medium_emission(p, density), density * medium_scattering(p));
        dense++;
        bool lit = greatest(n.scattering) > 0.0;
        add_stretch(ray, n, lit ? scattered_light(p, direction) : vec3(0.0), s.width, s.at);
        if (mean(ray.transmittance) < early_exit) break;
    }
    count_samples(taken);
    count_dense(dense);
    return ray;
}
#else
ray_state march_even(vec3 origin, vec3 direction, vec2 range, float offset) {
    ray_state ray = ray_begin();
    if (range.x >= range.y) return ray;
    walk w = walk_begin(origin, direction, range, range.y, offset);
    site s;
    int taken = 0, dense = 0;
    while (walk_on(w, s)) {
        vec3 p = origin + s.at * direction;
        node n = node(0.0, vec3(0.0), vec3(0.0));
        if (s.taken) {
            n = look(p, s.at);
            taken++;
        }
#if TEAMS
        vec3 run_begin = ray.transmittance;
        ray.transmittance *= exp(-medium_extinction() * team_sum_before(n.density * s.width));
        if (mean(ray.transmittance) < early_exit) n.density = 0.0;
#endif
        if (n.density > 0.0) {
            dense++;
            bool lit = greatest(n.scattering) > 0.0;
            add_stretch(ray, n, lit ? scattered_light(p, direction) : vec3(0.0), s.width, s.at);
        }
#if TEAMS
        ray.transmittance = run_begin * exp(-medium_extinction() * team_sum(n.density * s.width));
#endif
        if (mean(ray.transmittance) < early_exit) break;
    }
    count_samples(taken);
    count_dense(dense);
    return ray;
}
#endif

// Samples that are taken for each look at what may be there. A software device looks for all rays of
// a subgroup where one of them has to, so there it does so less often, and takes some in vain.
const int RUN = MARCH_SOFTWARE != 0 ? 4 : 1;

// The next sample, whatever is there; false at the end of the ray.
bool walk_further(inout walk w, inout site s) {
    s = walk_step(w, w.next);
    w.next++;
    return s.taken;
}

// Section 3.6: `last`, how far samples may lie, weighs them and leaves the steps as they are.
ray_state march_paper(vec3 origin, vec3 direction, vec2 range, float last, float offset) {
    ray_state ray = ray_begin();
    if (range.x >= range.y) return ray;
    walk w = walk_begin(origin, direction, range, last, offset);
    site s;
    int taken = 0, dense = 0;
    while (walk_on(w, s)) {
        int left = RUN;
        do {
            vec3 p = origin + s.at * direction;
            float part = 0.0;
            if (s.taken) {
                grid_width = pixel_width * s.at;
                part = min(medium_density(p) * opacity / float(steps), 1.0);
                taken++;
            }
#if TEAMS
            vec3 run_begin = ray.transmittance;
            ray.transmittance *= team_product_before(1.0 - part);
            if (ray.transmittance.x < early_exit) part = 0.0;
#endif
            if (part > 0.0) {
                dense++;
                add_paper(ray, p, part, s.at);
            }
#if TEAMS
            ray.transmittance = run_begin * team_product(1.0 - part);
#endif
        } while (--left > 0 && ray.transmittance.x >= early_exit && walk_further(w, s));
        if (ray.transmittance.x < early_exit) break;
    }
    count_samples(taken);
    count_dense(dense);
    return ray;
}

// ---- steps as long as they may be -------------------------------------------------------------
#if ADAPTIVE

const float SHORTEST = 1.0 / 8192.0; // part of a ray that a step has at least
const int MOST_SAMPLES = 65000;

struct step_nodes { // of a step that may be halved
    int known;      // nodes so far: none, its begin, its end too
    node begin, end;
};

// What the pixel would change by if a step of `length` metres were taken as two halves.
float halving(ray_state ray, step_nodes s, node middle, float length) {
    node ends = halfway(s.begin, s.end);
    vec3 extinction = medium_extinction() * length;
    vec3 one = ends.density * extinction;
    vec3 two = 0.5 * (ends.density + middle.density) * extinction;
    vec3 own = 0.5 * length * abs(ends.own - middle.own) * held(two);
    return greatest(ray.transmittance * max(abs(exp(-one) - exp(-two)), own / (1.0 + ray.light)));
}

// The light where the sample in the middle of a step lies, for the whole of it.
vec3 light_of_step(step_nodes s, node middle, vec3 p, vec3 direction) {
    vec3 scattering = middle.scattering + s.begin.scattering + s.end.scattering;
    return greatest(scattering) > 0.0 ? scattered_light(p, direction) : vec3(0.0);
}

// A step whose middle is `at` metres along, as two halves, each with the mean of its ends.
void add_step(inout ray_state ray, step_nodes s, node middle, vec3 lit, float length, float at) {
    add_stretch(ray, halfway(s.begin, middle), lit, 0.5 * length, at - 0.25 * length);
    add_stretch(ray, halfway(middle, s.end), lit, 0.5 * length, at + 0.25 * length);
}

// A step has a sample at each end and one in the middle, and is halved until it is good enough: the
// middle is then the new end.
ray_state march_adaptive(vec3 origin, vec3 direction, vec2 range, float offset) {
    ray_state ray = ray_begin();
    float span = range.y - range.x;
    if (span <= 0.0) return ray;
    float usual = usual_step(span);
    float from = range.x, length = min(2.0 * usual * max(offset, 0.05), span);
    step_nodes s;
    s.known = 0;
    int turns = 0, taken = 0, dense = 0;
    while (length > 1e-6 * span && turns < MOST_SAMPLES) {
        float at = from + length * (s.known == 2 ? 0.5 : float(s.known));
        vec3 p = origin + at * direction;
        node n = node(0.0, vec3(0.0), vec3(0.0));
        turns++;
        if (may_hold(p)) {
            n = look(p, at);
            taken++;
            if (n.density > 0.0) dense++;
        }
        if (s.known < 2) {
            if (s.known++ == 0)
                s.begin = n;
            else
                s.end = n;
            continue;
        }
        float change = halving(ray, s, n, length);
        float least = max(max(0.125 * usual, SHORTEST * span), 0.25 * pixel_width * from);
        if (change > tolerance && length > least) {
            length *= 0.5;
            s.end = n;
            continue;
        }
        add_step(ray, s, n, light_of_step(s, n, p, direction), length, at);
        if (mean(ray.transmittance) < early_exit) break;
        from += length;
        // What halving changes falls with the cube of the length.
        if (change < 0.0625 * tolerance) length = min(2.0 * length, 8.0 * usual);
        s.begin = s.end;
        s.known = 1;
        length = min(length, range.y - from);
    }
    count_samples(taken);
    count_dense(dense);
    return ray;
}
#endif
#endif
