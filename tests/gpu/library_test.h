// The library's pictures of templates, for tests.
#pragma once
#include "gpu_test.h"
#include "pass/templates.h"

static inline picture *library_picture(arena *memory, const char *name) {
    const char *root = getenv("ROIL_SOURCE_DIR");
    picture *out = arena_alloc(memory, sizeof *out);
    char path[4200];
    snprintf(path, sizeof path, "%s/effects/templates/%s.exr", root, name);
    gpu_test_ok(picture_read(path, root, 4096, memory, out));
    assert_int_equal(out->width, TEMPLATE_TILE);
    return out;
}
