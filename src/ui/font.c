// The window's fonts, which fontconfig finds among those installed.
#include "base/file.h"
#include "base/memory.h"
#include "ui/parts.h"
#include <fontconfig/fontconfig.h>
#include <string.h>

enum { MAX_FONT_BYTES = 64 << 20 };

static const struct {
    const char *family, *fallback;
    int weight;
} wanted[FONT_KIND_COUNT] = {
    [FONT_TEXT] = {"Inter", "sans", FC_WEIGHT_REGULAR},
    [FONT_STRONG] = {"Inter", "sans", FC_WEIGHT_DEMIBOLD},
    [FONT_MONO] = {"DejaVu Sans Mono", "monospace", FC_WEIGHT_REGULAR},
};

static FcPattern *font_find(font_kind kind) {
    FcPattern *pattern = FcPatternCreate();
    FcPatternAddString(pattern, FC_FAMILY, (const FcChar8 *)wanted[kind].family);
    FcPatternAddString(pattern, FC_FAMILY, (const FcChar8 *)wanted[kind].fallback);
    FcPatternAddInteger(pattern, FC_WEIGHT, wanted[kind].weight);
    FcPatternAddInteger(pattern, FC_SLANT, FC_SLANT_ROMAN);
    FcPatternAddBool(pattern, FC_SCALABLE, FcTrue);
    FcPatternAddBool(pattern, FC_VARIABLE, FcFalse);
    FcConfigSubstitute(NULL, pattern, FcMatchPattern);
    FcDefaultSubstitute(pattern);
    FcResult result;
    FcPattern *match = FcFontMatch(NULL, pattern, &result);
    FcPatternDestroy(pattern);
    return match;
}

// fontconfig also knows bitmap and Type 1 fonts, which the atlas does not read.
static bool is_outline(const font_file *file) {
    static const char kinds[][4] = {{0, 1, 0, 0}, "OTTO", "true", "ttcf"};
    for (size_t i = 0; file->size > 4 && i < COUNT_OF(kinds); i++)
        if (memcmp(file->data, kinds[i], 4) == 0) return true;
    return false;
}

font_file font_read(font_kind kind) {
    font_file file = {0};
    FcPattern *match = font_find(kind);
    FcChar8 *path = NULL;
    if (match && FcPatternGetString(match, FC_FILE, 0, &path) == FcResultMatch &&
        file_read((const char *)path, MAX_FONT_BYTES, &file.data, &file.size)) {
        if (FcPatternGetInteger(match, FC_INDEX, 0, &file.face) != FcResultMatch) file.face = 0;
        file.face &= 0xffff; // the upper half names an instance of a variable font
        if (!is_outline(&file)) font_free(&file);
    }
    if (match) FcPatternDestroy(match);
    return file;
}

void font_free(font_file *file) {
    mem_free(file->data);
    *file = (font_file){0};
}
