// An engine with two effects in one picture each, built against an installed roil and nothing of
// its source, as C and as C++.
//
//   engine FOLDER EFFECT.lua EFFECT.lua   draws frame 3 of both, to FOLDER/0.png and FOLDER/1.png
#include <roil.h>
#include <stdio.h>
#include <string.h>

enum { WIDTH = 96, HEIGHT = 54, FRAME = 3 };

#if ROIL_VERSION_MAJOR != 0 || ROIL_VERSION_MINOR < 1
#error "this engine was written for roil 0.1"
#endif

static bool fail(void) {
    fprintf(stderr, "engine: %s\n", roil_error());
    return false;
}

// Draws the effect, and another time into the engine's own memory.
static bool draw(roil_effect *e, const char *picture) {
    static uint8_t pixels[WIDTH * HEIGHT * 4], black[sizeof pixels];
    if (!roil_prepare(e, WIDTH, HEIGHT) || !roil_render(e, FRAME)) return fail();
    if (!roil_save(e, picture, NULL) || !roil_read(e, false, pixels)) return fail();
    return memcmp(pixels, black, sizeof pixels) != 0;
}

int main(int argc, char **argv) {
    roil_desc desc;
    roil_effect *effects[2] = {NULL, NULL};
    char version[32], picture[4096];
    if (argc != 4) return 2;
    snprintf(version, sizeof version, "%d.%d.%d", ROIL_VERSION_MAJOR, ROIL_VERSION_MINOR,
             ROIL_VERSION_PATCH);
    if (strcmp(version, roil_version()) != 0) return 3; // other headers than the library's
    memset(&desc, 0, sizeof desc);
    roil *r = roil_create(&desc);
    bool done = r || fail();
    for (int i = 0; done && i < 2; i++) {
        effects[i] = roil_load(r, argv[2 + i], NULL, 0);
        done = effects[i] || fail();
    }
    for (int i = 0; done && i < 2; i++) {
        snprintf(picture, sizeof picture, "%s/%d.png", argv[1], i);
        done = draw(effects[i], picture);
    }
    done = done && roil_validation_messages(r) == 0;
    for (int i = 0; i < 2; i++) roil_unload(effects[i]);
    roil_destroy(r);
    return done ? 0 : 1;
}
