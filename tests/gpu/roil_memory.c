// What effects ask of the device's memory before they take any: as much as they take then, and
// nothing at all where it is refused.
#include "base/memory.h"
#include "base/worker.h"
#include "long_test.h"
#include "roil/roil_impl.h"
#include "roil_test.h"

// What is asked for may miss what is taken by this: single texels, what depends on where things
// stand, and how drivers round (a GPU's by up to 64 KiB for each of some twenty images: twice
// this).
enum { WIDTH = 640, HEIGHT = 360, SLACK = 1 << 20, LAST = 3 };
enum { SHIPPED_WIDTH = 320, SHIPPED_HEIGHT = 180, FRAME = 1 << 20 };

static const char crate[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                            "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

static const char head[] = "local fx = effect { name = 'asks', fps = 60, frames = 10 }\n"
                           "fx.camera = orbit { target = {0, 0, 0.5}, distance = 5 }\n";

// A lattice with all that its state has: faces that air passes, bodies, a force that varies.
static const char air[] =
    "local air = lbm { size = {64, 64, 64}, voxel_size = 0.1, speed = 2, boundary = 'open',\n"
    "                  force = position * 0.1 }\n"
    "air:source { mesh { 'crate.obj', scale = 1.3 }, density = 1 }\n"
    "air:source { particles = particles { count = 64, rate = 60, lifetime = 1 }, density = 1 }\n"
    "air:collider { mesh { 'crate.obj', scale = 1.3 } }\n"
    "fx.output = final { march { density = air.density * 30, steps = 4 } }.color\n"
    "return fx\n";

static const char fire[] =
    "local flow = slices { count = 4, size = {128, 192}, height = 2 }\n"
    "flow:inflow { shape = disc { 0.5, 0.15, radius = 0.12 }, density = 0.8, temperature = 2 }\n"
    "fx.output = final { march { density = flow.density * 3, steps = 4 } }.color\n"
    "return fx\n";

// Of splats of each kind, and of pieces; what particles leave in a grid.
static const char swarm[] =
    "local p = particles { count = 1 << 16, rate = 1e4, lifetime = 1, velocity = {0, 0, 1} }\n"
    "local air = deposit { p, box = { min = {-1, -1, -1}, max = {1, 1, 1} }, resolution = 96,\n"
    "                      size = 0.1 }\n"
    "local added = splats { name = 'added', from = p, size = 0.1 }\n"
    "local weighed = splats { name = 'weighed', from = p, size = 0.1, blend = 'weighted' }\n"
    "local sorted = splats { name = 'sorted', from = p, size = 0.1, blend = 'sorted' }\n"
    "local solid = pieces { mesh { 'crate.obj' }, from = p, size = 0.1 }\n"
    "local volume = march { density = air.density, steps = 4 }\n"
    "fx.output = final { shader { 'all.comp', a = added.image, b = weighed.image,\n"
    "                    c = sorted.image, d = solid.albedo, e = volume.color }.color }.color\n"
    "return fx\n";

static const char all_shader[] =
    "// All of them.\n"
    "uniform sampler2D a; //= input : an image\n"
    "uniform sampler2D b; //= input : an image\n"
    "uniform sampler2D c; //= input : an image\n"
    "uniform sampler2D d; //= input : an image\n"
    "uniform sampler2D e; //= input : an image\n"
    "writeonly uniform image2D color; //= output rgba16f : their sum\n"
    "void main() {\n"
    "    ivec2 at = ivec2(gl_GlobalInvocationID.xy);\n"
    "    imageStore(color, at, texelFetch(a, at, 0) + texelFetch(b, at, 0) +\n"
    "               texelFetch(c, at, 0) + texelFetch(d, at, 0) + texelFetch(e, at, 0));\n"
    "}\n";

// Many bodies, drawn into many views; the body as cells, its distance and its light.
static const char crates[] =
    "local at = {}\n"
    "for i = 1, 20000 do at[i] = {i % 100 - 50, i // 100, 0} end\n"
    "local rows = instances { mesh { 'crate.obj' }, at = at }\n"
    "local body = voxels { mesh { 'crate.obj' }, resolution = 64 }\n"
    "local inside = box { size = {2, 2, 2} } * smoothstep(0.1, 0, body.distance)\n"
    "local lit = lighting { density = inside, glow_resolution = 32 }\n"
    "local seen = geometry { rows, mode = 'raster' }\n"
    "local maps = shadow_maps { from = seen, points = 2, point_size = 128 }\n"
    "local solid = shade { from = {seen, lit, maps} }\n"
    "local smoke = march { from = lit, depth = seen.depth, steps = 4 }\n"
    "fx.output = final { over { volume = smoke, source = solid, depth = seen.depth } }.color\n"
    "return fx\n";

// Bursts as meshes, of which there is one now and may be many; point lights by tiles and as
// spheres.
static const char bursts[] =
    "local all = explosions { {0, position = {0, 0, 1}} }\n"
    "local ball = shell { at = all, mode = 'mesh', life = 2, displacement = 0.1 }\n"
    "local lamps = point_lights { count = 3000, position = light_random * 4, range = 0.5,\n"
    "                             power = 2 }\n"
    "local seen = geometry { mesh { 'crate.obj' } }\n"
    "local near = shade { name = 'near', from = {seen, lamps}, point_lights_by = 'tiles',\n"
    "                     shadow_samples = 4 }\n"
    "local far = shade { name = 'far', from = {seen, lamps}, point_lights_by = 'volumes' }\n"
    "fx.output = final { shader { 'all.comp', a = ball.image, b = near.color,\n"
    "                    c = far.color, d = near.color, e = near.color }.color }.color\n"
    "return fx\n";

typedef struct extent {
    uint32_t width, height;
} extent;

static void list_all(roil_effect *e, extent size, budget_list *out) {
    ok(effect_compile(e->effect));
    ok(graph_compile(effect_graph(e->effect), size.width, size.height));
    assert_int_equal(effect_list_memory(e->effect, out, out), 0);
}

static uint64_t sum_of(const budget_list *list) {
    uint64_t sum = 0;
    for (size_t i = 0; i < list->count; i++) sum += list->rows[i].bytes;
    return sum;
}

static uint64_t used(const roil *r) { // without what was let go
    assert_true(gpu_idle(r->device));
    return gpu_get_memory_use(r->device).used;
}

static void show(const budget_list *list) {
    for (size_t i = 0; i < list->count; i++)
        print_message("%12llu %s\n", (unsigned long long)list->rows[i].bytes, list->rows[i].label);
}

static roil_effect *open(roil *r, const char *body) {
    char text[4096], path[512];
    write_text("crate.obj", crate, path);
    snprintf(text, sizeof text, "%s%s", head, body);
    return load_text(r, "asks.lua", text);
}

// What an effect asks for, added to `list`, is what it has taken once its first pictures are drawn.
static void expect_taken(roil *r, roil_effect *e, extent size, uint64_t ahead, budget_list *list) {
    list_all(e, size, list);
    const uint64_t before = used(r), asked = sum_of(list);
    ok(roil_prepare(e, size.width, size.height));
    for (int i = 1; i <= LAST; i++) ok(roil_render(e, i));
    const uint64_t taken = used(r) - before;
    const uint64_t slack = gpu_get_info(r->device)->kind == GPU_CPU ? SLACK : 2 * SLACK;
    if (taken <= asked + ahead + slack && asked <= taken + slack) return;
    show(list);
    fail_msg("%llu bytes were asked for, %llu are taken", (unsigned long long)asked,
             (unsigned long long)taken);
}

// `rows`: labels that must be among them, up to NULL.
static void expect_asked(roil *r, const char *body, const char *const *rows) {
    budget_list list = {0};
    roil_effect *e = open(r, body);
    expect_taken(r, e, (extent){WIDTH, HEIGHT}, 0, &list);
    for (; *rows; rows++) {
        size_t i = 0;
        while (i < list.count && strcmp(list.rows[i].label, *rows) != 0) i++;
        if (i == list.count) fail_msg("'%s' is not asked for", *rows);
    }
    budget_list_free(&list);
    roil_unload(e);
}

static void air_asks_for_its_state(void **state) {
    expect_asked(*state, air,
                 (const char *const[]){"lattice", "lattice's moments", "waves at open faces",
                                       "kinds of cells", "elements at faces", "force",
                                       "ids of cells", "masks of bodies", "values of a source",
                                       "particles of a source", NULL});
}

static void slices_ask_for_their_state(void **state) {
    expect_asked(*state, fire,
                 (const char *const[]){"flow", "flow's scalars", "flow's velocity", NULL});
}

static void particles_ask_for_theirs_and_for_what_draws_them(void **state) {
    char path[512];
    write_text("all.comp", all_shader, path);
    expect_asked(*state, swarm,
                 (const char *const[]){"positions", "velocities", "sums of particles",
                                       "depths of pieces", "triangles of pieces", NULL});
}

static void scenes_ask_for_what_is_drawn(void **state) {
    expect_asked(*state, crates,
                 (const char *const[]){"lists of draws", "draws", "nearest points", "ids of cells",
                                       "masks of bodies", "bodies by tiles of cells", "crate.obj",
                                       "boxes of meshes", "ranges", NULL});
}

static void bursts_and_point_lights_ask_for_their_lists(void **state) {
    char path[512];
    write_text("all.comp", all_shader, path);
    expect_asked(*state, bursts,
                 (const char *const[]){"vertices of shells", "shafts", "records of point lights",
                                       "point lights by tiles", "depths of tiles",
                                       "light of point lights", NULL});
}

// A body that turns gets masks for however it is turned: more than where it stands first.
static void what_turns_asks_for_all_turns(void **state) {
    static const char body[] =
        "local stick = mesh { 'stick.obj', rotation = function(t) return {0, 45 * t, 0} end }\n"
        "local cells = voxels { stick, box = { min = {-2, -2, -2}, max = {2, 2, 2} },\n"
        "                       resolution = 128 }\n"
        "fx.output = final { march { density = cells.inside, steps = 4 } }.color\n"
        "return fx\n";
    static const char stick[] = "v -1.5 0 0\nv 1.5 0.1 0\nv -1.5 0.1 0.1\nv 1.5 0 0.1\n"
                                "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    char path[512];
    write_text("stick.obj", stick, path);
    expect_asked(*state, body, (const char *const[]){"masks of bodies", NULL});
}

// Of a shipped effect that plays files, frames besides that are read and copied ahead of their
// time: two for each thread that decodes (field/sequence_jobs.c), and two.
static uint64_t bytes_ahead(void) {
    const uint32_t cores = worker_cores(), threads = cores > 2 ? cores - 2 : 1;
    return (2 * (threads < 12 ? threads : 12) + 2) * (uint64_t)FRAME;
}

static void expect_shipped(roil *r, const char *name) {
    char path[512];
    budget_list list = {0};
    snprintf(path, sizeof path, "%s/effects/%s.lua", getenv("ROIL_SOURCE_DIR"), name);
    roil_effect *e = roil_load(r, path, NULL, 0);
    ok(e);
    expect_taken(r, e, (extent){SHIPPED_WIDTH, SHIPPED_HEIGHT}, bytes_ahead(), &list);
    budget_list_free(&list);
    roil_unload(e);
}

static void shipped_effects_ask_for_what_they_take(void **state) {
    static const char *const names[] = {
        "deferred_lights", "containers",  "sparks",      "explosion",         "layered_explosion",
        "night",           "slices",      "plume",       "forest_fire",       "barrel_chain",
        "templates",       "comic_blast", "log_fire",    "step-10-explosion", "cigarette",
        "materials",       "figure",      "templates_3d"};
    const bool all = sim_long_tests("seventeen more shipped effects");
    for (size_t i = 0; i < (all ? COUNT_OF(names) : 1); i++) expect_shipped(*state, names[i]);
}

// Half of it could be had: the state without the pictures, or these without it.
static void nothing_is_taken_where_all_does_not_fit(void **state) {
    roil *r = *state;
    char limit[32];
    budget_list list = {0};
    roil_effect *e = open(r, air);
    list_all(e, (extent){WIDTH, HEIGHT}, &list);
    const uint64_t before = used(r), sum = budget_get(gpu_get_budget(r->device)).sum;
    snprintf(limit, sizeof limit, "%lluK", (unsigned long long)((sum + sum_of(&list) / 2) >> 10));
    assert_true(budget_set_share(limit));
    expect_error(roil_prepare(e, WIDTH, HEIGHT), "asks.lua: ");
    assert_non_null(strstr(roil_error(), "; the largest parts: "));
    assert_non_null(strstr(roil_error(), " lattice 13.0 MiB"));
    assert_int_equal(used(r), before);
    assert_true(budget_set_share(NULL));
    ok(roil_prepare(e, WIDTH, HEIGHT)); // nothing is left over that would be in the way
    budget_list_free(&list);
    roil_unload(e);
}

// What the device itself keeps is there before the first of the others is measured.
static void plain_effects_are_drawn(void **state) {
    roil_effect *e = load_text(*state, "plain.lua",
                               "local fx = effect { name = 'plain' }\n"
                               "fx.output = final { march { density = sphere {} } }.color\n"
                               "return fx\n");
    ok(roil_prepare(e, WIDTH, HEIGHT));
    for (int i = 1; i <= LAST; i++) ok(roil_render(e, i));
    roil_unload(e);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plain_effects_are_drawn),
        cmocka_unit_test(air_asks_for_its_state),
        cmocka_unit_test(slices_ask_for_their_state),
        cmocka_unit_test(particles_ask_for_theirs_and_for_what_draws_them),
        cmocka_unit_test(scenes_ask_for_what_is_drawn),
        cmocka_unit_test(bursts_and_point_lights_ask_for_their_lists),
        cmocka_unit_test(what_turns_asks_for_all_turns),
        cmocka_unit_test(shipped_effects_ask_for_what_they_take),
        cmocka_unit_test(nothing_is_taken_where_all_does_not_fit),
    };
    return test_run(tests);
}
