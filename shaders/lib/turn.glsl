// Turns by a unit quaternion (x, y, z, w).
vec3 turn_vector(vec4 q, vec3 v) {
    return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v);
}
