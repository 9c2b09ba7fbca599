// What a blast throws out: sparks on curved paths.
uniform sampler2D input_;          //= input : the picture
uniform sampler2D depth;           //= input : depth of the scene (m)
uniform vec3 position;             //= 0 m : where they come from
uniform int count;                 //= 200 [0, 256] : sparks
uniform float speed;               //= 14 [0, 100] m/s : of the fastest spark
uniform float width;               //= 0.012 [0, 1] m : of a spark
uniform float brightness;          //= 16 [0, 1000] : of a spark when it is young
uniform float shutter;             //= 0.04 [0, 1] s : how long a spark draws its streak
uniform writeonly image2D color;   //= output rgba16f : the picture with them
#include "lib/frame.glsl"
#include "lib/random.glsl"

// Each thread of a group works out one spark; then each draws all of them at its own pixel.
shared vec4 streak[256];           // two ends, in heights of the picture
shared vec3 look[256];             // width, heights of the picture; brightness; depth (m)

float chance(uint spark, uint of) { return float(random_hash(spark * 8u + of + frame.size.w)) / 4294967296.0; }

// Air slows a spark down, and it falls.
vec3 path(uint spark, float age) {
    float angle = 6.2832 * chance(spark, 0u), up = 0.05 + 0.95 * chance(spark, 1u);
    vec3 way = vec3(sqrt(1.0 - up * up) * vec2(cos(angle), sin(angle)), up);
    float fast = speed * (0.35 + 0.65 * chance(spark, 2u)), drag = 1.6;
    return position + way * fast * (1.0 - exp(-drag * age)) / drag - vec3(0.0, 0.0, 3.0 * age * age);
}

vec2 on_picture(vec3 seen) { return seen.xy / (-2.0 * frame.lens.y * seen.z); }

void throw_spark(uint spark) {
    float age = frame.time.x - 0.15 * chance(spark, 3u), life = 0.5 + 1.8 * chance(spark, 4u);
    vec3 now = path(spark, age), before = path(spark, max(age - shutter, 0.0));
    vec3 seen = (frame.view * vec4(now, 1.0)).xyz;
    bool out_of_sight = age < 0.0 || age > life || now.z < 0.0 || seen.z > -frame.lens.z || spark >= uint(count);
    streak[spark] = vec4(on_picture(seen), on_picture((frame.view * vec4(before, 1.0)).xyz));
    float size = width / (-2.0 * frame.lens.y * seen.z), least = 0.7 / float(frame.size.y);
    float left = 1.0 - age / life;
    // Thinner than a pixel, a spark is drawn a pixel wide and as much darker.
    look[spark] = vec3(max(size, least), out_of_sight ? 0.0 : brightness * left * left * min(size / least, 1.0), -seen.z);
}

float distance_to(vec2 p, vec4 line) {
    vec2 along = line.zw - line.xy, from = p - line.xy;
    return length(from - along * clamp(dot(from, along) / max(dot(along, along), 1e-9), 0.0, 1.0));
}

vec3 sparks(vec2 p, float deep) {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < count; i++) {
        if (look[i].y == 0.0 || look[i].z > deep) continue;
        float off = distance_to(p, streak[i]) / look[i].x;
        float bright = look[i].y * exp(-off * off);
        sum += bright * mix(vec3(1.0, 0.16, 0.02), vec3(1.0, 0.55, 0.2), min(look[i].y / brightness, 1.0));
    }
    return sum;
}

void main() {
    throw_spark(gl_LocalInvocationIndex);
    barrier();
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(color);
    if (any(greaterThanEqual(pixel, size))) return;
    vec2 uv = (vec2(pixel) + 0.5) / vec2(size);
    float deep = texelFetch(depth, pixel, 0).r;
    vec4 c = texelFetch(input_, pixel, 0);
    vec2 p = (uv - 0.5) * vec2(float(size.x) / float(size.y), -1.0);
    imageStore(color, pixel, c + vec4(sparks(p, deep), 0.0));
}
