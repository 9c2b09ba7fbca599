// Particles, counted: how many are alive, and the means of their height, age and quantity.
#include "lib/particles.glsl"
writeonly uniform image2D color; //= output rgba16f : these four
void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, imageSize(color)))) return;
    vec4 sum = vec4(0.0);
    for (uint slot = 0u; slot < particle_used; slot++) {
        particle p;
        if (particle_read(slot, p)) sum += vec4(1.0, p.position.z, p.age, p.quantity);
    }
    imageStore(color, at, vec4(sum.x, sum.yzw / max(sum.x, 1.0)));
}
