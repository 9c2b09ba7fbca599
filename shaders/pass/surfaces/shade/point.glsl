// Where a ray of the camera meets a surface of normal n at this depth, lifted off it as far as rounding may
// have moved the point, less than a pixel, and as far as the surface may be off: `lod` of `height` pixels.
// Rays to lights begin there.
vec3 lifted_point(float deep, vec3 along, vec3 n, float lod, float height) {
    float away = deep * length(along), level = lod * 2.0 * frame.lens.y / height * away;
    // An orthographic camera stands far off: of that, rounding alone counts.
    float rounded = 3e-4 * max(away - frame.eye.w, 0.0) + 2e-7 * frame.eye.w;
    return frame.eye.xyz + deep * along + (1e-4 + rounded + level) * n;
}
