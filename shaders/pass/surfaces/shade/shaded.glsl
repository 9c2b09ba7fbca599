// The surface that a point of the picture shows, as lib/shading.glsl wants it.
shaded shaded_at(surface_point s, vec2 uv) {
    vec4 kind = vec4(0.0, 1.0, 0.0, 1.0);
#if HAS_SURFACE
    kind = texelFetch(surface, ivec2(uv * vec2(textureSize(surface, 0))), 0);
#endif
    return shading_of(s.p, s.normal, -normalize(frame_ray(uv)), s.base.rgb, kind);
}
