// Light that enters the volume in each of the directions that it is swept in: of the sky, and of the
// meshes before it, which send back what falls on them. It is the mean over the volume, so that the
// ground below is half of all there is, however large the box. A few workgroups a direction.
#if defined(STAGE_AROUND)
const int OWN_LOOKS = LOOKS / LOOK_PARTS, TRIES = 16;
layout(local_size_x = OWN_LOOKS * RAYS_APART) in;
shared vec3 looks[OWN_LOOKS];

// What a surface sends back of the sky and the lights, each past the meshes and through the volume.
vec3 light_of_surface(vec3 p, bvh_hit hit) {
    vec3 sum = ambient * sky_irradiance(hit.normal);
    int declared = int(texelFetch(lights_made, ivec2(8, 0), 0).w);
    for (int i = 0; i < declared; i++) {
        light l = light_get(i);
        light_ray ray = light_at(l, p);
        vec3 given = ray.irradiance * max(dot(hit.normal, ray.direction), 0.0) / PI;
        if (given == vec3(0.0) || bvh_occluded(p, ray.direction, 0.0, ray.distance - l.radius)) continue;
        float passed = shadow_map_read(shadow_made, shadow_map_of(lights_made, i), p).x;
        sum += given * exp(-medium_extinction() * passed);
    }
    return hit.albedo * sum;
}

#if RIG != RIG_NONE
vec3 look(vec3 way, int index) { return vec3(0.0); } // a rig is all the light there is
#else
// A point in the smoke, by the sequence R3 (Roberts, "The unreasonable effectiveness of quasirandom
// sequences", 2018); one that is buried only where all are.
vec3 point_of(int index) {
    vec3 p;
    for (int i = 0; i < TRIES; i++) {
        vec3 at = fract(0.5 + float(index + i * LOOKS) * vec3(0.81917251, 0.67104361, 0.54970048));
        p = mix(box_min, box_max, at);
        if (textureLod(medium_made, at, 0.0).a > 0.0 && !bvh_occluded(p, vec3(0, 0, 1), 0.0, 1e9)) break;
    }
    return p;
}

// Light that comes to one of the points from one of the directions that a way stands for: all fill
// its cone, since the sun of a panorama is small.
vec3 look(vec3 way, int index) {
    vec3 side = normalize(cross(way, abs(way.z) < 0.7 ? vec3(0, 0, 1) : vec3(1, 0, 0)));
    float part = (float(index) + 0.5) / float(LOOKS), turn = 2.39996323 * float(index);
    float cosine = 1.0 - 2.0 * part / float(WAYS), sine = sqrt(1.0 - cosine * cosine);
    vec3 from = -normalize(cosine * way + sine * (cos(turn) * side + sin(turn) * cross(way, side)));
    vec3 p = point_of(index);
    bvh_hit hit = bvh_trace(p, from, 0.0, 1e9);
    if (hit.distance < 0.0) return ambient * sky_radiance(from);
    float off = 1e-4 + 1e-5 * hit.distance; // the surface, or a ray would meet it again
    return light_of_surface(p + hit.distance * from + off * hit.normal, hit);
}
#endif

// Rays that go far take all others of their subgroup with them, so that each has its own on a GPU.
void main() {
    int way = int(gl_WorkGroupID.x), part = int(gl_WorkGroupID.y), thread = int(gl_LocalInvocationIndex);
    int own = thread / RAYS_APART;
    if (thread % RAYS_APART == 0) looks[own] = look(way_of(way), part * OWN_LOOKS + own);
    for (int half_ = OWN_LOOKS / 2; half_ > 0; half_ /= 2) {
        barrier();
        if (thread < half_) looks[thread] += looks[thread + half_];
    }
    if (thread == 0) imageStore(around_kept, ivec3(way, part, 0), vec4(looks[0] / float(LOOKS), 0.0));
}
#endif
