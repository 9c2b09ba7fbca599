// The numbers that a script, a setting or a window may give to what stands around the volume.
#include "scene/material.h"
#include <math.h>
#include <stddef.h>

#define VALUE(TYPE, NAME, UNIT, HELP)                                                              \
    .desc.name = #NAME, .desc.unit = UNIT, .desc.help = HELP, .offset = offsetof(TYPE, NAME)
#define NUMBER(DEFAULT, MIN, MAX)                                                                  \
    .desc.components = 1, .desc.value = {DEFAULT}, .desc.min = MIN, .desc.max = MAX
#define VECTOR(X, Y, Z) .desc.components = 3, .desc.value = {X, Y, Z}
#define COLOR(R, G, B)                                                                             \
    .desc.type = VALUE_COLOR, .desc.components = 3, .desc.value = {R, G, B}, .desc.max = INFINITY
#define NO_DEFAULT(FORM) .desc.form = FORM
#define REQUIRED(FORM) .desc.form = FORM, .desc.required = true
#define END                                                                                        \
    { .desc.name = NULL }

// clang-format off
const scene_value scene_camera_values[] = {
    {VALUE(scene_camera, eye, "m", "where it stands"), VECTOR(0, 0, 0), REQUIRED("{x, y, z} m")},
    {VALUE(scene_camera, target, "m", "what it looks at"), VECTOR(0, 0, 1)},
    {VALUE(scene_camera, distance, "m", "from the target"), NUMBER(6, 0.001f, INFINITY), .need = SCENE_ORBIT},
    {VALUE(scene_camera, yaw, "degrees", "about +Z; 0 looks along +Y"), NUMBER(0, -360, 360), .need = SCENE_ORBIT},
    {VALUE(scene_camera, pitch, "degrees", "height of the eye above the target's horizon"), NUMBER(10, -89.9f, 89.9f),
        .need = SCENE_ORBIT},
    {VALUE(scene_camera, fov, "degrees", "vertical field of view"), NUMBER(40, 1, 170)},
    {VALUE(scene_camera, near, "m", "nothing nearer is seen"), NUMBER(0.1f, 0.0001f, INFINITY)},
    {VALUE(scene_camera, far, "m", "nothing solid farther away is seen"), NUMBER(1000, 0.001f, INFINITY)},
    {VALUE(scene_camera, orthographic, "m", "height of what is seen by lines of sight that are parallel, whatever `fov` says; 0: perspective"),
        NUMBER(0, 0, 1e6f)},
    {VALUE(scene_camera, aperture, "m", "diameter of the lens, by which is blurred what is not in focus, where a picture is averaged (`roil render --samples`) or traced (`reference`); 0, or with `orthographic`: all is sharp"),
        NUMBER(0, 0, 1e3f)},
    {VALUE(scene_camera, focus, "m", "how deep in the picture all is sharp; 0: as deep as the target is far"), NUMBER(0, 0, INFINITY)},
    END,
};

const scene_value scene_sun_values[] = {
    {VALUE(scene_sun, azimuth, "degrees", "where it stands: about +Z, from +X"), NUMBER(240, -360, 360)},
    {VALUE(scene_sun, elevation, "degrees", "above the horizon"), NUMBER(44, -90, 90)},
    {VALUE(scene_sun, color, "", "multiplies the strength"), COLOR(1, 1, 1)},
    {VALUE(scene_sun, strength, "W/m^2", "irradiance of what faces it"), NUMBER(2.5f, 0, INFINITY)},
    {VALUE(scene_sun, angle, "degrees", "how wide it looks: softens shadows"), NUMBER(0.53f, 0, 180)},
    END,
};

const scene_value scene_sky_values[] = {
    {VALUE(scene_sky, zenith, "", "radiance straight up"), COLOR(0.22f, 0.32f, 0.48f), .need = SCENE_GRADIENT},
    {VALUE(scene_sky, horizon, "", "radiance at the horizon and below"), COLOR(0.22f, 0.32f, 0.48f),
        .need = SCENE_GRADIENT},
    {VALUE(scene_sky, strength, "", "factor of its light; of an image 1 if not given"), NUMBER(0.6f, 0, INFINITY)},
    {VALUE(scene_sky, rotation, "degrees", "of the image, about +Z"), NUMBER(0, -360, 360), .need = SCENE_IMAGE},
    {VALUE(scene_sky, night, "", "how much of the sky is night, over its colours or its image: dark, with stars"),
        NUMBER(0, 0, 1), NO_DEFAULT("none [0, 1]"), .need = SCENE_NIGHT},
    {VALUE(scene_sky, night_zenith, "", "radiance of the night straight up"), COLOR(0.003f, 0.006f, 0.016f),
        .need = SCENE_NIGHT},
    {VALUE(scene_sky, night_horizon, "", "radiance of the night at the horizon"), COLOR(0.012f, 0.018f, 0.034f),
        .need = SCENE_NIGHT},
    {VALUE(scene_sky, stars, "", "factor of what stars and moon shine"), NUMBER(1, 0, INFINITY), .need = SCENE_NIGHT},
    {VALUE(scene_sky, moon, "degrees", "how wide the moon looks, which stands where the sun does; 0: none"),
        NUMBER(0, 0, 90), .need = SCENE_NIGHT},
    END,
};

const scene_value scene_light_values[] = {
    {VALUE(scene_light, position, "m", "where it stands"), VECTOR(0, 0, 0), REQUIRED("{x, y, z} m")},
    {VALUE(scene_light, color, "", "multiplies the power"), COLOR(1, 1, 1)},
    {VALUE(scene_light, power, "W", "as light into all directions, of which a spot's cone is cut out"),
        NUMBER(100, 0, INFINITY)},
    {VALUE(scene_light, range, "m", "beyond which nothing is lit; 0: none"), NUMBER(0, 0, INFINITY)},
    {VALUE(scene_light, radius, "m", "of the sphere that glows: softens shadows; a sphere_light needs it"),
        NUMBER(0, 0, INFINITY), .need = SCENE_SPHERE},
    {VALUE(scene_light, target, "m", "where it shines"), VECTOR(0, 0, 0), .need = SCENE_CONE},
    {VALUE(scene_light, angle, "degrees", "across the cone"), NUMBER(45, 0.1f, 360), .need = SCENE_CONE},
    {VALUE(scene_light, softness, "", "part of the cone over which it fades"), NUMBER(0.15f, 0, 1), .need = SCENE_CONE},
    END,
};

const scene_value scene_material_values[] = {
    {VALUE(scene_material, color, "", "of the whole mesh"), COLOR(1, 1, 1), NO_DEFAULT("the file's")},
    {VALUE(scene_material, specular, "", "how much is mirrored: 0.5 is 4 percent of what comes head on, as of most things; 0: matte"),
        NUMBER(0, 0, 1), NO_DEFAULT("0.5 with roughness or metallic, else the file's [0, 1]")},
    {VALUE(scene_material, roughness, "", "0: polished; 1: highlights spread over all"), NUMBER(0, 0, 1),
        NO_DEFAULT("the file's [0, 1]")},
    {VALUE(scene_material, metallic, "", "1: mirrors in its colour, and does nothing else"), NUMBER(0, 0, 1),
        NO_DEFAULT("the file's [0, 1]")},
    {VALUE(scene_material, emission, "", "radiance that it gives off; of instances times `glow`"), COLOR(0, 0, 0),
        NO_DEFAULT("the file's")},
    END,
};

const scene_value scene_mesh_values[] = {
    {VALUE(scene_mesh, position, "m", "where its origin goes"), VECTOR(0, 0, 0)},
    {VALUE(scene_mesh, rotation, "degrees", "about X, then Y, then Z"), VECTOR(0, 0, 0)},
    {VALUE(scene_mesh, scale, "", "factor of its size"), NUMBER(1, 0, 0)},
    {VALUE(scene_mesh, color, "", "multiplies the material's"), .desc.type = VALUE_COLOR, VECTOR(1, 1, 1)},
    END,
};

const scene_value scene_node_values[] = {
    {VALUE(scene_node, position, "m", "where its origin goes"), VECTOR(0, 0, 0)},
    {VALUE(scene_node, rotation, "degrees", "about X, then Y, then Z"), VECTOR(0, 0, 0)},
    {VALUE(scene_node, scale, "", "factor of its size"), NUMBER(1, 0, 0)},
    END,
};
// clang-format on

const field **scene_slot(void *structure, const scene_value *value) {
    return (const field **)(void *)((char *)structure + value->offset);
}

void scene_set_defaults(const scene_value *values, unsigned needs, void *structure, arena *memory) {
    for (const scene_value *v = values; v->desc.name; v++) {
        const field **slot = scene_slot(structure, v);
        if (!*slot && !v->desc.form && (v->need & needs) == v->need)
            *slot = field_constant(memory, v->desc.components, v->desc.value);
    }
}

bool scene_has(const scene *s, scene_need need) {
    switch (need) {
    case SCENE_ORBIT:
        return !s->camera.eye;
    case SCENE_GRADIENT:
        return !s->sky.image;
    case SCENE_IMAGE:
        return s->sky.image;
    case SCENE_NIGHT:
        return s->sky.night;
    default:
        return true;
    }
}
