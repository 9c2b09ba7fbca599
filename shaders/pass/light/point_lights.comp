// Point lights by the hundred, for `shade` and `forward`: where they are, how they shine and how far they reach is said once, by fields.
//
// point_lights { count = 200, position = vec(3 * sin(time + light_index), 0, 2), color = {1, 0.6, 0.3} }
// gives an image that shade { from = {scene, point_lights} } reads. Fields are evaluated for each light:
// `position` at the origin, the others where the light then is. They may use light_index (0, 1, 2 ...)
// and light_random (0..1). With at = instances there is one for each, which moves with it, and fields
// may use instance_state and the like: power = 200 * instance_state.x is a fire that the script lights.
//@ field vec3 position = {0, 0, 0} : where it is (m); with `at`: in the space of its instance, as the mesh is
//@ field vec3 color = {1, 1, 1} : multiplies the power
//@ field float power = 100 : as light into all directions (W); 0: it is off, and costs next to nothing
//@ field float range = 10 : how far it reaches (m): beyond, nothing is lit. What is lit is what it costs
//@ field float radius = 0 : of the sphere that glows (m); no point gets more than one on it
uniform int falloff;              //= inverse_square {inverse_square, linear} : inverse_square: as light does, let down smoothly to 0 at the range; linear: 1 - distance / range, times what the other gives at a metre
uniform uint seed;                //= 0 [0, 16777215] : another one gives other random numbers
writeonly uniform image2D point_lights;  //= output rgba32f : a row of four texels for each, a light_entry (shaders/shared.h)
uniform uint point_light_total;
uniform mat4 point_light_group; // of `at`: where all instances are

#include "shared.h"
#include "lib/frame.glsl"
#include "lib/random.glsl"
#include "lib/point_light.glsl"
#include "lib/instance.glsl"
#include "fields.glsl"

layout(local_size_x = 64) in;

const float FARTHEST = 1e6, BRIGHTEST = 1e12; // m; W/sr

float positive(float v, float most) { return v > 0.0 ? min(v, most) : 0.0; }

vec3 positive(vec3 v, float most) {
    return mix(vec3(0.0), min(v, most), greaterThan(v, vec3(0.0)));
}

bool is_place(vec3 p) {
    return all(lessThan(abs(p), vec3(FARTHEST))); // false for what is no number, too
}

#if POINT_LIGHTS_AT
layout(std430) readonly buffer Instances { instance_entry point_light_instances[]; };

vec3 place_of(uint index) {
    instance_entry at = point_light_instances[index];
    instance_say(at);
    return (point_light_group * vec4(instance_point(at, field_position(vec3(0.0))), 1.0)).xyz;
}
#else
vec3 place_of(uint index) {
    return field_position(vec3(0.0));
}
#endif

light_entry entry_of(uint index) {
    point_light_current = point_light_facts(float(index), float(random_hash(index + random_hash(seed)) >> 8) / 16777216.0);
    vec3 p = place_of(index);
    light_entry e = light_entry(vec4(0.0), vec4(vec3(0.0), LIGHT_POINT), vec4(0.0), vec4(0.0));
    if (!is_place(p)) return e;
    vec3 shines = positive(field_color(p) * positive(field_power(p), BRIGHTEST), BRIGHTEST) / (4.0 * 3.14159265);
    float reach = any(greaterThan(shines, vec3(0.0))) ? positive(field_range(p), FARTHEST) : 0.0;
    e.position = vec4(p, positive(field_radius(p), FARTHEST));
    e.color.rgb = reach > 0.0 ? shines : vec3(0.0);
    e.spread = vec4(0.0, reach, float(falloff), 0.0);
    return e;
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= point_light_total) return;
    light_entry e = entry_of(index);
    imageStore(point_lights, ivec2(0, index), e.position);
    imageStore(point_lights, ivec2(1, index), e.color);
    imageStore(point_lights, ivec2(2, index), e.axis);
    imageStore(point_lights, ivec2(3, index), e.spread);
}
