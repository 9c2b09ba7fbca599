// What engines expect of a sheet, as rows of a table: nothing else knows an engine.
//
// A flipbook blends the frame before and the one after, each moved along its own motion: the first
// is sampled at uv - motion * part, the second at uv + motion * (1 - part). In which direction a
// channel counts is the sign here. Unity: VFX Graph, VFXCommonOutput.hlsl; Houdini: the flipbook
// shader MotionVector.shader of 2018, which adds and turns the green channel; Unreal and Godot have
// uv from the top, and Unreal reads normals as DirectX does.
#include "base/memory.h"
#include "base/words.h"
#include "roil/sheet.h"
#include <string.h>

static const sheet_engine engines[] = {
    {NULL, "none", 1, 1, 1, "premultiplied", {NULL}},
    {"unity",
     "Unity, VFX Graph",
     1,
     1,
     1,
     "premultiplied",
     {"Import %s as a texture with sRGB on and `Alpha Is Transparency` off, all other maps with "
      "sRGB off and "
      "without compression",
      "Output Particle: Blend Mode `Premultiply`, Uv Mode `Flipbook Motion Blend`, Flip Book Size "
      "as `grid`",
      "Motion Vector Map: the map `motion`; Motion Vector Scale: its `scale`",
      "Six-way: Output Particle `Six Way Smoke Lit`, Lightmap Positive: `right-top-back`, Lightmap "
      "Negative: "
      "`left-bottom-front`, Emissive from its alpha times `scale`",
      NULL}},
    {"unreal",
     "Unreal Engine",
     1,
     -1,
     -1,
     "premultiplied",
     {"Import %s with sRGB on, all other maps with sRGB off and Compression `Vector "
      "Displacementmap`",
      "Material: Blend Mode `AlphaComposite (Premultiplied Alpha)`, Shading Model `Unlit`",
      "Niagara: Sprite Renderer, Sub Image Size as `grid`, Sub UV Blending on",
      "Sample at uv - (motion * 2 - 1) * scale / grid * blend for the first frame, and at uv + "
      "(motion * 2 - 1) * "
      "scale / grid * (1 - blend) for the second",
      NULL}},
    {"godot",
     "Godot",
     1,
     -1,
     1,
     "premultiplied",
     {"Import %s and its maps as textures without filter borders; no compression for maps",
      "CanvasItem: `render_mode blend_premul_alpha, unshaded;`",
      "Shader: sample at uv - (motion * 2 - 1) * scale / grid * blend for the first frame, and at "
      "uv + (motion * 2 - "
      "1) * scale / grid * (1 - blend) for the second",
      NULL}},
    {"labs",
     "SideFX Labs flipbook shader",
     -1,
     1,
     1,
     "straight",
     {"Import %s with sRGB on, the map `motion` with sRGB off",
      "Set the columns and rows of the shader as `grid`, and its motion vector strength to `scale`",
      NULL}},
};

const sheet_engine *sheet_find_engine(const char *name) {
    const char *names[COUNT_OF(engines)];
    size_t count = 0;
    if (!name) return &engines[0];
    for (size_t i = 1; i < COUNT_OF(engines); i++) {
        if (strcmp(engines[i].name, name) == 0) return &engines[i];
        names[count++] = engines[i].name;
    }
    words_refuse(names, count, name, NULL, "engine '%s'", name);
    return NULL;
}
