// A row of `lights` for each light of the scene.
#if defined(STAGE_LIGHTS)
layout(local_size_x = 64) in;

// Two directions perpendicular to `along`, the first nearly along the box's edge that is most so:
// the box then fills most of the picture.
void choose_axes(inout shadow_map m) {
    vec3 a = abs(m.along);
    vec3 edge = a.x <= min(a.y, a.z) ? vec3(1, 0, 0) : a.y <= a.z ? vec3(0, 1, 0) : vec3(0, 0, 1);
    m.up = normalize(cross(m.along, edge));
    m.right = cross(m.up, m.along);
}

vec3 corner(int i) {
    return mix(box_min, box_max, vec3(i & 1, (i >> 1) & 1, i >> 2));
}

// The window that the whole box is seen through.
vec2 extent_of_box(shadow_map m) {
    vec2 most = vec2(1e-4);
    for (int i = 0; i < 8; i++) {
        vec3 to = corner(i) - m.position;
        vec2 at = abs(vec2(dot(to, m.right), dot(to, m.up)));
        most = max(most, m.kind == SHADOW_MAP_FRUSTUM ? at / dot(to, m.along) : at);
    }
    return most;
}

// A light well outside of the box shines through a window as large as the box, a narrow spot
// through one as wide as its cone; any other needs all directions.
shadow_map place(light l) {
    vec3 centre = 0.5 * (box_min + box_max), zero = vec3(0.0);
    float around = 0.5 * length(box_max - box_min), away = distance(l.position, centre);
    shadow_map m = shadow_map(SHADOW_MAP_SPHERE, 0, l.position, zero, zero, zero, vec2(1.0), box_min, box_max);
    if (l.kind == LIGHT_SUN) {
        m.kind = SHADOW_MAP_PARALLEL;
        m.position = centre;
        m.along = -l.position;
    } else if (away > 1.5 * around) {
        m.kind = SHADOW_MAP_FRUSTUM;
        m.along = (centre - l.position) / away;
    }
    if (m.kind != SHADOW_MAP_SPHERE) {
        choose_axes(m);
        m.extent = extent_of_box(m);
    }
    float cone = sqrt(1.0 - l.outer * l.outer) / max(l.outer, 1e-4);
    bool narrow = m.kind == SHADOW_MAP_FRUSTUM ? cone < max(m.extent.x, m.extent.y) : cone < 2.0;
    if (l.kind == LIGHT_SPOT && l.outer > 0.0 && narrow) {
        m.kind = SHADOW_MAP_FRUSTUM;
        m.along = l.axis;
        choose_axes(m);
        m.extent = vec2(cone);
    }
    return m;
}

void main() {
    int row = int(gl_GlobalInvocationID.x), declared = imageSize(lights).y - FIRE_COUNT;
    if (row >= declared) return;
    light_entry entry = light_entry_of(row);
    shadow_map m = place(light_get(row));
    imageStore(lights, ivec2(0, row), entry.position);
    imageStore(lights, ivec2(1, row), entry.color);
    imageStore(lights, ivec2(2, row), entry.axis);
    imageStore(lights, ivec2(3, row), entry.spread);
    imageStore(lights, ivec2(4, row), vec4(m.position, 0.0));
    imageStore(lights, ivec2(5, row), vec4(m.right, m.extent.x));
    imageStore(lights, ivec2(6, row), vec4(m.up, m.extent.y));
    imageStore(lights, ivec2(7, row), vec4(m.along, float(m.kind)));
    imageStore(lights, ivec2(8, row), vec4(box_min, float(declared)));
    imageStore(lights, ivec2(9, row), vec4(box_max, 0.0));
    imageStore(lights, ivec2(10, row), vec4(medium_extinction(), 0.0));
}
#endif
