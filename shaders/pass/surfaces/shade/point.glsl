// Where a ray of the camera meets a surface of normal n at this depth, lifted off it as far as rounding may
// have moved the point, less than a pixel, and as far as the surface may be off: `lod` of `height` pixels.
// Rays to lights begin there.
vec3 lifted_point(float deep, vec3 along, vec3 n, float lod, float height) {
    float pixels = 3e-4 + lod * 2.0 * frame.lens.y / height;
    return frame.eye.xyz + deep * along + (1e-4 + pixels * (deep * length(along))) * n;
}
