// Shells: what of each is the same everywhere is found first (gather), then the surfaces, by a ray
// for each pixel, or by vertices that are pushed out and drawn. Drawn ones are laid over each other
// from the farthest centre to the nearest, of each the far side first, so that what shines through
// one is behind it.
#include "pass/shell/shell.h"
#include "base/error.h"
#include "base/memory.h"
#include "field/range.h"
#include "pass/pass_impl.h"
#include <string.h>

enum { SHELL_RECORD = 48, SHELL_VERTEX = 16 }; // bytes, as shell/surface.glsl has them
static const float SHELL_LEAST = -0.95f;       // of the displacement: the sphere stays one
enum { FACES = 6, CORNERS_OF_SQUARE = 6 };     // a square is two triangles

typedef enum shell_stage {
    SHELL_GATHER,
    SHELL_RAYS,
    SHELL_VERTICES, // of what is drawn, as those that follow
    SHELL_DRAW,
    SHELL_FRONT,
    SHELL_STAGES
} shell_stage;

#define SHELL_NAMES(NAME)                                                                          \
    NAME(mode), NAME(corners), NAME(sides), NAME(displacement), NAME(life), NAME(reach),           \
        NAME(image), NAME(front), NAME(drawn_front), NAME(shells), NAME(shell_count),              \
        NAME(bounds), NAME(picture), NAME(shell_at), NAME(far_side), NAME(ShellRecords),           \
        NAME(ShellVertices)
KERNEL_NAMES(SHELL_NAMES);

typedef struct shell_state {
    const scene_explosions *list;     // NULL: one from time 0 on
    bool drawn;                       // as meshes,
    bool both_sides;                  // of them
    uint32_t corners;                 // along a side of the cube that a mesh is made of
    uint32_t count;                   // of the frame being recorded,
    float places[PASS_SHELL_MOST][3]; // and where they are
    gpu_buffer *records, *vertices;
    graph_image z, drawn_front; // of what is drawn
} shell_state;

static const pass_kernel kernels[SHELL_STAGES] = {
    [SHELL_GATHER] = {.define = "STAGE_GATHER"},
    [SHELL_RAYS] = {.define = "STAGE_RAYS"},
    [SHELL_VERTICES] = {.define = "STAGE_VERTICES"},
    [SHELL_DRAW] = {.shader = "pass/shell/shell.frag", .vertex = "pass/shell/shell.vert"},
    [SHELL_FRONT] = {.define = "STAGE_FRONT"},
};

static shell_state *shell_state_of(pass *p) {
    if (!p->state) p->state = arena_alloc(p->host->memory, sizeof(shell_state));
    return p->state;
}

void pass_shell_open(pass *p, const scene_explosions *list) {
    shell_state_of(p)->list = list;
}

// ---- declaring and building -------------------------------------------------------------------

static uint32_t vertex_count(const shell_state *s) { // that are pushed out
    return FACES * s->corners * s->corners;
}

static uint32_t drawn_count(const shell_state *s) {
    return FACES * CORNERS_OF_SQUARE * (s->corners - 1) * (s->corners - 1);
}

static bool shell_declare_mesh(pass *p) {
    shell_state *s = shell_state_of(p);
    graph_image *image = pass_image(p, N_image);
    *image = pass_add_target(p, "image", p->formats[p->names[N_image].image]);
    s->z = pass_add_target(p, "z", GPU_D32F);
    s->drawn_front = pass_add_target(p, "drawn_front", GPU_R32F);
    const graph_image own[] = {s->z, s->drawn_front};
    return image->id && s->z.id && s->drawn_front.id && pass_declare_images(p) &&
           pass_add_to_graph_with(p, own, COUNT_OF(own));
}

static bool shell_declare(pass *p) {
    shell_state *s = shell_state_of(p);
    s->drawn = pass_option_is(p, N_mode, "mesh");
    s->both_sides = pass_option_is(p, N_sides, "both");
    s->corners = pass_option_number(p, N_corners);
    return s->drawn ? shell_declare_mesh(p) : pass_declare_images(p) && pass_add_to_graph(p);
}

static bool shell_defines(pass *p, size_t index, pass_defines *out) {
    pass_define_number(p, out, "SHELL_CORNERS", shell_state_of(p)->corners);
    return index == SHELL_GATHER || (index >= SHELL_VERTICES) == shell_state_of(p)->drawn;
}

static void shell_target(const pass *p, size_t index, gpu_graphics_desc *out) {
    (void)index;
    *out = (gpu_graphics_desc){
        .colors = {p->formats[p->names[N_image].image], p->formats[p->names[N_front].image]},
        .depth = GPU_D32F,
        .blend = true,
    };
}

static uint64_t shell_vertices_bytes(const shell_state *s) {
    const uint64_t most = s->list ? PASS_SHELL_MOST : 1;
    return s->drawn ? most * vertex_count(s) * SHELL_VERTEX : 0;
}

// For as many shells as there may ever be, so that frames take none.
static size_t shell_buffers(const pass *p, pass_buffer out[PASS_BUFFERS]) {
    shell_state *s = p->state;
    out[0] = (pass_buffer){&s->records, "records of shells", PASS_SHELL_MOST * SHELL_RECORD};
    out[1] = (pass_buffer){&s->vertices, "vertices of shells", shell_vertices_bytes(s)};
    return 2;
}

// ---- a frame ----------------------------------------------------------------------------------

static size_t list_alive(pass *p, const scene_explosion *out[PASS_SHELL_MOST], double *life) {
    static const scene_explosion only = {.size = 1, .life = 1};
    const scene_explosions *list = shell_state_of(p)->list;
    double time = p->host->context->time;
    *life = (double)pass_value(p, N_life);
    if (list) return scene_explosions_alive(list, time, *life, out, PASS_SHELL_MOST);
    out[0] = &only;
    return time >= 0 && time < *life;
}

// As shell/gather.glsl has them.
static void set_shells(pass *p) {
    const scene_explosion *alive[PASS_SHELL_MOST];
    float shells[PASS_SHELL_MOST][3][4];
    double life;
    uint32_t count = (uint32_t)list_alive(p, alive, &life);
    for (uint32_t i = 0; i < count; i++) {
        const scene_explosion *one = alive[i];
        double age = (p->host->context->time - one->time) / (life * (double)one->life);
        const float place[4] = {one->place.x, one->place.y, one->place.z, one->size};
        const float own[4] = {(float)age};
        memcpy(shell_state_of(p)->places[i], place, sizeof(float[3]));
        memcpy(shells[i][0], place, sizeof place);
        memcpy(shells[i][1], own, sizeof own);
        scene_explosion_chance(one, shells[i][2]);
    }
    shell_state_of(p)->count = count;
    pass_set_int(p, N_shell_count, (int32_t)count);
    pass_set(p, N_shells, shells, count * sizeof *shells);
}

// Between what nothing of the displacement leaves, at any place and age, and `reach`.
static bool find_bounds(pass *p, float out[2]) {
    const field *displacement = pass_given_field(p, N_displacement);
    intervals all = {{{0, 0}}};
    const box3 sphere = {{-1, -1, -1}, {1, 1, 1}};
    if (displacement && !field_ranges(displacement, p->host->context, sphere, &all)) return false;
    const float reach = pass_value(p, N_reach);
    out[0] = clampf(all.c[0].low, SHELL_LEAST, reach);
    out[1] = clampf(all.c[0].high, SHELL_LEAST, reach);
    return true;
}

static bool shell_update(pass *p) {
    uint32_t size[3];
    float bounds[2];
    graph_get_size(p->host->graph, *pass_image(p, N_image), size);
    const float picture[2] = {(float)size[0], (float)size[1]};
    if (!find_bounds(p, bounds)) return err_prefix("field 'displacement': ");
    pass_set(p, N_bounds, bounds, sizeof bounds);
    pass_set(p, N_picture, picture, sizeof picture);
    set_shells(p);
    return true;
}

static kernel *shell_use(pass *p, shell_stage stage) {
    const shell_state *s = shell_state_of(p);
    kernel *k = pass_use(p, stage);
    if (!k) return NULL;
    kernel_bind_buffer(k, N_ShellRecords, s->records);
    kernel_bind_buffer(k, N_ShellVertices, s->vertices);
    if (stage == SHELL_FRONT)
        kernel_bind_image(k, N_drawn_front, graph_get_image(p->host->graph, s->drawn_front));
    return k;
}

static bool shell_run(pass *p, shell_stage stage, uint32_t x, uint32_t y) {
    kernel *k = shell_use(p, stage);
    return k && kernel_run(k, p->host->device, x, y, 1);
}

static float distance_of(const pass *p, const float place[3]) {
    return glm_vec3_distance2((float *)(uintptr_t)place, (float *)(uintptr_t)p->host->frame->eye.v);
}

// Numbers of the shells, the farthest first.
static void sort(pass *p, uint32_t out[PASS_SHELL_MOST]) {
    const shell_state *s = shell_state_of(p);
    for (uint32_t i = 0; i < s->count; i++) {
        uint32_t at = i;
        float distance = distance_of(p, s->places[i]);
        for (; at > 0 && distance_of(p, s->places[out[at - 1]]) < distance; at--)
            out[at] = out[at - 1];
        out[at] = i;
    }
}

static bool draw_side(pass *p, kernel *k, gpu_draw_desc *target, uint32_t shell, int32_t far_side) {
    gpu_binding kept[GPU_MAX_SLOTS];
    kernel_set_int(k, N_shell_at, (int32_t)shell);
    kernel_set_int(k, N_far_side, far_side);
    gpu_draw draw = kernel_draw(k, kept);
    draw.vertices = drawn_count(shell_state_of(p));
    target->draws = &draw;
    target->draw_count = 1;
    return gpu_draw_all(p->host->device, target);
}

static bool draw_shells(pass *p, gpu_draw_desc *target) {
    const shell_state *s = shell_state_of(p);
    uint32_t order[PASS_SHELL_MOST];
    const int32_t first = s->both_sides ? 1 : 0;
    kernel *k = shell_use(p, SHELL_DRAW);
    if (!k) return false;
    sort(p, order);
    for (uint32_t i = 0; i < s->count; i++)
        for (int32_t side = first; side >= 0; side--)
            if (!draw_side(p, k, target, order[i], side)) return false;
    return true;
}

static bool shell_record_mesh(pass *p) {
    const shell_state *s = shell_state_of(p);
    graph *g = p->host->graph;
    uint32_t size[3];
    kernel *k = shell_use(p, SHELL_DRAW);
    if (!k) return false;
    gpu_draw_desc target = {
        .pipeline = k->pipeline,
        .colors = {pass_get_image(p, N_image), graph_get_image(g, s->drawn_front)},
        .depth = graph_get_image(g, s->z),
        .clear = true,
        .clear_color = {{0}, {1e9f}},
        .clear_depth = 1,
    };
    if (!gpu_draw_all(p->host->device, &target)) return false;
    target.clear = false;
    if (s->count > 0 &&
        !(shell_run(p, SHELL_VERTICES, vertex_count(s), s->count) && draw_shells(p, &target)))
        return false;
    graph_get_size(g, *pass_image(p, N_image), size);
    return !pass_get_image(p, N_front) || shell_run(p, SHELL_FRONT, size[0], size[1]);
}

static bool shell_record(pass *p) {
    const shell_state *s = shell_state_of(p);
    uint32_t size[3];
    if (!pass_prepare(p)) return false; // counts them, too
    if (s->count > 0 && !shell_run(p, SHELL_GATHER, PASS_SHELL_MOST, 1)) return false;
    if (s->drawn) return shell_record_mesh(p);
    graph_get_size(p->host->graph, *pass_image(p, N_image), size);
    return shell_run(p, SHELL_RAYS, size[0], size[1]);
}

const pass_type shell_type = {
    .name = "shell",
    .constructed = true,
    .shader = "pass/shell/shell.comp",
    PASS_KERNELS,
    .declare = shell_declare,
    .defines = shell_defines,
    .target = shell_target,
    .update = shell_update,
    .record = shell_record,
    .buffers = shell_buffers,
};
