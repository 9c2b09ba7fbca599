// Motion of a particle over a step or the rest of one. Values of fields that change with time are
// those of the middle of the step, so that the midpoint rule is of second order in time, too.
#if CARRIED

void move(inout vec3 p, inout vec3 v, float h, inout float lifetime) {
    vec3 from = p;
    v = field_velocity(p);
#if INTEGRATOR == INTEGRATOR_RK2
    v = field_velocity(p + 0.5 * h * v);
#endif
    p += h * v;
#if CONTACTS
    if (contact_distance(p) >= 0.0) return;
    if (CONTACT == CONTACT_DIE) lifetime = 0.0;
    vec3 motion, n = contact_normal(p, motion);
    contact_settle(p, v, n, motion);
    v = h > 0.0 ? (p - from) / h : v; // as far as it came: drawing goes back along it
#endif
}

#else

// Acceleration and air stay what they are for a moment.
struct move_push {
    vec3 acceleration, air;
    float drag; // 1/s
};

move_push move_at(vec3 p, vec3 v) {
    move_push push;
    push.acceleration = vec3(0.0, 0.0, -gravity) + field_force(p);
    push.air = field_velocity(p);
    push.drag = drag + drag_square * length(v - push.air);
    return push;
}

// Then the way is known exactly, however strong the drag (an exponential integrator: Hochbruck and
// Ostermann, "Exponential integrators", 2010).
void move_on(move_push push, inout vec3 p, inout vec3 v, float h) {
    float kh = push.drag * h, left = exp(-kh);
    // Integrals of exp(-k t) and of what it lacks to 1, over k; by series where they would cancel.
    float once = kh > 0.02 ? (1.0 - left) / push.drag : h * (1.0 - kh * (0.5 - kh * (1.0 / 6.0)));
    float twice = kh > 0.02 ? (h - once) / push.drag : h * h * (0.5 - kh * (1.0 / 6.0 - kh * (1.0 / 24.0)));
    vec3 difference = v - push.air;
    p += h * push.air + once * difference + twice * push.acceleration;
    v = push.air + left * difference + once * push.acceleration;
}

#if CONTACTS
#define MOVE_LOOKS 8 // along the way of a step

struct move_entry { // the part of a way in which it enters something
    float low, high;     // shares of the way
    float before, after; // distances there
};

// Whether there is one on the way from p to q. A distance says how far nothing is, so that who is far
// away looks no further, and who is fast does not step over a thin wall (Hart, "Sphere tracing",
// 1996). What the picture shows is no such distance: nearer things may be at other pixels.
bool move_enters(vec3 p, vec3 q, out move_entry e) {
    float way = length(q - p), d = contact_distance(p);
    e = move_entry(0.0, 0.0, d, d);
    if (d <= 0.0) return contact_distance(q) < 0.0;
    if (HAS_DEPTH == 0 && way <= 0.5 * d) return false;
    for (int i = 0; i < MOVE_LOOKS && e.high < 1.0; i++) {
        e.low = e.high;
        e.before = e.after;
        e.high = HAS_DEPTH != 0 ? 1.0 : min(e.high + max(e.after / way, 1.0 / float(MOVE_LOOKS)), 1.0);
        e.after = contact_distance(mix(p, q, e.high));
        if (e.after < 0.0) return true;
    }
    return false;
}

// Goes on to where the surface is met, by the secant twice, is turned there, and goes the rest.
void move_against(move_push push, move_entry e, inout vec3 p, inout vec3 v, float h) {
    bool within = e.high == 0.0; // it begins there
    float share = within ? 0.0 : mix(e.low, e.high, e.before / (e.before - e.after));
    vec3 q = p, w = v, motion;
    move_on(push, q, w, share * h);
    float there = contact_distance(q);
    if (there != 0.0 && !within) {
        share = there > 0.0 ? mix(share, e.high, there / (there - e.after)) :
                              mix(e.low, share, e.before / (e.before - there));
        q = p, w = v;
        move_on(push, q, w, share * h);
    }
    vec3 n = contact_normal(q, motion);
    p = q;
    v = contact_turn(w, n, motion);
    move_on(push, p, v, h - share * h);
    contact_settle(p, v, n, motion);
}
#endif

void move(inout vec3 p, inout vec3 v, float h, inout float lifetime) {
    vec3 q = p, w = v;
    move_push push = move_at(p, v);
#if INTEGRATOR == INTEGRATOR_RK2
    move_on(push, q, w, 0.5 * h);
    push = move_at(q, w);
    q = p, w = v;
#endif
    move_on(push, q, w, h);
#if CONTACTS
    move_entry e;
    if (move_enters(p, q, e)) {
        if (CONTACT == CONTACT_DIE) lifetime = 0.0;
        else {
            move_against(push, e, p, v, h);
            return;
        }
    }
#endif
    p = q;
    v = w;
}

#endif
