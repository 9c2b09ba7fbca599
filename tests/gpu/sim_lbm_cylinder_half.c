// Eddies leave a cylinder and take its drag, in half precision.
#include "sim_cylinder_test.h"

static void eddies_leave_a_cylinder_and_take_its_drag(void **state) {
    const eddies e = run(*state, 8, LBM_F16, 60, 4);
    cylinder_check(&e, 8);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(eddies_leave_a_cylinder_and_take_its_drag),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
