// Voxels: the cells of a box that meshes hold, as images for fields: whether a cell is inside, how
// far the surface is, how the body there moves. An image that nobody reads is not computed, and
// none while nothing moves.
#include "pass/grids/voxels.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/words.h"
#include "pass/pass_impl.h"
#include "scene/voxels.h"
#include <math.h>
#include <string.h>

enum { MARGIN = 2, MOST_CELLS = 1 << 27 }; // cells around meshes; in all

#define NAMES(NAME)                                                                                \
    NAME(rule), NAME(inside), NAME(distance), NAME(velocity), NAME(size), NAME(VoxelIds),          \
        NAME(VoxelMotions)
KERNEL_NAMES(NAMES);
static const pass_kernel kernels[1];

typedef struct voxels_pass {
    field_grid grid; // first: the effect has it
    pass *owner;
    voxels *cells;
    double updated; // seconds; NAN: never
    bool shown[2];  // images hold what is there: inside and velocity; distance
} voxels_pass;

static voxels_pass *state_of(const pass *p) {
    return p->state;
}

// ---- the grid ---------------------------------------------------------------------------------

static const struct {
    const char *name;
    int channel, components;
} fields[] = {{"inside", PASS_VOXELS_INSIDE, 1},
              {"distance", PASS_VOXELS_DISTANCE, 1},
              {"velocity", PASS_VOXELS_VELOCITY, 3}};

static const char *field_name(const field_grid *grid, size_t index) {
    (void)grid;
    return index < COUNT_OF(fields) ? fields[index].name : NULL;
}

static int find_field(field_grid *grid, const char *name, int *components) {
    const char *all[COUNT_OF(fields)];
    for (size_t i = 0; i < COUNT_OF(fields); i++) {
        all[i] = fields[i].name;
        if (strcmp(fields[i].name, name) != 0) continue;
        *components = fields[i].components;
        return fields[i].channel;
    }
    words_refuse(all, COUNT_OF(fields), name, "it has inside, distance and velocity",
                 "%s: no field '%s'", grid->name, name);
    return -1;
}

// ---- the box ----------------------------------------------------------------------------------

static void add_point(box3 *box, const vec3 p, bool first) {
    box3 at = {{p[0], p[1], p[2]}, {p[0], p[1], p[2]}};
    if (first) *box = at;
    box->min = (float3){fminf(box->min.x, p[0]), fminf(box->min.y, p[1]), fminf(box->min.z, p[2])};
    box->max = (float3){fmaxf(box->max.x, p[0]), fmaxf(box->max.y, p[1]), fmaxf(box->max.z, p[2])};
}

// Around all meshes as they stand now.
static bool box_of_meshes(const pass *p, const field_context *context, box3 *out) {
    for (size_t i = 0; i < p->mesh_count; i++) {
        const box3 *box = &p->meshes[i]->data.box;
        mat4 transform;
        if (!scene_mesh_transform(p->meshes[i], context, transform))
            return err_prefix("%s: ", p->meshes[i]->name);
        for (int k = 0; k < 8; k++) {
            vec3 at = {k & 1 ? box->max.x : box->min.x, k & 2 ? box->max.y : box->min.y,
                       k & 4 ? box->max.z : box->min.z};
            glm_mat4_mulv3(transform, at, 1, at);
            add_point(out, at, i == 0 && k == 0);
        }
    }
    return true;
}

// Cells that are cubes, as many as `resolution` along the longest side, the margin among them; the
// box grows to whole cells.
static void choose_size(box3 *box, uint32_t resolution, uint32_t margin, uint32_t size[3]) {
    float *low[3] = {&box->min.x, &box->min.y, &box->min.z};
    float *high[3] = {&box->max.x, &box->max.y, &box->max.z};
    float longest = 0;
    for (int a = 0; a < 3; a++) longest = fmaxf(longest, *high[a] - *low[a]);
    float cell = longest / (float)(resolution - 2 * margin);
    for (int a = 0; a < 3; a++) {
        float middle = 0.5f * (*low[a] + *high[a]);
        size[a] = (uint32_t)fmaxf(ceilf((*high[a] - *low[a]) / cell - 0.01f), 1) + 2 * margin;
        if (a == 0) size[a] = (size[a] + 3) / 4 * 4;
        *low[a] = middle - 0.5f * cell * (float)size[a];
        *high[a] = middle + 0.5f * cell * (float)size[a];
    }
}

static bool choose_box(const pass *p, const pass_voxels_desc *desc, const field_context *context,
                       field_grid *out) {
    bool given = !box3_is_empty(desc->box);
    out->box = desc->box;
    if (!given && !box_of_meshes(p, context, &out->box)) return false;
    float sides = out->box.max.x - out->box.min.x + out->box.max.y - out->box.min.y +
                  out->box.max.z - out->box.min.z;
    if (!(sides > 0 && sides < 1e18f))
        return err_set("%s: the meshes have no size; give box = { min, max }", p->label);
    memcpy(out->size, desc->size, sizeof out->size);
    if (!desc->size[0]) {
        choose_size(&out->box, desc->resolution, given ? 0 : MARGIN, out->size);
    } else if (!given) { // the margin is part of what was asked for
        float wide[3] = {out->box.max.x - out->box.min.x, out->box.max.y - out->box.min.y,
                         out->box.max.z - out->box.min.z};
        float grow = 0;
        for (int a = 0; a < 3; a++)
            if (out->size[a] > 2 * MARGIN)
                grow = fmaxf(grow, MARGIN * wide[a] / (float)(out->size[a] - 2 * MARGIN));
        out->box = box3_grow(out->box, grow);
    }
    if ((uint64_t)out->size[0] * out->size[1] * out->size[2] > MOST_CELLS)
        return err_set("%s: %u x %u x %u cells; at most %d in all", p->label, out->size[0],
                       out->size[1], out->size[2], MOST_CELLS);
    return true;
}

field_grid *pass_voxels_open(pass *p, const pass_voxels_desc *desc, const field_context *context) {
    voxels_pass *s = p->state = arena_alloc(p->host->memory, sizeof *s);
    *s = (voxels_pass){.owner = p, .updated = (double)NAN};
    if (p->mesh_count == 0)
        return ERR_NULL("%s: a mesh is missing, as in voxels { mesh { \"data/ball.obj\" } }",
                        p->label);
    if (!choose_box(p, desc, context, &s->grid)) return NULL;
    s->grid.name = p->label;
    s->grid.channel_count = PASS_VOXELS_CHANNELS;
    s->grid.state.active = s->grid.box;
    s->grid.field_name = field_name;
    s->grid.find_field = find_field;
    return &s->grid;
}

const voxels *pass_voxels_get(const pass *p) {
    return state_of(p)->cells;
}

// ---- fields -----------------------------------------------------------------------------------

static const field *combine(arena *memory, const char *kind, const field *a, const field *b) {
    const field *args[FIELD_MAX_ARGS] = {a, b};
    return field_make(memory, kind, args, NULL);
}

static const field *vector(arena *memory, float3 v) {
    return field_constant(memory, 3, (float[4]){v.x, v.y, v.z});
}

// The distance at the nearest point of the box, and how far that is. Half a cell within, where the
// images' texels are.
static const field *extend_distance(arena *memory, const field_grid *grid, const field *inner) {
    float3 half = {0.5f * (grid->box.max.x - grid->box.min.x) / (float)grid->size[0],
                   0.5f * (grid->box.max.y - grid->box.min.y) / (float)grid->size[1],
                   0.5f * (grid->box.max.z - grid->box.min.z) / (float)grid->size[2]};
    float3 low = {grid->box.min.x + half.x, grid->box.min.y + half.y, grid->box.min.z + half.z};
    float3 high = {grid->box.max.x - half.x, grid->box.max.y - half.y, grid->box.max.z - half.z};
    const field *here = field_make(memory, "position", NULL, NULL);
    const field *within = combine(memory, "max", here, vector(memory, low));
    within = combine(memory, "min", within, vector(memory, high));
    const field *away = combine(memory, "sub", within, here);
    const field *moved = combine(memory, "warp", inner, away);
    const field *far = field_make(memory, "length", (const field *[FIELD_MAX_ARGS]){away}, NULL);
    return moved && far ? combine(memory, "add", moved, far) : NULL;
}

const field *pass_voxels_field(pass *p, const char *name) {
    voxels_pass *s = state_of(p);
    arena *memory = p->host->memory;
    int components, channel = find_field(&s->grid, name, &components);
    if (channel < 0) return NULL;
    const field *node = field_grid_channel(memory, &s->grid, channel, components);
    return node && channel == PASS_VOXELS_DISTANCE ? extend_distance(memory, &s->grid, node) : node;
}

// ---- life -------------------------------------------------------------------------------------

static bool add_image(pass *p, voxels_pass *s, int output, int channel) {
    const int index = p->names[output].image;
    p->formats[index] = p->face->images[index].format; // as other shaders write it
    if (!pass_add_output(p, output,
                         (graph_image_desc){.width = s->grid.size[0],
                                            .height = s->grid.size[1],
                                            .depth = s->grid.size[2],
                                            .optional = true,
                                            .keep = true}))
        return false;
    pass_host_add_grid_image(p->host, &s->grid, channel / 4, *pass_image(p, output));
    return true;
}

static bool voxels_pass_declare(pass *p) {
    voxels_pass *s = state_of(p);
    const voxels_rule rule = (voxels_rule)pass_option(p, N_rule);
    voxels_body *bodies = arena_alloc(p->host->memory, p->mesh_count * sizeof *bodies);
    for (size_t i = 0; i < p->mesh_count; i++) bodies[i] = (voxels_body){p->meshes[i], rule};
    voxels_desc desc = {
        .box = s->grid.box, .bodies = bodies, .body_count = p->mesh_count, .distances = true};
    memcpy(desc.size, s->grid.size, sizeof desc.size);
    s->cells = voxels_create(p->host->memory, &desc);
    if (!s->cells) return err_prefix("%s: ", p->label);
    return add_image(p, s, N_inside, PASS_VOXELS_INSIDE) &&
           add_image(p, s, N_distance, PASS_VOXELS_DISTANCE) &&
           add_image(p, s, N_velocity, PASS_VOXELS_VELOCITY) && pass_add_to_graph(p);
}

static bool voxels_pass_build(pass *p) {
    const pass_host *host = p->host;
    return pass_build_kernels(p) &&
           voxels_build(state_of(p)->cells, host->device, host->library, host->reader);
}

static bool voxels_pass_allocate(pass *p) {
    return voxels_allocate(state_of(p)->cells, p->host->device);
}

static void voxels_pass_list_memory(const pass *p, budget_list *out) {
    const graph_image distance = *pass_image(p, N_distance);
    voxels_list_memory(state_of(p)->cells, p->host->context,
                       graph_is_read(p->host->graph, distance), out);
}

static void voxels_pass_destroy(pass *p) {
    voxels_pass *s = state_of(p);
    if (s && s->cells) voxels_destroy(s->cells, p->host->device);
}

// ---- a frame ----------------------------------------------------------------------------------

static bool voxels_pass_update(pass *p) {
    const field_grid *grid = &state_of(p)->grid;
    const float size[3] = {(float)grid->size[0], (float)grid->size[1], (float)grid->size[2]};
    pass_set_box(p, grid->box);
    pass_set(p, N_size, size, sizeof size);
    return true;
}

static bool has_content(const pass *p, int output) {
    return graph_has_content(p->host->graph, *pass_image(p, output));
}

// Whether there is a body in a cell, and how it moves.
static bool show_cells(pass *p, const voxels_pass *s) {
    const uint32_t *n = s->grid.size;
    kernel *k = pass_use(p, 0);
    if (!k) return false;
    kernel_bind_buffer(k, N_VoxelIds, voxels_ids(s->cells));
    kernel_bind_buffer(k, N_VoxelMotions, voxels_motions(s->cells));
    return kernel_run(k, p->host->device, n[0] / 4, n[1], n[2]);
}

static bool show(pass *p, voxels_pass *s, const voxels_change *change) {
    gpu_image *inside = pass_get_image(p, N_inside), *velocity = pass_get_image(p, N_velocity);
    gpu_image *distance = pass_get_image(p, N_distance); // NULL: nobody reads it
    bool kept = (!inside || has_content(p, N_inside)) && (!velocity || has_content(p, N_velocity));
    s->shown[0] = s->shown[0] && kept && !change->cells && (!change->motion || !velocity);
    s->shown[1] = s->shown[1] && has_content(p, N_distance) && !change->cells;
    if ((inside || velocity) && !s->shown[0]) {
        if (!show_cells(p, s)) return false;
        s->shown[0] = true;
        s->grid.state.content++;
    }
    if (distance && !s->shown[1]) {
        if (!voxels_write_distance(s->cells, p->host->device, distance)) return false;
        s->shown[1] = true;
        s->grid.state.content++;
    }
    return true;
}

static bool voxels_pass_record(pass *p) {
    voxels_pass *s = state_of(p);
    const field_context *context = p->host->context;
    double passed = context->time - s->updated; // a jump puts bodies where they are
    voxels_change change;
    if (p->host->fresh || !(passed > 0)) passed = 0;
    s->updated = context->time;
    return pass_prepare(p) && voxels_update(s->cells, p->host->device, context, passed, &change) &&
           show(p, s, &change);
}

const pass_type voxels_type = {
    .name = "voxels",
    .constructed = true,
    .shader = "pass/grids/voxels.comp",
    PASS_KERNELS,
    .meshes = PASS_USES_MESHES,
    .declare = voxels_pass_declare,
    .build = voxels_pass_build,
    .allocate = voxels_pass_allocate,
    .list_memory = voxels_pass_list_memory,
    .update = voxels_pass_update,
    .record = voxels_pass_record,
    .destroy = voxels_pass_destroy,
};
