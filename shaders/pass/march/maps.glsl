// What maps.comp keeps of a ray, beside its light.
const float MAPS_HALF_MOST = 6e4; // what a half float holds

struct maps_state {
    vec3 origin, way;
    float metres;  // along the ray for each metre of depth
    vec4 motion;   // and the weight of it all
    vec3 own;      // radiance
    vec3 facing;
    vec2 heat;     // and its weight
    vec2 deep;
    float through; // of the medium in grey
    float opacity;
    vec3 rigs[2];
} maps;

void maps_begin(vec3 origin, vec3 way, float metres) {
    maps = maps_state(origin, way, metres, vec4(0.0), vec3(0.0), vec3(0.0), vec2(0.0), vec2(0.0), 1.0, 0.0,
                      vec3[2](vec3(0.0), vec3(0.0)));
}

// Heights of the picture a second to the right and up, and m/s towards the camera.
vec3 maps_seen_motion(vec3 p, vec3 velocity) {
    vec3 at = (frame.view * vec4(p, 1.0)).xyz, v = (frame.view * vec4(velocity, 0.0)).xyz;
    float deep = max(-at.z, 1e-6);
    return vec3((v.xy + at.xy * (v.z / deep)) / (2.0 * frame.lens.y * deep), v.z);
}

// Away from where the density rises, by four looks at the corners of a tetrahedron.
vec3 maps_facing(vec3 p, float apart) {
    const vec2 k = vec2(1.0, -1.0);
    return -(k.xyy * medium_density(p + apart * k.xyy) + k.yyx * medium_density(p + apart * k.yyx) +
             k.yxy * medium_density(p + apart * k.yxy) + k.xxx * medium_density(p + apart * k.xxx));
}

#if HAS_LIGHTS_A || HAS_LIGHTS_B
// Radiance that scattering of 1/m adds in a metre, by the light of each of a rig's three lights.
vec3 maps_lit(sampler2D rows, sampler3D before, sampler3D around, vec3 p) {
    vec3 sum = lighting_scattered_by(rows, around, p, -maps.way, medium_anisotropy());
    float taken = texelFetch(rows, ivec2(10, 0), 0).x;
    for (int i = 0; i < 3; i++) {
        vec3 to = texelFetch(rows, ivec2(0, i), 0).xyz;
        float passed = shadow_map_read(before, shadow_map_of(rows, i), p).x;
        sum[i] += texelFetch(rows, ivec2(1, i), 0)[i] * medium_phase(dot(maps.way, to), 1.0) * exp(-taken * passed);
    }
    return sum;
}

void maps_add_rigs(vec3 p, node n, float length) {
    float x = n.density * length * mean(medium_extinction());
    float shines = maps.through * held(vec3(x)).x * length * mean(n.scattering);
    maps.through *= exp(-x);
    if (shines <= 0.0) return;
#if HAS_LIGHTS_A
    maps.rigs[0] += shines * maps_lit(lights_a, shadow_a, glow_a, p);
#endif
#if HAS_LIGHTS_B
    maps.rigs[1] += shines * maps_lit(lights_b, shadow_b, glow_b, p);
#endif
}
#else
void maps_add_rigs(vec3 p, node n, float length) {}
#endif

// A stretch of `length` metres; `shines`: what light of a metre in it adds to the pixel; `gained`:
// its opacity there.
void maps_add(vec3 shines, node n, vec3 lit, float gained, float length, float at) {
    vec3 p = maps.origin + at * maps.way;
    float weight = gained + mean(shines * (n.own + n.scattering * lit));
    maps.own += shines * n.own;
#if HAS_LIGHTS_OWN && HAS_GLOW_OWN
    maps.own += shines * n.scattering *
                lighting_scattered_by(lights_own, glow_own, p, -maps.way, medium_anisotropy());
#endif
    maps.opacity += gained;
    maps.deep += gained * vec2(at, 1.0);
    if (weight <= 0.0) return;
#if HAS_VELOCITY
    maps.motion += weight * vec4(maps_seen_motion(p, field_velocity(p)), 1.0);
#endif
#if HAS_TEMPERATURE
    maps.heat += weight * vec2(field_temperature(p), 1.0);
#endif
#if NORMALS == NORMALS_ON
    maps.facing += gained * maps_facing(p, max(pixel_width * at, 1e-4));
#endif
    maps_add_rigs(p, n, length);
}

void maps_keep(ivec2 pixel, maps_state m) {
    vec3 facing = (frame.view * vec4(m.facing, 0.0)).xyz;
    imageStore(motion, pixel, m.motion.w > 0.0 ? vec4(m.motion.xyz / m.motion.w, min(m.motion.w, MAPS_HALF_MOST)) : vec4(0.0));
    imageStore(right_top_back, pixel, vec4(min(m.rigs[0], MAPS_HALF_MOST), m.opacity));
    imageStore(left_bottom_front, pixel, vec4(min(m.rigs[1], MAPS_HALF_MOST), m.opacity));
    imageStore(emission_seen, pixel, vec4(min(m.own, MAPS_HALF_MOST), m.opacity));
    imageStore(normal, pixel, vec4(facing / max(length(facing), 1e-20), m.opacity));
    imageStore(heat, pixel, vec4(m.heat.x / max(m.heat.y, 1e-20), m.deep.y > 0.0 ? m.deep.x / (m.deep.y * m.metres) - frame.eye.w : 0.0, 0.0, m.opacity));
}

void maps_store(ivec2 pixel) { maps_keep(pixel, maps); }
