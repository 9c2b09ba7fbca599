// What each view is to show: the device chooses among all instances (shaders/pass/drawn/).
#include "base/error.h"
#include "base/memory.h"
#include "pass/surfaces/drawn.h"
#include "pass/surfaces/drawn_parts.h"
#include <string.h>

// ---- buffers ----------------------------------------------------------------------------------

static uint32_t bucket_count(const drawn_body *body) {
    return (uint32_t)body->kind_count * DRAWN_LEVELS;
}

static uint32_t block_count(const drawn_body *body) {
    return (body->count + DRAWN_BLOCK - 1) / DRAWN_BLOCK;
}

// What the device leaves as it is of the commands: all but how many instances, and the first.
static gpu_buffer *make_commands(gpu *device, const drawn_body *body, size_t views) {
    size_t count = views * body->command_count, size = count * sizeof(gpu_draw_indexed_command);
    gpu_draw_indexed_command *all = mem_alloc(size), *next = all;
    for (size_t v = 0; v < views; v++) {
        for (size_t k = 0; k < body->kind_count; k++) {
            const mesh_data *mesh = &body->kinds[k]->data;
            for (uint32_t i = 0; i < mesh->part_count; i++) {
                for (uint32_t level = 0; level < drawn_level_count(mesh); level++) {
                    mesh_run run = mesh_get_run(mesh, i, level);
                    *next++ =
                        (gpu_draw_indexed_command){.indices = run.count, .first_index = run.first};
                }
            }
        }
    }
    gpu_buffer *buffer = drawn_buffer(device, "draws", all, size);
    mem_free(all);
    return buffer;
}

static const char *const labels[DRAWN_BUFFERS] = {
    [DRAWN_CHOICES] = "choices of draws", [DRAWN_TOTALS] = "totals of draws",
    [DRAWN_COUNTS] = "counts of draws",   [DRAWN_FIRSTS] = "firsts of draws",
    [DRAWN_LIST] = "lists of draws",
};

static uint64_t bytes_of(const drawn_body *body, size_t views, int which) {
    const uint64_t buckets = views * bucket_count(body);
    if (which == DRAWN_CHOICES || which == DRAWN_LIST) return 4 * views * body->count;
    return 4 * (which == DRAWN_TOTALS ? buckets : buckets * block_count(body));
}

void drawn_list_lists(const drawn_body *body, size_t views, budget_list *out) {
    for (int i = 0; i < DRAWN_BUFFERS; i++)
        if (labels[i]) budget_list_add(out, labels[i], bytes_of(body, views, i));
    budget_list_add(out, "draws", views * body->command_count * sizeof(gpu_draw_indexed_command));
}

static bool make_buffers(gpu *device, drawn_body *body, size_t views) {
    bool done = true;
    for (int i = 0; i < DRAWN_BUFFERS && done; i++) {
        if (i == DRAWN_BUCKETS) continue;
        gpu_buffer_destroy(device, body->buffers[i]);
        body->buffers[i] =
            i == DRAWN_COMMANDS
                ? make_commands(device, body, views)
                : gpu_buffer_create(device, &(gpu_buffer_desc){.label = labels[i],
                                                               .size = bytes_of(body, views, i)});
        done = body->buffers[i] != NULL;
    }
    return done;
}

static bool fit_views(drawn *d, size_t count) {
    if (count > DRAWN_MAX_VIEWS)
        return err_set("%zu views; at most %d are drawn", count, DRAWN_MAX_VIEWS);
    if (count <= d->capacity) return true;
    d->capacity = 0;
    for (size_t i = 0; i < d->body_count; i++)
        if (!make_buffers(d->p->host->device, &d->bodies[i], count)) return false;
    d->capacity = count;
    return true;
}

// ---- where all stand --------------------------------------------------------------------------

static void fill_buckets(const mesh_data *mesh, const drawn_place *place, uint32_t command,
                         struct drawn_bucket out[DRAWN_LEVELS]) {
    float ball[4], scale = 1;
    mesh_get_ball(mesh, ball);
    if (place) {
        scale = glm_vec3_norm((float *)place->matrix[0]);
        glm_mat4_mulv3((vec4 *)place->matrix, ball, 1, ball);
    }
    uint32_t levels = drawn_level_count(mesh);
    for (uint32_t i = 0; i < DRAWN_LEVELS; i++) {
        float error = i == 0 ? 0 : i < levels ? mesh->levels[i - 1].error * scale : MESH_NO_LEVEL;
        out[i] = (struct drawn_bucket){
            .sphere = {{ball[0], ball[1], ball[2], ball[3] * scale}},
            .draws = {{command + i, i < levels ? mesh->part_count : 0, 0, levels}}};
        memcpy(&out[i].draws.v[2], &error, sizeof error);
    }
}

// Those of instances stand in their own space and never change, others where a mesh has moved.
static bool write_buckets(drawn *d, drawn_body *body) {
    gpu_buffer **buffer = &body->buffers[DRAWN_BUCKETS];
    if (body->instances && *buffer) return true;
    gpu *device = d->p->host->device;
    size_t size = bucket_count(body) * sizeof(struct drawn_bucket);
    struct drawn_bucket *all = mem_alloc(size);
    for (size_t k = 0; k < body->kind_count; k++)
        fill_buckets(&body->kinds[k]->data, body->instances ? NULL : &body->places[k],
                     body->commands[k], all + k * DRAWN_LEVELS);
    bool done = true;
    if (!*buffer)
        done = (*buffer = drawn_buffer(device, "kinds of draws", all, size)) != NULL;
    else if (memcmp(body->buckets, all, size) != 0)
        done = gpu_buffer_write(device, *buffer, 0, all, size);
    if (!body->buckets) body->buckets = arena_alloc(d->p->host->memory, size);
    memcpy(body->buckets, all, size);
    mem_free(all);
    return done;
}

static bool place(drawn *d, drawn_body *body) {
    const field_context *context = d->p->host->context;
    mat4 matrix;
    float tint[4] = {1, 1, 1, 1};
    if (body->instances && !scene_instances_place(body->instances, context, matrix, tint))
        return false;
    for (size_t k = 0; k < body->kind_count; k++) {
        drawn_place *at = &body->places[k];
        if (body->instances)
            glm_mat4_copy(matrix, at->matrix);
        else if (!scene_mesh_transform(body->kinds[k], context, at->matrix))
            return err_prefix("%s: ", body->kinds[k]->name);
        if (!scene_mesh_look(body->kinds[k], context, &at->look)) return false;
        for (int c = 0; c < 3; c++) at->look.tint[c] *= tint[c];
    }
    return true;
}

// ---- choosing ---------------------------------------------------------------------------------

static void set_numbers(const drawn_body *body, kernel *k, const kernel_place *places, float lod,
                        float most) {
    mat4 matrix = GLM_MAT4_IDENTITY_INIT;
    if (body->instances) glm_mat4_copy(body->places[0].matrix, matrix);
    const float scale = glm_vec3_norm(matrix[0]);
    const uint32_t buckets = bucket_count(body), blocks = block_count(body);
    if (!body->instances) most = 0;
    kernel_set_at(k, &places[N_instance_count], &body->count, sizeof body->count);
    kernel_set_at(k, &places[N_bucket_count], &buckets, sizeof buckets);
    kernel_set_at(k, &places[N_block_count], &blocks, sizeof blocks);
    kernel_set_at(k, &places[N_command_count], &body->command_count, sizeof body->command_count);
    kernel_set_at(k, &places[N_place], matrix, sizeof matrix);
    kernel_set_at(k, &places[N_scale], &scale, sizeof scale);
    kernel_set_at(k, &places[N_lod], &lod, sizeof lod);
    kernel_set_at(k, &places[N_most], &most, sizeof most);
}

static void bind_buffers(const drawn *d, const drawn_body *body, kernel *k,
                         const kernel_place *places) {
    static const int buffer_names[DRAWN_BUFFERS] = {
        [DRAWN_BUCKETS] = N_DrawnBuckets,   [DRAWN_CHOICES] = N_DrawnChoices,
        [DRAWN_TOTALS] = N_DrawnTotals,     [DRAWN_COUNTS] = N_DrawnCounts,
        [DRAWN_FIRSTS] = N_DrawnFirsts,     [DRAWN_LIST] = N_InstanceList,
        [DRAWN_COMMANDS] = N_DrawnCommands,
    };
    kernel_bind_at(k, &places[N_Views], (gpu_binding){.buffer = d->views});
    kernel_bind_at(k, &places[N_Instances], (gpu_binding){.buffer = drawn_entries(body)});
    for (int i = 0; i < DRAWN_BUFFERS; i++)
        kernel_bind_at(k, &places[buffer_names[i]], (gpu_binding){.buffer = body->buffers[i]});
}

static bool drawn_run(drawn *d, const drawn_body *body, drawn_step step, uint32_t views, float lod,
                      float most) {
    const size_t index = d->first + step;
    const kernel_place *places = pass_solver_places(d->p, index);
    kernel *k = pass_use(d->p, index);
    if (!k) return false;
    set_numbers(body, k, places, lod, most);
    bind_buffers(d, body, k, places);
    uint32_t threads = step == DRAWN_COUNT ? bucket_count(body) : body->count;
    return kernel_run(k, d->p->host->device, threads, views, 1);
}

static bool write_camera(drawn *d, uint32_t height) {
    const struct frame_block *frame = d->p->host->frame;
    struct view_entry view = {.eye = frame->eye};
    mat4 from, to, clip;
    memcpy(from, frame->view.m, sizeof from);
    memcpy(to, frame->projection.m, sizeof to);
    glm_mat4_mul(to, from, clip);
    memcpy(view.clip.m, clip, sizeof clip);
    view.eye.v[3] = (float)height / (2 * frame->lens.v[1]);
    d->views = d->camera;
    return gpu_buffer_write(d->p->host->device, d->camera, 0, &view, sizeof view);
}

bool drawn_cull(drawn *d, gpu_buffer *views, size_t count, uint32_t height, float lod, float most) {
    d->views = views;
    d->levels = lod > 0;
    if (most > 0) most += d->p->host->frame->eye.v[3]; // of a camera that has stepped back
    bool done = (views || write_camera(d, height)) && fit_views(d, count);
    for (size_t i = 0; i < d->body_count && done; i++) {
        drawn_body *body = &d->bodies[i];
        done = place(d, body) && write_buckets(d, body);
        gpu_buffer_fill(d->p->host->device, body->buffers[DRAWN_TOTALS], 0);
        gpu_buffer_fill(d->p->host->device, body->buffers[DRAWN_COUNTS], 0);
    }
    // Step by step, so that bodies need not wait for each other.
    for (int step = 0; step < DRAWN_STEPS; step++)
        for (size_t i = 0; i < d->body_count && done; i++)
            done = drawn_run(d, &d->bodies[i], (drawn_step)step, (uint32_t)count, lod, most);
    return done || err_prefix("%s: ", d->p->label);
}
