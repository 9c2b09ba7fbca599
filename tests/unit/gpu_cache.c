// The wrapper of the pipeline cache file: what is not exactly right never reaches a driver.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "gpu/vk.h"

typedef struct sample {
    VkPipelineCacheHeaderVersionOne head;
    uint8_t rest[32];
} sample;

static const VkPhysicalDeviceProperties device = {
    .vendorID = 0x10de, .deviceID = 0x2330, .pipelineCacheUUID = {1, 2, 3}};

static sample make_sample(void) {
    sample s = {.head = {.headerSize = sizeof s.head,
                         .headerVersion = VK_PIPELINE_CACHE_HEADER_VERSION_ONE,
                         .vendorID = device.vendorID,
                         .deviceID = device.deviceID}};
    memcpy(s.head.pipelineCacheUUID, device.pipelineCacheUUID, VK_UUID_SIZE);
    for (size_t i = 0; i < sizeof s.rest; i++) s.rest[i] = (uint8_t)i;
    return s;
}

static void packed_data_comes_back(void **state) {
    (void)state;
    sample s = make_sample();
    void *file;
    size_t size, inner = 0;
    assert_true(vk_cache_pack(&s, sizeof s, &file, &size));
    const void *data = vk_cache_unpack(file, size, &device, &inner);
    assert_non_null(data);
    assert_int_equal(inner, sizeof s);
    assert_memory_equal(data, &s, sizeof s);
    mem_free(file);
}

static void any_changed_or_missing_byte_is_seen(void **state) {
    (void)state;
    sample s = make_sample();
    void *file;
    size_t size, inner;
    assert_true(vk_cache_pack(&s, sizeof s, &file, &size));
    for (size_t i = 0; i < size; i++) {
        ((uint8_t *)file)[i] ^= 0x20;
        assert_null(vk_cache_unpack(file, size, &device, &inner));
        ((uint8_t *)file)[i] ^= 0x20;
        void *cut = mem_copy(file, i); // of its own, so that a sanitizer sees reads beyond it
        assert_null(vk_cache_unpack(cut, i, &device, &inner));
        mem_free(cut);
    }
    mem_free(file);
}

static void data_of_another_device_or_driver_is_refused(void **state) {
    (void)state;
    sample s = make_sample();
    void *file;
    size_t size, inner;
    assert_true(vk_cache_pack(&s, sizeof s, &file, &size));
    VkPhysicalDeviceProperties other = device;
    other.deviceID++;
    assert_null(vk_cache_unpack(file, size, &other, &inner));
    other = device;
    other.vendorID++;
    assert_null(vk_cache_unpack(file, size, &other, &inner));
    other = device;
    other.pipelineCacheUUID[15]++;
    assert_null(vk_cache_unpack(file, size, &other, &inner));
    mem_free(file);
}

static void format_names_are_those_of_glsl(void **state) {
    (void)state;
    for (int i = 1; i < GPU_FORMAT_COUNT; i++) {
        gpu_format format = (gpu_format)i;
        assert_int_equal(gpu_format_from_name(gpu_format_name(format)), format);
        assert_int_equal(gpu_format_size(format) % gpu_format_channels(format), 0);
    }
    assert_int_equal(gpu_format_from_name("rgba16f"), GPU_RGBA16F);
    assert_int_equal(gpu_format_from_name("r32ui"), GPU_R32U);
    assert_int_equal(gpu_format_from_name("none"), GPU_FORMAT_NONE);
    assert_int_equal(gpu_format_from_name(""), GPU_FORMAT_NONE);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(packed_data_comes_back),
        cmocka_unit_test(any_changed_or_missing_byte_is_seen),
        cmocka_unit_test(data_of_another_device_or_driver_is_refused),
        cmocka_unit_test(format_names_are_those_of_glsl),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
