// Pictures of templates on the device: tiles below each other, values times alpha, alpha.
#ifndef LIB_TEMPLATE_PICTURES_GLSL
#define LIB_TEMPLATE_PICTURES_GLSL
uniform sampler2D TemplateImages;

// Of a template, half of whose side is so many texels of what it is put into.
float template_level(float half_side) {
    return max(log2(float(textureSize(TemplateImages, 0).x) * 0.5 / half_side), 0.0);
}

// `at`: from the middle, in halves of the side; the upper edge is at +1.
vec4 template_picture(vec2 at, float tile, float level) {
    vec2 size = vec2(textureSize(TemplateImages, 0)); // one tile wide
    float inside = 1.0 - exp2(level) / size.x;
    at = clamp(at, -inside, inside);
    return textureLod(TemplateImages, vec2(0.5 + 0.5 * at.x, (tile + 0.5 - 0.5 * at.y) * size.x / size.y), level);
}
#endif
