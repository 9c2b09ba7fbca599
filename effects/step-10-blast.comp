// What a blast throws out: the light of its fire upon the ground, and sparks on curved paths.
uniform sampler2D input_;          //= input : the picture
uniform sampler2D depth;           //= input : depth of the scene (m)
uniform sampler2D volume;          //= input : the smoke, which hides the ground behind it
uniform vec3 position;             //= 0 m : middle of the fire
uniform float light;               //= 10 [0, 1000] : how much the fire lights the ground, at one metre
uniform vec3 tint;                 //= {1, 0.5, 0.2} [0, 1] : colour of that light
uniform int count;                 //= 200 [0, 256] : sparks
uniform float speed;               //= 14 [0, 100] m/s : of the fastest spark
uniform float width;               //= 0.012 [0, 1] m : of a spark
uniform float brightness;          //= 16 [0, 1000] : of a spark when it is young
uniform float shutter;             //= 0.04 [0, 1] s : how long a spark draws its streak
uniform writeonly image2D color;   //= output rgba16f : the picture with both
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
    return vec3(position.xy, 0.5) + way * fast * (1.0 - exp(-drag * age)) / drag - vec3(0.0, 0.0, 3.0 * age * age);
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

// The point of the scene in a pixel; far away for a pixel outside the picture.
vec3 ground(ivec2 pixel, ivec2 size) {
    if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, size))) return vec3(1e9);
    return frame.eye.xyz + frame_ray((vec2(pixel) + 0.5) / vec2(size)) * texelFetch(depth, pixel, 0).r;
}

// To the neighbour on the same surface: of the two that is the nearer one.
vec3 along(ivec2 pixel, ivec2 side, ivec2 size) {
    vec3 here = ground(pixel, size), after = ground(pixel + side, size) - here, before = here - ground(pixel - side, size);
    return dot(after, after) < dot(before, before) ? after : before;
}

// How much the fire lights the surface in this pixel.
float lit(ivec2 pixel, ivec2 size) {
    vec3 to = position - ground(pixel, size);
    vec3 normal = cross(along(pixel, ivec2(1, 0), size), along(pixel, ivec2(0, -1), size));
    return light * max(dot(normalize(normal), normalize(to)), 0.0) / max(dot(to, to), 1.0);
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
    if (deep < frame.lens.w) c.rgb *= 1.0 + lit(pixel, size) * tint * (1.0 - textureLod(volume, uv, 0.0).a);
    vec2 p = (uv - 0.5) * vec2(float(size.x) / float(size.y), -1.0);
    imageStore(color, pixel, c + vec4(sparks(p, deep), 0.0));
}
