// Where a ray of the camera meets a surface of normal n at this depth, lifted off it as far as rounding
// may have moved the point: less than a pixel. Rays to lights begin there.
vec3 lifted_point(float deep, vec3 along, vec3 n) {
    return frame.eye.xyz + deep * along + (1e-4 + 3e-4 * (deep * length(along))) * n;
}
