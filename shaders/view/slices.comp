// A slice of flow as a person looks at it: the whole of it over the whole picture, y upwards. Dye is
// bright; pressure green where it is raised and red where it is lowered (Krueger and Westermann 2005);
// velocity has the colour of its direction, and arrows.
layout(std140) uniform View {
    vec4 scale;  // x: 1 / what is brightest; y: middle of the slice in the image, 0 to 1; z: pixels between arrows
    ivec4 field; // x: of roil_slices_field; y: its channel
};
uniform sampler3D image; // x, y, slice
layout(rgba8) writeonly uniform image2D canvas;

const int TEMPERATURE = 1, PRESSURE = 3, VELOCITY = 4;
const vec3 GROUND = vec3(0.08); // colours are those of the display
const float THIRD = 2.0943951;

vec4 look(vec2 pixel, vec2 size) {
    vec2 at = pixel / size;
    return texture(image, vec3(at.x, 1.0 - at.y, scale.y));
}

// Black, red, orange, white.
vec3 heat(float t) { return clamp(vec3(2.4, 1.5, 3.0) * t - vec3(0.0, 0.5, 2.0), 0.0, 1.0); }

vec3 hue(vec2 v) {
    float angle = atan(v.y, v.x);
    return 0.5 + 0.5 * cos(vec3(angle, angle - THIRD, angle + THIRD));
}

vec3 color_of(vec4 value) {
    if (field.x == VELOCITY) {
        float speed = length(value.xy) * scale.x;
        vec3 whereto = speed > 0.0 ? hue(value.xy) : vec3(0.0);
        return GROUND + 0.6 * pow(min(speed, 1.0), 0.7) * (0.25 + 0.75 * whereto);
    }
    float v = value[field.y] * scale.x;
    if (field.x == PRESSURE) return GROUND + clamp(vec3(-0.9 * v, 0.75 * v, 0.0), 0.0, 0.9);
    float t = sqrt(clamp(v, 0.0, 1.0));
    return field.x == TEMPERATURE ? GROUND + 0.9 * heat(t) : GROUND + t * vec3(0.86, 0.88, 0.9);
}

float segment(vec2 p, vec2 a, vec2 b) { // distance
    vec2 along = b - a;
    float t = clamp(dot(p - a, along) / max(dot(along, along), 1e-6), 0.0, 1.0);
    return distance(p, a + t * along);
}

// How much of the pixel an arrow covers: one in each square, as long as the flow there is fast.
float arrow(vec2 pixel, vec2 size) {
    vec2 middle = (floor(pixel / scale.z) + 0.5) * scale.z;
    vec2 v = look(min(middle, size - 0.5), size).xy * vec2(1.0, -1.0) * scale.x;
    float speed = length(v);
    if (speed < 0.02) return 0.0;
    vec2 way = v / speed, across = vec2(-way.y, way.x);
    float half_length = 0.5 * scale.z * clamp(speed, 0.15, 0.95), head = 0.6 * half_length;
    vec2 p = pixel - middle, tip = way * half_length;
    float d = segment(p, -tip, tip);
    d = min(d, segment(p, tip, tip - (way + 0.6 * across) * head));
    d = min(d, segment(p, tip, tip - (way - 0.6 * across) * head));
    return clamp(1.2 - d, 0.0, 1.0);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(canvas);
    if (any(greaterThanEqual(pixel, size))) return;
    vec2 at = vec2(pixel) + 0.5;
    vec3 color = color_of(look(at, vec2(size)));
    if (field.x == VELOCITY && scale.z > 0.0) color = mix(color, vec3(0.95), 0.8 * arrow(at, vec2(size)));
    imageStore(canvas, pixel, vec4(color, 1.0));
}
