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

struct shell_span { // of a ray
    float at, height; // where it is (m)
    bool sinking;     // it is nearer to the surface than before
    float end, end_height; // once it has crossed: where it was then
};

// Metres above the surface; `from`: the eye, seen from the centre.
float above(shell_record s, vec3 from, vec3 way, float distance) {
    vec3 p = from + distance * way;
    float away = max(length(p), 1e-9);
    count_evaluated(1);
    return away - s.ball.w * (1.0 + shell_displaced(p / away));
}

float next_step(shell_span span, float last, int left) {
    return min(span.at + max(stride * abs(span.height), (last - span.at) / float(max(left, 1))), last);
}

// Part of a pixel that a surface covers whose edge is that far from the pixel's middle; about, since
// the height is not the distance.
float cover_of(float height, float distance) {
    return clamp(1.0 - height / (distance * pixel_angle), 0.0, 1.0);
}

// Where it comes nearest to a surface and does not meet it.
void pass_by(int shell, shell_span span, float height, inout shell_hit hit) {
    float cover = span.sinking && height > span.height ? cover_of(span.height, span.at) : 0.0;
    if (span.height <= 0.0 || cover <= hit.cover) return;
    hit.passed = shell;
    hit.passed_at = span.at;
    hit.cover = cover;
}

bool crosses(float before, float height) {
#if SIDES == SIDES_FRONT
    return before > 0.0 && height <= 0.0;
#else
    return (before > 0.0) != (height > 0.0);
#endif
}

// The part of a ray in the sphere that a shell can reach; false: there is none.
bool reach_of(shell_record s, vec3 from, vec3 way, inout float begin, inout float end) {
    float middle = -dot(from, way), most = s.ball.w * (1.0 + bounds.y) + abs(middle) * pixel_angle;
    vec3 nearest = from + middle * way;
    float square = most * most - dot(nearest, nearest);
    if (square <= 0.0) return false;
    begin = max(middle - sqrt(square), begin);
    end = min(middle + sqrt(square), end);
    return begin < end;
}

// The nearest crossing of one shell before the hit replaces that. The loop goes on by steps, and once
// it has crossed by parts of the last one: the height is asked for in one place, since its code is long.
void cross_shell(int shell, shell_record s, vec3 way, float begin, inout shell_hit hit) {
    vec3 from = frame.eye.xyz - s.ball.xyz;
    float at = begin, last = hit.distance;
    if (!reach_of(s, from, way, at, last)) return;
    shell_span span;
    int left = steps + 1, halvings = -2; // -1: it has not crossed yet, -2: nor begun
    while (left-- > 0) {
        float height = above(s, from, way, at);
        bool first = halvings == -2;
        if (first || (halvings < 0 && !crosses(span.height, height))) {
            if (!first) pass_by(shell, span, height, hit);
            if (at >= last) return;
            span = shell_span(at, height, !first && height < span.height, at, 0.0);
            halvings = -1;
            at = next_step(span, last, left);
            continue;
        }
        if (halvings < 0) left = HALVINGS + 1;
        if (halvings < 0 || (height > 0.0) != (span.height > 0.0)) {
            span.end = at;
            span.end_height = height;
        } else {
            span.at = at;
            span.height = height;
        }
        float part = span.height / (span.height - span.end_height);
        if (++halvings == HALVINGS) {
            hit.shell = shell;
            hit.distance = mix(span.at, span.end, part);
            return;
        }
        at = mix(span.at, span.end, clamp(part, 0.1, 0.9));
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
    vec3 p = frame.eye.xyz + distance * way;
    return shell_look(normalize(p - s.ball.xyz), p, end - distance);
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
