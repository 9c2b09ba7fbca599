// Eddies leave a cylinder and take its drag, in single precision. With ROIL_LONG_TESTS=1 a finer
// one, too.
#include "sim_cylinder_test.h"

static void eddies_leave_a_cylinder_and_take_its_drag(void **state) {
    const eddies e = run(*state, 8, LBM_F32, 60, 4);
    cylinder_check(&e, 8);
}

// Twice as fine, what the cells add is half: what is left is the drag of a round one.
static void a_finer_cylinder_has_less_drag(void **state) {
    if (!sim_long_tests("a finer cylinder")) return;
    static const double round = 1.54;
    const eddies coarse = run(*state, 8, LBM_F32, 60, 4), fine = run(*state, 16, LBM_F32, 60, 4);
    const double endless = 2 * fine.drag - coarse.drag;
    print_message("of endless cells: drag %.4f\n", endless);
    assert_true(fabs(fine.strouhal / tunnel_strouhal() - 1) < 0.04);
    assert_true(fabs(endless / round - 1) < 0.05);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(eddies_leave_a_cylinder_and_take_its_drag),
        cmocka_unit_test(a_finer_cylinder_has_less_drag),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
