// Where and when particles are born, how long they live, and what they carry.
#include "particles_test.h"

// ---- when -------------------------------------------------------------------------------------

static void as_many_are_born_as_the_rate_says(void **state) {
    swarm s = swarm_open(*state, 4096, 0);
    swarm_set(&s, "rate", 777);
    swarm_live(&s, 100, 100);
    swarm_build(&s);
    static const int frames[] = {1, 17, 60, 200};
    for (size_t k = 0; k < COUNT_OF(frames); k++) {
        swarm_run(&s, frames[k]);
        double wanted = 777.0 * frames[k] / 60;
        is_near(s.used, wanted, 1, "born");
        for (uint32_t i = 0; i < s.used; i++) // one after the other, evenly
            is_near((double)s.at[i][3], (wanted - i - 1) / 777, 1e-4, "age");
    }
    swarm_close(&s);
}

// However a step lies to the moments: each is where one that flew for as long as it is old would
// be.
static void each_is_thrown_at_its_own_moment(void **state) {
    swarm s = swarm_open(*state, 512, 0);
    swarm_set(&s, "rate", 410);
    swarm_live(&s, 100, 100);
    swarm_set(&s, "gravity", 10);
    swarm_field(&s, "speed", triple(s.e, 3, 0, 4));
    swarm_build(&s);
    swarm_run(&s, 60);
    for (uint32_t i = 0; i < s.used; i++) {
        double age = (double)s.at[i][3];
        is_near((double)s.at[i][0], 3 * age, 1e-4, "x");
        is_near((double)s.at[i][2], 4 * age - 5 * age * age, 1e-4, "z");
        is_near((double)s.move[i][2], 4 - 10 * age, 1e-4, "speed");
    }
    swarm_close(&s);
}

static void each_lives_as_long_as_it_should(void **state) {
    swarm s = swarm_open(*state, 4096, 0);
    swarm_set(&s, "rate", 2000);
    swarm_live(&s, 0.5f, 1.5f);
    swarm_build(&s);
    swarm_run(&s, 240);
    double sum = 0, square = 0;
    int alive = 0, young = 0;
    for (uint32_t i = 0; i < s.used; i++) {
        double life = (double)s.move[i][3], age = (double)s.at[i][3];
        if (life == 0) continue; // it has been dead for more than a step
        assert_true(life >= 0.5 && life <= 1.5 && age < life + 1.0 / 60 + 1e-4);
        alive += swarm_lives(&s, i);
        if (age >= 0.5) continue;
        young++;
        sum += life;
        square += life * life;
    }
    double mean = sum / young;
    is_near(young, 1000, 1, "too young to die");
    is_near(mean, 1, 0.04, "mean lifetime");
    is_near(square / young - mean * mean, 1.0 / 12, 0.01, "its variance");
    is_near(alive, 2000, 50, "alive");
    swarm_close(&s);
}

// The ring: who is born takes the place of the oldest.
static void the_oldest_make_room(void **state) {
    swarm s = swarm_open(*state, 100, 0);
    swarm_set(&s, "rate", 600);
    swarm_live(&s, 50, 50);
    swarm_build(&s);
    swarm_run(&s, 95); // 950 born
    assert_int_equal(s.used, 100);
    for (uint32_t i = 0; i < 100; i++) {
        uint32_t number = i < 50 ? 900 + i : 800 + i; // of the slot's particle
        assert_true(swarm_lives(&s, i));
        is_near((double)s.at[i][3], (949 - (double)number) / 600, 1e-4, "age");
    }
    const pass_simulation *simulation = pass_get_simulation(s.pass);
    const char *trouble = simulation->trouble(s.pass);
    assert_non_null(trouble);
    if (!strstr(trouble, "'count' to 30000")) fail_msg("%s", trouble);
    swarm_close(&s);
}

// Up at 1 m/s, from the middle of a ball of 0.25 m, to the end at 0.5 m.
static void they_die_where_they_should_not_be(void **state) {
    swarm s = swarm_open(*state, 512, 0);
    swarm_set(&s, "burst", 512);
    swarm_live(&s, 100, 100);
    swarm_set(&s, "radius", 0.25f);
    swarm_field(&s, "velocity", triple(s.e, 0, 0, 1));
    const field *here = make(s.e, "position", NULL);
    swarm_field(&s, "alive",
                make(s.e, "sub", number(s.e, 0.5f), field_swizzle(effect_memory(s.e), here, "z")));
    swarm_build(&s);
    static const int alive[][2] = {{12, 512}, {30, 256}, {47, 0}}; // frame, how many
    for (size_t k = 0; k < COUNT_OF(alive); k++) {
        int count = 0;
        swarm_run(&s, alive[k][0]);
        for (uint32_t i = 0; i < s.used; i++) {
            count += swarm_lives(&s, i);
            assert_true(!swarm_lives(&s, i) || s.at[i][2] < 0.5f);
        }
        is_near(count, alive[k][1], k == 1 ? 50 : 0, "alive");
    }
    swarm_close(&s);
}

// ---- where ------------------------------------------------------------------------------------

static double length_of(const float *p) {
    return sqrt((double)(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]));
}

// Evenly in a ball: by itself, and found in the box of a shape.
static void a_ball_is_filled_evenly(void **state) {
    for (int by_shape = 0; by_shape < 2; by_shape++) {
        swarm s = swarm_open(*state, 8192, 0);
        swarm_set(&s, "burst", 8192);
        swarm_live(&s, 100, 100);
        if (by_shape)
            swarm_field(&s, "shape",
                        make(s.e, "sphere", triple(s.e, 0, 0, 0), number(s.e, 2), number(s.e, 0)));
        else
            swarm_set(&s, "radius", 2);
        swarm_build(&s);
        swarm_run(&s, 1);
        int inner = 0, octants[8] = {0};
        for (uint32_t i = 0; i < s.used; i++) {
            const float *p = s.at[i];
            assert_true(swarm_lives(&s, i) && length_of(p) <= 2.0001);
            inner += length_of(p) < 1;
            octants[(p[0] > 0) + 2 * (p[1] > 0) + 4 * (p[2] > 0)]++;
        }
        is_near(inner, 1024, 120, "within half the radius"); // 4 deviations
        for (int i = 0; i < 8; i++) is_near(octants[i], 1024, 120, "in an octant");
        swarm_close(&s);
    }
}

static void a_threshold_says_where(void **state) {
    swarm s = swarm_open(*state, 1024, 0);
    swarm_set(&s, "burst", 1024);
    swarm_live(&s, 100, 100);
    // Falls from 1 at the middle of a ball to 0 at its surface: 0.75 at a quarter of the radius.
    swarm_field(&s, "shape",
                make(s.e, "sphere", triple(s.e, 1, 0, 0), number(s.e, 2), number(s.e, 2)));
    swarm_set(&s, "threshold", 0.75f);
    swarm_build(&s);
    swarm_run(&s, 1);
    int alive = 0;
    for (uint32_t i = 0; i < s.used; i++) {
        if (!swarm_lives(&s, i)) continue;
        alive++;
        float from[3] = {s.at[i][0] - 1, s.at[i][1], s.at[i][2]};
        assert_true(length_of(from) < 0.5001);
    }
    const pass_simulation *simulation = pass_get_simulation(s.pass);
    pass_readout all[8];
    size_t count = simulation->readouts(s.pass, all, COUNT_OF(all));
    assert_string_equal(all[count - 1].name, "without a place");
    is_near(all[count - 1].value, 100 - alive / 10.24, 1e-6, "share without a place");
    assert_non_null(simulation->trouble(s.pass));
    if (!strstr(simulation->trouble(s.pass), "found no place"))
        fail_msg("%s", simulation->trouble(s.pass));
    is_near(alive, 1024 * (1 - pow(1 - 0.00818, 256)), 42, "found a place"); // pi / 6 / 64 each try
    swarm_close(&s);
}

// Five triangles whose areas are as 1, 2, 4, 8 and 16, side by side along x.
static const float widths[] = {1, 2, 4, 8, 16};
enum { TRIANGLES = COUNT_OF(widths) };

static void make_triangles(swarm *s, scene_mesh *mesh) {
    arena *memory = effect_memory(s->e);
    mesh_vertex *vertices = arena_alloc(memory, 3 * TRIANGLES * sizeof *vertices);
    uint32_t *indices = arena_alloc(memory, 3 * TRIANGLES * sizeof *indices);
    for (uint32_t i = 0; i < 3 * TRIANGLES; i++) {
        vertices[i].position[0] = 10 * (float)(i / 3);
        vertices[i].position[1] = i % 3 == 1 ? 2 : 0;
        vertices[i].position[2] = i % 3 == 2 ? widths[i / 3] : 0;
        indices[i] = i;
    }
    *mesh = (scene_mesh){.name = "triangles",
                         .data = {.vertices = vertices,
                                  .vertex_count = 3 * TRIANGLES,
                                  .indices = indices,
                                  .index_count = 3 * TRIANGLES},
                         .position = triple(s->e, 0, 0, 0),
                         .rotation = triple(s->e, 0, 0, 0),
                         .scale = number(s->e, 1),
                         .color = triple(s->e, 1, 1, 1)};
    gpu_test_ok(pass_add_mesh(s->pass, mesh));
}

static void a_mesh_is_covered_evenly(void **state) {
    swarm s = swarm_open(*state, 31 * 256, 0);
    scene_mesh mesh;
    make_triangles(&s, &mesh);
    swarm_set(&s, "burst", 31 * 256);
    swarm_live(&s, 100, 100);
    swarm_set(&s, "outward", 1.5f);
    swarm_build(&s);
    swarm_run(&s, 1);
    double hits[TRIANGLES] = {0}, mean[TRIANGLES][2] = {{0}}, chi = 0;
    for (uint32_t i = 0; i < s.used; i++) {
        const float *p = s.at[i];
        int k = (int)(p[0] / 10 + 0.5f);
        float y = p[1] / 2, z = p[2] / widths[k];
        is_near((double)p[0], 10 * k + 1.5 / 60, 1e-4, "along the normal");
        assert_true(y >= 0 && z >= 0 && y + z <= 1.0001f);
        hits[k]++;
        mean[k][0] += (double)y;
        mean[k][1] += (double)z;
    }
    for (int k = 0; k < TRIANGLES; k++) {
        double wanted = 256 * (double)widths[k];
        chi += (hits[k] - wanted) * (hits[k] - wanted) / wanted;
        for (int a = 0; a < 2; a++) // a coordinate's variance is 1 / 18
            is_near(mean[k][a] / hits[k], 1.0 / 3, 4 * sqrt(1 / 18.0 / hits[k]), "middle");
    }
    printf("chi-square of 5 triangles: %.2f\n", chi);
    assert_true(chi < 18.5); // 1 in 1000 with 4 degrees of freedom
    swarm_close(&s);
}

// 3 m/s along y: born where it is then, with half its speed.
static void a_mesh_that_moves_takes_them_along(void **state) {
    swarm s = swarm_open(*state, 512, 0);
    scene_mesh mesh;
    make_triangles(&s, &mesh);
    mesh.position = make(s.e, "mul", field_time(effect_memory(s.e)), triple(s.e, 0, 3, 0));
    swarm_set(&s, "rate", 200);
    swarm_set(&s, "mesh_factor", 0.5f);
    swarm_live(&s, 100, 100);
    gpu_test_ok(pass_set_option(s.pass, "motion", "forces"));
    swarm_build(&s);
    swarm_run(&s, 60);
    for (uint32_t i = 0; i < s.used; i++) {
        double born = 1 - (double)s.at[i][3];
        double y = (double)s.at[i][1] - 3 * born - 1.5 * (1 - born); // on the mesh
        assert_true(y > -1e-3 && y < 2.001);
        is_near((double)s.move[i][1], 1.5, 1e-3, "speed");
    }
    swarm_close(&s);
}

// ---- how fast, and with what ------------------------------------------------------------------

static void a_cone_is_filled_evenly(void **state) {
    swarm s = swarm_open(*state, 8192, 0);
    swarm_set(&s, "burst", 8192);
    swarm_live(&s, 100, 100);
    swarm_field(&s, "speed", triple(s.e, 0, 0, 2));
    swarm_set(&s, "spread", 60);
    swarm_set(&s, "variation", 0.25f);
    swarm_build(&s);
    swarm_run(&s, 1);
    int inner = 0;
    double sum = 0;
    for (uint32_t i = 0; i < s.used; i++) {
        double speed = length_of(s.move[i]), up = (double)s.move[i][2] / speed;
        assert_true(speed > 1.4999 && speed < 2.0001 && up > 0.4999);
        inner += up > 0.75;
        sum += speed;
    }
    is_near(inner, 4096, 180, "in the inner half");
    is_near(sum / s.used, 1.75, 0.007, "mean speed");
    swarm_close(&s);
}

static void each_carries_what_is_around_it(void **state) {
    for (int stays = 0; stays < 2; stays++) {
        swarm s = swarm_open(*state, 256, 0);
        swarm_set(&s, "rate", 300);
        swarm_live(&s, 100, 100);
        swarm_set(&s, "radius", 1);
        swarm_field(&s, "velocity", triple(s.e, 0, 0, 2));
        swarm_field(&s, "quantity",
                    field_swizzle(effect_memory(s.e), make(s.e, "position", NULL), "z"));
        if (stays) gpu_test_ok(pass_set_option(s.pass, "quantity_from", "birth"));
        swarm_build(&s);
        swarm_run(&s, 40);
        float carried[256];
        gpu_buffer *quantities = particles_of(s.pass)->buffers.quantities;
        gpu_test_ok(gpu_buffer_read(*state, quantities, 0, carried, sizeof carried));
        for (uint32_t i = 0; i < s.used; i++) {
            double wanted = (double)s.at[i][2] - (stays ? 2 * (double)s.at[i][3] : 0);
            is_near((double)carried[i], wanted, 1e-4, "quantity");
        }
        swarm_close(&s);
    }
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(as_many_are_born_as_the_rate_says),
        cmocka_unit_test(each_is_thrown_at_its_own_moment),
        cmocka_unit_test(each_lives_as_long_as_it_should),
        cmocka_unit_test(the_oldest_make_room),
        cmocka_unit_test(they_die_where_they_should_not_be),
        cmocka_unit_test(a_ball_is_filled_evenly),
        cmocka_unit_test(a_threshold_says_where),
        cmocka_unit_test(a_mesh_is_covered_evenly),
        cmocka_unit_test(a_mesh_that_moves_takes_them_along),
        cmocka_unit_test(a_cone_is_filled_evenly),
        cmocka_unit_test(each_carries_what_is_around_it),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
