// Burnt ground: colours that `geometry` found, darkened towards soot where a field says that fire has been.
//@ field float burnt = 0 : how much of it lies at a point; about 1 is black
uniform sampler2D albedo;          //= input : colours of the surfaces
uniform sampler2D depth;           //= input : where they are (m)
uniform vec3 soot;                 //= {0.028, 0.024, 0.022} [0, 1] : what is left
uniform float lift;                //= 1.2 [0, 100] m : how far below and above it is looked for, where it lies in cells
uniform writeonly image2D color;   //= output rgba16f : the colours, to be lit
#include "lib/frame.glsl"
#include "fields.glsl"

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    vec4 base = texelFetch(albedo, pixel, 0);
    vec3 p = frame.eye.xyz + frame_ray((vec2(pixel) + 0.5) / vec2(size)) * texelFetch(depth, pixel, 0).r;
    float here = 0.0;
    int reach = lift > 0.0 ? 1 : 0;
    if (base.a > 0.0) // both arms would be evaluated for the sky, too
        for (int i = -reach; i <= reach; i++) here = max(here, field_burnt(p + vec3(0.0, 0.0, lift * float(i))));
    imageStore(color, pixel, vec4(mix(base.rgb, soot, 1.0 - exp(-3.0 * here)), base.a));
}
