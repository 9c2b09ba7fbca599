// The light of the lamps of `point_lights` that a surface sends back.
//@ option lamp_shadows = maps {maps, rays, none} : which lamps of point_lights cast shadows: maps: those that have maps; rays: all, the others by a ray to each; none: none
#if HAS_LAMPS

// Part of a lamp that no mesh hides.
float lamp_seen(lamp l, light_ray ray, shaded s) {
#if HAS_SHADOW_MAPS && LAMP_SHADOWS != LAMP_SHADOWS_NONE
    shadow_maps maps = shadow_maps_of_lamp(l.index);
    if (maps.count > 0) return shadow_of(maps, false, l.position, s.position, s.normal);
#endif
#if LAMP_SHADOWS == LAMP_SHADOWS_RAYS
    float far = ray.distance - l.radius;
    return far > 0.0 && bvh_occluded(s.position, ray.direction, 0.0, far) ? 0.0 : 1.0;
#else
    return 1.0;
#endif
}

reflected lamp_reflected(lamp l, shaded s) {
    light_ray ray = lamp_ray(l, s.position);
    reflected given = shading_respond(s, ray.direction, ray.irradiance);
    if (any(greaterThan(given.white + given.shine, vec3(0.0)))) shading_dim(given, vec3(lamp_seen(l, ray, s)));
    return given;
}

void add_lamps(inout reflected sum, shaded s, ivec2 pixel) {
    for (lamp_list list = lamps_at(pixel); lamps_next(list);) {
        lamp l = lamps_get(list);
        if (lamp_reaches(l, s.position, s.normal)) shading_add(sum, lamp_reflected(l, s));
    }
}
#endif
