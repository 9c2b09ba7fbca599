// Recipes of strangers: any PNG file gives one whose parts are sane, or a message.
#include "base/error.h"
#include "effect/recipe.h"
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void check(const recipe *r) {
    if (!(r->frame >= 0 && r->frame <= 1e9) || !r->width || !r->height) abort();
    if (r->width > 16384 || r->height > 16384) abort();
    if (r->setting_count > RECIPE_MAX_SETTINGS) abort();
    if (r->file && (r->file[0] == '/' || strstr(r->file, "/../"))) abort();
    for (size_t i = 0; i < r->setting_count; i++)
        if (!r->settings[i].name[0] || strchr(r->settings[i].text, '\n')) abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    arena memory = {0};
    png_text texts[PNG_MAX_TEXTS];
    size_t count;
    recipe r;
    err_clear();
    if (png_decode_texts(data, size, "fuzz.png", &memory, texts, &count) &&
        recipe_read(texts, count, &memory, &r))
        check(&r);
    else if (!err_get()[0])
        abort();
    arena_free(&memory);
    return 0;
}
