// Lines of `outline`: where the depth jumps, and where the normal turns; against the edges of a
// cube, projected.
#include "pass_test.h"

enum { SIZE = 192, PIXELS = SIZE * SIZE };

static const float THICKNESS = 22.5f; // 4 pixels of a picture of 192 rows

typedef struct point {
    double x, y;
} point;

// Where a corner of the cube is seen, pixels.
static point project(const pass_world *w, const double corner[3]) {
    const float *v = w->frame.view.m;
    double at[3];
    for (int i = 0; i < 3; i++)
        at[i] = (double)v[i] * corner[0] + (double)v[4 + i] * corner[1] +
                (double)v[8 + i] * corner[2] + (double)v[12 + i];
    return (point){(0.5 + 0.5 * at[0] / -at[2] / (double)w->frame.lens.v[0]) * SIZE,
                   (0.5 - 0.5 * at[1] / -at[2] / (double)w->frame.lens.v[1]) * SIZE};
}

static double distance(point p, point a, point b) {
    double x = b.x - a.x, y = b.y - a.y;
    double t = ((p.x - a.x) * x + (p.y - a.y) * y) / (x * x + y * y);
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    return hypot(p.x - a.x - t * x, p.y - a.y - t * y);
}

typedef struct edges { // of a cube that three faces of are seen
    point silhouette[6][2], creases[3][2];
} edges;

// Edges of a cube of half-size 1 between faces: an edge is of the silhouette when one of its faces
// looks at the eye and the other does not, and a crease when both do.
static edges find_edges(const pass_world *w) {
    edges out;
    size_t around = 0, inside = 0;
    for (int axis = 0; axis < 3; axis++)
        for (int k = 0; k < 4; k++) {
            int u = (axis + 1) % 3, v = (axis + 2) % 3, facing = 0;
            double a[3], b[3], side[2] = {k & 1 ? 1 : -1, k & 2 ? 1 : -1};
            a[u] = b[u] = side[0];
            a[v] = b[v] = side[1];
            a[axis] = -1;
            b[axis] = 1;
            facing += (double)w->frame.eye.v[u] * side[0] > 1;
            facing += (double)w->frame.eye.v[v] * side[1] > 1;
            if (facing == 0) continue;
            assert_true(facing == 1 ? around < 6 : inside < 3);
            point *edge = facing == 1 ? out.silhouette[around++] : out.creases[inside++];
            edge[0] = project(w, a);
            edge[1] = project(w, b);
        }
    assert_true(around == 6 && inside == 3);
    return out;
}

static double nearest(point p, const point (*list)[2], size_t count) {
    double least = 1e9;
    for (size_t i = 0; i < count; i++) least = fmin(least, distance(p, list[i][0], list[i][1]));
    return least;
}

// Opacity of the lines round a cube that stands on a corner's view; its edges.
static float *draw(pass_world *w, gpu *device, const char *mode, float creases, edges *found) {
    world_open(w, device);
    w->scene.camera.eye = triple(w, 3.6f, -5.2f, 3.1f);
    scene_mesh *cube = world_mesh(w, "crate.obj");
    pass *solid = world_add(w, "geometry", NULL, "geometry");
    gpu_test_ok(pass_add_mesh(solid, cube) && pass_declare(solid));
    pass *lines = world_add(w, "outline", NULL, "outline");
    pass_add_source(lines, solid);
    gpu_test_ok(pass_set_option(lines, "mode", mode));
    gpu_test_ok(pass_set_uniform(lines, "thickness", number(w, THICKNESS)));
    gpu_test_ok(pass_set_uniform(lines, "normal_threshold", number(w, creases)));
    gpu_test_ok(pass_set_uniform(lines, "color", triple(w, 0.5f, 0.25f, 1)));
    gpu_test_ok(pass_set_uniform(lines, "opacity", number(w, 0.8f)));
    gpu_test_ok(pass_declare(lines));
    world_render(w, SIZE, SIZE, pass_output(lines, "image"));
    *found = find_edges(w);
    return world_read(w, pass_output(lines, "image"));
}

// Full within a pixel of an edge, nothing beyond two pixels and a bit more than roundings need.
static void lies_along(const float *image, const edges *e, bool creases) {
    int full = 0;
    for (int i = 0; i < PIXELS; i++) {
        point p = {i % SIZE + 0.5, i / SIZE + 0.5};
        double away = nearest(p, e->silhouette, 6), inner = nearest(p, e->creases, 3);
        if (creases) away = fmin(away, inner);
        float alpha = image[4 * i + 3];
        if (away < 0.5 && !(alpha > 0.7f))
            fail_msg("%d, %d: %g from an edge, opacity %g", i % SIZE, i / SIZE, away,
                     (double)alpha);
        if (away > 3.2 && alpha != 0)
            fail_msg("%d, %d: %g from any edge, opacity %g", i % SIZE, i / SIZE, away,
                     (double)alpha);
        full += alpha > 0.79f;
        for (int k = 0; k < 3; k++) {
            const float color[] = {0.5f, 0.25f, 1};
            assert_true(fabsf(image[4 * i + k] - alpha * color[k]) <= 1e-3f);
        }
    }
    assert_true(full > SIZE);
}

static void a_cube_has_its_silhouette_only(void **state) {
    const char *const modes[] = {"planes", "published"};
    for (size_t i = 0; i < COUNT_OF(modes); i++) {
        pass_world w;
        edges e;
        float *image = draw(&w, *state, modes[i], 0, &e);
        lies_along(image, &e, false);
        mem_free(image);
        world_close(&w);
    }
}

static void its_creases_are_drawn_by_the_normal(void **state) {
    pass_world w;
    edges e;
    float *image = draw(&w, *state, "planes", 60, &e);
    lies_along(image, &e, true);
    mem_free(image);
    world_close(&w);
}

// However many pixels the lines have, they lie where those of the picture do.
static void coarse_lines_lie_along_too(void **state) {
    pass_world w;
    world_open(&w, *state);
    scene_mesh *cube = world_mesh(&w, "crate.obj");
    pass *solid = world_add(&w, "geometry", NULL, "geometry");
    gpu_test_ok(pass_add_mesh(solid, cube) && pass_declare(solid));
    pass *lines[2];
    for (int i = 0; i < 2; i++) {
        lines[i] = world_add(&w, "outline", NULL, i ? "coarse" : "fine");
        pass_add_source(lines[i], solid);
        gpu_test_ok(pass_set_uniform(lines[i], "thickness", number(&w, THICKNESS)));
        if (i) gpu_test_ok(pass_set_scale(lines[i], 0.5f));
        gpu_test_ok(pass_declare(lines[i]));
        graph_add_output(w.host.graph, pass_output(lines[i], "image"));
    }
    world_render(&w, SIZE, SIZE, pass_output(lines[0], "image"));
    float *fine = world_read(&w, pass_output(lines[0], "image"));
    float *coarse = world_read(&w, pass_output(lines[1], "image"));
    for (int i = 0; i < PIXELS / 4; i++) {
        int x = i % (SIZE / 2), y = i / (SIZE / 2);
        assert_true(coarse[4 * i + 3] == fine[4 * ((2 * y + 1) * SIZE + 2 * x + 1) + 3]);
    }
    mem_free(fine);
    mem_free(coarse);
    world_close(&w);
}

static void count_lines(gpu *device, float reach, int *on_cube, int *beside) {
    pass_world w;
    world_open(&w, device);
    scene_mesh *cube = world_mesh(&w, "crate.obj");
    pass *solid = world_add(&w, "geometry", NULL, "geometry");
    gpu_test_ok(pass_add_mesh(solid, cube) && pass_declare(solid));
    pass *lines = world_add(&w, "outline", NULL, "outline");
    pass_add_source(lines, solid);
    gpu_test_ok(pass_set_option(lines, "side", "outside"));
    gpu_test_ok(pass_set_uniform(lines, "thickness", number(&w, THICKNESS)));
    gpu_test_ok(pass_set_uniform(lines, "reach", number(&w, reach)));
    gpu_test_ok(pass_declare(lines));
    graph_add_output(w.host.graph, pass_output(solid, "depth"));
    world_render(&w, SIZE, SIZE, pass_output(lines, "image"));
    float *image = world_read(&w, pass_output(lines, "image"));
    float *depth = world_read_depth(&w, pass_output(solid, "depth"));
    *on_cube = *beside = 0;
    for (int i = 0; i < PIXELS; i++)
        if (image[4 * i + 3] > 0) *(depth[i] < 1e8f ? on_cube : beside) += 1;
    mem_free(image);
    mem_free(depth);
    world_close(&w);
}

static void outside_lines_lie_on_what_is_behind(void **state) {
    int on_cube, beside, far;
    count_lines(*state, 0, &on_cube, &beside);
    assert_int_equal(on_cube, 0);
    assert_true(beside > 4 * SIZE);
    count_lines(*state, 6, &on_cube, &far); // the cube begins at 4 m: a third is left
    assert_true(far > 0 && far < beside * 2 / 3);
    count_lines(*state, 4, &on_cube, &far);
    assert_int_equal(far, 0);
}

// Whose depth differs from pixel to pixel by more than a part of it, but which is flat.
static void ground_that_is_seen_flat_has_no_lines(void **state) {
    const char *const modes[] = {"planes", "published"};
    int drawn[2] = {0};
    for (int m = 0; m < 2; m++) {
        pass_world w;
        world_open(&w, *state);
        w.scene.camera.eye = triple(&w, 0, -5, 0.4f);
        scene_mesh *ground = world_mesh(&w, "plane.obj");
        ground->scale = number(&w, 400);
        ground->rotation = triple(&w, 90, 0, 0);
        pass *solid = world_add(&w, "geometry", NULL, "geometry");
        gpu_test_ok(pass_add_mesh(solid, ground) && pass_declare(solid));
        pass *lines = world_add(&w, "outline", NULL, "outline");
        pass_add_source(lines, solid);
        gpu_test_ok(pass_set_option(lines, "mode", modes[m]) && pass_declare(lines));
        graph_add_output(w.host.graph, pass_output(solid, "depth"));
        world_render(&w, SIZE, SIZE, pass_output(lines, "image"));
        float *image = world_read(&w, pass_output(lines, "image"));
        float *depth = world_read_depth(&w, pass_output(solid, "depth"));
        for (int i = 0; i < PIXELS; i++) { // away from the horizon, which is a line of its own
            int above = i - 4 * SIZE;
            if (above >= 0 && depth[above] < 300) drawn[m] += image[4 * i + 3] > 0;
        }
        mem_free(image);
        mem_free(depth);
        world_close(&w);
    }
    assert_int_equal(drawn[0], 0);
    assert_true(drawn[1] > 0); // what the published comparison does there
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cube_has_its_silhouette_only),
        cmocka_unit_test(its_creases_are_drawn_by_the_normal),
        cmocka_unit_test(outside_lines_lie_on_what_is_behind),
        cmocka_unit_test(coarse_lines_lie_along_too),
        cmocka_unit_test(ground_that_is_seen_flat_has_no_lines),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
