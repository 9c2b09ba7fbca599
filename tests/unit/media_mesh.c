// Meshes: geometry, materials and axes as the formats define them, and no file beyond the root.
#include "media_test.h"

#include "base/log.h"
#include "media/mesh.h"
#include "media/png.h"
#include <math.h>

static arena memory;
static mesh_data mesh;

static bool load(const char *name) {
    arena_free(&memory);
    return mesh_load(test_path(name), test_folder, &memory, &mesh);
}

static void put_text(const char *name, const char *text) {
    test_put(name, text, strlen(text));
}

static void put_png(const char *name) {
    static const uint8_t TEXELS[2 * 2 * 3] = {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255};
    assert_true(png_write(test_path(name), &(png_image){2, 2, 3, 8, TEXELS}, NULL, 0));
}

static bool near(float a, float b) {
    return fabsf(a - b) < 1e-5f;
}

static void an_obj_has_its_geometry_and_material(void **state) {
    (void)state;
    put_text("a/quad.mtl", "newmtl blue\nKd 0.25 0.5 1\nd 1\nmap_Kd ../textures/t.png\n");
    put_text("textures/keep", "");
    put_png("textures/t.png");
    put_text("a/quad.obj", "mtllib quad.mtl\nv -1 -1 2\nv 1 -1 2\nv 1 1 2\nv -1 1 2\n"
                           "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl blue\n"
                           "f 1/1 2/2 3/3 4/4\n");
    assert_true(load("a/quad.obj"));
    assert_int_equal(mesh.vertex_count, 4);
    assert_int_equal(mesh.index_count, 6);
    assert_int_equal(mesh.part_count, 1);
    assert_int_equal(mesh.parts[0].first, 0);
    assert_int_equal(mesh.parts[0].count, 6);
    const float blue[4] = {0.25f, 0.5f, 1.0f, 1.0f};
    for (int i = 0; i < 4; i++) assert_true(near(mesh.parts[0].color[i], blue[i]));
    assert_true(near(mesh.box.min.x, -1) && near(mesh.box.max.y, 1) && near(mesh.box.min.z, 2));
    for (uint32_t v = 0; v < 4; v++) {
        const mesh_vertex *m = &mesh.vertices[v];
        assert_true(near(m->normal[2], 1.0f)); // made up: the file has none; Z stays up
        assert_true(near(m->u, m->position[0] > 0 ? 1.0f : 0.0f));
        assert_true(near(m->v, m->position[1] > 0 ? 0.0f : 1.0f)); // from the top
    }
    assert_int_equal(mesh.parts[0].texture, 0);
    assert_int_equal(mesh.texture_count, 1);
    const uint8_t red[4] = {255, 0, 0, 255};
    assert_int_equal(mesh.textures[0].width, 2);
    assert_memory_equal(mesh.textures[0].pixels, red, 4);
    assert_int_equal(mesh.file_count, 3); // mesh, material, texture
}

#define TRIANGLE_HEAD                                                                              \
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"                   \
    "\"nodes\":[{\"mesh\":0,\"translation\":[0,2,0]}],"                                            \
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":0}]}],"            \
    "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0.25,1,1],"                \
    "\"baseColorTexture\":{\"index\":0}}}],\"textures\":[{\"source\":0}],"
#define TRIANGLE_TAIL                                                                              \
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"accessors\":[{\"bufferView\":0,"         \
    "\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,0]}]}"

static void put_triangle(const char *name, const char *buffer, const char *image) {
    char text[2048];
    snprintf(text, sizeof text,
             TRIANGLE_HEAD "\"images\":[{\"uri\":\"%s\"}],\"buffers\":[{\"uri\":\"%s\","
                           "\"byteLength\":36}]," TRIANGLE_TAIL,
             image, buffer);
    put_text(name, text);
}

static void a_gltf_is_turned_to_z_up_and_has_its_texture(void **state) {
    (void)state;
    static const float POINTS[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    test_put("tri.bin", POINTS, sizeof POINTS);
    put_png("t.png");
    put_triangle("tri.gltf", "tri.bin", "t.png");
    assert_true(load("tri.gltf"));
    assert_int_equal(mesh.index_count, 3);
    // Upwards by 2, which is +Y in glTF and +Z here; the face looked along +Z, now along -Y.
    assert_true(near(mesh.box.min.z, 2) && near(mesh.box.max.z, 3));
    assert_true(near(mesh.box.min.y, 0) && near(mesh.box.max.y, 0));
    for (int v = 0; v < 3; v++) assert_true(near(mesh.vertices[v].normal[1], -1.0f));
    const mesh_vertex *p[3];
    for (int i = 0; i < 3; i++) p[i] = &mesh.vertices[mesh.indices[i]];
    float ux = p[1]->position[0] - p[0]->position[0], uz = p[1]->position[2] - p[0]->position[2];
    float vx = p[2]->position[0] - p[0]->position[0], vz = p[2]->position[2] - p[0]->position[2];
    assert_true(uz * vx - ux * vz < 0.0f); // counter-clockwise about the normal
    assert_true(near(mesh.parts[0].color[1], 0.25f));
    assert_int_equal(mesh.parts[0].texture, 0);
    assert_int_equal(mesh.textures[0].height, 2);
}

static bool shines(float specular, float roughness, float metallic) {
    const mesh_part *p = &mesh.parts[0];
    return near(p->specular, specular) && near(p->roughness, roughness) &&
           near(p->metallic, metallic);
}

// Of an OBJ file by its highlight; a file that says nothing is matte.
static void an_obj_says_how_it_shines(void **state) {
    (void)state;
    put_text("s.obj", "mtllib s.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
    put_text("s.mtl", "newmtl m\nKd 1 1 1\n");
    assert_true(load("s.obj") && shines(0, 1, 0));
    assert_true(mesh.parts[0].emission[0] == 0);
    put_text("s.mtl", "newmtl m\nKd 1 1 1\nKs 0.1 0.3 0.2\nNs 30\nKe 2 1 0.5\n");
    assert_true(load("s.obj") && shines(0.3f, 0.5f, 0)); // (2 / 32)^(1/4)
    assert_true(near(mesh.parts[0].emission[0], 2) && near(mesh.parts[0].emission[2], 0.5f));
    put_text("s.mtl", "newmtl m\nKd 1 1 1\nKs 7 0 -1\nNs nan\nKe -1 1e30 inf\n");
    assert_true(load("s.obj"));
    for (int i = 0; i < 3; i++)
        assert_true(mesh.parts[0].emission[i] >= 0 && mesh.parts[0].emission[i] <= 1e4f);
    assert_true(mesh.parts[0].specular <= 1 && mesh.parts[0].roughness <= 1);
}

// Both at 1 is what the format means where nothing is said.
static void a_gltf_says_how_it_shines(void **state) {
    (void)state;
    static const float POINTS[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    test_put("tri.bin", POINTS, sizeof POINTS);
    static const struct {
        const char *said;
        float specular, roughness, metallic;
    } files[] = {{"", 0, 1, 0},
                 {"\"metallicFactor\":0,\"roughnessFactor\":0.25", 0.5f, 0.25f, 0},
                 {"\"roughnessFactor\":0.5", 0.5f, 0.5f, 1}};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        char text[2048];
        snprintf(
            text, sizeof text,
            "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
            "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":"
            "{\"POSITION\":0},\"material\":0}]}],\"materials\":[{\"pbrMetallicRoughness\":{%s},"
            "\"emissiveFactor\":[0.5,0.25,0]}],\"buffers\":[{\"uri\":\"tri.bin\","
            "\"byteLength\":36}]," TRIANGLE_TAIL,
            files[i].said);
        put_text("m.gltf", text);
        assert_true(load("m.gltf"));
        assert_true(shines(files[i].specular, files[i].roughness, files[i].metallic));
        assert_true(near(mesh.parts[0].emission[1], 0.25f));
    }
}

static void an_embedded_texture_is_read(void **state) {
    (void)state;
    static const char *const NAMES[] = {"triangle.gltf", "triangle.glb"};
    for (int i = 0; i < 2; i++) {
        char name[128];
        snprintf(name, sizeof name, "tests/fuzz/corpus/fuzz_mesh/%s", NAMES[i]);
        const char *path = test_source(name);
        if (!path) skip();
        char folder[PATH_CAP];
        path_folder(folder, path);
        arena_free(&memory);
        assert_true(mesh_load(path, folder, &memory, &mesh));
        assert_int_equal(mesh.texture_count, 1);
        assert_int_equal(mesh.textures[0].width, 2);
        assert_int_equal(mesh.file_count, 1);
    }
}

static void a_jpeg_is_a_texture_whatever_its_name_says(void **state) {
    (void)state;
    const char *path = test_source("tests/fuzz/corpus/fuzz_texture/red_left_blue_right.jpg");
    void *data;
    size_t size;
    if (!path) skip();
    assert_true(file_read(path, 1 << 20, &data, &size));
    static const char *const NAMES[] = {"c.jpg", "c.png"};
    for (int i = 0; i < 2; i++) {
        char material[64];
        snprintf(material, sizeof material, "newmtl m\nmap_Kd %s\n", NAMES[i]);
        put_text("c.mtl", material);
        test_put(NAMES[i], data, size);
        put_text("c.obj", "mtllib c.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
        arena_free(&memory);
        assert_true(load("c.obj"));
        assert_int_equal(mesh.texture_count, 1);
        assert_int_equal(mesh.textures[0].width, 32);
        assert_int_equal(mesh.textures[0].height, 16);
        const uint8_t *left = mesh.textures[0].pixels, *right = left + 31 * 4;
        assert_true(left[0] > 240 && left[2] < 20 && left[3] == 255);
        assert_true(right[0] < 20 && right[2] > 240 && right[3] == 255);
    }
    mem_free(data);
}

static void a_texture_that_cannot_be_read_is_left_out(void **state) {
    (void)state;
    put_text("b.mtl", "newmtl m\nmap_Kd absent.png\n");
    put_text("b.obj", "mtllib b.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
    assert_true(load("b.obj"));
    assert_int_equal(mesh.parts[0].texture, -1);
    put_text("b.mtl", "newmtl m\nmap_Kd b.jpg\n");
    put_text("b.jpg", "jpg");
    assert_true(load("b.obj"));
    assert_int_equal(mesh.texture_count, 0);
    put_text("c.obj", "mtllib absent.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    assert_true(load("c.obj"));
}

static void files_outside_the_root_are_refused(void **state) {
    (void)state;
    static const char *const ESCAPES[] = {"../../secret.mtl", "link.mtl"};
    assert_int_equal(symlink("/etc/hostname", test_path("link.mtl")), 0);
    for (int i = 0; i < 2; i++) {
        char text[256];
        snprintf(text, sizeof text, "mtllib %s\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", ESCAPES[i]);
        put_text("out.obj", text);
        assert_false(load("out.obj"));
        assert_message("may not read");
    }
    // An absolute name is taken as one below the root, where there is no such file.
    put_text("out.obj", "mtllib /etc/hostname\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    assert_true(load("out.obj"));
    assert_int_equal(mesh.file_count, 1);
    put_text("out.mtl", "newmtl m\nmap_Kd ../../../etc/secret.png\n");
    put_text("out.obj", "mtllib out.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
    assert_false(load("out.obj"));
    assert_message("may not read");
    put_triangle("out.gltf", "../../secret.bin", "t.png");
    assert_false(load("out.gltf"));
    assert_message("may not read");
    put_text("sub/inner.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    put_text("other/keep", "");
    arena_free(&memory);
    assert_false(mesh_load(test_path("sub/inner.obj"), test_path("other"), &memory, &mesh));
    assert_message("outside");
}

static void a_mesh_without_faces_is_an_error(void **state) {
    (void)state;
    put_text("points.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n");
    assert_false(load("points.obj"));
    assert_message("points.obj");
    put_text("empty.obj", "");
    assert_false(load("empty.obj"));
    put_text("empty.gltf", "{\"asset\":{\"version\":\"2.0\"}}");
    assert_false(load("empty.gltf"));
}

static void positions_that_are_not_finite_are_an_error(void **state) {
    (void)state;
    put_text("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    assert_false(load("nan.obj"));
    put_text("far.obj", "v 1e30 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    assert_false(load("far.obj"));
    assert_message("not finite");
}

static void other_formats_and_missing_files_are_errors(void **state) {
    (void)state;
    put_text("a.stl", "solid a\nendsolid a\n");
    assert_false(load("a.stl"));
    assert_message(".obj, .gltf and .glb");
    assert_false(load("absent.obj"));
    assert_message("absent.obj");
}

static void random_bytes_never_end_the_program(void **state) {
    (void)state;
    static const char *const NAMES[] = {"noise.obj", "noise.gltf", "noise.glb"};
    uint32_t random = 11;
    for (int i = 0; i < 60; i++) {
        uint8_t noise[600];
        for (size_t k = 0; k < sizeof noise; k++) noise[k] = (uint8_t)test_random(&random);
        if (i % 3 == 2) memcpy(noise, "glTF\2\0\0\0\x58\2\0\0", 12);
        test_put(NAMES[i % 3], noise, sizeof noise);
        assert_false(load(NAMES[i % 3]));
        assert_message("noise.");
    }
}

static void a_crash_of_the_library_is_a_message(void **state) {
    (void)state;
    // Kinds of JSON values that assimp 5.2 takes for granted, one after the other.
    static const char *const TEXTS[] = {
        "{\"asset\":{\"version\":\"2.0\"},\"meshes\":[{\"primitives\":[{\"attributes\":1}]}]}",
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[7]}],\"nodes\":[]}",
        "{\"asset\":{\"version\":2},\"scene\":\"x\",\"nodes\":[{\"children\":[0]}]}",
        "{\"asset\":{\"version\":\"2.0\"},\"accessors\":[{\"count\":4294967295,"
        "\"componentType\":5126,\"type\":\"VEC3\"}],\"meshes\":[{\"primitives\":[{"
        "\"attributes\":{\"POSITION\":0}}]}],\"nodes\":[{\"mesh\":0}],\"scenes\":[{\"nodes\":[0]}]"
        "}",
    };
    for (size_t i = 0; i < sizeof TEXTS / sizeof *TEXTS; i++) {
        put_text("odd.gltf", TEXTS[i]);
        assert_false(load("odd.gltf"));
        assert_message("odd.gltf");
    }
}

// By which the library's parser would run out of stack.
static void deep_objects_are_refused(void **state) {
    enum { DEPTH = 200000 };
    (void)state;
    static char text[20 + DEPTH + 1];
    memset(text, '[', sizeof text - 1);
    memcpy(text, "{\"a\":\"]]]]\",\"b\":", 16);
    put_text("deep.gltf", text);
    assert_false(load("deep.gltf"));
    assert_message("deep.gltf: objects nested ");
    assert_message("up to 100 are accepted");
    const uint32_t head[] = {0x46546c67, 2, sizeof text, DEPTH, 0x4e4f534a};
    memcpy(text, head, sizeof head);
    test_put("deep.glb", text, sizeof text - 1);
    assert_false(load("deep.glb"));
    assert_message("deep.glb: objects nested 200000 deep");
}

static int teardown(void **state) {
    arena_free(&memory);
    return test_teardown(state);
}

int main(void) {
    log_set_level(LOG_ERROR);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_obj_has_its_geometry_and_material),
        cmocka_unit_test(a_gltf_is_turned_to_z_up_and_has_its_texture),
        cmocka_unit_test(an_obj_says_how_it_shines),
        cmocka_unit_test(a_gltf_says_how_it_shines),
        cmocka_unit_test(an_embedded_texture_is_read),
        cmocka_unit_test(a_jpeg_is_a_texture_whatever_its_name_says),
        cmocka_unit_test(a_texture_that_cannot_be_read_is_left_out),
        cmocka_unit_test(files_outside_the_root_are_refused),
        cmocka_unit_test(a_mesh_without_faces_is_an_error),
        cmocka_unit_test(positions_that_are_not_finite_are_an_error),
        cmocka_unit_test(other_formats_and_missing_files_are_errors),
        cmocka_unit_test(random_bytes_never_end_the_program),
        cmocka_unit_test(a_crash_of_the_library_is_a_message),
        cmocka_unit_test(deep_objects_are_refused),
    };
    return cmocka_run_group_tests(tests, test_setup, teardown);
}
