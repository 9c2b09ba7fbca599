layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) buffer Data { vec4 rows[]; } data;
layout(std140, binding = 1) uniform Uniforms { float a; int b; vec2 c; vec3 d; vec4 e; mat4 f; vec4 g[3]; uint h; };
layout(binding = 2) uniform sampler3D volume;
layout(binding = 3, rgba16f) writeonly uniform image2D color;
layout(binding = 4, r32ui) uniform uimage3D cells;
layout(std430, binding = 5) readonly buffer In { uint words[]; };
shared float tile[64];
void main() {
    uint i = gl_LocalInvocationIndex;
    tile[i] = texture(volume, d).x + float(words[i & 3u]);
    barrier();
    data.rows[i] = f * e + g[b % 3] + vec4(tile[(i + h) % 64u], a, c);
    imageStore(color, ivec2(i), data.rows[i]);
    imageAtomicAdd(cells, ivec3(i), 1u);
}
