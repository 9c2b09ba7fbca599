// The base colour of a mesh that is drawn, for fragment shaders (src/pass/surfaces/drawn.h).
#include "lib/mesh_part.glsl"
uniform sampler2D mesh_texture;

// Clear (a < 0.5) where the texture has a hole. `tint`: of the instance.
vec4 mesh_color(vec2 uv, vec3 tint) {
    vec4 color = vec4(part.color.rgb * tint, part.color.a);
    if (part.flags.x != 0u) color *= texture(mesh_texture, uv);
    return color;
}
