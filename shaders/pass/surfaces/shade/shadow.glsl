// Shadow rays by the lists of shafts.glsl.
const uint SHAFT_NONE = 0xffffffffu;

uint shaft_of(int light) {
    return light < shaft_lights ? shaft_start(light) : SHAFT_NONE;
}

bool shaft_is_clear(uint list) {
    return list != SHAFT_NONE && shaft_words[list] == 0u;
}

bool shaft_occluded(uint list, vec3 p, vec3 direction, float far) {
    uint count = list == SHAFT_NONE ? SHAFT_LEAVES + 1u : shaft_words[list];
    if (count > SHAFT_LEAVES) return bvh_occluded(p, direction, 0.0, far);
    bvh_ray ray = bvh_make_ray(p, direction, 0.0, far), inner = ray;
    uint instance = SHAFT_NONE;
    for (uint k = 1u; k <= count; k++) {
        uint leaf = shaft_words[list + k];
        if (leaf >> 24 != instance) {
            instance = leaf >> 24;
            inner = bvh_to_mesh(ray, instance);
        }
        uint first = leaf & 0x3fffffu, last = first + (leaf >> 22 & 3u);
        for (uint i = first; i <= last; i++) {
            float distance = bvh_meet_triangle(inner, bvh_triangles[i]);
            if (distance >= 0.0 && distance <= far) return true;
        }
    }
    return false;
}
