// A ray for each pixel. Outside of the sphere that the surface can reach there is nothing to look for;
// within it a ray goes on by a part of the distance to the surface along the radius (sphere tracing,
// Hart 1996, of a height that is no distance: hence the part), and where it has crossed the surface,
// the place is sought between the last two points.
layout(local_size_x = 16, local_size_y = 16) in;

const int HALVINGS = 4;
float pixel_angle; // that a pixel is across, about

// What a ray finds first: where it crosses a surface, and, before that, where it passes one so closely
// that the surface covers a part of the pixel. Without the latter outlines would be stairs.
struct shell_hit {
    int shell; // -1: none
    float distance;
    int passed; // the shell that it passes; -1: none
    float passed_at, cover;
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

// Part of a pixel that a surface covers whose edge is that far from the pixel's middle; about, since
// the height is not the distance.
float cover_of(float height, float distance) {
    return clamp(1.0 - height / (distance * pixel_angle), 0.0, 1.0);
}

// The nearest crossing of one shell before the hit replaces that.
void cross_shell(int shell, shell_record s, vec3 way, float begin, inout shell_hit hit) {
    vec3 from = frame.eye.xyz - s.ball.xyz;
    float middle = -dot(from, way), most = s.ball.w * (1.0 + bounds.y) + abs(middle) * pixel_angle;
    vec3 nearest = from + middle * way;
    float half_chord = most * most - dot(nearest, nearest);
    if (half_chord <= 0.0) return;
    half_chord = sqrt(half_chord);
    float at = max(middle - half_chord, begin), last = min(middle + half_chord, hit.distance);
    if (at >= last) return;
    float height = above(s, from, way, at);
    bool sinking = false;
    for (int i = 0; i < steps && at < last; i++) {
        float before = at, height_before = height;
        at = min(at + max(stride * abs(height), (last - at) / float(steps - i)), last);
        height = above(s, from, way, at);
        bool crossed = (height > 0.0) != (height_before > 0.0);
#if SIDES == SIDES_FRONT
        crossed = crossed && height_before > 0.0;
#endif
        if (crossed) {
            hit.shell = shell;
            hit.distance = cross_between(s, from, way, before, at, height_before, height);
            return;
        }
        float cover = sinking && height > height_before ? cover_of(height_before, before) : 0.0;
        if (height_before > 0.0 && cover > hit.cover) {
            hit.passed = shell;
            hit.passed_at = before;
            hit.cover = cover;
        }
        sinking = height < height_before;
    }
}

shell_hit find(vec3 way, float begin, float end) {
    shell_hit hit = shell_hit(-1, end, -1, end, 0.0);
    for (uint i = 0u; i < shell_count; i++) {
        shell_record s = shell_records[i];
        if (!(s.ball.w > 0.0)) continue;
        shell_said = shell_facts_of(s);
        cross_shell(int(i), s, way, begin, hit);
    }
    return hit;
}

vec4 look_at(int shell, float distance, vec3 way, float end) {
    shell_record s = shell_records[shell];
    shell_said = shell_facts_of(s);
    vec3 p = frame.eye.xyz + distance * way, outward = normalize(p - s.ball.xyz);
    float displacement = shell_displaced(outward);
    return shell_look(outward, p, displacement, shell_normal(outward, displacement), end - distance);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(image);
    if (any(greaterThanEqual(pixel, size))) return;
    vec2 uv = (vec2(pixel) + 0.5) / vec2(size);
    vec3 ray = frame_ray(uv);
    float stop = shell_stop(uv), deep = length(ray), end = stop * deep, begin = frame.lens.z * deep;
    vec3 way = ray / deep;
    vec4 sum = vec4(0.0);
    float near = stop;
    pixel_angle = 2.0 * frame.lens.y / float(size.y);
    for (int i = 0; i < surfaces && sum.a < 0.998; i++) {
        shell_hit hit = find(way, begin, end);
        bool passes = hit.passed >= 0 && hit.passed_at < hit.distance;
        if (hit.shell < 0 && !passes) break;
        // Where it passes one and hits what is behind, the next turn finds the latter.
        float at = passes ? hit.passed_at : hit.distance;
        vec4 found = look_at(passes ? hit.passed : hit.shell, at, way, end);
        if (passes) found *= hit.cover;
        if (found.a >= 0.5 && near == stop) near = at / deep;
        sum += (1.0 - sum.a) * found;
        if (passes && hit.shell < 0) break;
        float beyond = passes ? 2.0 * at * pixel_angle : 1e-3 * shell_records[hit.shell].ball.w;
        begin = at + max(beyond, 1e-5 * at);
    }
    imageStore(image, pixel, sum);
    imageStore(front, pixel, vec4(near));
}
