// An engine that embeds libroil needs no more than this: a device, an effect, a frame, a file.
// Numbers in files have a point, also when the engine has chosen a locale that writes a comma.
#include "roil.h"
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char effect[] =
    "local fx = effect { name = 'embed' }\n"
    "assert(tostring(1.5) == '1.5' and tonumber('2.5') == 2.5)\n"
    "assert(string.format('%.1f', 0.5) == '0.5')\n"
    "local size = param { 'size', 1.25, min = 0.5, max = 2.5 }\n"
    "local cloud = sphere { radius = size } * (perlin { frequency = 1.5 } + 1.5)\n"
    "local smoke = march { density = cloud * 2.5 }\n"
    "fx.camera = orbit { distance = 4.5 }\n"
    "fx.output = final { smoke }.color\n"
    "return fx\n";

static bool draw(roil *r, const char *file, const char *picture) {
    const roil_setting settings[] = {{"march.steps", "16"}, {"size", "1.75"}};
    roil_effect *e = roil_load(r, file, settings, 2);
    bool done = e && roil_prepare(e, 96, 54) && roil_render(e, 12) && roil_save(e, picture, NULL);
    if (!done) fprintf(stderr, "%s\n", roil_error());
    roil_unload(e);
    return done;
}

static bool write_text(const char *file, const char *text) {
    FILE *f = fopen(file, "w");
    return f && fputs(text, f) >= 0 && fclose(f) == 0;
}

static bool same(const char *a, const char *b) {
    roil_difference d;
    return roil_compare(&(roil_comparison){.a = a, .b = b}, &d) && isinf(d.psnr);
}

int main(void) {
    const char *home = getenv("ROIL_SOURCE_DIR"), *out = getenv("ROIL_BINARY_DIR");
    char file[4096], pictures[2][4096];
    snprintf(file, sizeof file, "%s/embed.lua", out);
    for (int i = 0; i < 2; i++)
        snprintf(pictures[i], sizeof pictures[i], "%s/embed-%d.png", out, i);
    if (!write_text(file, effect)) return EXIT_FAILURE;
    roil *r = roil_create(&(roil_desc){.home = home});
    bool done = r && draw(r, file, pictures[0]);
    if (!setlocale(LC_ALL, "de_DE.UTF-8") || strcmp(localeconv()->decimal_point, ",") != 0) {
        fprintf(stderr, "no locale de_DE.UTF-8 in LOCPATH (Debian: locales)\n");
        return EXIT_FAILURE;
    }
    done = done && draw(r, file, pictures[1]) && same(pictures[0], pictures[1]);
    bool silent = !r || roil_validation_messages(r) == 0;
    roil_destroy(r);
    return done && silent ? EXIT_SUCCESS : EXIT_FAILURE;
}
