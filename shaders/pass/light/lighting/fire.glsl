// Lights that stand for the volume's fire where it falls on what is outside of it: each is the sum
// of a part of the voxels, and shines more to the side where less smoke is in its way.
//
// FIRE: how much of each voxel's light gets out of the volume, and to which side. GATHER: the sum
// of all, or of each octant around their centre; one workgroup a light, always in the same order.
#if defined(STAGE_FIRE)
const int SLOTS = 16, VOXELS = 8; // threads of a voxel, one for each way and two idle; voxels of a workgroup
layout(local_size_x = SLOTS, local_size_y = VOXELS) in;
shared vec3 left[VOXELS][SLOTS];

// Towards faces and corners of a cube; with their weights they integrate polynomials of degree 5
// exactly (Lebedev, "Quadratures on a sphere", 1976).
const int WAYS = 14;
vec4 way_out(int i) {
    if (i < 6) {
        vec3 way = vec3(0.0);
        way[i >> 1] = (i & 1) == 0 ? 1.0 : -1.0;
        return vec4(way, 1.0 / 15.0);
    }
    return vec4((vec3(i & 1, (i >> 1) & 1, ((i - 6) >> 2) & 1) * 2.0 - 1.0) * 0.57735027, 3.0 / 40.0);
}

// What the smoke takes of light that goes out on any path, scattered or not: the square root of
// absorption times extinction (Schuster, "Radiation through a foggy atmosphere", 1905).
vec3 smoke_between() {
    vec3 all = medium_extinction();
    return sqrt(all * max(all - extinction * albedo, vec3(0.0)));
}

// Density times metres from a voxel's centre to the outside.
float passed_to_outside(ivec3 voxel, vec3 way) {
    vec3 cells = way * float(GLOW_SIZE) / max(box_max - box_min, vec3(1e-6));
    float metres = 1.0 / max(abs(cells.x), max(abs(cells.y), abs(cells.z)));
    float passed = 0.5 * texelFetch(medium_made, voxel, 0).a;
    for (int i = 1; i < GLOW_SIZE; i++) {
        vec3 at = (vec3(voxel) + 0.5 + float(i) * metres * cells) / float(GLOW_SIZE);
        if (any(lessThan(at, vec3(0.0))) || any(greaterThan(at, vec3(1.0)))) break;
        passed += textureLod(medium_made, at, 0.0).a;
    }
    return passed * metres;
}

void main() {
    int slot = int(gl_LocalInvocationID.x), own = int(gl_LocalInvocationID.y);
    ivec3 voxel = 2 * ivec3(gl_WorkGroupID) + ivec3(own & 1, (own >> 1) & 1, own >> 2);
    vec3 given = texelFetch(medium_made, voxel, 0).rgb, mean = vec3(0.0), side = vec3(0.0);
    bool shines = given.r + given.g + given.b > 0.0;
    if (shines && slot < WAYS) {
        vec4 way = way_out(slot);
        left[own][slot] = way.w * exp(-smoke_between() * passed_to_outside(voxel, way.xyz));
    }
    barrier();
    if (slot > 0) return;
    for (int i = 0; i < WAYS && shines; i++) {
        mean += left[own][i];
        side += dot(left[own][i], given) * way_out(i).xyz;
    }
    imageStore(fire_kept, voxel, vec4(given * mean, 0.0));
    imageStore(fire_kept, voxel + ivec3(0, 0, GLOW_SIZE), vec4(side, 0.0));
}
#endif

#if defined(STAGE_GATHER)
const int THREADS = MOST_THREADS, VOXELS = GLOW_SIZE * GLOW_SIZE * GLOW_SIZE, AT_ONCE = 8;
layout(local_size_x = THREADS) in;
shared vec4 sums[3][THREADS];

struct heap { // of voxels; weights are their light, all colours added
    vec3 color;
    float spread; // weight times distance squared from the centre of all
    vec3 place;   // weight times position
    float weight;
    vec3 side;
};

// Sums the voxels of one octant around `centre`, or all (-1), over the workgroup. Several are read at
// once: one after the other would be a chain of waiting.
heap gather(vec3 centre, int octant) {
    int thread = int(gl_LocalInvocationIndex);
    heap own = heap(vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0));
    for (int i = thread; i < VOXELS; i += THREADS * AT_ONCE) {
        vec3 color[AT_ONCE], side[AT_ONCE], place[AT_ONCE];
        for (int k = 0; k < AT_ONCE; k++) {
            int at = i + k * THREADS;
            ivec3 voxel = ivec3(at % GLOW_SIZE, (at / GLOW_SIZE) % GLOW_SIZE, at / (GLOW_SIZE * GLOW_SIZE));
            color[k] = texelFetch(fire_made, min(voxel, GLOW_SIZE - 1), 0).rgb;
            side[k] = texelFetch(fire_made, min(voxel, GLOW_SIZE - 1) + ivec3(0, 0, GLOW_SIZE), 0).rgb;
            place[k] = mix(box_min, box_max, (vec3(voxel) + 0.5) / float(GLOW_SIZE)) - centre;
        }
        for (int k = 0; k < AT_ONCE && i + k * THREADS < VOXELS; k++) {
            float weight = color[k].r + color[k].g + color[k].b;
            ivec3 above = ivec3(greaterThan(place[k], vec3(0.0)));
            if (octant >= 0 && octant != above.x + 2 * above.y + 4 * above.z) continue;
            own.color += color[k];
            own.weight += weight;
            own.place += weight * place[k];
            own.spread += weight * dot(place[k], place[k]);
            own.side += side[k];
        }
    }
    barrier();
    sums[0][thread] = vec4(own.color, own.spread);
    sums[1][thread] = vec4(own.place, own.weight);
    sums[2][thread] = vec4(own.side, 0.0);
    for (int half_ = THREADS / 2; half_ > 0; half_ /= 2) {
        barrier();
        if (thread >= half_) continue;
        for (int k = 0; k < 3; k++) sums[k][thread] += sums[k][thread + half_];
    }
    barrier();
    return heap(sums[0][0].xyz, sums[0][0].w, sums[1][0].xyz, sums[1][0].w, sums[2][0].xyz);
}

void main() {
    int index = int(gl_WorkGroupID.x), row = imageSize(lights).y - FIRE_COUNT + index;
    heap all = gather(0.5 * (box_min + box_max), -1);
    vec3 centre = 0.5 * (box_min + box_max) + all.place / max(all.weight, 1e-30);
    heap own = gather(centre, FIRE_COUNT == 1 ? -1 : index);
    if (gl_LocalInvocationIndex > 0u) return;
    vec3 voxel = (box_max - box_min) / float(GLOW_SIZE);
    vec3 middle = own.place / max(own.weight, 1e-30), side = 3.0 * own.side / max(own.weight, 1e-30);
    float spread = sqrt(max(own.spread / max(own.weight, 1e-30) - dot(middle, middle), 0.0));
    imageStore(lights, ivec2(0, row), vec4(centre + middle, spread));
    imageStore(lights, ivec2(1, row), vec4(own.color * (voxel.x * voxel.y * voxel.z), float(LIGHT_FIRE)));
    imageStore(lights, ivec2(2, row), vec4(side / max(length(side), 1.0), 0.0));
    for (int i = 3; i < SHADOW_MAP_TEXELS; i++) imageStore(lights, ivec2(i, row), vec4(0.0));
}
#endif
