// Everything a shader can declare.
//@ option mode = fine {coarse, fine} : how
//@ counter samples : evaluations
uniform float strength; //= 0.2 [0, 1] m : how far
uniform int kind; //= soft {hard, soft} : an enumeration
uniform bool invert; //= false : a toggle
uniform sampler3D input_; //= input : a volume
writeonly uniform image2D color; //= output rgba16f : the picture
layout(std430) buffer Data { vec4 rows[]; };
struct ray { vec3 from, to; };
vec4 march(ray r) { return texture(input_, mix(r.from, r.to, strength)); }
void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    vec4 sum = rows[at.x & 7];
    for (int i = 0; i < 4; i++) sum += march(ray(vec3(at, i), vec3(1)));
    if (invert || kind == KIND_HARD) sum = -sum;
#if MODE == MODE_FINE
    sum *= 0.5;
#endif
    count_samples(1);
    imageStore(color, at, sum);
}
