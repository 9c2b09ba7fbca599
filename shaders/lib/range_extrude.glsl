// Ranges of slices round an axis (lib/extrude.glsl): over all slices, what lies as far from the axis
// as the box does.
#ifndef LIB_RANGE_EXTRUDE_GLSL
#define LIB_RANGE_EXTRUDE_GLSL
#include "lib/range_grid.glsl"
#include "lib/range_operator.glsl"
#include "lib/extrude.glsl"

// Of a part of the slices, from `low` to `high` (0..1).
range4 extrude_part(sampler3D ranges, sampler3D values, vec2 low, vec2 high, vec2 layers, vec3 count) {
    range3 part = range3(vec3(low, layers.x), vec3(high, layers.y));
    return range_fetch(ranges, values, part, vec3(0.0), vec3(1.0), vec3(0.0), vec3(1.0), count);
}

range4 extrude_range(sampler3D ranges, sampler3D values, vec4 x, vec4 y, vec4 z, vec4 size, range3 p, vec3 count) {
    const float inexact = 1e-5;
    range3 q = range_transform(p, x, y, z);
    float bottom = q.low.z - inexact, top = q.high.z + inexact;
    if (size.z >= 0.0) {
        float angle = size.z / size.w * EXTRUDE_PI, layer = (size.z + 0.5) / (size.w + 1.0);
        range1 r = range_add(range_mul(range_x(q), range_number(cos(angle))),
                             range_mul(range_y(q), range_number(sin(angle))));
        return extrude_part(ranges, values, vec2(0.5 + r.low - inexact, bottom),
                            vec2(0.5 + r.high + inexact, top), vec2(layer), count);
    }
    vec2 near = max(max(q.low.xy, -q.high.xy), vec2(0.0)), far = max(abs(q.low.xy), abs(q.high.xy));
    float least = max(length(near) - inexact, 0.0), most = length(far) + inexact;
    const vec2 all_layers = vec2(0.0, 1.0);
    return range_union(extrude_part(ranges, values, vec2(0.5 - most, bottom),
                                    vec2(0.5 - least, top), all_layers, count),
                       extrude_part(ranges, values, vec2(0.5 + least, bottom),
                                    vec2(0.5 + most, top), all_layers, count));
}

// Of vectors: outward is any direction across the axis.
range4 extrude_vector_range(sampler3D ranges, sampler3D values, vec4 x, vec4 y, vec4 z, vec4 size, range3 p, vec3 count) {
    range4 v = extrude_range(ranges, values, x, y, z, size, p, count);
    range1 along = range_y(v);
    vec3 axis = size.y * z.xyz, most = max(abs(v.low.x), abs(v.high.x)) * sqrt(max(1.0 - axis * axis, 0.0));
    range1 part[3];
    for (int i = 0; i < 3; i++)
        part[i] = range_add(range_make(-most[i], most[i]), range_mul(along, range_number(axis[i])));
    return range_vec(part[0], part[1], part[2], range_w(v));
}

#endif
