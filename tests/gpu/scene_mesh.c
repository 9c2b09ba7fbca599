// Meshes on the device: what is uploaded, and when.
#include "gpu_test.h"
#include "scene/scene.h"
#include <string.h>

static const mesh_vertex vertices[3] = {{{-1, 0, -1}, 0, {0, -1, 0}, 1},
                                        {{1, 0, -1}, 1, {0, -1, 0}, 1},
                                        {{0, 0, 1}, 0.5f, {0, -1, 0}, 0}};
static const uint32_t indices[3] = {0, 1, 2};
static const uint8_t texels[2][8] = {{255, 0, 0, 255, 0, 255, 0, 255},
                                     {1, 2, 3, 4, 250, 128, 64, 32}};
static const mesh_texture textures[2] = {{2, 1, texels[0]}, {1, 2, texels[1]}};
static const mesh_part part = {.first = 0, .count = 3, .color = {1, 1, 1, 1}, .texture = 0};

static scene_mesh make_mesh(void) {
    return (scene_mesh){.name = "triangle",
                        .data = {.vertices = vertices,
                                 .vertex_count = 3,
                                 .indices = indices,
                                 .index_count = 3,
                                 .parts = &part,
                                 .part_count = 1,
                                 .textures = textures,
                                 .texture_count = 2}};
}

static void mesh_is_on_the_device_as_it_was_read(void **state) {
    scene_mesh mesh = make_mesh();
    gpu_test_ok(scene_mesh_upload(&mesh, *state));
    mesh_vertex seen[3];
    uint32_t numbers[3];
    uint8_t pixels[8];
    gpu_test_ok(gpu_buffer_read(*state, mesh.vertices, 0, seen, sizeof seen));
    gpu_test_ok(gpu_buffer_read(*state, mesh.indices, 0, numbers, sizeof numbers));
    assert_memory_equal(seen, vertices, sizeof seen);
    assert_memory_equal(numbers, indices, sizeof numbers);
    for (int i = 0; i < 2; i++) {
        gpu_test_ok(gpu_image_read(*state, mesh.textures[i], pixels, sizeof pixels));
        assert_memory_equal(pixels, texels[i], sizeof pixels);
    }
    scene_mesh_destroy(&mesh, *state);
}

static void mesh_is_uploaded_once(void **state) {
    scene_mesh mesh = make_mesh();
    gpu_test_ok(scene_mesh_upload(&mesh, *state));
    gpu_buffer *first = mesh.vertices;
    gpu_image *texture = mesh.textures[0];
    gpu_test_ok(scene_mesh_upload(&mesh, *state));
    assert_ptr_equal(mesh.vertices, first);
    assert_ptr_equal(mesh.textures[0], texture);
    scene_mesh_destroy(&mesh, *state);
    scene_mesh_destroy(&mesh, *state);
    gpu_test_ok(scene_mesh_upload(&mesh, *state)); // and may come back
    scene_mesh_destroy(&mesh, *state);
}

static void mesh_never_uploaded_may_be_destroyed(void **state) {
    scene_mesh mesh = make_mesh();
    scene_mesh_destroy(&mesh, *state);
    scene_mesh_destroy(&mesh, NULL); // as an effect that was only checked does
    assert_null(mesh.vertices);
}

static void mesh_without_textures_is_fine(void **state) {
    scene_mesh mesh = make_mesh();
    mesh.data.textures = NULL;
    mesh.data.texture_count = 0;
    gpu_test_ok(scene_mesh_upload(&mesh, *state));
    assert_non_null(mesh.vertices);
    scene_mesh_destroy(&mesh, *state);
    assert_null(mesh.vertices);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(mesh_is_on_the_device_as_it_was_read),
        cmocka_unit_test(mesh_is_uploaded_once),
        cmocka_unit_test(mesh_never_uploaded_may_be_destroyed),
        cmocka_unit_test(mesh_without_textures_is_fine),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
