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
// Goes on to where the surface is met, by the secant twice, is turned there, and goes the rest.
void move_against(move_push push, inout vec3 p, inout vec3 v, float h, float end) {
    float begin = contact_distance(p), share = begin > 0.0 ? begin / (begin - end) : 0.0;
    vec3 q = p, w = v, motion;
    move_on(push, q, w, share * h);
    float there = contact_distance(q);
    if (there != 0.0 && begin > 0.0) {
        share = there > 0.0 ? mix(share, 1.0, there / (there - end)) : share * begin / (begin - there);
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
    float end = contact_distance(q);
    if (end < 0.0) {
        if (CONTACT == CONTACT_DIE) lifetime = 0.0;
        else {
            move_against(push, p, v, h, end);
            return;
        }
    }
#endif
    p = q;
    v = w;
}

#endif
