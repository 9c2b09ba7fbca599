// Looking into an effect: which images it has, keeping them, and what is seen of them.
#include "roil_test.h"

enum { W = 8, H = 6, N = 48 }; // of the images, and of the texture

// Its output shows nothing of it: what is looked at is `values`, which its successor reads.
static const char *const values_shader =
    "// Known numbers; the count of frames in the last column.\n"
    "\n"
    "uniform sampler2D before;           //= input history values : the last frame's\n"
    "writeonly uniform image2D values;   //= output rgba32f : by place\n"
    "writeonly uniform image2D single;   //= output r16f : one channel\n"
    "writeonly uniform uimage2D whole;   //= output r32ui : whole numbers\n"
    "void main() {\n"
    "    ivec2 p = ivec2(gl_GlobalInvocationID.xy), size = imageSize(values);\n"
    "    if (any(greaterThanEqual(p, size))) return;\n"
    "    vec4 v = vec4(vec2(p) / 16.0, -0.5, 0.25);\n"
    "    if (p == ivec2(2, 1)) v.g = uintBitsToFloat(0x7f800000u);\n"
    "    if (p.x == size.x - 1) v = texelFetch(before, p, 0) + 1.0;\n"
    "    imageStore(values, p, v);\n"
    "    imageStore(single, p, vec4(0.5));\n"
    "    imageStore(whole, p, uvec4(3000000000u));\n"
    "}\n";
static const char *const copy_shader =
    "// Copies.\n"
    "\n"
    "uniform sampler2D source;          //= input : what is copied\n"
    "writeonly uniform image2D color;   //= output rgba32f : the copy\n"
    "void main() {\n"
    "    ivec2 p = ivec2(gl_GlobalInvocationID.xy);\n"
    "    if (any(greaterThanEqual(p, imageSize(color)))) return;\n"
    "    imageStore(color, p, texelFetch(source, p, 0));\n"
    "}\n";
static const char *const probe_shader =
    "// Reads a grid, so that it is baked.\n"
    "\n"
    "//@ field vec3 value : what is read\n"
    "uniform sampler2D source;          //= input : and a picture\n"
    "writeonly uniform image2D color;   //= output rgba32f : the sum\n"
    "#include \"fields.glsl\"\n"
    "void main() {\n"
    "    ivec2 p = ivec2(gl_GlobalInvocationID.xy);\n"
    "    if (any(greaterThanEqual(p, imageSize(color)))) return;\n"
    "    imageStore(color, p, texelFetch(source, p, 0) + vec4(field_value(vec3(0.5)), 0.0));\n"
    "}\n";
static const char *const place_glsl = "// Where a point lies, counted in voxels.\n"
                                      "vec3 place(vec3 p) { return floor(p) / 4.0; }\n";
static const char *const look_lua =
    "local fx = effect { name = 'look', fps = 24, frames = 99 }\n"
    "local where = glsl { 'place.glsl', 'place', components = 3 }\n"
    "local grid = bake(where, { size = {4, 3, 2}, box = { min = {0, 0, 0}, max = {4, 3, 2} } })\n"
    "local values = shader { 'values.comp' }\n"
    "local a = shader { 'copy.comp', values.values }\n"
    "local b = shader { 'copy.comp', a }\n"
    "local c = shader { 'copy.comp', b }\n"
    "local unused = shader { 'copy.comp', c }\n"
    "fx.output = shader { 'probe.comp', c, value = grid }.color\n"
    "return fx\n";
static const char *const solid_lua =
    "local fx = effect { name = 'solid', fps = 24, frames = 9 }\n"
    "fx.camera = camera { eye = {0, -5, 0}, target = {0, 0, 0} }\n"
    "local scene = geometry { mesh { 'wall.obj' }, mode = 'raster' }\n" // what has a depth buffer
    "local shown = final { source = scene, bloom = bloom { bright { scene } } }\n"
    "fx.output = shown.color\n"
    "return fx\n";
static const char *const wall_obj = "v -9 0 -9\nv 9 0 -9\nv 0 0 9\nf 1 2 3\n";

static roil_effect *open_effect(roil *r) {
    char path[512];
    write_text("values.comp", values_shader, path);
    write_text("copy.comp", copy_shader, path);
    write_text("probe.comp", probe_shader, path);
    write_text("place.glsl", place_glsl, path);
    roil_effect *e = load_text(r, "look.lua", look_lua);
    ok(roil_prepare(e, W, H));
    ok(roil_render(e, 1));
    return e;
}

// Keeps one image more and renders a frame with it.
static void keep(roil_effect *e, const char *image, double frame) {
    ok(roil_keep(e, image));
    ok(roil_prepare(e, W, H));
    ok(roil_render(e, frame));
}

// Four pixels for a texel, the image in the middle of the texture.
static roil_inspection plainly(const char *image) {
    return (roil_inspection){
        .image = image, .channels = 7, .center = {0.5f, 0.5f}, .zoom = 4, .cursor = {-1, -1}};
}

// What is seen: drawn into a texture, which a window shows as it is.
static void look(roil *r, roil_effect *e, const roil_inspection *how, uint8_t out[N * N * 4]) {
    static const roil_vertex corners[4] = {{0, 0, 0, 0, 0xffffffff},
                                           {N, 0, 1, 0, 0xffffffff},
                                           {0, N, 0, 1, 0xffffffff},
                                           {N, N, 1, 1, 0xffffffff}};
    static const uint32_t indices[6] = {0, 1, 2, 2, 1, 3};
    roil_texture *target = roil_texture_create(r, N, N, NULL);
    roil_texel texel;
    ok(target);
    ok(roil_inspect(e, how, target, &texel));
    roil_draw draw = {.texture = target, .count = 6, .clip = {0, 0, N, N}};
    ok(roil_show(r, &(roil_picture){.width = N,
                                    .height = N,
                                    .vertices = corners,
                                    .vertex_count = 4,
                                    .indices = indices,
                                    .index_count = 6,
                                    .draws = &draw,
                                    .draw_count = 1}));
    ok(roil_read_shown(r, out));
    roil_texture_destroy(r, target);
}

// After so many calls, as many as frames are in flight, the value is that of the first.
enum { LATER = GPU_FRAMES_IN_FLIGHT + 1 };

static roil_texel point_at(roil *r, roil_effect *e, roil_inspection how, float x, float y) {
    roil_texture *target = roil_texture_create(r, N, N, NULL);
    roil_texel texel = {0};
    ok(target);
    how.cursor[0] = x;
    how.cursor[1] = y;
    for (int i = 0; i < LATER; i++) ok(roil_inspect(e, &how, target, &texel));
    roil_texture_destroy(r, target);
    return texel;
}

static void expect_texel(roil_texel texel, uint32_t x, uint32_t y, uint32_t z, float red,
                         float green, float blue) {
    if (texel.valid && texel.at[0] == x && texel.at[1] == y && texel.at[2] == z &&
        texel.value[0] == red && texel.value[1] == green && texel.value[2] == blue)
        return;
    fail_msg("%s texel %u %u %u is %g %g %g", texel.valid ? "valid" : "invalid", texel.at[0],
             texel.at[1], texel.at[2], (double)texel.value[0], (double)texel.value[1],
             (double)texel.value[2]);
}

static uint8_t seen[N * N * 4];

// Of pixel `corner` (0 to 15) of the texel, when plainly shown.
static void expect_shown(uint32_t x, uint32_t y, int corner, int red, int green, int blue) {
    uint32_t left = (N - 4 * W) / 2 + (uint32_t)corner % 4;
    uint32_t top = (N - 4 * H) / 2 + (uint32_t)corner / 4;
    expect_pixel(seen, N, left + 4 * x, top + 4 * y, red, green, blue, 1);
}

static bool is_odd(uint32_t x, uint32_t y) { // infinite, or the count of frames
    return (x == 2 && y == 1) || x == W - 1;
}

#define FOR_TEXELS(x, y)                                                                           \
    for (uint32_t y = 0; y < H; y++)                                                               \
        for (uint32_t x = 0; x < W; x++)                                                           \
            if (!is_odd(x, y))

// ---- which images -----------------------------------------------------------------------------

static const roil_image_info *find(const roil_image_info *list, size_t count, const char *name) {
    for (size_t i = 0; i < count; i++)
        if (strcmp(list[i].name, name) == 0) return &list[i];
    fail_msg("no image %s", name);
    return NULL;
}

static void images_are_listed(void **state) {
    roil_image_info list[32];
    roil_effect *e = open_effect(*state), *fresh = load_text(*state, "look.lua", look_lua);
    assert_int_equal(roil_images(fresh, list, 32), 0); // not prepared
    roil_unload(fresh);
    size_t count = roil_images(e, list, 32);
    assert_int_equal(count, 10); // bake, 3 of values and a history, 4 copies, the sum
    assert_int_equal(roil_images(e, NULL, 0), count);
    const roil_image_info *bake = find(list, count, "bake");
    assert_true(bake->volume && !bake->culled && bake->mips == 1);
    assert_true(bake->size[0] == 4 && bake->size[1] == 3 && bake->size[2] == 2);
    assert_string_equal(bake->format, "rgba16f");
    const roil_image_info *values = find(list, count, "values.values");
    assert_true(!values->volume && values->size[0] == W && values->size[1] == H);
    assert_int_equal(values->size[2], 1);
    assert_string_equal(values->format, "rgba32f");
    assert_string_equal(find(list, count, "values.whole")->format, "r32ui");
    find(list, count, "values.values history");
    assert_false(find(list, count, "copy_3.color")->culled);
    assert_true(find(list, count, "copy_4.color")->culled);
    roil_unload(e);
}

static void only_what_is_kept_can_be_looked_at(void **state) {
    roil_effect *e = open_effect(*state);
    roil_texture *target = roil_texture_create(*state, N, N, NULL);
    roil_texel texel;
    roil_inspection how = plainly("copy.color");
    expect_error(roil_inspect(e, &how, target, &texel), "'copy.color' shares its memory");
    how.image = "copy_4";
    expect_error(roil_inspect(e, &how, target, &texel), "'copy_4' is not drawn");
    how.image = "cpoy.color";
    expect_error(roil_inspect(e, &how, target, &texel), "did you mean 'copy.color'");
    expect_error(roil_keep(e, "cpoy.color"), "did you mean 'copy.color'");

    ok(roil_keep(e, "copy.color") && roil_keep(e, "copy_4") && roil_keep(e, "copy.color"));
    ok(roil_render(e, 2)); // as before until it is prepared
    how.image = "copy_4";
    expect_error(roil_inspect(e, &how, target, &texel), "is not drawn");
    ok(roil_prepare(e, W, H));
    expect_error(roil_inspect(e, &how, target, &texel), "render a frame first");
    ok(roil_render(e, 3));
    ok(roil_inspect(e, &how, target, &texel));
    how.image = "copy.color";
    ok(roil_inspect(e, &how, target, &texel));

    roil_keep_only(e, "copy_2");
    ok(roil_prepare(e, W, H) && roil_render(e, 4));
    how.image = "copy_4";
    expect_error(roil_inspect(e, &how, target, &texel), "is not drawn");
    roil_keep_only(e, NULL);
    ok(roil_prepare(e, W, H) && roil_render(e, 5));
    uint8_t picture[W * H * 4];
    ok(roil_read(e, false, picture)); // the effect's own is never let go
    how.image = "copy.color";
    expect_error(roil_inspect(e, &how, target, &texel), "shares its memory");
    roil_texture_destroy(*state, target);
    roil_unload(e);
}

static void histories_go_on_when_images_are_kept(void **state) {
    roil_effect *e = open_effect(*state);
    ok(roil_render(e, 2) && roil_render(e, 3));
    keep(e, "copy", 4);
    expect_texel(point_at(*state, e, plainly("copy"), 8 + 4 * (W - 1), 12), W - 1, 0, 0, 4, 4, 4);
    roil_keep_only(e, NULL);
    keep(e, "copy_4", 5);
    expect_texel(point_at(*state, e, plainly("copy_4"), 8 + 4 * (W - 1), 12), W - 1, 0, 0, 5, 5, 5);
    roil_unload(e);
}

// ---- what is seen -----------------------------------------------------------------------------

static void texels_are_crisp_squares(void **state) {
    roil_effect *e = open_effect(*state);
    roil_inspection how = plainly("values");
    for (int stops = 0; stops <= 2; stops += 2) {
        how.exposure = (float)stops;
        look(*state, e, &how, seen);
        float factor = (float)(1 << stops);
        FOR_TEXELS(x, y) {
            int red = srgb((float)x / 16 * factor), green = srgb((float)y / 16 * factor);
            expect_shown(x, y, 0, red, green, 0);
            expect_shown(x, y, 15, red, green, 0);
        }
        expect_shown(2, 1, 5, 255, 0, 255); // infinite
        expect_pixel(seen, N, 7, 12, 14, 14, 14, 0);
        expect_pixel(seen, N, 8, 11, 14, 14, 14, 0);
        expect_pixel(seen, N, 40, 35, 14, 14, 14, 0);
        expect_pixel(seen, N, 39, 36, 14, 14, 14, 0);
    }
    how.exposure = 0;
    how.center[0] = 0; // its left edge comes to the middle
    look(*state, e, &how, seen);
    expect_pixel(seen, N, N / 2 - 1, 12, 14, 14, 14, 0);
    expect_pixel(seen, N, N / 2 + 4, 12, srgb(1 / 16.0f), 0, 0, 1);
    roil_unload(e);
}

static void one_channel_is_grey(void **state) {
    roil_effect *e = open_effect(*state);
    roil_inspection how = plainly("values");
    for (unsigned channel = 1; channel <= 8; channel *= 2) {
        how.channels = channel;
        look(*state, e, &how, seen);
        FOR_TEXELS(x, y) {
            float value = channel == 1   ? (float)x / 16
                          : channel == 2 ? (float)y / 16
                          : channel == 4 ? -0.5f
                                         : 0.25f;
            int grey = srgb(value);
            expect_shown(x, y, 6, grey, grey, grey);
        }
    }
    expect_shown(2, 1, 5, srgb(0.25f), srgb(0.25f), srgb(0.25f)); // its alpha is finite
    how = plainly("values.single");                               // has no other
    look(*state, e, &how, seen);
    expect_shown(3, 3, 0, srgb(0.5f), srgb(0.5f), srgb(0.5f));
    how = plainly("values.whole");
    look(*state, e, &how, seen);
    expect_shown(3, 3, 0, 255, 255, 255);
    roil_unload(e);
}

static void transparency_shows_checkers(void **state) {
    roil_effect *e = open_effect(*state);
    roil_inspection how = plainly("values");
    how.channels = 15;
    look(*state, e, &how, seen);
    FOR_TEXELS(x, y) {
        uint32_t square = (8 + 4 * x) / 8 + (12 + 4 * y) / 8;
        float behind = 0.75f * (square % 2 ? 0.3f : 0.13f);
        expect_shown(x, y, 0, srgb((float)x / 16 + behind), srgb((float)y / 16 + behind),
                     srgb(-0.5f + behind));
    }
    roil_unload(e);
}

static void the_sign_has_two_colours(void **state) {
    roil_effect *e = open_effect(*state);
    roil_inspection how = plainly("values");
    how.negative = true;
    how.channels = 1;
    look(*state, e, &how, seen);
    FOR_TEXELS(x, y) {
        float value = (float)x / 16;
        expect_shown(x, y, 9, srgb(value), srgb(0.35f * value), srgb(0.05f * value));
    }
    how.channels = 7; // blue is the farthest from zero
    how.exposure = -1;
    look(*state, e, &how, seen);
    FOR_TEXELS(x, y)
    expect_shown(x, y, 9, srgb(0.05f * 0.25f), srgb(0.35f * 0.25f), srgb(0.25f));
    roil_unload(e);
}

static void what_is_made_smaller_is_a_mean(void **state) {
    roil_effect *e = open_effect(*state);
    roil_inspection how = plainly("values");
    how.zoom = 0.5f;
    look(*state, e, &how, seen);
    expect_pixel(seen, N, 22, 23, srgb(0.5f / 16), srgb(1.5f / 16), 0, 1);
    expect_pixel(seen, N, 24, 24, srgb(4.5f / 16), srgb(3.5f / 16), 0, 1);
    expect_pixel(seen, N, 23, 23, 255, 0, 255, 0); // one of four is infinite
    expect_pixel(seen, N, 21, 23, 14, 14, 14, 0);
    how.zoom = 0.01f; // all of it in less than a pixel
    look(*state, e, &how, seen);
    expect_pixel(seen, N, 0, 0, 14, 14, 14, 0);
    roil_unload(e);
}

static void volumes_are_cut_along_each_axis(void **state) {
    static const struct {
        int axis;
        uint32_t across[3]; // axes to the right, up, and of sight
    } cases[] = {{0, {1, 2, 0}}, {1, {0, 2, 1}}, {2, {0, 1, 2}}};
    static const uint32_t size[3] = {4, 3, 2};
    roil_effect *e = open_effect(*state);
    keep(e, "bake", 2);
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        const uint32_t *across = cases[i].across;
        uint32_t width = size[across[0]], height = size[across[1]], depth = size[across[2]];
        for (uint32_t cut = 0; cut < depth; cut++) {
            roil_inspection how = plainly("bake");
            how.axis = cases[i].axis;
            how.slice = ((float)cut + 0.5f) / (float)depth;
            look(*state, e, &how, seen);
            for (uint32_t k = 0; k < width * height; k++) {
                uint32_t at[3], x = k % width, row = k / width;
                at[across[0]] = x;
                at[across[1]] = height - 1 - row;
                at[across[2]] = cut;
                uint32_t left = (N - 4 * width) / 2 + 4 * x, top = (N - 4 * height) / 2 + 4 * row;
                float color[3];
                for (int c = 0; c < 3; c++) color[c] = (float)at[c] / 4;
                expect_pixel(seen, N, left, top, srgb(color[0]), srgb(color[1]), srgb(color[2]), 1);
                roil_texel texel = point_at(*state, e, how, (float)left + 1.5f, (float)top + 3.9f);
                expect_texel(texel, at[0], at[1], at[2], color[0], color[1], color[2]);
            }
        }
    }
    roil_inspection how = plainly("bake");
    how.axis = 2;
    how.slice = 1; // the last one, not the one behind it
    assert_int_equal(point_at(*state, e, how, N / 2, N / 2).at[2], 1);
    roil_unload(e);
}

static void levels_and_depth_can_be_seen(void **state) {
    char path[512];
    write_text("wall.obj", wall_obj, path);
    roil_effect *e = load_text(*state, "solid.lua", solid_lua);
    ok(roil_keep(e, "geometry.z") && roil_keep(e, "bloom"));
    ok(roil_prepare(e, W, H) && roil_render(e, 1));
    roil_inspection how = plainly("geometry.z");
    roil_texel texel = point_at(*state, e, how, N / 2, N / 2);
    assert_true(texel.valid && texel.value[0] > 0 && texel.value[0] < 1);
    look(*state, e, &how, seen);
    int grey = srgb(texel.value[0]);
    expect_pixel(seen, N, N / 2, N / 2, grey, grey, grey, 1);
    how = plainly("bloom.color");
    how.mip = 1; // 4 x 3
    look(*state, e, &how, seen);
    expect_pixel(seen, N, 15, 24, 14, 14, 14, 0);
    expect_pixel(seen, N, 32, 24, 14, 14, 14, 0);
    expect_pixel(seen, N, 24, 17, 14, 14, 14, 0);
    expect_pixel(seen, N, 24, 30, 14, 14, 14, 0);
    assert_true(memcmp(seen + 4 * (18 * N + 16), seen, 4) != 0);
    assert_true(memcmp(seen + 4 * (29 * N + 31), seen, 4) != 0);
    texel = point_at(*state, e, how, 31, 29);
    assert_true(texel.valid && texel.at[0] == 3 && texel.at[1] == 2 && texel.at[2] == 0);
    roil_unload(e);
}

// ---- the cursor -------------------------------------------------------------------------------

static void the_value_under_the_cursor_comes_later(void **state) {
    roil_effect *e = open_effect(*state);
    roil_texture *target = roil_texture_create(*state, N, N, NULL);
    roil_texel texel;
    ok(target);
    roil_inspection how = plainly("values");
    how.cursor[0] = 8 + 4 * 3 + 0.5f;
    how.cursor[1] = 12 + 4 * 4 + 3.9f;
    ok(roil_inspect(e, &how, target, &texel));
    assert_false(texel.valid);
    for (int i = 1; i < LATER; i++) ok(roil_inspect(e, &how, target, &texel));
    expect_texel(texel, 3, 4, 0, 3 / 16.0f, 4 / 16.0f, -0.5f);
    assert_true(texel.value[3] == 0.25f);
    how.cursor[0] = -1;
    ok(roil_inspect(e, &how, target, &texel));
    assert_false(texel.valid);
    how.image = "values.single"; // nothing of what was there before
    how.cursor[0] = 8;
    ok(roil_inspect(e, &how, target, &texel));
    assert_false(texel.valid);
    roil_texture_destroy(*state, target);

    assert_false(point_at(*state, e, plainly("values"), 7, 12).valid); // beside the image
    assert_false(point_at(*state, e, plainly("values"), N, 12).valid); // beside the texture
    texel = point_at(*state, e, plainly("values.whole"), 8, 12);
    expect_texel(texel, 0, 0, 0, 3e9f, 0, 0);
    roil_unload(e);
}

static void impossible_views_are_errors(void **state) {
    roil_effect *e = open_effect(*state);
    keep(e, "bake", 2);
    roil_texture *target = roil_texture_create(*state, 4, 4, NULL);
    roil_texel texel;
    roil_inspection how = plainly("bake");
    how.axis = 3;
    expect_error(roil_inspect(e, &how, target, &texel), "axis is 3; accepted: 0 (x)");
    how = plainly("bake");
    how.mip = 1;
    expect_error(roil_inspect(e, &how, target, &texel), "has no level 1, only 1 levels");
    how = plainly("bake");
    how.zoom = 0;
    expect_error(roil_inspect(e, &how, target, &texel), "zoom is 0; accepted: above 0");
    how = plainly("bake");
    how.center[1] = NAN;
    expect_error(roil_inspect(e, &how, target, &texel), "must be finite");
    roil_texture_destroy(*state, target);
    roil_unload(e);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(images_are_listed),
        cmocka_unit_test(only_what_is_kept_can_be_looked_at),
        cmocka_unit_test(histories_go_on_when_images_are_kept),
        cmocka_unit_test(texels_are_crisp_squares),
        cmocka_unit_test(one_channel_is_grey),
        cmocka_unit_test(transparency_shows_checkers),
        cmocka_unit_test(the_sign_has_two_colours),
        cmocka_unit_test(what_is_made_smaller_is_a_mean),
        cmocka_unit_test(volumes_are_cut_along_each_axis),
        cmocka_unit_test(levels_and_depth_can_be_seen),
        cmocka_unit_test(the_value_under_the_cursor_comes_later),
        cmocka_unit_test(impossible_views_are_errors),
    };
    return test_run(tests);
}
