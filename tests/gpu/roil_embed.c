// An engine that embeds libroil needs no more than this: a device, an effect, a frame, a file.
#include "roil.h"
#include <stdio.h>
#include <stdlib.h>

int main(void) {
    const char *home = getenv("ROIL_SOURCE_DIR"), *out = getenv("ROIL_BINARY_DIR");
    char file[4096], picture[4096];
    snprintf(file, sizeof file, "%s/effects/heat_haze.lua", home);
    snprintf(picture, sizeof picture, "%s/embed.png", out);
    roil *r = roil_create(&(roil_desc){.home = home});
    roil_effect *e = r ? roil_load(r, file, &(roil_setting){"march.steps", "16"}, 1) : NULL;
    bool done = e && roil_prepare(e, 96, 54) && roil_render(e, 12) && roil_save(e, picture, NULL);
    if (!done) fprintf(stderr, "%s\n", roil_error());
    roil_unload(e);
    bool silent = !r || roil_validation_messages(r) == 0;
    roil_destroy(r);
    return done && silent ? EXIT_SUCCESS : EXIT_FAILURE;
}
