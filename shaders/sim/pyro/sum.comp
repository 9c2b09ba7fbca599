// Adds up what each group of another kernel has summed, by one group.
layout(local_size_x = 256) in;
uniform int groups, place, vectors; // of each group; sums begin at a place
layout(std430) readonly buffer PyroReport { vec4 report[]; };
layout(std430) writeonly buffer PyroSums { vec4 sums[]; };

shared vec4 parts[256];

vec4 sum_of(int vector) {
    uint i = gl_LocalInvocationIndex;
    vec4 sum = vec4(0.0);
    for (int k = int(i); k < groups; k += 256) sum += report[vectors * k + vector];
    parts[i] = sum;
    for (uint step_ = 128u; step_ > 0u; step_ >>= 1) {
        barrier();
        if (i < step_) parts[i] += parts[i + step_];
    }
    barrier();
    return parts[0];
}

void main() {
    for (int n = 0; n < vectors; n++) {
        vec4 sum = sum_of(n);
        if (gl_LocalInvocationIndex == 0u) sums[place + n] = sum;
        barrier();
    }
}
