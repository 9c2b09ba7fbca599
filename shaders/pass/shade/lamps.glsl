// The light of the lamps of `point_lights` that a surface sends back.
#if HAS_LAMPS

reflected lamp_reflected(lamp l, shaded s) {
    light_ray ray = lamp_ray(l, s.position);
#if HAS_SHADOW_MAPS
    ray.irradiance *= shadow_of(shadow_maps_of_lamp(l.index), false, l.position, s.position, s.normal);
#endif
    return shading_respond(s, ray.direction, ray.irradiance);
}

void add_lamps(inout reflected sum, shaded s, ivec2 pixel) {
    for (lamp_list list = lamps_at(pixel); lamps_next(list);)
        shading_add(sum, lamp_reflected(lamps_get(list), s));
}
#endif
