// What is decided by the device: by its kind, its driver's version and its limits.
#include "gpu/profile.h"
#include "gpu/vk.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h> // wants the headers above

static const gpu_limits large = {.group_threads = 1024,
                                 .shared_bytes = 49152,
                                 .storage_buffers = 1024,
                                 .storage_images = 1024,
                                 .first_instance = true};

static gpu_profile find(gpu_kind kind, VkDriverId driver, const char *version) {
    const gpu_info info = {.kind = kind, .subpixel_bits = 8, .int64 = true};
    return vk_profile_find(&info, driver, version, &large);
}

static bool is_rewritten(VkDriverId driver, const char *version) {
    const gpu_profile p = find(GPU_CPU, driver, version);
    assert_int_equal(p.hoists_uniforms, p.hides_uniforms);
    assert_int_equal(p.hoists_uniforms, p.slices_dispatches);
    return p.hoists_uniforms;
}

static void code_is_rewritten_for_the_versions_it_was_measured_on(void **state) {
    (void)state;
    assert_true(is_rewritten(VK_DRIVER_ID_MESA_LLVMPIPE, "Mesa 22.3.6 (LLVM 15.0.6)"));
    assert_true(is_rewritten(VK_DRIVER_ID_MESA_LLVMPIPE, "Mesa 22.3.0 (LLVM 15.0.6)"));
    assert_false(is_rewritten(VK_DRIVER_ID_MESA_LLVMPIPE, "Mesa 22.2.5 (LLVM 15.0.6)"));
    assert_false(is_rewritten(VK_DRIVER_ID_MESA_LLVMPIPE, "Mesa 22.4.0-devel (LLVM 15.0.6)"));
    assert_false(is_rewritten(VK_DRIVER_ID_MESA_LLVMPIPE, "Mesa 24.0.1 (LLVM 17.0.6)"));
    assert_false(is_rewritten(VK_DRIVER_ID_MESA_LLVMPIPE, "a driver"));
    assert_false(is_rewritten(VK_DRIVER_ID_MESA_LLVMPIPE, ""));
    assert_false(is_rewritten(VK_DRIVER_ID_GOOGLE_SWIFTSHADER, "22.3.6"));
}

static void indices_are_clamped_for_every_processor(void **state) {
    (void)state;
    assert_true(find(GPU_CPU, VK_DRIVER_ID_MESA_LLVMPIPE, "Mesa 24.0.1").clamps_indices);
    assert_true(find(GPU_CPU, VK_DRIVER_ID_GOOGLE_SWIFTSHADER, "5").clamps_indices);
    assert_false(find(GPU_DISCRETE, VK_DRIVER_ID_NVIDIA_PROPRIETARY, "550.1.2").clamps_indices);
}

static void maps_win_where_drawing_them_does(void **state) {
    (void)state;
    const bool wins[] = {[GPU_DISCRETE] = false,
                         [GPU_INTEGRATED] = true,
                         [GPU_VIRTUAL] = false,
                         [GPU_CPU] = true,
                         [GPU_OTHER] = true};
    for (int kind = GPU_DISCRETE; kind <= GPU_OTHER; kind++)
        assert_int_equal(find((gpu_kind)kind, 0, "1.2.3").shadow_maps_win, wins[kind]);
}

static void coarse_corners_are_traced(void **state) {
    (void)state;
    gpu_info info = {.kind = GPU_CPU, .subpixel_bits = 4};
    assert_true(vk_profile_find(&info, 0, "", &large).geometry_traces);
    info.subpixel_bits = 8;
    assert_false(vk_profile_find(&info, 0, "", &large).geometry_traces);
}

static void a_device_that_is_small_of_itself_is_cut_to_as_well(void **state) {
    (void)state;
    const gpu_info info = {.kind = GPU_INTEGRATED, .subpixel_bits = 8};
    gpu_limits limits = large;
    limits.shared_bytes = 16384;
    const gpu_profile p = vk_profile_find(&info, 0, "", &limits);
    assert_int_equal(p.sort_threads, 128);
    assert_int_equal(p.flow_coarse, 16);
    assert_true(p.geometry_traces); // its buffers and images do
    limits.storage_buffers = 8;
    assert_false(vk_profile_find(&info, 0, "", &limits).geometry_traces);
    assert_int_equal(vk_profile_find(&info, 0, "", &limits).flow_sweeps, 1);
}

static void a_switch_takes_nothing_but_limits(void **state) {
    (void)state;
    gpu_profile p = find(GPU_CPU, VK_DRIVER_ID_MESA_LLVMPIPE, "Mesa 22.3.6"), before = p;
    vk_profile_make_small(&p);
    assert_int_equal(p.limits.storage_buffers, 8);
    assert_int_equal(p.limits.group_threads, 256);
    assert_int_equal(p.hoists_uniforms, before.hoists_uniforms);
    gpu_limits least = {
        .group_threads = 128, .shared_bytes = 8192, .storage_buffers = 4, .storage_images = 2};
    p.limits = least;
    vk_profile_make_small(&p);
    assert_memory_equal(&p.limits, &least, sizeof least); // it never has more than the device
}

static void without_a_device_nothing_is_refused(void **state) {
    (void)state;
    const gpu_demand demand = {1u << 20, 1u << 30, 1000, 1000};
    assert_true(gpu_meets_limits(&gpu_get_profile(NULL)->limits, "any", &demand));
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(code_is_rewritten_for_the_versions_it_was_measured_on),
        cmocka_unit_test(indices_are_clamped_for_every_processor),
        cmocka_unit_test(maps_win_where_drawing_them_does),
        cmocka_unit_test(coarse_corners_are_traced),
        cmocka_unit_test(a_device_that_is_small_of_itself_is_cut_to_as_well),
        cmocka_unit_test(a_switch_takes_nothing_but_limits),
        cmocka_unit_test(without_a_device_nothing_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
