// Lines round what is drawn, and along its creases, as in a drawing: where the depth jumps, and where
// the normal turns. outline { from = scene } takes both from a pass geometry; over { lines, picture }
// lays the lines over a picture.
//
// The published way compares the depths of opposite neighbours, which also marks ground that is seen
// flat. Here a jump is what keeps the depth from running on straight: the inverse of the depth is linear
// in the picture on every plane, however it is turned, so that its second difference is zero there.
//@ option mode = planes {planes, published} : planes: no lines on what is flat; published: wherever opposite neighbours differ by `depth_step`
//@ option side = both {both, outside} : of an edge: outside: on what is behind only, so that thin things keep their colour; of mode planes
uniform sampler2D depth;         //= input : depth of the scene (m)
uniform sampler2D normal;        //= input optional : normals of its surfaces
uniform vec3 color;              //= {0, 0, 0} [0, 1000] color : of the lines
uniform float opacity;           //= 1 [0, 1] : of the lines
uniform float thickness;         //= 2.5 [0, 64] : of the lines, in pixels of a picture of 1080 rows
uniform float depth_threshold;   //= 0.02 [0, 1] : jump that makes a line, as a part of the distance; 1: none
uniform float depth_step;        //= 0.5 [0, 1000] m : of mode published: difference that makes a line
uniform float normal_threshold;  //= 50 [0, 180] degrees : turn of the surface that makes a line; 0: none
uniform float reach;             //= 0 [0, inf] m : distance at which lines have become as thin as nothing; 0: they never do
writeonly uniform image2D image; //= output rgba16f : premultiplied colour and opacity
#include "lib/frame.glsl"

const float PI = 3.14159265;
const float THINNEST = 0.75; // pixels: lines of a smaller half become fainter instead
const int PAIRS = 8;         // of opposite taps on the circle that is as wide as the line
const float SURE = 0.3;      // part of them that lie across an edge where a line is full
const float STEEP = 6.0;     // sum of the slopes of two faces that are seen at 70 degrees each

float depth_at(ivec2 texel) {
    return texelFetch(depth, clamp(texel, ivec2(0), textureSize(depth, 0) - 1), 0).r;
}

vec3 normal_at(ivec2 texel) {
#if HAS_NORMAL
    return texelFetch(normal, clamp(texel, ivec2(0), textureSize(normal, 0) - 1), 0).xyz;
#else
    return vec3(0.0);
#endif
}

// Where a fold, seen steeply from both sides, has a second difference as well; what is less than that is
// none. For lines of `radius` pixels.
float least_jump(float radius, int rows) {
    return max(depth_threshold, STEEP * radius * 2.0 * frame.lens.y / float(rows));
}

// 1 where there is one, 0 where there is none; -1 on the side of it that shall have no line: the nearer.
float jump_at(float a, float middle, float b, float least) {
#if MODE == MODE_PUBLISHED
    return abs(a - b) >= depth_step ? 1.0 : 0.0;
#else
    float wa = 1.0 / a, wm = 1.0 / middle, wb = 1.0 / b, bend = wa + wb - 2.0 * wm;
    if (depth_threshold >= 1.0 || abs(bend) < least * max(max(wa, wb), wm)) return 0.0;
    return SIDE == SIDE_BOTH ? 1.0 : sign(bend);
#endif
}

bool is_crease(vec3 a, vec3 b, float least) {
    return HAS_NORMAL == 1 && normal_threshold > 0.0 && dot(a, a) > 0.0 && dot(b, b) > 0.0 && dot(a, b) < least;
}

struct edge_test {
    ivec2 pixel;
    float here;   // its depth
    float jump;   // least
    float crease; // greatest cosine
};

// Whether an edge runs between two points on opposite sides of the pixel.
bool is_edge(edge_test t, vec2 offset) {
    ivec2 a = t.pixel + ivec2(round(offset)), b = t.pixel - ivec2(round(offset));
    float jump = jump_at(depth_at(a), t.here, depth_at(b), t.jump);
    return jump == 0.0 ? is_crease(normal_at(a), normal_at(b), t.crease) : jump > 0.0;
}

// How much of the pixel a line covers: the closer its edge, the more of the pairs on a circle round the
// pixel have it between them. What is thinner than the line is found by a smaller circle.
float line_at(edge_test t, float radius) {
    int found = 0, inner = 0;
    for (int i = 0; i < PAIRS; i++) {
        float angle = PI * (float(i) + 0.5) / float(PAIRS);
        vec2 way = radius * vec2(cos(angle), sin(angle));
        if (is_edge(t, way)) found++;
        if ((i & 1) == 0 && radius > 2.0 && is_edge(t, 0.5 * way)) inner++;
    }
    return clamp(float(max(found, 2 * inner)) / (SURE * float(PAIRS)), 0.0, 1.0);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(image), seen = textureSize(depth, 0);
    if (any(greaterThanEqual(pixel, size))) return;
    ivec2 at = ivec2((vec2(pixel) + 0.5) * vec2(seen) / vec2(size)); // in pixels of the depth from here on
    float radius = (SIDE == SIDE_BOTH ? 0.5 : 1.0) * thickness * float(seen.y) / 1080.0;
    if (reach > 0.0) { // by what is nearest: the line belongs to that
        ivec2 d = ivec2(ceil(radius));
        float near = min(min(depth_at(at), min(depth_at(at + ivec2(d.x, 0)), depth_at(at - ivec2(d.x, 0)))),
                         min(depth_at(at + ivec2(0, d.y)), depth_at(at - ivec2(0, d.y))));
        radius *= clamp(1.0 - near / reach, 0.0, 1.0);
    }
    float faint = min(radius / THINNEST, 1.0), alpha = 0.0;
    radius = max(radius, THINNEST);
    edge_test t = edge_test(at, depth_at(at), least_jump(radius, seen.y), cos(radians(normal_threshold)));
    if (faint > 0.0) alpha = opacity * faint * line_at(t, radius);
    imageStore(image, pixel, vec4(alpha * color, alpha));
}
