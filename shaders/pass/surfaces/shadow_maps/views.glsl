// The views, for those who draw (Views) and for those who look (shadow_views; lib/shadows.glsl).

shadow_view fixed_view(int index) {
    int first = index * SHADOW_VIEW_VECTORS;
    return shadow_view(mat4(fixed_views[first], fixed_views[first + 1], fixed_views[first + 2],
                            fixed_views[first + 3]), fixed_views[first + 4], fixed_views[first + 5]);
}

vec3 face_axis(int face) {
    vec3 axis = vec3(0.0);
    axis[face >> 1] = (face & 1) == 0 ? 1.0 : -1.0;
    return axis;
}

// Out of a point light, through a face of a cube. A face shows a little more than its part, so that
// what is looked up near its edge lies in one view.
//
// Four faces of a tetrahedron would do (Liao, "Shadow mapping for omnidirectional light using
// tetrahedron mapping", GPU Pro, 2010). Counted for both, at as many texels in all: the coarsest texel
// is 1.3 times as wide as a cube's even if the triangular faces are packed without loss, 1.9 times in
// their boxes, and the solid angles of texels differ by 26 to 1, a cube's by 5 to 1. For that it saves
// two draws of six; what it draws is less by 5 percent only, since of meshes 10 degrees wide 16 percent
// lie on an edge of it, and 22 percent on one of a cube.
shadow_view face_view(light_entry e, int face, float size) {
    vec3 along = face_axis(face), up = vec3(0.0);
    up[face >> 1 == 2 ? 1 : 2] = 1.0;
    vec3 right = cross(along, up), p = e.position.xyz;
    float half_width = size / (size - 2.0 * margin), far = min(reach_of(e), distance);
    // As near as a float's digits allow, which are spread as one over the depth.
    float near = min(max(e.position.w, max(far * 5e-4, 0.01)), 0.5 * far), slope = far / (far - near);
    vec4 x = vec4(right, -dot(right, p)) / half_width, y = vec4(up, -dot(up, p)) / half_width;
    vec4 deep = vec4(along, -dot(along, p)), z = slope * (deep - vec4(0.0, 0.0, 0.0, near));
    return shadow_view(transpose(mat4(x, y, z, deep)), vec4(right, 2.0 * half_width / size), vec4(up, 0.0));
}

// Whether the camera sees anything that the light shines on through that face: the least sphere about
// its part of the light's own has its middle below the corners.
bool is_face_in_sight(light_entry e, int face) {
    float far = min(reach_of(e), distance);
    return is_in_sight(e.position.xyz + sqrt(1.0 / 3.0) * far * face_axis(face), sqrt(2.0 / 3.0) * far);
}

shadow_view view_of(int index) {
    const shadow_view none = shadow_view(mat4(0.0), vec4(0.0), vec4(0.0));
    if (index < SHADOW_FIXED) return fixed_view(index);
    int point = (index - SHADOW_FIXED) / SHADOW_FACES, face = (index - SHADOW_FIXED) % SHADOW_FACES;
    if (chosen[point] == NOBODY || fade_of(point) == 0.0) return none;
    light_entry e = candidate_of(int(chosen[point]));
    return is_face_in_sight(e, face) ? face_view(e, face, places[index].z) : none;
}

// The first row of shadow_views says what all share; then there is one for each view.
void write_view(int index) {
    shadow_view v = view_of(index);
    views_drawn[index] = view_entry(v.clip, vec4(frame.eye.xyz, pixels));
    mat4 rows = transpose(v.clip);
    vec4 place = places[index];
    vec4 x = 0.5 * place.z * (rows[0] + rows[3]) + place.x * rows[3];
    vec4 y = 0.5 * place.w * (rows[1] + rows[3]) + place.y * rows[3];
    imageStore(shadow_views, ivec2(0, 1 + index), x);
    imageStore(shadow_views, ivec2(1, 1 + index), y);
    imageStore(shadow_views, ivec2(2, 1 + index), rows[2]);
    imageStore(shadow_views, ivec2(3, 1 + index), rows[3]);
    imageStore(shadow_views, ivec2(4, 1 + index), v.right);
    imageStore(shadow_views, ivec2(5, 1 + index), v.up);
    imageStore(shadow_views, ivec2(6, 1 + index), vec4(place.xy, place.xy + place.zw));
}

// x: first view; y: how many, 0: it has no maps; z: how dark its shadows are.
vec4 maps_of(int index) {
    if (!competes(index)) return vec4(fixed_lights[index].xy, 1.0, 0.0);
    for (int k = 0; k < SHADOW_POINTS; k++)
        if (chosen[k] == uint(index)) {
            float dark = fade_of(k);
            return vec4(SHADOW_FIXED + k * SHADOW_FACES, dark > 0.0 ? SHADOW_FACES : 0, dark, 0.0);
        }
    return vec4(0.0);
}

void write_light(int index) {
    imageStore(shadow_views, ivec2(index & 7, 1 + SHADOW_VIEWS + (index >> 3)), maps_of(index));
}
