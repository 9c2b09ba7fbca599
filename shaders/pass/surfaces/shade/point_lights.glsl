// The light of the point lights that a surface sends back.
//@ option point_light_shadows = maps {maps, rays, none} : which point lights cast shadows: maps: those that have maps; rays: all, the others by a ray to each; none: none
#if HAS_POINT_LIGHTS

// Part of a point light that no mesh hides.
float point_light_seen(point_light l, light_ray ray, shaded s) {
#if HAS_SHADOW_MAPS && POINT_LIGHT_SHADOWS != POINT_LIGHT_SHADOWS_NONE
    shadow_maps maps = shadow_maps_of_point_light(l.index);
    if (maps.count > 0) return shadow_of(maps, false, l.position, s.position, s.normal);
#endif
#if POINT_LIGHT_SHADOWS == POINT_LIGHT_SHADOWS_RAYS
    float far = ray.distance - l.radius;
    return far > 0.0 && bvh_occluded(s.position, ray.direction, 0.0, far) ? 0.0 : 1.0;
#else
    return 1.0;
#endif
}

reflected point_light_reflected(point_light l, shaded s) {
    light_ray ray = point_light_ray(l, s.position);
    reflected given = shading_respond(s, ray.direction, ray.irradiance);
    if (any(greaterThan(given.white + given.shine, vec3(0.0)))) shading_dim(given, vec3(point_light_seen(l, ray, s)));
    return given;
}

void add_point_lights(inout reflected sum, shaded s, ivec2 pixel) {
    for (point_light_list list = point_lights_at(pixel); point_lights_next(list);) {
        point_light l = point_lights_get(list);
        if (point_light_reaches(l, s.position, s.normal)) shading_add(sum, point_light_reflected(l, s));
    }
}
#endif
