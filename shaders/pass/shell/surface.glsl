// What all stages of a shell share: where each of them is, how far its surface is pushed out, and what
// a point of it looks like.
#include "lib/frame.glsl"
#include "lib/random.glsl"
#include "lib/shell.glsl"
#include "lib/sky.glsl"
#include "lib/light.glsl"
#include "fields.glsl"
uniform uint shell_count;
uniform vec2 bounds; // of the displacement, in radii

struct shell_record {
    vec4 ball;  // centre and radius (m)
    vec4 said;  // age, random, depth, 0
    vec4 shift; // xyz
};
#if defined(STAGE_GATHER)
layout(std430) writeonly buffer ShellRecords { shell_record shell_records[]; };
#else
layout(std430) readonly buffer ShellRecords { shell_record shell_records[]; };
#endif

shell_facts shell_facts_of(shell_record s) {
    return shell_facts(s.said.x, s.said.y, s.shift.xyz, s.said.z, 0.0, vec3(0.0), vec3(0.0));
}

#if !defined(STAGE_GATHER)
// At a direction from the centre (unit), in radii.
float shell_displaced(vec3 way) {
    return clamp(field_displacement(way), bounds.x, bounds.y);
}

// The normal of the surface 1 + d(way), outwards: the way times that, less the slope of d over the unit
// sphere; w: d.
vec4 shell_facing(vec3 way) {
    const float ASIDE = 0.004;
    vec3 u = normalize(cross(way, abs(way.z) < 0.7 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0)));
    vec3 v = cross(way, u), d;
    for (int i = 0; i < 3; i++) { // one call, which is unfolded once
        vec3 aside = i == 0 ? vec3(0.0) : i == 1 ? u : v;
        d[i] = shell_displaced(normalize(way + ASIDE * aside));
    }
    return vec4(normalize((1.0 + d.x) * way - (d.y - d.x) / ASIDE * u - (d.z - d.x) / ASIDE * v), d.x);
}

// Depth of the scene at a point of the picture (m).
float shell_stop(vec2 uv) {
#if HAS_DEPTH
    return texelFetch(depth, ivec2(uv * vec2(textureSize(depth, 0))), 0).r;
#else
    return 1e9;
#endif
}

#if HAS_ALBEDO
// What a white surface sends back, lit by sky and lights that nothing hides.
vec3 shell_lit(vec3 p, vec3 normal) {
    vec3 sum = sky_irradiance(normal);
    for (int i = 0; i < light_count(); i++) {
        light_ray ray = light_at(light_get(i), p);
        float facing = (dot(normal, ray.direction) + wrap) / (1.0 + wrap);
        sum += ray.irradiance * (max(facing, 0.0) / (1.0 + wrap) / 3.14159265);
    }
    return sum;
}
#endif

// Premultiplied radiance and opacity of a point, whose facts `shell_said` holds but for the last three;
// `ahead`: metres to what the scene has behind it.
vec4 shell_look(vec3 way, vec3 p, float ahead) {
    vec4 facing = shell_facing(way);
    shell_said.displacement = facing.w;
    shell_said.view = normalize(frame.eye.xyz - p);
    shell_said.normal = dot(facing.xyz, shell_said.view) < 0.0 ? -facing.xyz : facing.xyz;
    if (!(field_clip(way) > 0.0)) return vec4(0.0);
    float given = field_opacity(way), opacity = clamp(given, 0.0, 1.0);
    if (!(given != 0.0)) return vec4(0.0);
    if (soften > 0.0) opacity *= clamp(ahead / soften, 0.0, 1.0);
    vec3 color = brightness * max(field_color(way), vec3(0.0));
#if HAS_ALBEDO
    color += clamp(field_albedo(way), 0.0, 1.0) * shell_lit(p, shell_said.normal);
#endif
    return opacity * vec4(min(color, vec3(65000.0)), 1.0);
}
#endif
