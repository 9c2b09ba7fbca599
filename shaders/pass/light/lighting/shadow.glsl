// A light's rays through the volume: each is marched once, away from the light, and what it has
// passed is kept at every step, so that a texel costs one evaluation of the density.
//
// Several threads share a ray: each sums a part of its own, then adds the parts before it.
#if defined(STAGE_SHADOW)
const int PARTS = SHADOW_PARTS, PART = SHADOW_SIZE / PARTS;
const int RAYS_X = PARTS > 8 ? 4 : 8, RAYS_Y = 4, RAYS = RAYS_X * RAYS_Y;
layout(local_size_x = RAYS_X, local_size_y = RAYS_Y, local_size_z = PARTS) in;

const float FAR = 1e5;      // metres to where meshes still throw a shadow
shared float passed[PARTS][RAYS];
shared float hidden_from[RAYS]; // metres in the box after which a mesh hides the light

#if RIG != RIG_NONE
float find_mesh(shadow_map m, shadow_ray ray) { return FAR; } // those of a rig shine past them
#else
// Meshes between the light and the box count as well.
float find_mesh(shadow_map m, shadow_ray ray) {
    vec3 enter = ray.origin + ray.range.x * ray.direction;
    float before = m.kind == SHADOW_MAP_PARALLEL ? FAR : ray.range.x;
    if (bvh_occluded(enter, -ray.direction, 0.0, before)) return -FAR;
    bvh_hit hit = bvh_trace(enter, ray.direction, 0.0, ray.range.y - ray.range.x);
    return hit.distance < 0.0 ? FAR : hit.distance;
}
#endif

void main() {
    int index = int(gl_WorkGroupID.z), part = int(gl_LocalInvocationID.z);
    int lane = int(gl_LocalInvocationID.y) * RAYS_X + int(gl_LocalInvocationID.x);
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    shadow_map m = shadow_map_of(lights_made, index);
    shadow_ray ray = shadow_map_ray(m, texel, SHADOW_SIZE);
    float slice = max(ray.range.y - ray.range.x, 0.0) / float(SHADOW_SIZE);

    float sum = 0.0, sums[PART];
    for (int i = 0; i < PART; i++) {
        float at = ray.range.x + (float(part * PART + i) + 0.5) * slice;
        if (slice > 0.0) sum += slice * medium_density(ray.origin + at * ray.direction);
        sums[i] = sum;
    }
    count_samples(slice > 0.0 ? PART : 0);
    passed[part][lane] = sum;
    const int tracer = RAYS_APART > 1 ? lane % PARTS : 0; // of the ray's threads: spread, or side by side
    if (part == tracer) hidden_from[lane] = slice > 0.0 ? find_mesh(m, ray) : FAR;
    barrier();

    float before = 0.0;
    for (int i = 0; i < part; i++) before += passed[i][lane];
    for (int i = 0; i < PART; i++) {
        int k = part * PART + i;
        // The edge of a mesh's shadow is as soft as a slice.
        float steps = slice > 0.0 ? hidden_from[lane] / slice - float(k) - 0.5 : 1.0;
        vec2 kept = vec2(min(before + sums[i], HALF_MOST), clamp(steps, 0.0, 1.0));
        imageStore(shadow, ivec3(texel, index * SHADOW_SIZE + k), vec4(kept, 0.0, 0.0));
    }
}
#endif
