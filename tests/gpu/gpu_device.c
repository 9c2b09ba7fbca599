// Listing and choosing devices, and the pipeline cache on disk.
#include "base/file.h"
#include "gpu_shaders.h"
#include "gpu_test.h"
#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

static void devices_are_listed_real_ones_first(void **state) {
    (void)state;
    gpu_info list[16];
    int count = gpu_list(list, 16);
    assert_in_range(count, 1, 16);
    bool software = false;
    for (int i = 0; i < count; i++) {
        assert_true(list[i].name[0] != '\0');
        assert_true(list[i].usable == (list[i].missing[0] == '\0'));
        if (software) assert_int_equal(list[i].kind, GPU_CPU);
        software = list[i].kind == GPU_CPU;
    }
    assert_int_equal(gpu_list(NULL, 0), count);
}

static void best_device_is_the_first_usable(void **state) {
    gpu_info list[16];
    int count = gpu_list(list, 16), first = 0;
    while (first < count && !list[first].usable) first++;
    assert_in_range(first, 0, count - 1);
    assert_string_equal(gpu_get_info(*state)->name, list[first].name);
}

static void device_is_found_by_index_and_part_of_name(void **state) {
    (void)state;
    gpu_info list[16];
    int count = gpu_list(list, 16);
    for (int i = 0; i < count; i++) {
        if (!list[i].usable) continue;
        char index[16], part[8] = {0};
        snprintf(index, sizeof index, "%d", i);
        for (int c = 0; c < 5 && list[i].name[c]; c++) { // other case than the driver's
            part[c] = (char)(list[i].name[c] ^ (list[i].name[c] >= 'A' ? 0x20 : 0));
        }
        gpu *by_index = gpu_create(&(gpu_desc){.device = index});
        gpu_test_ok(by_index);
        assert_string_equal(gpu_get_info(by_index)->name, list[i].name);
        gpu_destroy(by_index);
        gpu *by_name = gpu_create(&(gpu_desc){.device = part});
        gpu_test_ok(by_name);
        assert_memory_equal(gpu_get_info(by_name)->name, list[i].name, strlen(part));
        gpu_destroy(by_name);
    }
}

static void wrong_device_name_lists_the_devices(void **state) {
    (void)state;
    gpu_info info;
    assert_in_range(gpu_list(&info, 1), 1, 16);
    assert_null(gpu_create(&(gpu_desc){.device = "no such gpu"}));
    assert_non_null(strstr(err_get(), "no such gpu"));
    assert_non_null(strstr(err_get(), info.name));
    assert_null(gpu_create(&(gpu_desc){.device = "999"}));
    assert_non_null(strstr(err_get(), "999"));
}

static void impossible_resources_are_refused(void **state) {
    gpu *g = *state;
    static const gpu_image_desc wrong[] = {
        {.label = "none", .width = 4, .height = 4, .use = GPU_USE_STORAGE},
        {.label = "flat", .format = GPU_R32F, .width = 4, .use = GPU_USE_STORAGE},
        {.label = "unused", .format = GPU_R32F, .width = 4, .height = 4},
        {.label = "levels", .format = GPU_R32F, .width = 4, .height = 4, .mips = 4, .use = 1},
        {.label = "large", .format = GPU_R32F, .width = 1 << 20, .height = 4, .use = 1},
        {.label = "huge", .format = GPU_R32F, .width = UINT32_MAX, .height = UINT32_MAX, .use = 1},
        {.label = "srgb", .format = GPU_RGBA8_SRGB, .width = 4, .height = 4, .use = 2},
        {.label = "deep", .format = GPU_R32F, .width = 4, .height = 4, .depth = 4, .use = 4},
    };
    for (size_t i = 0; i < COUNT_OF(wrong); i++) {
        assert_null(gpu_image_create(g, &wrong[i]));
        assert_non_null(strstr(err_get(), wrong[i].label));
    }
    assert_null(gpu_buffer_create(g, &(gpu_buffer_desc){.label = "empty"}));
    assert_non_null(strstr(err_get(), "empty"));
    assert_null(gpu_buffer_create(g, &(gpu_buffer_desc){.label = "endless", .size = UINT64_MAX}));
    assert_non_null(strstr(err_get(), "endless"));
}

static gpu_pipeline *make_step(gpu *g, const void *code, size_t size) {
    const gpu_slot slots[] = {
        {.binding = 0, .kind = GPU_SLOT_UNIFORM},
        {.binding = 1, .kind = GPU_SLOT_STORAGE_BUFFER, .reads = true, .writes = true}};
    return gpu_pipeline_create_compute(g, &(gpu_compute_desc){.label = "step",
                                                              .code = code,
                                                              .code_size = size,
                                                              .slots = slots,
                                                              .slot_count = COUNT_OF(slots),
                                                              .local_size = {64, 1, 1}});
}

static void code_that_is_not_spirv_is_refused(void **state) {
    static const uint32_t text[8] = {0x73726576, 0x206e6f69};
    assert_null(make_step(*state, text, sizeof text));
    assert_null(make_step(*state, step_comp_code, 8));
    assert_null(make_step(*state, NULL, 0));
    assert_non_null(strstr(err_get(), "'step'"));
}

// Returns how many threads of this process are as nice as that.
static int threads_as_nice_as(int nice) {
    DIR *threads = opendir("/proc/self/task");
    assert_non_null(threads);
    int count = 0;
    for (struct dirent *entry; (entry = readdir(threads)) != NULL;)
        if (entry->d_name[0] != '.')
            count += getpriority(PRIO_PROCESS, (id_t)atoi(entry->d_name)) == nice;
    closedir(threads);
    return count;
}

// Only the driver's threads are nicer: what calls the device is not.
static void threads_of_a_device_yield(void **state) {
    int own = getpriority(PRIO_PROCESS, 0), nicer = own + 2 < 19 ? own + 2 : 19;
    if (gpu_get_info(*state)->kind != GPU_CPU || own == nicer) skip();
    int before = threads_as_nice_as(nicer);
    gpu *g = gpu_create(&(gpu_desc){.yields = true});
    gpu_test_ok(g);
    assert_true(threads_as_nice_as(nicer) > before);
    assert_int_equal(getpriority(PRIO_PROCESS, (id_t)gettid()), own);
    gpu_destroy(g);
    assert_null(gpu_create(&(gpu_desc){.yields = true, .device = "no such gpu"}));
    assert_non_null(strstr(err_get(), "no such gpu"));
}

static void pipeline_cache_is_saved_and_a_broken_one_is_replaced(void **state) {
    (void)state;
    char folder[] = "/tmp/roil-cache-XXXXXX", pattern[64];
    assert_non_null(mkdtemp(folder));
    snprintf(pattern, sizeof pattern, "%s/*.bin", folder);
    for (int round = 0; round < 3; round++) {
        gpu *g = gpu_test_open(folder);
        gpu_pipeline *pipeline = make_step(g, step_comp_code, sizeof step_comp_code);
        gpu_test_ok(pipeline);
        gpu_pipeline_destroy(g, pipeline);
        gpu_test_close(g);
        file_list files;
        assert_true(file_glob(pattern, &files));
        assert_int_equal(files.count, 1);
        if (round == 1) assert_true(file_write(files.paths[0], "roilpc1 broken", 14));
        if (round == 2) {
            struct stat info;
            assert_int_equal(stat(files.paths[0], &info), 0);
            assert_true(info.st_size > 14); // written anew
            assert_int_equal(unlink(files.paths[0]), 0);
        }
        file_list_free(&files);
    }
    assert_int_equal(rmdir(folder), 0);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(devices_are_listed_real_ones_first),
        cmocka_unit_test(best_device_is_the_first_usable),
        cmocka_unit_test(device_is_found_by_index_and_part_of_name),
        cmocka_unit_test(wrong_device_name_lists_the_devices),
        cmocka_unit_test(threads_of_a_device_yield),
        cmocka_unit_test(impossible_resources_are_refused),
        cmocka_unit_test(code_that_is_not_spirv_is_refused),
        cmocka_unit_test(pipeline_cache_is_saved_and_a_broken_one_is_replaced),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
