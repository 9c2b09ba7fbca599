// A ray for each pixel. Outside of the sphere that the surface can reach there is nothing to look for;
// within it a ray goes on by a part of the distance to the surface along the radius (sphere tracing,
// Hart 1996, of a height that is no distance: hence the part), and where it has crossed the surface,
// the place is sought between the last two points.
layout(local_size_x = 16, local_size_y = 16) in;

const int HALVINGS = 4;

struct shell_hit {
    int shell; // -1: none
    float distance;
};

// Metres above the surface; `from`: the eye, seen from the centre.
float above(shell_record s, vec3 from, vec3 way, float distance) {
    vec3 p = from + distance * way;
    float away = max(length(p), 1e-9);
    count_evaluated(1);
    return away - s.ball.w * (1.0 + shell_displaced(p / away));
}

// Where it crosses the surface between two distances, whose heights are of different sign.
float cross_between(shell_record s, vec3 from, vec3 way, float a, float b, float height_a, float height_b) {
    for (int i = 0; i < HALVINGS; i++) {
        float middle = mix(a, b, clamp(height_a / (height_a - height_b), 0.1, 0.9));
        float height = above(s, from, way, middle);
        bool near = (height > 0.0) == (height_a > 0.0);
        a = near ? middle : a;
        height_a = near ? height : height_a;
        b = near ? b : middle;
        height_b = near ? height_b : height;
    }
    return mix(a, b, height_a / (height_a - height_b));
}

// The nearest crossing of one shell between two distances, else `end`.
float cross_shell(shell_record s, vec3 way, float begin, float end) {
    vec3 from = frame.eye.xyz - s.ball.xyz;
    float most = s.ball.w * (1.0 + bounds.y), middle = -dot(from, way);
    vec3 nearest = from + middle * way;
    float half_chord = most * most - dot(nearest, nearest);
    if (half_chord <= 0.0) return end;
    half_chord = sqrt(half_chord);
    float at = max(middle - half_chord, begin), last = min(middle + half_chord, end);
    if (at >= last) return end;
    float height = above(s, from, way, at);
    for (int i = 0; i < steps && at < last; i++) {
        float before = at, height_before = height;
        at = min(at + max(stride * abs(height), (last - at) / float(steps - i)), last);
        height = above(s, from, way, at);
        bool crossed = (height > 0.0) != (height_before > 0.0);
#if SIDES == SIDES_FRONT
        crossed = crossed && height_before > 0.0;
#endif
        if (crossed) return cross_between(s, from, way, before, at, height_before, height);
    }
    return end;
}

shell_hit find(vec3 way, float begin, float end) {
    shell_hit hit = shell_hit(-1, end);
    for (uint i = 0u; i < shell_count; i++) {
        shell_record s = shell_records[i];
        if (!(s.ball.w > 0.0)) continue;
        shell_said = shell_facts_of(s);
        float distance = cross_shell(s, way, begin, hit.distance);
        if (distance < hit.distance) hit = shell_hit(int(i), distance);
    }
    return hit;
}

vec4 look_at(shell_hit hit, vec3 way, float end) {
    shell_record s = shell_records[hit.shell];
    shell_said = shell_facts_of(s);
    vec3 p = frame.eye.xyz + hit.distance * way, outward = normalize(p - s.ball.xyz);
    float displacement = shell_displaced(outward);
    return shell_look(outward, p, displacement, shell_normal(outward, displacement), end - hit.distance);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(image);
    if (any(greaterThanEqual(pixel, size))) return;
    vec2 uv = (vec2(pixel) + 0.5) / vec2(size);
    vec3 ray = frame_ray(uv);
    float stop = shell_stop(uv), deep = length(ray), end = stop * deep, begin = frame.lens.z * deep;
    vec3 way = ray / deep;
    vec4 sum = vec4(0.0);
    float near = 1e9;
    for (int i = 0; i < surfaces && sum.a < 0.998; i++) {
        shell_hit hit = find(way, begin, end);
        if (hit.shell < 0) break;
        vec4 found = look_at(hit, way, end);
        if (found.a >= 0.5 && near == 1e9) near = hit.distance / deep;
        sum += (1.0 - sum.a) * found;
        begin = hit.distance + max(1e-3 * shell_records[hit.shell].ball.w, 1e-5 * hit.distance);
    }
    imageStore(image, pixel, sum);
    imageStore(front, pixel, vec4(near));
}
