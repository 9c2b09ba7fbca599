// Pictures that other threads write are those that roil_save writes, and a failure is told.
#include "gpu_test.h"
#include "roil.h"
#include <stdio.h>
#include <string.h>

enum { FRAMES = 6 };

static roil_effect *open_effect(roil *r) {
    char file[4096];
    snprintf(file, sizeof file, "%s/effects/heat_haze.lua", getenv("ROIL_SOURCE_DIR"));
    const roil_setting setting = {"march.steps", "8"};
    roil_effect *e = roil_load(r, file, &setting, 1);
    gpu_test_ok(e && roil_prepare(e, 64, 36));
    return e;
}

static size_t read_all(const char *file, char *out, size_t capacity) {
    FILE *f = fopen(file, "rb");
    if (!f) fail_msg("%s is not there", file);
    size_t size = fread(out, 1, capacity, f);
    fclose(f);
    remove(file);
    return size;
}

static void files_are_those_of_roil_save(void **state) {
    (void)state;
    static const char *const kinds[] = {"png", "exr"};
    static char one[1 << 17], other[1 << 17];
    roil *r = roil_create(&(roil_desc){.home = getenv("ROIL_SOURCE_DIR")});
    roil_effect *e = open_effect(r);
    for (int kind = 0; kind < 2; kind++) {
        roil_writer *w = roil_writer_create();
        char file[64];
        for (int i = 0; i < FRAMES; i++) {
            gpu_test_ok(roil_render(e, i));
            snprintf(file, sizeof file, "writer-%d.%s", i, kinds[kind]);
            gpu_test_ok(roil_writer_save(w, e, file, NULL));
            snprintf(file, sizeof file, "saved-%d.%s", i, kinds[kind]);
            gpu_test_ok(roil_save(e, file, NULL));
        }
        gpu_test_ok(roil_writer_finish(w));
        for (int i = 0; i < FRAMES; i++) {
            snprintf(file, sizeof file, "writer-%d.%s", i, kinds[kind]);
            size_t size = read_all(file, one, sizeof one);
            snprintf(file, sizeof file, "saved-%d.%s", i, kinds[kind]);
            assert_int_equal(read_all(file, other, sizeof other), size);
            assert_true(size > 0 && size < sizeof one);
            assert_memory_equal(one, other, size);
        }
    }
    roil_unload(e);
    roil_destroy(r);
}

static void file_that_cannot_be_written_is_told(void **state) {
    (void)state;
    roil *r = roil_create(&(roil_desc){.home = getenv("ROIL_SOURCE_DIR")});
    roil_effect *e = open_effect(r);
    gpu_test_ok(roil_render(e, 0));
    roil_writer *w = roil_writer_create();
    roil_writer_save(w, e, "/dev/null/picture.png", NULL);
    assert_false(roil_writer_finish(w));
    assert_non_null(strstr(roil_error(), "/dev/null"));
    roil_unload(e);
    roil_destroy(r);
}

int main(void) {
    gpu_test_need_device();
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_are_those_of_roil_save),
        cmocka_unit_test(file_that_cannot_be_written_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
