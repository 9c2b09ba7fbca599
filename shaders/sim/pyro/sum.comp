// Adds up what each group of another kernel has summed, by one group.
layout(local_size_x = 256) in;
uniform int groups, place; // the sum's place
layout(std430) readonly buffer PyroReport { vec4 report[]; };
layout(std430) writeonly buffer PyroSums { vec4 sums[]; };

shared vec4 parts[256];

void main() {
    uint i = gl_LocalInvocationIndex;
    vec4 sum = vec4(0.0);
    for (int k = int(i); k < groups; k += 256) sum += report[k];
    parts[i] = sum;
    for (uint step_ = 128u; step_ > 0u; step_ >>= 1) {
        barrier();
        if (i < step_) parts[i] += parts[i + step_];
    }
    if (i == 0u) sums[place] = parts[0];
}
