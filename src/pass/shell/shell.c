// Shells: what of each is the same everywhere is found first (gather), then the surfaces, by a ray
// for each pixel, or by vertices that are pushed out and drawn (shell_mesh.c).
#include "pass/shell/shell.h"
#include "base/error.h"
#include "base/memory.h"
#include "field/range.h"
#include "pass/shell/shell_parts.h"
#include <string.h>

static const char *const names[] = {SHELL_NAMES(KERNEL_NAME_TEXT)};
static const pass_kernel kernels[SHELL_STAGES] = {
    [SHELL_GATHER] = {.define = "STAGE_GATHER"},
    [SHELL_RAYS] = {.define = "STAGE_RAYS"},
    [SHELL_VERTICES] = {.define = "STAGE_VERTICES"},
    [SHELL_DRAW] = {.shader = "pass/shell/shell.frag", .vertex = "pass/shell/shell.vert"},
    [SHELL_FRONT] = {.define = "STAGE_FRONT"},
};

shell_state *shell_state_of(pass *p) {
    if (!p->state) p->state = arena_alloc(p->host->memory, sizeof(shell_state));
    return p->state;
}

void pass_shell_open(pass *p, const scene_explosions *list) {
    shell_state_of(p)->list = list;
}

// ---- declaring and building -------------------------------------------------------------------

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

kernel *shell_use(pass *p, shell_stage stage) {
    const shell_state *s = shell_state_of(p);
    kernel *k = pass_use(p, stage);
    if (!k) return NULL;
    kernel_bind_buffer(k, N_ShellRecords, s->records);
    kernel_bind_buffer(k, N_ShellVertices, s->vertices);
    if (stage == SHELL_FRONT)
        kernel_bind_image(k, N_drawn_front, graph_get_image(p->host->graph, s->drawn_front));
    return k;
}

bool shell_run(pass *p, shell_stage stage, uint32_t x, uint32_t y) {
    kernel *k = shell_use(p, stage);
    return k && kernel_run(k, p->host->device, x, y, 1);
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
    .kernels = kernels,
    .kernel_count = SHELL_STAGES,
    .names = {names, COUNT_OF(names)},
    .declare = shell_declare,
    .defines = shell_defines,
    .target = shell_target,
    .update = shell_update,
    .record = shell_record,
    .buffers = shell_buffers,
};
