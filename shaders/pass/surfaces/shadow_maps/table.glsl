// What of the table is fixed before a frame (src/pass/surfaces/shadow_maps.c), and how a light is found in it.
#define SHADOW_GROUP 256
#define SHADOW_FACES 6
layout(std430) writeonly buffer Views { view_entry views_drawn[]; };
uniform vec4 fixed_views[SHADOW_VIEW_VECTORS * max(SHADOW_FIXED, 1)]; // of the sun and of spots
uniform vec4 places[max(SHADOW_VIEWS, 1)]; // in the atlas: x, y, width, height
uniform vec4 fixed_lights[LIGHT_MAX];      // x: first view; y: how many; below 0: it competes for one
uniform float margin;                      // texels at the edges of a view
uniform float pixels;                      // of a metre at 1 m of the camera

#ifndef HAS_POINT_LIGHTS
#define HAS_POINT_LIGHTS 0
#endif

// Lights come first, then point_lights.
int shadow_candidates() {
#if HAS_POINT_LIGHTS
    return light_count() + textureSize(point_lights, 0).y;
#else
    return light_count();
#endif
}

light_entry candidate_of(int index) {
#if HAS_POINT_LIGHTS
    int point_light = index - light_count();
    if (point_light >= 0)
        return light_entry(texelFetch(point_lights, ivec2(0, point_light), 0), texelFetch(point_lights, ivec2(1, point_light), 0),
                           texelFetch(point_lights, ivec2(2, point_light), 0), texelFetch(point_lights, ivec2(3, point_light), 0));
#endif
    return light_entry_of(index);
}

bool competes(int index) {
    return index >= light_count() || index >= LIGHT_MAX || fixed_lights[index].y < 0.0;
}
