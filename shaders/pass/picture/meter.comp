// Automatic exposure: the stops that bring a picture's mean to the key, followed over time as an eye
// adapts.
//
// The mean is that of the logarithm of the luminance (Reinhard et al. 2002, section 3.1), of the
// pixels between two percentiles: neither a black background nor a few glowing pixels count. Black
// pixels do not count at all: a histogram has no place for them.
#include "lib/color.glsl"
#include "lib/frame.glsl"
uniform sampler2D source;           //= input : the picture, scene-linear
uniform sampler2D before;           //= input history exposure : that of the last frame
uniform float key;                  //= 0.18 [0.001, 10] : what the mean becomes
uniform float low;                  //= 0.5 [0, 1] : part of the pixels, from the darkest, that does not count
uniform float high;                 //= 0.98 [0, 1] : part of the pixels up to which they count
uniform float min_ev;               //= -8 [-20, 20] EV : least exposure
uniform float max_ev;               //= 8 [-20, 20] EV : most exposure
uniform float brighten;             //= 1 [0, 100] s : time constant of the way to a higher exposure; 0: at once
uniform float darken;               //= 0.3 [0, 100] s : time constant of the way to a lower exposure; 0: at once
writeonly uniform image2D exposure; //= output rg32f : stops of exposure; 1 from the first picture that is not black

layout(local_size_x = 16, local_size_y = 16) in;

const int BINS = 256;         // eight a stop
const float LOWEST = -16.0;   // log2 of the luminance at which they begin
const float PER_STOP = 8.0;
const int SIDE = 128;         // pixels that are looked at are at most 128 by 128
const float PARTS = 65535.0;  // of a bin

shared uint count[BINS];
shared uint place[BINS]; // of all samples of a bin: how far into it they lie

void add(float l) {
    if (!(l > exp2(LOWEST)) || isinf(l)) return;
    float at = min((log2(l) - LOWEST) * PER_STOP, float(BINS) - 1e-3);
    atomicAdd(count[int(at)], 1u);
    atomicAdd(place[int(at)], uint(fract(at) * PARTS + 0.5));
}

// Mean log2 of the luminance between the percentiles. A bin that lies in part between them counts in
// part.
float mean_log(float total) {
    float from = min(low, high) * total, to = max(low, high) * total;
    if (to - from < 1.0) to = min(from + 1.0, total), from = to - 1.0; // the percentile itself
    float seen = 0.0, sum = 0.0;
    for (int i = 0; i < BINS; i++) {
        float here = float(count[i]);
        if (here == 0.0) continue;
        float part = clamp(to - seen, 0.0, here) - clamp(from - seen, 0.0, here);
        sum += part * (float(i) + float(place[i]) / PARTS / here);
        seen += here;
    }
    return LOWEST + sum / ((to - from) * PER_STOP);
}

void main() {
    int thread = int(gl_LocalInvocationIndex);
    count[thread] = 0u;
    place[thread] = 0u;
    barrier();
    ivec2 size = textureSize(source, 0), grid = min(size, ivec2(SIDE));
    for (int i = thread; i < grid.x * grid.y; i += BINS) {
        vec2 at = (vec2(i % grid.x, i / grid.x) + 0.5) / vec2(grid);
        add(luminance(texelFetch(source, ivec2(at * vec2(size)), 0).rgb));
    }
    barrier();
    if (thread > 0) return;
    float total = 0.0;
    for (int i = 0; i < BINS; i++) total += float(count[i]);
    vec2 last = texelFetch(before, ivec2(0), 0).rg;
    float target = total > 0.0 ? log2(key) - mean_log(total) : last.r;
    target = clamp(target, min_ev, max(min_ev, max_ev));
    float seconds = target > last.r ? brighten : darken;
    float gone = last.g == 0.0 || seconds == 0.0 ? 1.0 : 1.0 - exp(-max(frame.time.y, 0.0) / seconds);
    float ev = mix(last.r, target, gone);
    imageStore(exposure, ivec2(0), vec4(ev, max(last.g, float(total > 0.0)), 0.0, 0.0));
}
