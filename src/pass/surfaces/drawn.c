// What is drawn: the meshes of a pass, bound part by part and recorded as one call of the device.
#include "pass/surfaces/drawn.h"
#include "base/error.h"
#include "base/memory.h"
#include "pass/surfaces/drawn_parts.h"
#include <string.h>

static const char *const names[] = {DRAWN_NAMES(KERNEL_NAME_TEXT)};
static const char *const files[] = {
    "pass/surfaces/drawn/choose.comp", "pass/surfaces/drawn/count.comp",
    "pass/surfaces/drawn/list.comp", "pass/surfaces/geometry.vert", "pass/surfaces/geometry.frag"};
const kernel_table drawn_kernel_table = {{names, COUNT_OF(names)}, files, COUNT_OF(files)};

// ---- what there is ----------------------------------------------------------------------------

uint32_t drawn_level_count(const mesh_data *mesh) {
    return 1 + mesh->level_count;
}

static void add_body(drawn *d, scene_instances *instances, scene_mesh *const *kinds,
                     size_t kind_count) {
    arena *memory = d->p->host->memory;
    drawn_body *body = &d->bodies[d->body_count++];
    body->instances = instances;
    body->kinds = kinds;
    body->kind_count = kind_count;
    body->count = instances ? scene_instances_count(instances) : (uint32_t)kind_count;
    body->places = arena_alloc(memory, kind_count * sizeof *body->places);
    body->commands = arena_alloc(memory, kind_count * sizeof *body->commands);
    for (size_t k = 0; k < kind_count; k++) {
        const mesh_data *mesh = &kinds[k]->data;
        body->commands[k] = body->command_count;
        body->command_count += mesh->part_count * drawn_level_count(mesh);
    }
}

drawn *drawn_create(pass *p, size_t first, bool alike) {
    drawn *d = arena_alloc(p->host->memory, sizeof *d);
    d->p = p;
    d->first = first;
    d->alike = alike;
    d->bodies = arena_alloc(p->host->memory, (1 + p->instances_count) * sizeof *d->bodies);
    if (p->mesh_count > 0) add_body(d, NULL, p->meshes, p->mesh_count);
    for (size_t i = 0; i < p->instances_count; i++) {
        scene_mesh *const *kinds;
        size_t count = scene_instances_kinds(p->instances[i], &kinds);
        if (scene_instances_count(p->instances[i]) > 0) add_body(d, p->instances[i], kinds, count);
    }
    return d;
}

gpu_buffer *drawn_buffer(gpu *device, const char *label, const void *data, size_t size) {
    gpu_buffer *buffer =
        gpu_buffer_create(device, &(gpu_buffer_desc){.label = label, .size = size});
    if (buffer && gpu_buffer_write(device, buffer, 0, data, size)) return buffer;
    gpu_buffer_destroy(device, buffer);
    return NULL;
}

// Of meshes by themselves: each is an instance of its own kind, where that stands.
static gpu_buffer *make_entries(gpu *device, uint32_t count) {
    struct instance_entry *all = mem_alloc(count * sizeof *all);
    for (uint32_t i = 0; i < count; i++)
        all[i] = (struct instance_entry){.place = {{0, 0, 0, 1}},
                                         .turn = {{0, 0, 0, 1}},
                                         .color = {{1, 1, 1, 1}},
                                         .kind = {{i, i, 0, 0}}};
    gpu_buffer *buffer = drawn_buffer(device, "meshes as instances", all, count * sizeof *all);
    mem_free(all);
    return buffer;
}

gpu_buffer *drawn_entries(const drawn_body *body) {
    return body->instances ? scene_instances_buffer(body->instances) : body->entries;
}

bool drawn_allocate(drawn *d) {
    gpu *device = d->p->host->device;
    static const struct view_entry blank = {{{0}}, {{0}}};
    if (!d->camera) d->camera = drawn_buffer(device, "view of the camera", &blank, sizeof blank);
    bool done = d->camera != NULL;
    for (size_t i = 0; i < d->body_count && done; i++) {
        drawn_body *body = &d->bodies[i];
        if (body->instances)
            done = scene_instances_allocate(body->instances, device);
        else if (!body->entries)
            done = (body->entries = make_entries(device, body->count)) != NULL;
        for (size_t k = 0; k < body->kind_count && done; k++)
            done = scene_mesh_upload(body->kinds[k], device);
    }
    return done || err_prefix("%s: ", d->p->label);
}

void drawn_list_memory(const drawn *d, size_t views, budget_list *out) {
    for (size_t i = 0; i < d->body_count; i++) {
        const drawn_body *body = &d->bodies[i];
        if (body->instances && budget_list_first(out, body->instances))
            scene_instances_list_memory(body->instances, out);
        if (!body->instances && !body->entries)
            budget_list_add(out, "meshes as instances",
                            body->count * sizeof(struct instance_entry));
        for (size_t k = 0; k < body->kind_count; k++)
            if (budget_list_first(out, body->kinds[k])) scene_mesh_list_memory(body->kinds[k], out);
        if (views > d->capacity) drawn_list_lists(body, views, out);
    }
}

void drawn_destroy(drawn *d) {
    if (!d) return;
    gpu *device = d->p->host->device;
    gpu_buffer_destroy(device, d->camera);
    for (size_t i = 0; i < d->body_count; i++) {
        gpu_buffer_destroy(device, d->bodies[i].entries);
        for (int k = 0; k < DRAWN_BUFFERS; k++) gpu_buffer_destroy(device, d->bodies[i].buffers[k]);
    }
    mem_free(d->draws);
    mem_free(d->bindings);
    mem_free(d->parts);
}

// ---- recording --------------------------------------------------------------------------------

static void fill_part(const drawn_place *place, const mesh_part *part, size_t view,
                      struct drawn_part *out) {
    *out = (struct drawn_part){.flags = {{part->texture >= 0, (uint32_t)view, 0, 0}}};
    memcpy(out->place.m, place->matrix, sizeof out->place.m);
    for (int c = 0; c < 3; c++) out->color.v[c] = part->color[c] * place->look.tint[c];
    scene_look_part(&place->look, part, out->surface.v, out->emission.v);
    out->color.v[3] = part->color[3];
}

// The list of what stands in a view is bound part by part.
static void bind_part(const drawn *d, kernel *k, const kernel_place *places, const drawn_body *body,
                      const scene_mesh *mesh, const mesh_part *part,
                      const struct drawn_part *block) {
    const gpu_binding bindings[] = {
        [N_Views] = {.buffer = d->views},
        [N_Instances] = {.buffer = drawn_entries(body)},
        [N_DrawnFirsts] = {.buffer = body->buffers[DRAWN_FIRSTS]},
        [N_InstanceList] = {.buffer = body->buffers[DRAWN_LIST]},
        [N_Part] = {.uniform = block, .uniform_size = sizeof *block},
        [N_Vertices] = {.buffer = mesh->vertices},
        [N_mesh_texture] = {.image =
                                part->texture >= 0 ? mesh->textures[part->texture] : d->p->blank[0],
                            .sampler = GPU_LINEAR_REPEAT},
    };
    for (size_t i = 0; i < COUNT_OF(bindings); i++) kernel_bind_at(k, &places[i], bindings[i]);
}

typedef struct recording {
    drawn *d;
    kernel *k;
    const kernel_place *places; // of drawn_kernel_table
    size_t view;
    const uint32_t *viewport; // NULL: the whole target
    bool apart; // each level is a draw of its own: commands cannot say where their lists begin
} recording;

static bool draws_apart(const drawn *d) {
    return !gpu_get_profile(d->p->host->device)->limits.first_instance;
}

static size_t count_draws(const drawn *d) { // of a view, at most
    size_t count = 0;
    for (size_t i = 0; i < d->body_count; i++)
        for (size_t k = 0; k < d->bodies[i].kind_count; k++) {
            const mesh_data *mesh = &d->bodies[i].kinds[k]->data;
            if (draws_apart(d))
                count += mesh->part_count * drawn_level_count(mesh);
            else
                count += d->alike ? 1 : mesh->part_count;
        }
    return count;
}

// All places first: draws point at bindings, and these at parts.
static void reserve(drawn *d, size_t draws, size_t slots) {
    MEM_RESERVE(d->draws, draws, d->draw_capacity);
    MEM_RESERVE(d->bindings, draws * slots, d->binding_capacity);
    MEM_RESERVE(d->parts, draws, d->part_capacity);
    d->draw_count = 0;
}

// Of a level of a kind, in the view: where its list begins, among the firsts.
static uint32_t find_first(const recording *r, const drawn_body *body, size_t kind,
                           uint32_t level) {
    const size_t bucket = (r->view * body->kind_count + kind) * DRAWN_LEVELS + level;
    return (uint32_t)bucket * ((body->count + DRAWN_BLOCK - 1) / DRAWN_BLOCK);
}

// The part from a level on; `count`: commands, which may go on to the parts behind it.
static void add_draw(const recording *r, const drawn_body *body, size_t kind, uint32_t part,
                     uint32_t level, uint32_t count) {
    drawn *d = r->d;
    size_t i = d->draw_count++;
    const scene_mesh *mesh = body->kinds[kind];
    fill_part(&body->places[kind], &mesh->data.parts[part], r->view, &d->parts[i]);
    d->parts[i].flags.v[2] = find_first(r, body, kind, level);
    bind_part(d, r->k, r->places, body, mesh, &mesh->data.parts[part], &d->parts[i]);
    uint64_t command = (uint64_t)r->view * body->command_count + body->commands[kind] +
                       part * drawn_level_count(&mesh->data) + level;
    gpu_draw *draw = &d->draws[i];
    *draw = kernel_draw(r->k, d->bindings + i * r->k->slot_count);
    draw->indices = mesh->indices;
    draw->commands = body->buffers[DRAWN_COMMANDS];
    draw->command = command * sizeof(gpu_draw_indexed_command);
    draw->commands_drawn = count;
    if (r->viewport) memcpy(draw->viewport, r->viewport, sizeof draw->viewport);
}

static void add_body_draws(const recording *r, const drawn_body *body) {
    for (size_t k = 0; k < body->kind_count; k++) {
        const mesh_data *mesh = &body->kinds[k]->data;
        uint32_t levels = drawn_level_count(mesh);
        if (r->d->alike && !r->apart) add_draw(r, body, k, 0, 0, levels * mesh->part_count);
        for (uint32_t i = 0; i < mesh->part_count && !r->d->alike && !r->apart; i++)
            add_draw(r, body, k, i, 0, r->d->levels ? levels : 1);
        for (uint32_t i = 0; i < mesh->part_count * levels && r->apart; i++)
            add_draw(r, body, k, i / levels, i % levels, 1);
    }
}

bool drawn_record(drawn *d, size_t index, gpu_draw_desc *target, size_t first, size_t count,
                  const uint32_t (*places)[4]) {
    kernel *k = pass_use(d->p, index);
    if (!k) return false;
    reserve(d, count * count_draws(d), k->slot_count);
    for (size_t v = 0; v < count; v++) {
        const recording r = {d,
                             k,
                             pass_solver_places(d->p, index),
                             first + v,
                             places ? places[v] : NULL,
                             draws_apart(d)};
        for (size_t i = 0; i < d->body_count; i++) add_body_draws(&r, &d->bodies[i]);
    }
    target->pipeline = k->pipeline;
    target->draws = d->draws;
    target->draw_count = d->draw_count;
    return (d->draw_count == 0 || kernel_is_bound(k)) && gpu_draw_all(d->p->host->device, target);
}
