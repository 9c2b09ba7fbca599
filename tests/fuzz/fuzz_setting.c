// Palettes and curves as text: what is taken prints as text that is taken again, and is the same.
#include "base/error.h"
#include "field/curve.h"
#include "field/palette.h"
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void try_palette(const char *text) {
    palette_stop stops[PALETTE_MAX_STOPS], again[PALETTE_MAX_STOPS];
    size_t count, count_again;
    if (!palette_parse(text, stops, &count)) return;
    strbuf printed = {0}, twice = {0};
    palette_print(stops, count, &printed);
    if (!palette_parse(strbuf_text(&printed), again, &count_again) || count_again != count) abort();
    palette_print(again, count, &twice);
    if (strcmp(strbuf_text(&printed), strbuf_text(&twice)) != 0) abort();
    strbuf_free(&printed);
    strbuf_free(&twice);
}

static void try_curve(const char *text) {
    curve_key keys[CURVE_MAX_KEYS], keys_again[CURVE_MAX_KEYS];
    curve c, again;
    if (!curve_parse(text, keys, &c) || !c.count) return;
    strbuf printed = {0}, twice = {0};
    curve_print(&c, &printed);
    if (!curve_parse(strbuf_text(&printed), keys_again, &again) || again.count != c.count) abort();
    curve_print(&again, &twice);
    if (strcmp(strbuf_text(&printed), strbuf_text(&twice)) != 0) abort();
    strbuf_free(&printed);
    strbuf_free(&twice);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    char *text = malloc(size + 1);
    if (!text) abort();
    if (size) memcpy(text, data, size);
    text[size] = '\0';
    try_palette(text);
    try_curve(text);
    free(text);
    return 0;
}
