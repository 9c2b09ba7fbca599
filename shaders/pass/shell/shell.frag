// What a mesh looks like that shell.vert draws: the same as where a ray meets it.
#include "face.glsl"
#include "surface.glsl"
uniform vec2 picture; // pixels
uniform uint shell_at;
uniform bool far_side; // only what faces away is drawn, else only what faces the eye
layout(location = 0) in vec3 place;
layout(location = 1) in float away;
layout(location = 0) out vec4 image;
layout(location = 1) out vec4 front; // laid over what is there, where its alpha is 1

void main() {
    if (gl_FrontFacing == far_side) discard;
    float stop = shell_stop(gl_FragCoord.xy / picture);
    if (away >= stop) discard;
    shell_record s = shell_records[shell_at];
    shell_said = shell_facts_of(s);
    vec3 way = normalize(place - s.ball.xyz);
    float longer = length(place - frame.eye.xyz) / away;
    image = shell_look(way, place, (stop - away) * longer);
    if (image.a == 0.0) discard;
    front = image.a >= 0.5 ? vec4(away, 0.0, 0.0, 1.0) : vec4(0.0);
}
