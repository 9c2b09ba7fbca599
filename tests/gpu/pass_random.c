// Blue noise on the device: the texture's numbers, without end in space and time.
#include "pass/blue_noise.h"
#include "pass_test.h"

enum { WIDTH = 150, HEIGHT = 70 }; // more than the texture

static float texel(uint32_t x, uint32_t y, uint32_t frame) {
    const uint32_t size = BLUE_NOISE_SIZE;
    uint32_t at = ((frame % BLUE_NOISE_FRAMES) * size + y % size) * size + x % size;
    return ((float)blue_noise_texels[at] + 0.5f) / 256;
}

static void numbers_are_those_of_the_texture(void **state) {
    const uint32_t frames[] = {1, 31, 32, 1000};
    static float pixels[WIDTH * HEIGHT * 4];
    pass_world w;
    world_open(&w, *state);
    pass *noise = world_add(&w, NULL, "blue_noise.comp", "noise");
    gpu_test_ok(pass_declare(noise));
    world_render(&w, WIDTH, HEIGHT, pass_output(noise, "color"));
    for (size_t f = 0; f < COUNT_OF(frames); f++) {
        world_frame(&w, WIDTH, HEIGHT, frames[f]);
        gpu_image *image = graph_get_image(w.host.graph, pass_output(noise, "color"));
        gpu_test_ok(gpu_image_read(*state, image, pixels, sizeof pixels));
        for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
            uint32_t x = i % WIDTH, y = i / WIDTH;
            float want = texel(x, y, frames[f]), other = texel(x + 48, y + 36, frames[f]);
            assert_true(fabsf(pixels[4 * i] - want) < 1e-5f);
            assert_true(fabsf(pixels[4 * i + 1] - want) < 1e-5f);
            assert_true(fabsf(pixels[4 * i + 2] - other) < 1e-5f);
        }
    }
    world_close(&w);
}

int main(void) {
    static const struct CMUnitTest tests[] = {cmocka_unit_test(numbers_are_those_of_the_texture)};
    return gpu_test_run(tests, COUNT_OF(tests));
}
