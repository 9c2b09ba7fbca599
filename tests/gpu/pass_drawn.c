// What is drawn of meshes and instances: culling changes no pixel, lists hold each instance that is
// seen once and in order, levels follow distance, and the number of draws does not grow with that
// of instances.
#include "pass/surfaces/drawn.h"
#include "pass/surfaces/drawn_parts.h"
#include "pass_test.h"

enum { WIDTH = 96, HEIGHT = 64, PIXELS = WIDTH * HEIGHT, KINDS = 2, TARGETS = 3 };

typedef struct stand {
    pass_world w;
    pass *p;
    scene_instances *instances;
    drawn *d;
    size_t kernel; // of the pass: draws without surface and emission, which nothing reads
    gpu_image *colors[TARGETS], *depth;
    gpu_buffer *views;
} stand;

static const gpu_format formats[TARGETS] = {GPU_RGBA16F, GPU_RGBA16F, GPU_R32F};

static gpu_image *make_target(gpu *g, gpu_format format) {
    gpu_image *image = gpu_image_create(g, &(gpu_image_desc){.label = "target",
                                                             .format = format,
                                                             .width = WIDTH,
                                                             .height = HEIGHT,
                                                             .use = GPU_USE_TARGET});
    gpu_test_ok(image);
    return image;
}

enum { RINGS = 16, SECTORS = 32 };

// A ball of radius 1 of two halves, with its levels.
static scene_mesh *make_ball(pass_world *w) {
    uint32_t row = SECTORS + 1, count = 0;
    mesh_vertex *vertices = arena_alloc(&w->memory, row * (RINGS + 1) * sizeof *vertices);
    mesh_part *parts = arena_alloc(&w->memory, 2 * sizeof *parts);
    uint32_t *indices = arena_alloc(&w->memory, RINGS * SECTORS * 6 * sizeof *indices);
    for (uint32_t r = 0; r <= RINGS; r++) {
        for (uint32_t s = 0; s <= SECTORS; s++) {
            float up = GLM_PIf * (float)r / RINGS,
                  around = 2 * GLM_PIf * (float)(s % SECTORS) / SECTORS;
            float n[3] = {sinf(up) * cosf(around), sinf(up) * sinf(around), cosf(up)};
            mesh_vertex *v = &vertices[r * row + s];
            for (int c = 0; c < 3; c++) v->position[c] = v->normal[c] = n[c];
            if (r == RINGS || s == SECTORS) continue;
            uint32_t at = r * row + s;
            const uint32_t corners[6] = {at, at + row, at + row + 1, at, at + row + 1, at + 1};
            memcpy(indices + count, corners, sizeof corners);
            count += 6;
        }
    }
    for (uint32_t i = 0; i < 2; i++)
        parts[i] = (mesh_part){.first = i * count / 2,
                               .count = count / 2,
                               .color = {i ? 1 : 0.5f, 0.5f, 0.25f, 1},
                               .texture = -1};
    scene_mesh *mesh = world_mesh(w, "plane.obj");
    mesh->data = (mesh_data){.vertices = vertices,
                             .vertex_count = row * (RINGS + 1),
                             .indices = indices,
                             .index_count = count,
                             .parts = parts,
                             .part_count = 2,
                             .box = {{-1, -1, -1}, {1, 1, 1}}};
    world_make_levels(w, mesh);
    return mesh;
}

// A number in 0..1 that is always the same.
static float chance(uint32_t i, uint32_t what) {
    uint32_t x = i * 747796405u + what * 2891336453u + 1;
    x = (x >> ((x >> 28) + 4) ^ x) * 277803737u;
    return (float)((x >> 22 ^ x) & 0xffffff) / 0x1000000;
}

// All around the camera at (0, -5, 0), turned and of several sizes; some are not shown.
static void scatter(struct instance_entry *all, uint32_t count, float reach) {
    for (uint32_t i = 0; i < count; i++) {
        struct instance_entry *e = &all[i];
        for (uint32_t c = 0; c < 3; c++) {
            e->place.v[c] = reach * (2 * chance(i, c) - 1);
            e->color.v[c] = 0.25f + 0.75f * chance(i, 4 + c);
        }
        e->place.v[3] = 0.1f + 0.5f * chance(i, 7);
        vec4 turn = {chance(i, 8) - 0.5f, chance(i, 9) - 0.5f, chance(i, 10) - 0.5f, 0.5f};
        glm_vec4_normalize(turn);
        memcpy(e->turn.v, turn, sizeof turn);
        e->kind.v[0] = i % 11 == 5 ? INSTANCE_HIDDEN : i * 7 / 3 % KINDS;
    }
}

// Of the pass's kernels, the first with that shader.
static size_t find_kernel(const pass *p, const char *shader) {
    size_t i = 0;
    while (!p->type->kernels[i].shader || strcmp(p->type->kernels[i].shader, shader) != 0) {
        i++;
        assert_true(i < p->type->kernel_count);
    }
    return i;
}

static void open_stand(stand *s, gpu *device, uint32_t count, float reach) {
    *s = (stand){0};
    pass_world *w = &s->w;
    world_open(w, device);
    scene_mesh *kinds[KINDS] = {world_mesh(w, "crate.obj"), make_ball(w)};
    scene_mesh *alone = world_mesh(w, "plane.obj");
    alone->position = triple(w, 0.5f, 3, -1);
    struct instance_entry *all = mem_alloc(count * sizeof *all);
    scatter(all, count, reach);
    s->instances = scene_instances_create(&(scene_instances_desc){
        .name = "instances",
        .kinds = kinds,
        .kind_count = KINDS,
        .entries = all,
        .count = count,
        .position = triple(w, 0.5f, -4, 0.25f),
        .rotation = triple(w, 10, 20, 30),
        .scale = number(w, 1.5f),
        .color = triple(w, 1, 0.75f, 0.5f),
    });
    mem_free(all);
    gpu_test_ok(s->instances);
    s->p = world_add(w, "geometry", NULL, "geometry");
    gpu_test_ok(pass_set_option(s->p, "mode", "raster"));
    gpu_test_ok(pass_add_mesh(s->p, alone) && pass_add_instances(s->p, s->instances));
    gpu_test_ok(pass_declare(s->p));
    gpu_test_ok(scene_instances_allocate(s->instances, device));
    world_render(w, WIDTH, HEIGHT, pass_output(s->p, "albedo"));
    s->d = drawn_create(s->p, find_kernel(s->p, "pass/surfaces/drawn/choose.comp"), false);
    s->kernel = find_kernel(s->p, "pass/surfaces/geometry.frag");
    gpu_test_ok(drawn_allocate(s->d));
    for (int i = 0; i < TARGETS; i++) s->colors[i] = make_target(device, formats[i]);
    s->depth = make_target(device, GPU_D32F);
}

static void close_stand(stand *s) {
    gpu *device = s->w.host.device;
    for (int i = 0; i < TARGETS; i++) gpu_image_destroy(device, s->colors[i]);
    gpu_image_destroy(device, s->depth);
    gpu_buffer_destroy(device, s->views);
    drawn_destroy(s->d);
    scene_instances_destroy(s->instances, device);
    world_close(&s->w);
}

// The camera's view; one that holds everything; one that is none.
enum { CAMERA, ALL, NOTHING, VIEWS };

static void make_views(stand *s) {
    struct view_entry views[VIEWS] = {0};
    mat4 view, projection, clip;
    memcpy(view, s->w.frame.view.m, sizeof view);
    memcpy(projection, s->w.frame.projection.m, sizeof projection);
    glm_mat4_mul(projection, view, clip);
    memcpy(views[CAMERA].clip.m, clip, sizeof clip);
    for (int i = 0; i < 3; i++) views[ALL].clip.m[5 * i] = 1e-3f; // a kilometre wide
    views[ALL].clip.m[14] = 0.5f;
    views[ALL].clip.m[15] = 1;
    for (int i = 0; i < VIEWS; i++) {
        memcpy(views[i].eye.v, (const float[4]){0, -5, 0, 1500}, sizeof views[i].eye.v);
    }
    s->views = gpu_buffer_create(s->w.host.device,
                                 &(gpu_buffer_desc){.label = "views", .size = sizeof views});
    gpu_test_ok(s->views && gpu_buffer_write(s->w.host.device, s->views, 0, views, sizeof views));
}

static void cull_within(stand *s, float lod, float most) {
    gpu *device = s->w.host.device;
    gpu_test_ok(gpu_frame_begin(device));
    gpu_test_ok(scene_instances_upload(s->instances, device));
    gpu_test_ok(drawn_cull(s->d, s->views, VIEWS, HEIGHT, lod, most));
    gpu_test_ok(gpu_frame_end(device));
}

static void cull(stand *s, float lod) {
    cull_within(s, lod, 0);
}

// Draws what was chosen for a view, seen by the camera whatever view that is.
static void draw(stand *s, size_t view, void *pixels[TARGETS]) {
    gpu *device = s->w.host.device;
    gpu_draw_desc target = {.depth = s->depth, .clear = true, .clear_depth = 1};
    memcpy(target.colors, s->colors, sizeof s->colors);
    gpu_test_ok(gpu_frame_begin(device));
    gpu_test_ok(drawn_record(s->d, s->kernel, &target, view, 1, NULL));
    gpu_test_ok(gpu_frame_end(device));
    for (int i = 0; i < TARGETS; i++) {
        size_t size = (size_t)PIXELS * gpu_format_size(formats[i]);
        pixels[i] = mem_alloc(size);
        gpu_test_ok(gpu_image_read(device, s->colors[i], pixels[i], size));
    }
}

static const drawn_body *instances_of(const stand *s) {
    for (size_t i = 0; i < s->d->body_count; i++)
        if (s->d->bodies[i].instances) return &s->d->bodies[i];
    fail_msg("no instances are drawn");
    return NULL;
}

typedef struct shown { // of the instances in a view: those of each kind and level, by its commands
    uint32_t counts[KINDS][DRAWN_LEVELS], *list[KINDS][DRAWN_LEVELS], total;
} shown;

static void *read_buffer(stand *s, gpu_buffer *buffer) {
    size_t size = gpu_buffer_size(buffer);
    void *data = mem_alloc(size);
    gpu_test_ok(gpu_buffer_read(s->w.host.device, buffer, 0, data, size));
    return data;
}

static shown read_shown(stand *s, size_t view, uint32_t **list) {
    const drawn_body *body = instances_of(s);
    gpu_draw_indexed_command *commands = read_buffer(s, body->buffers[DRAWN_COMMANDS]);
    shown out = {0};
    *list = read_buffer(s, body->buffers[DRAWN_LIST]);
    for (size_t k = 0; k < KINDS; k++) {
        const mesh_data *mesh = &body->kinds[k]->data;
        for (uint32_t level = 0; level < drawn_level_count(mesh); level++) {
            const gpu_draw_indexed_command *first =
                commands + view * body->command_count + body->commands[k] + level;
            for (uint32_t i = 0; i < mesh->part_count; i++) {
                const gpu_draw_indexed_command *command = first + i * drawn_level_count(mesh);
                mesh_run run = mesh_get_run(mesh, i, level);
                assert_true(command->indices == run.count && command->first_index == run.first);
                assert_true(command->instances == first->instances);
                assert_true(command->first_instance == first->first_instance);
            }
            out.counts[k][level] = first->instances;
            out.list[k][level] = *list + first->first_instance;
            out.total += first->instances;
        }
    }
    mem_free(commands);
    return out;
}

static void culling_changes_no_pixel(void **state) {
    stand s;
    open_stand(&s, *state, 3000, 12);
    make_views(&s);
    cull(&s, 0);
    void *seen[TARGETS], *all[TARGETS], *none[TARGETS];
    draw(&s, CAMERA, seen);
    draw(&s, ALL, all);
    draw(&s, NOTHING, none);
    size_t covered = 0;
    for (int i = 0; i < TARGETS; i++) {
        size_t size = (size_t)PIXELS * gpu_format_size(formats[i]);
        assert_memory_equal(seen[i], all[i], size);
        for (size_t k = 0; k < size / 2; k++) assert_true(((uint16_t *)none[i])[k] == 0);
    }
    for (size_t i = 0; i < PIXELS; i++) covered += ((float *)seen[2])[i] > 0;
    assert_true(covered > PIXELS / 2);
    uint32_t *lists[2];
    uint32_t few = read_shown(&s, CAMERA, &lists[0]).total;
    uint32_t most = read_shown(&s, ALL, &lists[1]).total;
    if (few < 50 || few > 600) fail_msg("%u of %u instances are in view", few, most);
    assert_int_equal(most, 3000 - 3000 / 11 - (3000 % 11 > 5));
    for (int i = 0; i < 2; i++) mem_free(lists[i]);
    for (int i = 0; i < TARGETS; i++) {
        mem_free(seen[i]);
        mem_free(all[i]);
        mem_free(none[i]);
    }
    close_stand(&s);
}

// In the order of their numbers, each once; as they are now, not as they were.
static void lists_hold_each_once_and_in_order(void **state) {
    stand s;
    open_stand(&s, *state, 1000, 12);
    make_views(&s);
    for (int time = 0; time < 2; time++) {
        cull(&s, 0);
        const struct instance_entry *entries = scene_instances_entries(s.instances);
        uint32_t *list;
        shown all = read_shown(&s, ALL, &list);
        for (uint32_t k = 0; k < KINDS; k++) {
            uint32_t at = 0;
            for (uint32_t i = 0; i < 1000; i++)
                if (entries[i].kind.v[0] == k) assert_int_equal(all.list[k][0][at++], i);
            assert_int_equal(all.counts[k][0], at);
        }
        mem_free(list);
        for (uint32_t i = 0; i < 1000; i += 3) { // for the second time
            struct instance_entry entry = entries[i];
            entry.kind.v[0] = i % 2 ? INSTANCE_HIDDEN : 1;
            scene_instances_set(s.instances, i, &entry);
        }
    }
    close_stand(&s);
}

// Ten thousand take as many draws as one does, in one call.
static void draws_do_not_grow_with_instances(void **state) {
    size_t draws[2];
    for (int many = 0; many < 2; many++) {
        stand s;
        open_stand(&s, *state, many ? 10000 : 1, 60);
        make_views(&s);
        cull(&s, 1);
        void *pixels[TARGETS];
        draw(&s, CAMERA, pixels);
        for (int i = 0; i < TARGETS; i++) mem_free(pixels[i]);
        draws[many] = s.d->draw_count;
        size_t wanted = 0;
        for (size_t m = 0; m < s.w.mesh_count; m++) wanted += s.w.meshes[m].data.part_count;
        assert_int_equal(draws[many], wanted);
        close_stand(&s);
    }
    assert_int_equal(draws[0], draws[1]);
}

// Of an instance in the world; returns the radius around it, in the mesh's own units.
static float find_middle(mat4 place, const struct instance_entry *e, const mesh_data *mesh,
                         mat4 matrix, vec3 out) {
    scene_instances_matrix(e, matrix);
    glm_mat4_mul(place, matrix, matrix);
    const float3 *low = &mesh->box.min, *high = &mesh->box.max;
    vec3 middle = {(low->x + high->x) / 2, (low->y + high->y) / 2, (low->z + high->z) / 2};
    glm_mat4_mulv3(matrix, middle, 1, out);
    return glm_vec3_distance(middle, (vec3){high->x, high->y, high->z});
}

// What is farther than it may be is left out, of instances alone, and nothing else.
static void far_instances_are_left_out(void **state) {
    stand s;
    open_stand(&s, *state, 3000, 12);
    make_views(&s);
    const float most[] = {0.5f, 6, 11, 1000};
    const uint32_t placed = 3000 - 3000 / 11 - (3000 % 11 > 5);
    const struct instance_entry *entries = scene_instances_entries(s.instances);
    uint32_t before = 0;
    for (size_t m = 0; m < COUNT_OF(most); m++) {
        cull_within(&s, 0, most[m]);
        const drawn_body *body = instances_of(&s);
        mat4 place, matrix;
        float tint[4];
        gpu_test_ok(scene_instances_place(s.instances, &s.w.context, place, tint));
        uint32_t *list, wanted[2] = {0}; // surely, and by rounding
        shown all = read_shown(&s, ALL, &list);
        for (uint32_t i = 0; i < 3000; i++) {
            if (entries[i].kind.v[0] == INSTANCE_HIDDEN) continue;
            vec3 middle;
            find_middle(place, &entries[i], &body->kinds[entries[i].kind.v[0]]->data, matrix,
                        middle);
            float far = glm_vec3_distance(middle, (vec3){0, -5, 0});
            wanted[0] += far < most[m] * 0.9999f;
            wanted[1] += far < most[m] * 1.0001f;
        }
        if (all.total < wanted[0] || all.total > wanted[1])
            fail_msg("%u are nearer than %g m, %u are drawn", wanted[0], (double)most[m],
                     all.total);
        assert_true(all.total > before || m == 0);
        before = all.total;
        mem_free(list);
        for (size_t i = 0; i < s.d->body_count; i++) { // the mesh beside them is always there
            const drawn_body *alone = &s.d->bodies[i];
            if (alone->instances) continue;
            gpu_draw_indexed_command *commands = read_buffer(&s, alone->buffers[DRAWN_COMMANDS]);
            assert_int_equal(commands[ALL * alone->command_count].instances, 1);
            mem_free(commands);
        }
    }
    assert_int_equal(before, placed);
    close_stand(&s);
}

// The level of each is the coarsest whose error is within a pixel where the instance is nearest.
static void levels_follow_distance(void **state) {
    stand s;
    open_stand(&s, *state, 4000, 25);
    make_views(&s);
    const float lod = 1.5f, pixels = 1500;
    cull(&s, lod);
    uint32_t *list, levels_used = 0;
    shown all = read_shown(&s, ALL, &list);
    const drawn_body *body = instances_of(&s);
    mat4 place;
    float tint[4];
    gpu_test_ok(scene_instances_place(s.instances, &s.w.context, place, tint));
    const mesh_data *ball = &body->kinds[1]->data;
    assert_true(ball->level_count > 0);
    for (uint32_t level = 0; level < drawn_level_count(ball); level++) {
        levels_used += all.counts[1][level] > 0;
        for (uint32_t i = 0; i < all.counts[1][level]; i++) {
            const struct instance_entry *e =
                &scene_instances_entries(s.instances)[all.list[1][level][i]];
            mat4 inner;
            vec3 centre;
            float radius = find_middle(place, e, ball, inner, centre);
            float scale = glm_vec3_norm(inner[0]);
            float near = glm_vec3_distance(centre, (vec3){0, -5, 0}) - radius * scale;
            uint32_t wanted = 0;
            for (uint32_t k = 0; k < ball->level_count; k++)
                if (ball->levels[k].error * scale * pixels <= lod * fmaxf(near, 0)) wanted = k + 1;
            if (wanted != level) { // unless rounding decides
                float edge = ball->levels[(wanted > level ? wanted : level) - 1].error * scale;
                assert_true(fabsf(edge * pixels - lod * near) < 1e-3f * lod * near);
            }
        }
    }
    assert_true(levels_used == drawn_level_count(ball));
    mem_free(list);
    close_stand(&s);
}

// Bit by bit the same as a mesh by itself, which stands where the instance does.
static void an_instance_looks_as_a_mesh_does(void **state) {
    float *pictures[2];
    for (int alone = 0; alone < 2; alone++) {
        pass_world w;
        world_open(&w, *state);
        scene_mesh *ball = make_ball(&w);
        scene_instances *one = NULL;
        pass *p = world_add(&w, "geometry", NULL, "geometry");
        gpu_test_ok(pass_set_option(p, "mode", "raster"));
        if (alone) {
            ball->position = triple(&w, 0.5f, 1, 0.25f);
            ball->scale = number(&w, 0.5f);
            ball->color = triple(&w, 0.5f, 0.25f, 1);
            gpu_test_ok(pass_add_mesh(p, ball));
        } else {
            const struct instance_entry entry = {.place = {{0.5f, 1, 0.25f, 0.5f}},
                                                 .turn = {{0, 0, 0, 1}},
                                                 .color = {{0.5f, 0.25f, 1, 1}}};
            one = scene_instances_create(&(scene_instances_desc){.name = "one",
                                                                 .kinds = &ball,
                                                                 .kind_count = 1,
                                                                 .entries = &entry,
                                                                 .count = 1,
                                                                 .position = triple(&w, 0, 0, 0),
                                                                 .rotation = triple(&w, 0, 0, 0),
                                                                 .scale = number(&w, 1),
                                                                 .color = triple(&w, 1, 1, 1)});
            gpu_test_ok(one && pass_add_instances(p, one));
            gpu_test_ok(scene_instances_allocate(one, w.host.device));
        }
        gpu_test_ok(pass_declare(p));
        graph_add_output(w.host.graph, pass_output(p, "normal"));
        world_render(&w, WIDTH, HEIGHT, pass_output(p, "albedo"));
        if (one) {
            gpu_test_ok(gpu_frame_begin(w.host.device));
            gpu_test_ok(scene_instances_upload(one, w.host.device));
            gpu_test_ok(gpu_frame_end(w.host.device));
        }
        world_frame(&w, WIDTH, HEIGHT, 2);
        float *albedo = world_read(&w, pass_output(p, "albedo"));
        float *normal = world_read(&w, pass_output(p, "normal"));
        pictures[alone] = mem_alloc(8 * PIXELS * sizeof(float));
        memcpy(pictures[alone], albedo, 4 * PIXELS * sizeof(float));
        memcpy(pictures[alone] + 4 * PIXELS, normal, 4 * PIXELS * sizeof(float));
        mem_free(albedo);
        mem_free(normal);
        if (one) scene_instances_destroy(one, w.host.device);
        world_close(&w);
    }
    size_t covered = 0;
    for (size_t i = 0; i < PIXELS; i++) covered += pictures[0][4 * i + 3] > 0;
    assert_true(covered > PIXELS / 50);
    assert_memory_equal(pictures[0], pictures[1], 8 * PIXELS * sizeof(float));
    for (int i = 0; i < 2; i++) mem_free(pictures[i]);
}

static void a_mesh_is_seen_when_it_comes_into_view(void **state) {
    pass_world w;
    world_open(&w, *state);
    scene_mesh *crate = world_mesh(&w, "crate.obj");
    pass *p = world_add(&w, "geometry", NULL, "geometry");
    gpu_test_ok(pass_set_option(p, "mode", "raster"));
    gpu_test_ok(pass_add_mesh(p, crate) && pass_declare(p));
    crate->position = triple(&w, 40, 0, 0);
    world_render(&w, WIDTH, HEIGHT, pass_output(p, "depth"));
    const float places[] = {0, -40, 0};
    for (uint32_t i = 0; i < COUNT_OF(places); i++) {
        crate->position = triple(&w, places[i], 0, 0);
        world_frame(&w, WIDTH, HEIGHT, 2 + i);
        float *depth = world_read_depth(&w, pass_output(p, "depth"));
        bool seen = depth[HEIGHT / 2 * WIDTH + WIDTH / 2] < 10;
        assert_true(seen == (places[i] == 0));
        mem_free(depth);
    }
    world_close(&w);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(culling_changes_no_pixel),
        cmocka_unit_test(lists_hold_each_once_and_in_order),
        cmocka_unit_test(draws_do_not_grow_with_instances),
        cmocka_unit_test(far_instances_are_left_out),
        cmocka_unit_test(levels_follow_distance),
        cmocka_unit_test(an_instance_looks_as_a_mesh_does),
        cmocka_unit_test(a_mesh_is_seen_when_it_comes_into_view),
    };
    return gpu_test_run(tests, COUNT_OF(tests));
}
