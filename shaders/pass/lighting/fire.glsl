// Lights that stand for the volume's fire where it falls on what is outside of it: each is the sum
// of a part of the voxels, and shines more to the side where less smoke is in its way.
//
// FIRE: how much of each voxel's light gets out of the volume, and to which side. GATHER: the sum
// of all, or of each octant around their centre; one workgroup a light, always in the same order.
#if defined(STAGE_FIRE)
layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;

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
    ivec3 voxel = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(voxel, ivec3(GLOW_SIZE)))) return;
    vec3 given = texelFetch(medium_made, voxel, 0).rgb, mean = vec3(0.0), side = vec3(0.0);
    if (given.r + given.g + given.b > 0.0) {
        vec3 taken = smoke_between();
        for (int i = 0; i < WAYS; i++) {
            vec4 way = way_out(i);
            vec3 out_ = way.w * exp(-taken * passed_to_outside(voxel, way.xyz));
            mean += out_;
            side += dot(out_, given) * way.xyz;
        }
    }
    imageStore(fire_kept, voxel, vec4(given * mean, 0.0));
    imageStore(fire_kept, voxel + ivec3(0, 0, GLOW_SIZE), vec4(side, 0.0));
}
#endif

#if defined(STAGE_GATHER)
const int THREADS = 512, VOXELS = GLOW_SIZE * GLOW_SIZE * GLOW_SIZE;
layout(local_size_x = THREADS) in;
shared vec4 sums[3][THREADS];

struct heap { // of voxels; weights are their light, all colours added
    vec3 color;
    float spread; // weight times distance squared from the centre of all
    vec3 place;   // weight times position
    float weight;
    vec3 side;
};

vec3 centre_of(int voxel) {
    vec3 at = vec3(voxel % GLOW_SIZE, (voxel / GLOW_SIZE) % GLOW_SIZE, voxel / (GLOW_SIZE * GLOW_SIZE));
    return mix(box_min, box_max, (at + 0.5) / float(GLOW_SIZE));
}

// Sums the voxels of one octant around `centre`, or all (-1), over the workgroup.
heap gather(vec3 centre, int octant) {
    int thread = int(gl_LocalInvocationIndex);
    heap own = heap(vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0));
    for (int i = thread; i < VOXELS; i += THREADS) {
        ivec3 voxel = ivec3(i % GLOW_SIZE, (i / GLOW_SIZE) % GLOW_SIZE, i / (GLOW_SIZE * GLOW_SIZE));
        vec3 color = texelFetch(fire_made, voxel, 0).rgb, p = centre_of(i) - centre;
        float weight = color.r + color.g + color.b;
        int mine = int(p.x > 0.0) + 2 * int(p.y > 0.0) + 4 * int(p.z > 0.0);
        if (weight <= 0.0 || (octant >= 0 && octant != mine)) continue;
        own.color += color;
        own.weight += weight;
        own.place += weight * p;
        own.spread += weight * dot(p, p);
        own.side += texelFetch(fire_made, voxel + ivec3(0, 0, GLOW_SIZE), 0).xyz;
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
