// The voxeliser from frame to frame. A body whose transform is what it was costs nothing; for those
// that moved three dispatches do, whatever they are: prepare.comp, cross.comp, compose.comp. Each
// part of a body keeps masks of its own, so that what a body uncovers is composed from the masks of
// those that did not move; a row of cells looks only at the parts near to it (voxels_tiles.c).
//
// Cost for T triangles and a box of N cells: 3 T threads that read 64 bytes each, an atomic
// operation for each word from a crossing to the end of its column (at 128 cells 2.5 on average), 3
// N / 8 bytes of masks cleared and read, 4 N bytes of ids written. At 128^3 with 20,000 triangles
// across the box: 60,000 threads, 250,000 atomics, 0.8 MB cleared, 0.8 MB read, 8 MB written.
#include "base/error.h"
#include "base/memory.h"
#include "scene/voxels_impl.h"
#include <math.h>
#include <string.h>

enum { LISTS_SPARE = 2 }; // times what lists hold, so that they are seldom made anew

// ---- creating ---------------------------------------------------------------------------------

static bool voxels_check_desc(const voxels_desc *desc) {
    for (int a = 0; a < 3; a++)
        if (desc->size[a] < 1 || desc->size[a] > VOXELS_MAX_SIDE || (a == 0 && desc->size[a] % 4))
            return err_set("voxels: size is %u x %u x %u; accepted: 1 to %d each, the first a "
                           "multiple of 4",
                           desc->size[0], desc->size[1], desc->size[2], VOXELS_MAX_SIDE);
    if (box3_is_empty(desc->box) || !box3_is_finite(desc->box))
        return err_set("voxels: the box is empty or has no end");
    return true;
}

// Bodies of the same mesh share what was made of it.
static size_t find_surface(voxels *v, const voxels_body *body) {
    uint32_t longest = 0;
    for (int a = 0; a < 3; a++) longest = v->size[a] > longest ? v->size[a] : longest;
    const mesh_data *mesh = &body->mesh->data;
    for (size_t i = 0; i < v->surface_count; i++)
        if (v->sources[i].vertices == mesh->vertices && v->sources[i].rule == body->rule) return i;
    voxel_surface *s = &v->surfaces[v->surface_count];
    voxel_surface_create(s, mesh, body->rule, longest);
    v->sources[v->surface_count] = (struct voxels_source){
        mesh->vertices, body->rule, (uint32_t)v->point_count, (uint32_t)v->item_count};
    v->point_count += s->point_count;
    v->item_count += s->item_count;
    return v->surface_count++;
}

static bool are_constant(const field *a, const field *b, const field *c) {
    const field *const values[] = {a, b, c};
    for (size_t i = 0; i < COUNT_OF(values); i++)
        if (!field_is_constant(values[i])) return false;
    return true;
}

static bool is_still(const scene_mesh *mesh) {
    if (mesh->instances || !are_constant(mesh->position, mesh->rotation, mesh->scale)) return false;
    for (const scene_node *in = mesh->parent; in; in = in->parent)
        if (!are_constant(in->position, in->rotation, in->scale)) return false;
    return true;
}

// Counts that are too large for their numbers are too large for every buffer (voxels_allocate).
static void add_body(voxels *v, size_t index, const voxels_body *body) {
    voxels_placed *b = &v->bodies[index];
    *b = (voxels_placed){
        .body = *body, .surface = find_surface(v, body), .still = is_still(body->mesh)};
    const voxel_surface *s = &v->surfaces[b->surface];
    const struct voxels_source *source = &v->sources[b->surface];
    for (size_t i = 0; i < s->group_count; i++) {
        const voxel_group *group = &s->groups[i];
        v->parts[v->part_count++] = (voxels_part){
            .body = index,
            .group = group,
            .first_point = source->first_point,
            .point_count = i == 0 ? (uint32_t)s->point_count : 0,
            .first_item = source->first_item + (uint32_t)group->first_item,
            .first_placed = (uint32_t)v->placed_count,
            .first_number = (uint32_t)v->number_count,
        };
        v->number_count += group->item_count;
    }
    v->placed_count += s->point_count;
}

voxels *voxels_create(arena *memory, const voxels_desc *desc) {
    if (!voxels_check_desc(desc)) return NULL;
    voxels *v = arena_alloc(memory, sizeof *v);
    v->memory = memory;
    v->box = desc->box;
    memcpy(v->size, desc->size, sizeof v->size);
    v->cell[0] = (v->box.max.x - v->box.min.x) / (float)v->size[0];
    v->cell[1] = (v->box.max.y - v->box.min.y) / (float)v->size[1];
    v->cell[2] = (v->box.max.z - v->box.min.z) / (float)v->size[2];
    v->bodies = arena_alloc(memory, desc->body_count * sizeof *v->bodies);
    v->surfaces = arena_alloc(memory, desc->body_count * sizeof *v->surfaces);
    v->sources = arena_alloc(memory, desc->body_count * sizeof *v->sources);
    v->parts = arena_alloc(memory, desc->body_count * VOXEL_GROUPS * sizeof *v->parts);
    v->motions = arena_alloc(memory, (desc->body_count + 1) * sizeof *v->motions);
    v->body_count = desc->body_count;
    v->distances = desc->distances;
    for (size_t i = 0; i < desc->body_count; i++) add_body(v, i, &desc->bodies[i]);
    v->state = arena_alloc(memory, sizeof *v->state + v->part_count * sizeof *v->state->parts);
    return v;
}

// ---- where bodies are -------------------------------------------------------------------------

// The turn that takes one orientation to another, as its axis times its angle (radians, up to pi).
static void turned_by(mat4 from, mat4 to, vec3 out) {
    mat3 a, b, turn;
    float size_a = cbrtf(glm_mat4_det(from)), size_b = cbrtf(glm_mat4_det(to));
    glm_vec3_zero(out);
    if (size_a == 0 || size_b == 0) return;
    glm_mat4_pick3(from, a);
    glm_mat4_pick3(to, b);
    glm_mat3_scale(a, 1 / size_a);
    glm_mat3_scale(b, 1 / size_b);
    glm_mat3_transpose(a);
    glm_mat3_mul(b, a, turn);
    versor q;
    glm_mat3_quat(turn, q);
    if (q[3] < 0) glm_vec4_negate(q);
    float sine = glm_vec3_norm(q), angle = 2 * atan2f(sine, q[3]);
    if (sine > 0) glm_vec3_scale(q, angle / sine, out);
}

static void find_motion(const voxels *v, const voxels_placed *b, mat4 now, double dt,
                        voxels_motion *out) {
    const box3 *box = &v->surfaces[b->surface].box;
    vec3 middle = {0.5f * (box->min.x + box->max.x), 0.5f * (box->min.y + box->max.y),
                   0.5f * (box->min.z + box->max.z)};
    vec3 centre, before, turn = {0};
    glm_mat4_mulv3(now, middle, 1, centre);
    *out = (voxels_motion){.centre = {centre[0], centre[1], centre[2]}};
    if (!b->moved || !b->placed || !(dt > 0)) return;
    mat4 last;
    glm_mat4_copy((vec4 *)b->transform, last);
    float rate = (float)(1 / dt);
    glm_mat4_mulv3(last, middle, 1, before);
    out->linear = (float3){(centre[0] - before[0]) * rate, (centre[1] - before[1]) * rate,
                           (centre[2] - before[2]) * rate};
    turned_by(last, now, turn);
    out->angular = (float3){turn[0] * rate, turn[1] * rate, turn[2] * rate};
    float size = cbrtf(glm_mat4_det(now)), size_before = cbrtf(glm_mat4_det(last));
    if (size != 0) out->growth = (1 - size_before / size) * rate;
}

static bool is_finite(mat4 m) {
    for (int i = 0; i < 16; i++)
        if (!(fabsf(m[i / 4][i % 4]) < 1e12f)) return false;
    return true;
}

// Notes which bodies moved. One that is scaled to nothing or out of all numbers is nowhere.
static bool place_bodies(voxels *v, const field_context *context, double dt, bool *motion) {
    for (size_t i = 0; i < v->body_count; i++) {
        voxels_placed *b = &v->bodies[i];
        mat4 now;
        b->moved = false;
        if (!scene_mesh_transform(b->body.mesh, context, now))
            return err_prefix("%s: ", b->body.mesh->name);
        if (!is_finite(now)) glm_mat4_zero(now);
        b->moved = !b->placed || memcmp(now, b->transform, sizeof now) != 0;
        voxels_motion found;
        if (!b->moved && dt <= 0) continue; // the same time once more
        find_motion(v, b, now, dt, &found);
        if (!b->placed || memcmp(&found, &b->motion, sizeof found) != 0) *motion = true;
        b->motion = found;
        glm_mat4_copy(now, b->transform);
        b->placed = true;
    }
    return true;
}

// Mesh to cells, in rows.
static void find_rows(const voxels *v, const voxels_placed *b, shared_vec4 out[3]) {
    const float low[3] = {v->box.min.x, v->box.min.y, v->box.min.z};
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 4; column++) {
            float shift = column == 3 ? low[row] : 0;
            out[row].v[column] = (b->transform[column][row] - shift) / v->cell[row];
        }
}

// Cells of an axis that a range of places meets: with a little more, as corners are rounded.
static void clip_axis(float from, float to, uint32_t cells, uint32_t step, uint32_t *low,
                      uint32_t *size) {
    const float margin = 2.0f / VOXEL_UNIT, most = (float)cells;
    float first = floorf(from - margin), end = floorf(to + margin) + 1;
    first = first > 0 ? fminf(first, most) : 0; // what is no number becomes the whole axis
    end = end < most ? fmaxf(end, 0) : most;
    *low = (uint32_t)first / step * step;
    uint32_t past = ((uint32_t)end + step - 1) / step * step;
    *size = first < end ? past - *low : 0;
}

// The cells that a part meets, by the corners of its box: the true box of the turned one. A body
// without size meets none.
static cell_box find_box(const voxels *v, const voxels_part *p, const shared_vec4 rows[3]) {
    const box3 *box = &p->group->box;
    cell_box out = {{0}, {0}};
    bool empty = false;
    for (int a = 0; a < 3; a++) {
        const float *row = rows[a].v;
        const float low[3] = {box->min.x, box->min.y, box->min.z};
        const float high[3] = {box->max.x, box->max.y, box->max.z};
        float from = row[3], to = row[3];
        for (int i = 0; i < 3; i++) {
            from += fminf(row[i] * low[i], row[i] * high[i]);
            to += fmaxf(row[i] * low[i], row[i] * high[i]);
        }
        clip_axis(from, to, v->size[a], a == 0 ? 4 : 1, &out.low[a], &out.size[a]);
        empty = empty || out.size[a] == 0;
    }
    bool nothing = rows[0].v[0] == 0 && rows[0].v[1] == 0 && rows[0].v[2] == 0;
    return empty || nothing ? (cell_box){{0}, {0}} : out;
}

// ---- masks ------------------------------------------------------------------------------------

// uvec4s of the masks of a box: state.glsl says how they lie.
static uint64_t mask_size(const uint32_t size[3], bool shell) {
    uint64_t words[3], x = size[0], y = size[1], z = size[2];
    for (int a = 0; a < 3; a++) words[a] = (size[a] + 31) / 32;
    uint64_t along_x = (words[0] * y * z + 3) / 4;
    return along_x * (shell ? 2 : 1) + (x * z * words[1] + x * y * words[2]) / 4;
}

static float scale_of(const voxels_placed *b) {
    return cbrtf(fabsf(glm_mat4_det((vec4 *)(uintptr_t)b->transform)));
}

// What a part needs however it is turned: the masks of a cube around it.
static uint32_t choose_capacity(const voxels *v, const voxels_placed *b, const voxels_part *p) {
    if (b->still) return p->used;
    const box3 *box = &p->group->box;
    float x = box->max.x - box->min.x, y = box->max.y - box->min.y, z = box->max.z - box->min.z;
    float across = sqrtf(x * x + y * y + z * z) * scale_of(b);
    uint32_t size[3];
    for (int a = 0; a < 3; a++) {
        float cells = ceilf(across / v->cell[a]) + 8;
        size[a] = cells < (float)v->size[a] ? ((uint32_t)cells + 3) & ~3u : v->size[a];
        if (size[a] > v->size[a]) size[a] = v->size[a];
    }
    uint64_t most = mask_size(size, isfinite(p->group->thinnest));
    return most > p->used ? (uint32_t)most : p->used;
}

// Some part has outgrown its masks: all get new ones, and are voxelised anew.
static bool voxels_grow(voxels *v, gpu *g) {
    uint64_t count = 0;
    for (size_t i = 0; i < v->part_count; i++) {
        voxels_part *p = &v->parts[i];
        p->capacity = choose_capacity(v, &v->bodies[p->body], p);
        p->masks = (uint32_t)count;
        p->moved = true;
        count += p->capacity;
    }
    gpu_buffer_destroy(g, v->buffers[VOXELS_MASKS]);
    v->buffers[VOXELS_MASKS] = NULL;
    if (voxels_make_buffer(v, g, VOXELS_MASKS, 16 * count)) return true;
    for (size_t i = 0; i < v->part_count; i++) v->parts[i].capacity = 0; // tries again
    return false;
}

// ---- the work of an update --------------------------------------------------------------------

static void add_cells(cell_box *all, const cell_box *more) {
    if (more->size[0] == 0) return;
    for (int a = 0; a < 3 && all->size[0]; a++) {
        uint32_t end = all->low[a] + all->size[a], past = more->low[a] + more->size[a];
        if (more->low[a] < all->low[a]) all->low[a] = more->low[a];
        all->size[a] = (end > past ? end : past) - all->low[a];
    }
    if (all->size[0] == 0) *all = *more;
}

// Where a part is, and how much of masks it uses there.
static void place_part(const voxels *v, const voxels_placed *b, voxels_part *p,
                       struct voxel_part *out) {
    const float widest = fmaxf(v->cell[0], fmaxf(v->cell[1], v->cell[2]));
    find_rows(v, b, out->rows);
    p->box = find_box(v, p, out->rows);
    out->scale.v[0] = scale_of(b) * v->surfaces[b->surface].size / widest;
    p->shell = p->group->thinnest * out->scale.v[0] < (float)VOXEL_THIN;
    p->used = (uint32_t)mask_size(p->box.size, p->shell);
}

void voxels_expect(const voxels *v, const field_context *context, uint64_t *masks,
                   uint64_t *lists) {
    enum { WORK = 4 }; // words of a part in list_work
    const cell_box all = {{0}, {v->size[0], v->size[1], v->size[2]}};
    uint64_t count = 0, words = voxels_count_tiles(&all) + 1;
    for (size_t i = 0; i < v->part_count; i++) {
        voxels_part p = v->parts[i];
        voxels_placed b = v->bodies[p.body];
        struct voxel_part place;
        if (!scene_mesh_transform(b.body.mesh, context, b.transform) || !is_finite(b.transform))
            glm_mat4_zero(b.transform);
        place_part(v, &b, &p, &place);
        count += choose_capacity(v, &b, &p);
        words += WORK + voxels_count_tiles(&p.box);
    }
    *masks = 16 * count;
    *lists = LISTS_SPARE * words * sizeof *v->lists.items;
}

// Where parts are now; what has to be composed anew. True in `full` when masks do not suffice.
static void place_parts(voxels *v, cell_box *dirty, bool *full) {
    for (size_t i = 0; i < v->part_count; i++) {
        voxels_part *p = &v->parts[i];
        const voxels_placed *b = &v->bodies[p->body];
        p->moved = b->moved;
        if (!p->moved) continue;
        add_cells(dirty, &p->box);
        place_part(v, b, p, &v->state->parts[i]);
        add_cells(dirty, &p->box);
        *full = *full || p->used > p->capacity;
    }
}

static void describe_part(const voxels_part *p, struct voxel_part *out) {
    for (int a = 0; a < 3; a++) {
        out->low.v[a] = p->box.low[a];
        out->size.v[a] = p->box.size[a];
    }
    out->low.v[3] = (uint32_t)p->body + 1;
    out->size.v[3] = p->shell;
    out->mesh = (shared_uvec4){
        {p->first_point, p->point_count, p->first_item, (uint32_t)p->group->item_count}};
    out->place = (shared_uvec4){{p->first_placed, p->masks, p->used, p->first_number}};
}

// The list of parts at work, with the groups of threads that are theirs. One that meets no cell is
// still placed, for distances.
static void list_work(voxels *v) {
    struct voxel_head *head = &v->state->head;
    voxels_lists *l = &v->lists;
    memset(&head->count, 0, sizeof head->count);
    l->count = 0;
    head->count.v[0] = (uint32_t)v->part_count;
    for (uint32_t i = 0; i < v->part_count; i++) {
        const voxels_part *p = &v->parts[i];
        if (!p->moved) continue;
        struct voxel_part *out = &v->state->parts[i];
        describe_part(p, out);
        uint32_t clear = voxels_groups((p->used + VOXEL_CLEARED - 1) / VOXEL_CLEARED);
        uint32_t points = voxels_groups(out->mesh.v[1]), prepare = clear > points ? clear : points;
        uint64_t crossing = p->box.size[0] ? (3u + p->shell) * (uint64_t)out->mesh.v[3] : 0;
        const uint32_t work[] = {i, head->count.v[2], head->count.v[3], prepare};
        MEM_RESERVE(l->items, l->count + COUNT_OF(work), l->capacity);
        memcpy(l->items + l->count, work, sizeof work);
        l->count += COUNT_OF(work);
        head->count.v[1]++;
        head->count.v[2] += prepare;
        head->count.v[3] += voxels_groups(crossing);
    }
}

static void describe_grid(voxels *v, const cell_box *dirty) {
    struct voxel_head *head = &v->state->head;
    const float corner[3] = {v->box.min.x, v->box.min.y, v->box.min.z};
    float across = 0;
    for (int a = 0; a < 3; a++) {
        head->low.v[a] = dirty->low[a];
        head->size.v[a] = dirty->size[a];
        head->grid.v[a] = v->size[a];
        head->corner.v[a] = corner[a];
        head->cell.v[a] = v->cell[a];
        across += v->cell[a] * (float)v->size[a] * v->cell[a] * (float)v->size[a];
    }
    head->grid.v[3] = v->number_count;
    head->corner.v[3] = sqrtf(across);
}

// From the beginning of a row that a thread composes.
static void begin_rows(cell_box *dirty) {
    uint32_t more = dirty->low[0] % VOXEL_ROW;
    if (dirty->size[0] == 0) return;
    dirty->low[0] -= more;
    dirty->size[0] += more;
}

static bool write_lists(voxels *v, gpu *g) {
    const uint64_t bytes = v->lists.count * sizeof *v->lists.items;
    gpu_buffer *now = v->buffers[VOXELS_LISTS];
    if (!now || gpu_buffer_size(now) < bytes) {
        gpu_buffer_destroy(g, now);
        v->buffers[VOXELS_LISTS] = NULL;
        if (!voxels_make_buffer(v, g, VOXELS_LISTS, LISTS_SPARE * bytes)) return false;
    }
    return gpu_buffer_write(g, v->buffers[VOXELS_LISTS], 0, v->lists.items, bytes);
}

static bool voxels_run(voxels *v, gpu *g, const cell_box *dirty) {
    const struct voxel_head *head = &v->state->head;
    const uint32_t threads[3] = {(dirty->size[0] + VOXEL_ROW - 1) / VOXEL_ROW, dirty->size[1],
                                 dirty->size[2]};
    const size_t state = sizeof *v->state + v->part_count * sizeof *v->state->parts;
    return write_lists(v, g) && gpu_buffer_write(g, v->buffers[VOXELS_STATE], 0, v->state, state) &&
           voxels_dispatch_groups(v, g, VOXELS_PREPARE, head->count.v[2]) &&
           voxels_dispatch_groups(v, g, VOXELS_CROSS, head->count.v[3]) &&
           (dirty->size[0] == 0 ||
            voxels_dispatch(v, g, VOXELS_COMPOSE, threads, &(voxels_images){0}));
}

static void put_vec4(shared_vec4 *out, float3 v, float w) {
    *out = (shared_vec4){{v.x, v.y, v.z, w}};
}

static bool write_motions(voxels *v, gpu *g) {
    for (size_t i = 0; i < v->body_count; i++) {
        const voxels_motion *m = &v->bodies[i].motion;
        struct voxel_motion *out = &v->motions[i + 1];
        put_vec4(&out->centre, m->centre, 0);
        put_vec4(&out->linear, m->linear, m->growth);
        put_vec4(&out->angular, m->angular, 0);
    }
    v->motions_written = gpu_buffer_write(g, v->buffers[VOXELS_MOTIONS], 0, v->motions,
                                          (v->body_count + 1) * sizeof *v->motions);
    return v->motions_written;
}

static void count_work(voxels *v, const cell_box *dirty) {
    v->work.updates++;
    for (size_t i = 0; i < v->body_count; i++) v->work.bodies += v->bodies[i].moved;
    v->work.cells += (uint64_t)dirty->size[0] * dirty->size[1] * dirty->size[2];
}

static bool voxelise(voxels *v, gpu *g) {
    cell_box dirty = {{0}, {0}};
    bool full = false;
    if (!v->started) memcpy(dirty.size, v->size, sizeof dirty.size);
    place_parts(v, &dirty, &full);
    if (full && !voxels_grow(v, g)) return false;
    begin_rows(&dirty);
    describe_grid(v, &dirty);
    list_work(v);
    voxels_list_tiles(v, &dirty);
    count_work(v, &dirty);
    v->started = voxels_run(v, g, &dirty);
    return v->started;
}

bool voxels_update(voxels *v, gpu *g, const field_context *context, double dt, voxels_change *out) {
    *out = (voxels_change){.cells = !v->started, .motion = !v->motions_written};
    bool done = place_bodies(v, context, dt, &out->motion) && (!out->motion || write_motions(v, g));
    for (size_t i = 0; i < v->body_count; i++) out->cells = out->cells || v->bodies[i].moved;
    if (done && out->cells) done = voxelise(v, g);
    for (size_t i = 0; i < v->body_count && !done; i++) v->bodies[i].placed = false; // all anew
    return done;
}

// ---- asking -----------------------------------------------------------------------------------

void voxels_get_motion(const voxels *v, size_t body, voxels_motion *out) {
    *out = v->bodies[body].motion;
}

gpu_buffer *voxels_ids(const voxels *v) {
    return v->buffers[VOXELS_IDS];
}

gpu_buffer *voxels_motions(const voxels *v) {
    return v->buffers[VOXELS_MOTIONS];
}

voxels_work voxels_get_work(const voxels *v) {
    return v->work;
}
