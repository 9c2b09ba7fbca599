// Which point lights get maps: those of the greatest strength, found one after the other. It is
// counted anew in each frame, so that a frame never depends on the one before.
shared uint chosen[SHADOW_POINTS + 1]; // lights, and the first that gets none; NOBODY: there are no more
shared uint strengths[SHADOW_POINTS + 1]; // as bits, which are ordered as the numbers are
const uint NOBODY = 0xffffffffu;
const float FAINT = 0.01; // W/m^2: where less arrives a light without a range counts as ended

// How far it reaches, metres.
float reach_of(light_entry e) {
    float most = max(e.color.r, max(e.color.g, e.color.b));
    return e.spread.y > 0.0 ? e.spread.y : sqrt(most / FAINT);
}

// Whether a sphere meets the camera's pyramid, or does so nearly.
bool is_in_sight(vec3 centre, float radius) {
    vec3 seen = (frame.view * vec4(centre, 1.0)).xyz;
    vec2 across = frame_across(), slack = radius * sqrt(1.0 + across * across);
    return seen.z < radius && all(lessThan(abs(seen.xy) + seen.z * across, slack));
}

// Light that would reach the camera, of one whose reach is in sight: the part of the picture that
// it lights goes with that. 0: it needs no maps.
float strength_of(int index) {
    if (!competes(index)) return 0.0;
    light_entry e = candidate_of(index);
    float most = max(e.color.r, max(e.color.g, e.color.b));
    if (!(most > 0.0) || !is_in_sight(e.position.xyz, reach_of(e))) return 0.0;
    vec3 away = e.position.xyz - frame.eye.xyz;
    return most / max(dot(away, away), 1.0);
}

bool is_chosen(uint index, int count) {
    bool found = false;
    for (int i = 0; i < count; i++) found = found || chosen[i] == index;
    return found;
}

void choose_points(int thread) {
    int count = shadow_candidates();
    for (int k = 0; k <= SHADOW_POINTS; k++) {
        if (thread == 0) chosen[k] = NOBODY;
        if (thread == 0) strengths[k] = 0u;
        barrier();
        uint best = 0u, who = NOBODY;
        for (int i = thread; i < count; i += SHADOW_GROUP) {
            uint strength = is_chosen(uint(i), k) ? 0u : floatBitsToUint(strength_of(i));
            if (strength > best) who = uint(i);
            best = max(best, strength);
        }
        if (best > 0u) atomicMax(strengths[k], best);
        barrier();
        if (best > 0u && best == strengths[k]) atomicMin(chosen[k], who);
        barrier();
    }
}

// How dark the shadows of the k-th are.
float fade_of(int k) {
    float mine = uintBitsToFloat(strengths[k]), first = uintBitsToFloat(strengths[SHADOW_POINTS]);
    return first == 0.0 || point_fade == 0.0 ? 1.0 : clamp((mine - first) / (point_fade * mine), 0.0, 1.0);
}
