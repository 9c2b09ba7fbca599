// Instances as an effect shows them: where they stand, what a script sets while it runs, and that
// all is as it began when time has gone back.
#include "roil_test.h"

enum { WIDTH = 48, HEIGHT = 16 };

static const char SQUARE[] = "v -0.5 0 -0.5\nv 0.5 0 -0.5\nv 0.5 0 0.5\nv -0.5 0 0.5\nf 1 2 3 4\n";

// Three squares side by side, each 16 pixels wide. What has no material has a colour of 0.6.
static const char SCRIPT[] =
    "local fx = effect { name = 'squares', fps = 10, frames = 100 }\n"
    "fx.camera = camera { eye = {0, -4, 0}, target = {0, 0, 0}, fov = 14.25 }\n"
    "local moved = node { position = {0, 0, 1}, parent = node { position = {0, 0, -1} } }\n"
    "local row = instances { mesh { 'square.obj' }, at = { {-1, 0, 0}, {0, 0, 0}, {1, 0, 0} },\n"
    "    scale = { 0.8, 0.8, 0.8 }, color = { {0.5, 0, 0}, {0, 0.5, 0}, {0, 0, 0.5} },\n"
    "    tint = 2 / 0.6, parent = moved, state = function(i) return {i, 10 * i} end }\n"
    "fx.update = function(t)\n"
    "  if t > 0.05 then\n"
    "    row:set(1, { kind = 0 })\n"
    "    row:set({2, 3}, { state = 7, color = {0.5, 0.5, 0.5} })\n"
    "    row:set(2, { position = {-1, 0, 0} })\n"
    "    assert(row:get(2).state[1] == 7 and row:get(2).state[2] == 20)\n"
    "    assert(#row:near({-1, 0}, 0.5) == 2 and row:near({1, 0, 0}, 9)[1] == 3)\n"
    "  else\n"
    "    assert(#row == 3 and row:get(3).kind == 1 and row:get(3).state[2] == 30)\n"
    "  end\n"
    "  if t > 0.15 then row:reset() row:set_all { color = {'#ffffff', '#000000', '#ffffff'} } end\n"
    "end\n"
    "local scene = geometry { row, mode = 'rays' }\n"
    "fx.output = final { scene.albedo, tonemap = 'none' }\n"
    "return fx\n";

static void expect_squares(roil_effect *e, double frame, const float colors[3][3]) {
    uint8_t pixels[WIDTH * HEIGHT * 4];
    ok(roil_render(e, frame));
    ok(roil_read(e, false, pixels));
    for (uint32_t i = 0; i < 3; i++) {
        expect_pixel(pixels, WIDTH, 8 + 16 * i, 8, srgb(colors[i][0]), srgb(colors[i][1]),
                     srgb(colors[i][2]), 1);
        expect_pixel(pixels, WIDTH, 16 * i, 8, 0, 0, 0, 1); // between them
    }
}

static void squares_stand_and_change_and_come_back(void **state) {
    static const float first[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    static const float second[3][3] = {{1, 1, 1}, {0, 0, 0}, {1, 1, 1}};
    static const float third[3][3] = {{1, 1, 1}, {0, 0, 0}, {1, 1, 1}};
    char path[512];
    write_text("square.obj", SQUARE, path);
    roil_effect *e = load_text(*state, "squares.lua", SCRIPT);
    ok(roil_prepare(e, WIDTH, HEIGHT));
    expect_squares(e, 1, first);
    expect_squares(e, 2, second);
    expect_squares(e, 3, third);
    expect_squares(e, 1, first);
    roil_unload(e);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(squares_stand_and_change_and_come_back),
    };
    return test_run(tests);
}
