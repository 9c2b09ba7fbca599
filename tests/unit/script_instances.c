// instances { }, scatter { } and node { } in an effect file: what they take, what a script gets
// from them, and what is said after a mistake. Without a device.
#include "base/memory.h"
#include "script_helper.h"

#define HEAD "local fx = effect { name = 'wood' }\n"
#define TWO                                                                                        \
    "local wood = instances { mesh 'a.obj', mesh 'b.obj', at = { {0, 0, 0}, {4, 0, 0}, {9, 0, 1} " \
    "}, "
#define TAIL "\nfx.output = geometry { wood or mesh 'a.obj' }\nreturn fx\n"

static const char TRIANGLE[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

static void refused(const char *text, const char *message) {
    helper_refuses(HEAD, text, TAIL, message);
}

static void accepted(const char *text) {
    effect_destroy(helper_accepts(HEAD, text, TAIL, NULL, 0));
}

static void put_meshes(void) {
    helper_put("a.obj", TRIANGLE);
    helper_put("b.obj", TRIANGLE);
}

static void mistakes_are_named(void **state) {
    (void)state;
    put_meshes();
    refused("local wood = instances { at = { {0, 0, 0} } }", "0 meshes are given; 1 to 64");
    refused("local wood = instances { 3, at = { {0, 0, 0} } }", "value 1 is a number");
    refused("local wood = instances { mesh 'a.obj' }", "'at' is missing");
    refused("local wood = instances { mesh 'a.obj', at = {} }", "'at' has 0 places");
    refused("local wood = instances { mesh 'a.obj', at = { 3 } }", "'position' of an instance is");
    refused("local wood = instances { mesh 'a.obj', at = { {0, 2e6} } }", "up to 1e6");
    refused("local wood = instances { mesh { 'a.obj', scale = 2 }, at = { {0, 0} } }",
            "'a.obj' has a place or colour of its own");
    refused(TWO "scales = 2 }", "unknown key 'scales'; did you mean 'scale'?");
    refused(TWO "scale = {1, 2, 3, 4} }",
            "'scale' is a list of 4; one value, {low, high}, a list of 3");
    refused(TWO "scale = 'big' }", "'scale' of an instance is a number, up to 1e6; got string");
    refused(TWO "scale = 0/0 }", "'scale' of an instance is");
    refused(TWO "kind = 9 }", "0: not shown; got 9");
    refused(TWO "color = {1, 0/0, 2} }", "got {1, nan, 2}");
    refused(TWO "scale = function(i) return 'x' end }", "'scale' of an instance is");
    refused(TWO "scale = function(i) error('no') end }", "no");
    refused(TWO "kind = 3 }", "a whole number from 1 to 2, by its meshes");
    refused(TWO "kind = {0, 0} }", "all shares of 'kind' are 0");
    refused(TWO "kind = {1, -1} }", "a share of 'kind' is -1");
    refused(TWO "color = {1, -1, 0} }", "'color' of an instance is");
    refused(TWO "glow = -1 }", "'glow' of an instance is a number from 0 on");
    refused(TWO "state = {1, 2, 3, 4, 5} }", "'state' of an instance is");
    refused(TWO "lean = 200 }", "'lean' is 200");
    refused(TWO "parent = 3 }", "'parent' takes node { }; got a number");
    refused(TWO "position = position }", "'position' varies in space");
    refused(TWO "}\nwood:sett(1, {})", "unknown method 'sett'; did you mean 'set'?");
    refused(TWO "}\nwood:set(4, {})", "wood: there is no instance 4; 1 to 3 are there");
    refused(TWO "}\nwood:set(0, {})", "no instance 0");
    refused(TWO "}\nwood:set({1, 2.5}, {})", "no instance 2.5");
    refused(TWO "}\nwood:set(1, { kinds = 1 })", "unknown key 'kinds'; did you mean 'kind'?");
    refused(TWO "}\nwood:set(1, { 3 })", "a key is a number");
    refused(TWO "}\nwood:set(1, 3)", "what is set is a table");
    refused(TWO "}\nwood:set_all { scale = {1, 2} }", "'scale' has 2 values; one, or 3");
    refused(TWO "}\nwood:near(3, 1)", "near takes a point and a radius");
    refused(TWO "}\nwood:near({0, 0}, -1)", "its radius is -1");
    refused(TWO "}\nwood.set(1, {})", "set is a method of instances");
    refused(TWO "}\nlocal a = final { wood }", "final: takes no instances");
    refused("local wood = node { 3 }", "node takes only named values");
    refused("local wood\nlocal n for i = 1, 70 do n = node { parent = n } end",
            "65 stand in each other");
}

static void scatter_says_what_it_takes(void **state) {
    (void)state;
    put_meshes();
    refused("local wood = scatter { count = 5 }", "'size' is missing");
    refused("local wood = scatter { count = 5, size = 0 }", "'size' takes one or two lengths");
    refused("local wood = scatter { size = 5 }", "'count' is 0");
    refused("local wood = scatter { size = 5, count = 2e5 }", "'count' is 200000");
    refused("local wood = scatter { size = 5, count = 2, distance = -1 }", "'distance' is -1");
    refused("local wood = scatter { size = 5, count = 2, inside = -1 }", "no place was found");
    refused("local wood = scatter { size = 5, count = 2, inside = position }", "1 component");
    refused("local f = position.x for i = 1, 100 do f = f * 0.5 - 1 end\n"
            "local wood = scatter { size = 5, count = 1e5, density = f + 2.005 }",
            "instruction limit of");
}

static void values_are_what_was_said(void **state) {
    (void)state;
    put_meshes();
    accepted(
        "local list = scatter { count = 30, size = {20, 10}, distance = 1, position = {5, 5, 2},\n"
        "  inside = position.x - 5, height = 3 }\n"
        "assert(#list == 30)\n"
        "for _, p in ipairs(list) do assert(p[1] >= 5 and p[1] <= 15 and p[3] == 5) end\n"
        "assert(#scatter { size = 8, distance = 1 } > 30)\n"
        "local wood = instances { mesh 'a.obj', mesh 'b.obj', at = list, kind = {1, 3},\n"
        "  scale = {0.5, 1.5}, yaw = {90, 100}, color = {'#000', '#fff'}, glow = {2, 3},\n"
        "  state = function(i, p) return {i, p[1]} end }\n"
        "local kinds, randoms = {0, 0}, {}\n"
        "for i = 1, #wood do\n"
        "  local w = wood:get(i)\n"
        "  kinds[w.kind] = kinds[w.kind] + 1\n"
        "  assert(w.scale >= 0.5 and w.scale <= 1.5 and w.glow >= 2 and w.glow <= 3)\n"
        "  assert(w.yaw > 89.99 and w.yaw < 100.01 and w.color[1] == w.color[3])\n"
        "  assert(w.state[1] == i and math.abs(w.state[2] - list[i][1]) < 1e-5)\n"
        "  assert(not randoms[w.random]) randoms[w.random] = true\n"
        "end\n"
        "assert(kinds[1] > 1 and kinds[2] > kinds[1])\n");
}

static void what_is_set_can_be_got(void **state) {
    (void)state;
    put_meshes();
    accepted(TWO "lean = 30, yaw = 40, kind = {2, 1, 0}, scale = {1, 2, 3} }\n"
                 "local function near(a, b) return math.abs(a - b) < 1e-3 end\n"
                 "assert(wood:get(1).kind == 2 and wood:get(3).kind == 0)\n"
                 "assert(wood:get(3).scale == 3 and near(wood:get(2).yaw, 40))\n"
                 "wood:set(2, { yaw = -120 })\n"
                 "assert(near(wood:get(2).yaw, -120))\n"
                 "wood:set({1, 3}, { rotation = {0, 0, 50}, scale = 7, kind = 1 })\n"
                 "assert(near(wood:get(3).yaw, 50) and wood:get(3).kind == 1)\n"
                 "wood:set_all { scale = {4, 5, 6}, state = {9, 8}, color = '#ff0000' }\n"
                 "assert(wood:get(2).scale == 5 and wood:get(2).state[2] == 8)\n"
                 "assert(wood:get(1).color[1] == 1 and wood:get(1).color[2] == 0)\n"
                 "wood:set_all { position = { {0, 0}, {4, 0}, {9, 0, 1} },\n"
                 "  rotation = { {0, 0, 1}, {0, 0, 2}, {0, 0, 3} }, yaw = {4, 5, 6},\n"
                 "  scale = {1, 2, 3}, kind = {1, 2, 0}, glow = {1, 2, 3},\n"
                 "  color = { {1, 0, 0}, {0, 1, 0}, {0, 0, 1} },\n"
                 "  state = { {7}, {1, 2, 3, 4}, {9} } }\n"
                 "assert(near(wood:get(3).yaw, 6) and wood:get(2).state[4] == 4)\n"
                 "assert(wood:get(3).color[3] == 1 and wood:get(3).state[1] == 9)\n"
                 "assert(#wood:near({0, 0, 0}, 4.5) == 2 and wood:near({5, 0, 0}, 100)[1] == 2)\n"
                 "wood:set(2, { position = {100, 0} })\n"
                 "assert(#wood:near({0, 0, 0}, 4.5) == 1 and wood:get(2).position[3] == 0)\n"
                 "wood:reset()\n"
                 "assert(wood:get(2).position[1] == 4 and near(wood:get(2).yaw, 40))\n");
}

static void nodes_and_meshes_compile(void **state) {
    (void)state;
    put_meshes();
    effect *e = helper_accepts(
        HEAD,
        "local hub = node { position = {0, 0, 1}, rotation = function(t) return {0, 0, t} end,\n"
        "  parent = node { scale = 2 } }\n" TWO "parent = hub }\n"
        "local all = geometry { mesh { 'a.obj', parent = hub }, wood, mode = 'rays' }\n"
        "local cells = voxels { wood, resolution = 8 }\n",
        TAIL, NULL, 0);
    if (!effect_check(e)) fail_msg("%s", err_get());
    effect_destroy(e);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(mistakes_are_named),       cmocka_unit_test(scatter_says_what_it_takes),
        cmocka_unit_test(values_are_what_was_said), cmocka_unit_test(what_is_set_can_be_got),
        cmocka_unit_test(nodes_and_meshes_compile),
    };
    return cmocka_run_group_tests(tests, helper_setup, helper_teardown);
}
