// A thread for each particle: small ones are drawn at once, the others kept and counted for the
// tiles that they touch.
#if defined(STAGE_PROJECT) && BLEND != BLEND_SORTED

// A point of the picture, in the four pixels around it: whatever its place, all of it is in them.
void add_point(splat s, vec3 at, vec3 light, float opacity) {
    vec2 corner = floor(at.xy - 0.5), part = at.xy - 0.5 - corner;
    opacity *= splat_visible(ivec2(floor(at.xy)), at.z);
    if (opacity <= 0.0) return;
    for (int i = 0; i < 4; i++) {
        ivec2 side = ivec2(i & 1, i >> 1), pixel = ivec2(corner) + side;
        if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, ivec2(picture)))) continue;
        vec2 share = mix(1.0 - part, part, vec2(side));
        splat_add(splat_part(light, opacity * share.x * share.y, at.z, s.seed, pixel), pixel);
    }
}

// A streak is points no more than a pixel apart.
void add_small(looks l) {
    vec4 mean = look_mean(l.s);
    float whole = l.s.opacity * mean.a * l.s.radius * l.s.radius;
    int count = max(int(ceil(distance(l.s.at, l.before.xy))), 1);
    for (int i = 0; i < count; i++) {
        float part = (float(i) + 0.5) / float(count);
        vec3 at = count > 1 ? mix(vec3(l.s.at, l.s.depth), l.before, part) : vec3(l.s.at, l.s.depth);
        add_point(l.s, at, l.s.color * mean.rgb, whole / float(count));
    }
}

void count_tiles(splat s) {
    ivec4 box = splat_tile_box(s);
    for (int y = box.y; y < box.w; y++)
        for (int x = box.x; x < box.z; x++)
            if (splat_meets(s, ivec2(x, y))) atomicAdd(splat_tiles[splat_tile(ivec2(x, y))].y, 1u);
}

void add_tiles(splat s) {
    ivec4 box = splat_tile_box(s);
    for (int y = box.y; y < box.w; y++)
        for (int x = box.x; x < box.z; x++)
            if (splat_meets(s, ivec2(x, y))) splat_add_tile(s, ivec2(x, y));
}

void main() {
    looks l = look_at(slot_of_thread());
    if (!l.seen) return;
    if (l.s.radius <= SMALL && distance(l.s.at, l.before.xy) <= SHORT) {
        count_small(1);
        add_small(l);
        return;
    }
    count_large(1);
    uint index = atomicAdd(splat_found, 1u);
    splat s = look_spread(l);
    if (index < records_most) {
        splat_keep(index, s);
        count_tiles(s);
    } else {
        add_tiles(s);
    }
}
#endif
