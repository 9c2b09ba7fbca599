// Pieces: a mesh at each particle, drawn in compute: threads for each triangle of each piece find
// the least depth in its pixels (depth), then the first of the triangles that are as near (number),
// so that nothing is left to chance; then each pixel tells of its triangle, or of the scene: how
// that reflects and glows (look), and its colour, way and depth (show). In one kernel these are
// five images, which small devices do not allow.
#include "base/error.h"
#include "base/memory.h"
#include "pass/particles/particles.h"
#include "pass/pass_impl.h"
#include "scene/material.h"
#include "shared.h"
#include <string.h>

enum { MOST_TRIANGLES = 4096 };

// The scene's images are named as those of the pass that gives them, after "scene_".
#define SCENE_NAMES(NAME)                                                                          \
    NAME(scene_albedo), NAME(scene_normal), NAME(scene_depth), NAME(scene_surface),                \
        NAME(scene_emission)
#define NAMES(NAME)                                                                                \
    SCENE_NAMES(NAME), NAME(depth), NAME(picture), NAME(PieceTriangles), NAME(PieceMaterials),     \
        NAME(PieceDepths), NAME(PieceNumbers)
KERNEL_NAMES(NAMES);

typedef enum pieces_stage { DEPTH, NUMBER, LOOK, SHOW, STAGES } pieces_stage;
static const pass_kernel kernels[STAGES] = {
    [DEPTH] = {.define = "STAGE_DEPTH"},
    [NUMBER] = {.define = "STAGE_NUMBER"},
    [LOOK] = {.define = "STAGE_LOOK"},
    [SHOW] = {.define = "STAGE_SHOW"},
};

typedef struct pieces_state {
    uint32_t triangle_count; // of the mesh
    gpu_buffer *triangles, *depths, *numbers;
    struct surface_material *looks; // of the triangles, as on the device
    gpu_buffer *materials;
    bool empty; // depths and numbers are
} pieces_state;

static pieces_state *state_of(const pass *p) {
    return p->state;
}

// ---- declaring --------------------------------------------------------------------------------

// The scene is that of the first pass among the sources that gives one.
static void find_scene(pass *p) {
    for (int i = N_scene_albedo; i <= N_scene_emission; i++) {
        graph_image *input = pass_image(p, i);
        for (size_t k = 0; k < p->source_count && !input->id; k++)
            *input = pass_output(p->sources[k], names[i] + strlen("scene_"));
    }
    pass_drop_matte(p, "scene_surface", "scene_emission");
}

static bool pieces_declare(pass *p) {
    pieces_state *s = p->state = arena_alloc(p->host->memory, sizeof *s);
    if (p->mesh_count != 1)
        return err_set("%s: %zu meshes; one is needed, as in pieces { shards, mesh { "
                       "\"data/ball.obj\" } }",
                       p->label, p->mesh_count);
    s->triangle_count = p->meshes[0]->data.index_count / 3;
    if (s->triangle_count < 1 || s->triangle_count > MOST_TRIANGLES)
        return err_set(
            "%s: the mesh has %u triangles; 1 to %d are accepted: each is drawn anew for "
            "every particle",
            p->label, s->triangle_count, MOST_TRIANGLES);
    find_scene(p);
    return pass_declare_images(p) && pass_add_to_graph(p);
}

// ---- building ---------------------------------------------------------------------------------

static uint32_t threads_of_triangle(const pass *p) {
    return gpu_get_profile(p->host->device)->draws_by_groups ? 8 : 1;
}

static bool pieces_defines(pass *p, size_t index, pass_defines *out) {
    (void)index;
    pass_define_number(p, out, "TRIANGLES", state_of(p)->triangle_count);
    pass_define_number(p, out, "THREADS", threads_of_triangle(p));
    return true;
}

static void write_triangle(const mesh_data *mesh, uint32_t first, struct bvh_triangle *out) {
    const float *corners[3];
    for (int k = 0; k < 3; k++) corners[k] = mesh->vertices[mesh->indices[first + k]].position;
    for (int k = 0; k < 3; k++) {
        out->corner.v[k] = corners[0][k];
        out->first.v[k] = corners[1][k] - corners[0][k];
        out->second.v[k] = corners[2][k] - corners[0][k];
    }
}

static bool pieces_allocate(pass *p) {
    pieces_state *s = state_of(p);
    const mesh_data *mesh = &p->meshes[0]->data;
    if (s->triangles) return true;
    size_t size = s->triangle_count * sizeof(struct bvh_triangle), count = 0;
    struct bvh_triangle *all = mem_alloc(size);
    for (uint32_t i = 0; i < mesh->part_count; i++) {
        const mesh_part *part = &mesh->parts[i];
        for (uint32_t k = 0; k + 2 < part->count && count < s->triangle_count; k += 3)
            write_triangle(mesh, part->first + k, &all[count++]);
    }
    s->triangles = gpu_buffer_create(
        p->host->device, &(gpu_buffer_desc){.label = "triangles of pieces", .size = size});
    bool done = s->triangles && gpu_buffer_write(p->host->device, s->triangles, 0, all, size);
    mem_free(all);
    size = s->triangle_count * sizeof *s->looks;
    s->looks = mem_alloc(size);
    s->materials = gpu_buffer_create(
        p->host->device, &(gpu_buffer_desc){.label = "materials of pieces", .size = size});
    done =
        done && s->materials && gpu_buffer_write(p->host->device, s->materials, 0, s->looks, size);
    return done || err_prefix("%s: ", p->label);
}

static void pieces_destroy(pass *p) {
    pieces_state *s = state_of(p);
    if (!s) return;
    gpu_buffer *const buffers[] = {s->triangles, s->materials, s->depths, s->numbers};
    for (size_t i = 0; i < COUNT_OF(buffers); i++) gpu_buffer_destroy(p->host->device, buffers[i]);
    mem_free(s->looks);
}

// ---- a frame ----------------------------------------------------------------------------------

static void picture_size(const pass *p, uint32_t size[3]) {
    graph_get_size(p->host->graph, *pass_image(p, N_depth), size);
}

static uint64_t pixels_bytes(const pass *p) {
    uint32_t size[3];
    picture_size(p, size);
    return 4ull * size[0] * size[1];
}

static void pieces_list_memory(const pass *p, budget_list *out) {
    const pieces_state *s = state_of(p);
    const uint64_t triangles = s->triangle_count, pixels = pixels_bytes(p);
    if (!s->triangles)
        budget_list_add(out, "triangles of pieces", triangles * sizeof(struct bvh_triangle));
    if (!s->materials) budget_list_add(out, "materials of pieces", triangles * sizeof *s->looks);
    if (!s->depths || gpu_buffer_size(s->depths) != pixels)
        budget_list_add(out, "depths of pieces", pixels);
    if (!s->numbers || gpu_buffer_size(s->numbers) != pixels)
        budget_list_add(out, "numbers of pieces", pixels);
}

static bool pieces_update(pass *p) {
    uint32_t size[3];
    picture_size(p, size);
    const float picture[2] = {(float)size[0], (float)size[1]};
    pass_set(p, N_picture, picture, sizeof picture);
    return true;
}

static bool make_buffer(pass *p, gpu_buffer **buffer, const char *label, uint64_t size) {
    if (!*buffer || gpu_buffer_size(*buffer) != size) state_of(p)->empty = false;
    return gpu_buffer_make(p->host->device, buffer, label, size) || err_prefix("%s: ", p->label);
}

// What the triangles look like in this frame.
static bool write_looks(pass *p) {
    pieces_state *s = state_of(p);
    const mesh_data *mesh = &p->meshes[0]->data;
    scene_look look;
    if (!scene_mesh_look(p->meshes[0], p->host->context, &look)) return false;
    size_t size = s->triangle_count * sizeof *s->looks;
    struct surface_material *all = mem_alloc(size);
    for (uint32_t i = 0, at = 0; i < mesh->part_count; i++) {
        const mesh_part *part = &mesh->parts[i];
        struct surface_material made = {0};
        for (int c = 0; c < 3; c++) made.color.v[c] = part->color[c] * look.tint[c];
        scene_look_part(&look, part, made.surface.v, made.emission.v);
        for (uint32_t k = 0; k + 2 < part->count && at < s->triangle_count; k += 3)
            all[at++] = made;
    }
    bool same = memcmp(all, s->looks, size) == 0;
    memcpy(s->looks, all, size);
    mem_free(all);
    return same || gpu_buffer_write(p->host->device, s->materials, 0, s->looks, size);
}

static kernel *use(pass *p, pieces_stage stage) {
    const pieces_state *s = state_of(p);
    kernel *k = pass_use(p, stage);
    if (!k) return NULL;
    kernel_bind_buffer(k, N_PieceTriangles, s->triangles);
    kernel_bind_buffer(k, N_PieceMaterials, s->materials);
    kernel_bind_buffer(k, N_PieceDepths, s->depths);
    kernel_bind_buffer(k, N_PieceNumbers, s->numbers);
    return k;
}

static bool run_triangles(pass *p, pieces_stage stage, uint64_t count) {
    kernel *k = use(p, stage);
    return k && kernel_run_each(k, p->host->device, count * threads_of_triangle(p));
}

// A thread for each pixel.
static bool run_pixels(pass *p, pieces_stage stage, const uint32_t size[3]) {
    kernel *k = use(p, stage);
    return k && kernel_run(k, p->host->device, size[0], size[1], 1);
}

static bool pieces_record(pass *p) {
    pieces_state *s = state_of(p);
    uint32_t size[3];
    uint64_t count = (uint64_t)pass_particles_used(p->particles) * s->triangle_count;
    picture_size(p, size);
    const uint64_t bytes = pixels_bytes(p);
    const uint64_t most = UINT32_MAX / threads_of_triangle(p) - 1;
    if (count > most)
        return err_set("%s: %llu triangles; at most %llu are drawn", p->label,
                       (unsigned long long)count, (unsigned long long)most);
    if (!pass_prepare(p) || !write_looks(p) ||
        !make_buffer(p, &s->depths, "depths of pieces", bytes) ||
        !make_buffer(p, &s->numbers, "numbers of pieces", bytes))
        return false;
    if (!s->empty) {
        gpu_buffer_fill(p->host->device, s->depths, UINT32_MAX);
        gpu_buffer_fill(p->host->device, s->numbers, UINT32_MAX);
    }
    s->empty = false; // until they are shown
    s->empty = run_triangles(p, DEPTH, count) && run_triangles(p, NUMBER, count) &&
               run_pixels(p, LOOK, size) && run_pixels(p, SHOW, size);
    return s->empty;
}

const pass_type pieces_type = {
    .name = "pieces",
    .shader = "pass/particles/pieces.comp",
    PASS_KERNELS,
    .meshes = PASS_USES_MESHES,
    .declare = pieces_declare,
    .defines = pieces_defines,
    .allocate = pieces_allocate,
    .list_memory = pieces_list_memory,
    .update = pieces_update,
    .record = pieces_record,
    .destroy = pieces_destroy,
};
