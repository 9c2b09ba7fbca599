// Births at instances: which of them, and where in their space.
#include "particles_test.h"
#include "shared.h"

enum { INSTANCES = 3 };

typedef struct grove {
    swarm swarm;
    scene_instances *trees;
} grove;

// At x = 0, 10 and 20 m, with the states 1, 0 and 3, which are the shares; the last is twice as
// large and turned by 90 degrees about z. Particles rise from (1, 0, 2) of each.
static grove open_grove(gpu *device, uint32_t seed) {
    grove g = {.swarm = swarm_open(device, 8192, 0)};
    effect *e = g.swarm.e;
    scene_mesh *mesh = effect_add_mesh(e, "crate.obj");
    gpu_test_ok(mesh);
    struct instance_entry entries[INSTANCES] = {0};
    for (int i = 0; i < INSTANCES; i++) {
        entries[i].place = (shared_vec4){{10.0f * (float)i, 0, 0, i == 2 ? 2 : 1}};
        entries[i].turn = (shared_vec4){{0, 0, 0, 1}};
        entries[i].color = (shared_vec4){{1, 1, 1, 1}};
    }
    entries[0].state.v[0] = 1;
    entries[2].state.v[0] = 3;
    entries[2].turn = (shared_vec4){{0, 0, sqrtf(0.5f), sqrtf(0.5f)}};
    const field *zero = triple(e, 0, 0, 0), *one = number(e, 1);
    g.trees = effect_add_instances(e, &(scene_instances_desc){.name = "trees",
                                                              .kinds = &mesh,
                                                              .kind_count = 1,
                                                              .entries = entries,
                                                              .count = INSTANCES,
                                                              .position = triple(e, 0, 0, 100),
                                                              .rotation = zero,
                                                              .scale = one,
                                                              .color = triple(e, 1, 1, 1)});
    gpu_test_ok(g.trees);
    const field *state = make(e, "instance_state", NULL);
    const field *share = field_swizzle(effect_memory(e), state, "x");
    gpu_test_ok(pass_particles_open(
        g.swarm.pass,
        &(pass_particles_desc){
            .count = 8192, .time_step = 1.0 / RATE_OF_FRAMES, .at = g.trees, .share = share}));
    swarm_set(&g.swarm, "rate", 300);
    swarm_set(&g.swarm, "seed", (float)seed);
    swarm_set3(&g.swarm, "position", 1, 0, 2);
    swarm_live(&g.swarm, 100, 100);
    swarm_field(&g.swarm, "quantity", share); // of its instance, when it is born
    gpu_test_ok(pass_set_option(g.swarm.pass, "quantity_from", "birth"));
    swarm_build(&g.swarm);
    return g;
}

static void count(const swarm *s, int out[INSTANCES]) {
    static const float places[INSTANCES][3] = {{1, 0, 102}, {11, 0, 102}, {20, 2, 104}};
    memset(out, 0, INSTANCES * sizeof *out);
    for (uint32_t i = 0; i < s->used; i++) {
        int found = -1;
        for (int k = 0; k < INSTANCES; k++)
            if (fabsf(s->at[i][0] - places[k][0]) + fabsf(s->at[i][1] - places[k][1]) +
                    fabsf(s->at[i][2] - places[k][2]) <
                1e-4f)
                found = k;
        if (found < 0)
            fail_msg("born at %g, %g, %g", (double)s->at[i][0], (double)s->at[i][1],
                     (double)s->at[i][2]);
        out[found]++;
    }
}

static void they_are_shared_out_as_the_field_says(void **state) {
    grove g = open_grove(*state, 0);
    int born[INSTANCES];
    swarm_run(&g.swarm, 60);
    count(&g.swarm, born);
    is_near(g.swarm.used, 1200, 1, "born"); // 300 times 1 + 3
    assert_int_equal(born[1], 0);
    is_near(born[0], 300, 60, "of the first"); // four times the standard deviation
    swarm_close(&g.swarm);
}

static void shares_may_change(void **state) {
    grove g = open_grove(*state, 0);
    int before[INSTANCES], after[INSTANCES];
    swarm_run(&g.swarm, 30);
    count(&g.swarm, before);
    struct instance_entry now = scene_instances_entries(g.trees)[1];
    now.state.v[0] = 2;
    scene_instances_set(g.trees, 1, &now);
    for (uint32_t i = 0; i < INSTANCES; i += 2) {
        now = scene_instances_entries(g.trees)[i];
        now.state.v[0] = -5; // none
        scene_instances_set(g.trees, i, &now);
    }
    swarm_run(&g.swarm, 60);
    count(&g.swarm, after);
    assert_int_equal(after[0], before[0]);
    assert_int_equal(after[2], before[2]);
    is_near(after[1], 300, 1, "of the second"); // 300 times 2 for half a second
    now = scene_instances_entries(g.trees)[1];
    now.state.v[0] = 0;
    scene_instances_set(g.trees, 1, &now);
    uint32_t used = g.swarm.used;
    swarm_run(&g.swarm, 90);
    assert_int_equal(g.swarm.used, used);
    swarm_close(&g.swarm);
}

static void they_are_the_same_every_time(void **state) {
    grove a = open_grove(*state, 5), b = open_grove(*state, 5), other = open_grove(*state, 6);
    swarm_run(&a.swarm, 20);
    swarm_run(&b.swarm, 7);
    swarm_run(&b.swarm, 20);
    swarm_run(&other.swarm, 20);
    size_t size = a.swarm.used * sizeof *a.swarm.at;
    assert_memory_equal(a.swarm.at, b.swarm.at, size);
    assert_memory_not_equal(a.swarm.at, other.swarm.at, size);
    swarm_close(&a.swarm);
    swarm_close(&b.swarm);
    swarm_close(&other.swarm);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(they_are_shared_out_as_the_field_says),
    cmocka_unit_test(shares_may_change),
    cmocka_unit_test(they_are_the_same_every_time),
};

int main(void) {
    return gpu_test_run(tests, COUNT_OF(tests));
}
