// A group for each tile, a thread for each pixel.
#if defined(STAGE_DRAW)
layout(local_size_x = TILE, local_size_y = TILE) in;

#if BLEND == BLEND_SORTED
// The tile's list, nearest first.
vec4 color_of_pixel(ivec2 pixel, uvec2 list) {
    vec3 light = vec3(0.0);
    float through = 1.0;
    for (uint i = list.x; i < list.y && through > LEAST_THROUGH; i++) {
        if (splat_misses(splat_pairs[i].y, pixel)) continue;
        splat s = splat_kept(splat_pairs[i].y);
        vec4 c = splat_at(s, vec2(pixel) + 0.5 - s.at);
        float covered = c.a > 0.0 ? c.a * splat_visible(pixel, s.depth) : 0.0;
        light += through * covered * c.rgb;
        through *= 1.0 - covered;
    }
    return vec4(min(light, MOST), 1.0 - through);
}
#else
// Leaves the sums empty for the next frame.
splat_sum take_sum(ivec2 pixel) {
    uint at = CHANNELS * uint(pixel.y * int(picture.x) + pixel.x);
    splat_sum sum = splat_sum(uvec3(splat_sums[at], splat_sums[at + 1u], splat_sums[at + 2u]), 0u, 0u);
#if BLEND == BLEND_WEIGHTED
    sum.weight = splat_sums[at + 3u];
    sum.log = splat_sums[at + 4u];
#endif
    for (uint i = 0u; i < CHANNELS; i++) splat_sums[at + i] = 0u;
    return sum;
}

// What was added to the pixel, and the tile's list.
vec4 color_of_pixel(ivec2 pixel, uvec2 list) {
    splat_sum sum = take_sum(pixel);
    for (uint i = list.x; i < min(list.y, entries_most); i++) {
        if (splat_misses(splat_entries[i], pixel)) continue;
        splat_sum part = splat_part_at(splat_kept(splat_entries[i]), pixel);
        sum.color += part.color;
        sum.weight += part.weight;
        sum.log += part.log;
    }
#if BLEND == BLEND_WEIGHTED
    float opacity = 1.0 - exp2(-float(sum.log) / LOG_UNIT);
    return vec4(min(vec3(sum.color) / max(float(sum.weight), 1.0) * opacity, MOST), opacity);
#else
    return vec4(min(vec3(sum.color) / UNIT, MOST), 0.0);
#endif
}
#endif

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(picture)))) return;
    imageStore(image, pixel, color_of_pixel(pixel, splat_tiles[splat_tile(ivec2(gl_WorkGroupID.xy))]));
#if HAS_DEPTH
    vec2 uv = (vec2(pixel) + 0.5) / picture;
    imageStore(edge, pixel, vec4(texelFetch(depth, ivec2(uv * vec2(textureSize(depth, 0))), 0).r));
#else
    imageStore(edge, pixel, vec4(1e9));
#endif
}
#endif
