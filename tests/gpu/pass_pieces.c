// Particles as meshes: where a cube is seen, which is before which, and what of the scene.
#include "scene/material.h"
#include "splats_test.h"

enum { MIDDLE = SIDE / 2 };

typedef struct boxes {
    spots s; // its splats are not seen
    pass *pieces;
} boxes;

// Cubes of 0.8 m, red.
static void boxes_open(boxes *b, gpu *device, uint32_t count, float wall) {
    spots_open(&b->s, device, count);
    pass_world *w = &b->s.w;
    b->pieces = world_add(w, "pieces", NULL, "pieces");
    pass_add_source(b->pieces, b->s.particles);
    gpu_test_ok(pass_add_mesh(b->pieces, world_mesh(w, "crate.obj")));
    gpu_test_ok(pass_set_field(b->pieces, "size", number(w, 0.4f)));
    gpu_test_ok(pass_set_field(b->pieces, "color", triple(w, 0.5f, 0, 0)));
    if (wall > 0) {
        pass *p = world_add(w, NULL, "wall.comp", "wall");
        gpu_test_ok(pass_set_uniform(p, "distance_to", number(w, wall)) && pass_declare(p));
        gpu_test_ok(pass_set_image(b->pieces, "scene_depth", pass_output(p, "depth")));
    }
    gpu_test_ok(pass_declare(b->pieces) && pass_declare(b->s.splats));
}

static void boxes_build(boxes *b) {
    graph_add_output(b->s.w.host.graph, pass_output(b->pieces, "albedo"));
    graph_add_output(b->s.w.host.graph, pass_output(b->pieces, "normal"));
    world_render(&b->s.w, SIDE, SIDE, pass_output(b->pieces, "depth"));
    b->s.w.host.hold = true;
}

// Depths; the normals too where they are asked for. Free both with mem_free.
static float *boxes_draw(boxes *b, const spot *list, float **normals) {
    float *colors = spots_draw_other(&b->s, list, pass_output(b->pieces, "albedo"));
    float *depths = world_read_depth(&b->s.w, pass_output(b->pieces, "depth"));
    for (int i = 0; i < SIDE * SIDE; i++) {
        bool there = colors[4 * i + 3] > 0;
        assert_true((colors[4 * i] > 0.2f) == there && colors[4 * i + 1] == 0);
    }
    if (normals) *normals = world_read(&b->s.w, pass_output(b->pieces, "normal"));
    mem_free(colors);
    return depths;
}

static int count_below(const float *depths, float most) {
    int count = 0;
    for (int i = 0; i < SIDE * SIDE; i++) count += depths[i] < most;
    return count;
}

// Its front is 0.8 m wide, 4.6 m away: nothing of the other sides is seen.
static void a_cube_is_seen_where_it_stands(void **state) {
    boxes b;
    boxes_open(&b, *state, 1, 0);
    boxes_build(&b);
    spot one = {.age = 0};
    float *normals, *depths = boxes_draw(&b, &one, &normals);
    double side = 0.8 * METRE * 5 / 4.6;
    is_near(sqrt(count_below(depths, 100)), side, 1, "pixels of the side");
    is_near((double)depths[MIDDLE * SIDE + MIDDLE], 4.6, 1e-4, "depth");
    const float *normal = pixel_at(normals, MIDDLE, MIDDLE);
    is_near((double)normal[1], -1, 1e-3, "towards the viewer");
    assert_true(depths[0] == 1e9f && pixel_at(normals, 0, 0)[1] == 0);
    mem_free(normals);
    mem_free(depths);
    spots_close(&b.s);
}

static void the_nearest_is_seen(void **state) {
    boxes b;
    boxes_open(&b, *state, 3, 4.95f);
    boxes_build(&b);
    // One behind the wall, one before it, and a nearer one that is dead.
    static const spot list[3] = {{.at = {-0.6f, 1, 0}},
                                 {.at = {0.6f, 0, 0}},
                                 {.at = {0.6f, -1, 0}, .age = 3, .lifetime = 2}};
    float *depths = boxes_draw(&b, list, NULL);
    is_near((double)depths[MIDDLE * SIDE + 10], 4.95, 1e-4, "wall");
    is_near((double)depths[MIDDLE * SIDE + MIDDLE + 20], 4.6, 1e-4, "cube");
    mem_free(depths);
    // Order is nothing: two in one place.
    static const spot near_last[3] = {
        {.at = {0, 0.3f, 0}}, {.at = {0, 0.1f, 0}}, {.at = {0, -0.5f, 0}}};
    depths = boxes_draw(&b, near_last, NULL);
    is_near((double)depths[MIDDLE * SIDE + MIDDLE], 4.1, 1e-4, "nearest");
    mem_free(depths);
    spots_close(&b.s);
}

// Turned by an eighth about its own axis, that of its way to the right, an edge looks at the
// viewer.
static void a_piece_turns_about_its_way(void **state) {
    boxes b;
    boxes_open(&b, *state, 1, 0);
    gpu_test_ok(pass_set_option(b.pieces, "turn", "along"));
    gpu_test_ok(pass_set_field(b.pieces, "angle", number(&b.s.w, 45)));
    boxes_build(&b);
    spot one = {.moves = {3, 0, 0}};
    float *normals, *depths = boxes_draw(&b, &one, &normals);
    is_near((double)depths[MIDDLE * SIDE + MIDDLE], 5 - 0.4 * sqrt(2), 0.02, "edge");
    const float *above = pixel_at(normals, MIDDLE, MIDDLE - 6);
    const float *below = pixel_at(normals, MIDDLE, MIDDLE + 6);
    is_near((double)above[2], sqrt(0.5), 1e-3, "normal above");
    is_near((double)below[2], -sqrt(0.5), 1e-3, "normal below");
    is_near((double)above[0], 0, 1e-3, "normal along");
    mem_free(normals);
    mem_free(depths);
    spots_close(&b.s);
}

// Before the wall as their mesh is, elsewhere as what is behind.
static void materials_are_those_of_the_pieces_and_of_the_scene(void **state) {
    boxes b;
    boxes_open(&b, *state, 1, 8);
    pass_world *w = &b.s.w;
    const scene_material skin = {
        .specular = number(w, 0.25f), .roughness = number(w, 0.5f), .emission = triple(w, 2, 1, 0)};
    scene_mesh_set_material(&w->meshes[0], &skin, &w->memory);
    graph_add_output(w->host.graph, pass_output(b.pieces, "surface"));
    graph_add_output(w->host.graph, pass_output(b.pieces, "emission"));
    boxes_build(&b);
    spot one = {.age = 0};
    mem_free(boxes_draw(&b, &one, NULL));
    float *s = world_read(w, pass_output(b.pieces, "surface"));
    float *e = world_read(w, pass_output(b.pieces, "emission"));
    size_t middle = 4 * (MIDDLE * SIDE + MIDDLE);
    const float want[] = {0.25f, 0.5f, 0, 1, 2, 1, 0, 0};
    for (size_t i = 0; i < 4; i++)
        assert_true(s[middle + i] == want[i] && e[middle + i] == want[4 + i]);
    assert_true(s[0] == 0 && e[0] == 0);
    mem_free(s);
    mem_free(e);
    spots_close(&b.s);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cube_is_seen_where_it_stands),
        cmocka_unit_test(the_nearest_is_seen),
        cmocka_unit_test(a_piece_turns_about_its_way),
        cmocka_unit_test(materials_are_those_of_the_pieces_and_of_the_scene),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
