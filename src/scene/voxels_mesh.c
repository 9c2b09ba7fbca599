// From how a mesh hangs together to what is voxelised. Closed components whose boxes overlap are
// put into different groups, of which each is solid by itself, so that one does not hollow out the
// other; a cavity stays with what it is in.
#include "scene/voxels_mesh.h"
#include "base/memory.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

// Components that are looked at for overlaps; with more of them all are one group.
enum { MOST_COMPONENTS = 2048 };

static bool overlap(box3 a, box3 b) {
    return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y &&
           a.min.z <= b.max.z && b.min.z <= a.max.z;
}

static bool contains(box3 outer, box3 inner) {
    return outer.min.x <= inner.min.x && outer.min.y <= inner.min.y && outer.min.z <= inner.min.z &&
           outer.max.x >= inner.max.x && outer.max.y >= inner.max.y && outer.max.z >= inner.max.z;
}

static int by_volume(const void *a, const void *b) {
    double x = fabs((*(voxel_component *const *)a)->volume);
    double y = fabs((*(voxel_component *const *)b)->volume);
    return x > y ? -1 : x < y;
}

// The group of a component, those before it having theirs: a cavity's is that of the smallest
// component around it.
static uint32_t choose_group(voxel_component *const *sorted, size_t index, bool inverted) {
    const voxel_component *c = sorted[index];
    if ((c->volume < 0) != inverted)
        for (size_t i = index; i-- > 0;)
            if ((sorted[i]->volume < 0) == inverted && contains(sorted[i]->box, c->box))
                return sorted[i]->group;
    bool taken[VOXEL_GROUPS] = {false};
    for (size_t i = 0; i < index; i++)
        taken[sorted[i]->group] = taken[sorted[i]->group] || overlap(sorted[i]->box, c->box);
    for (uint32_t g = 0; g < VOXEL_GROUPS - 1; g++)
        if (!taken[g]) return g;
    return VOXEL_GROUPS - 2; // crowded: these are told apart by parity alone
}

// What is open has a group of its own, the last one.
static void choose_groups(voxel_topology *t) {
    voxel_component **sorted = mem_alloc(t->component_count * sizeof *sorted);
    size_t count = 0;
    double volume = 0;
    for (size_t i = 0; i < t->component_count; i++) {
        voxel_component *c = &t->components[i];
        c->group = c->closed ? 0 : VOXEL_GROUPS - 1;
        if (!c->closed) continue;
        sorted[count++] = c;
        volume += c->volume;
    }
    qsort(sorted, count, sizeof(voxel_component *), by_volume);
    for (size_t i = 0; i < count && count <= MOST_COMPONENTS; i++)
        sorted[i]->group = choose_group(sorted, i, volume < 0);
    mem_free(sorted);
}

// ---- items ------------------------------------------------------------------------------------

// Strips that a triangle is cut into, so that threads have about the same to do: as if the mesh
// filled the box.
static uint32_t count_strips(const voxel_topology *t, const voxel_triangle *tri, uint32_t cells) {
    float widest = 0;
    for (int a = 0; a < 3; a++) {
        float p = t->points[tri->points[0]][a], q = t->points[tri->points[1]][a];
        float r = t->points[tri->points[2]][a];
        widest = fmaxf(widest, fmaxf(p, fmaxf(q, r)) - fminf(p, fminf(q, r)));
    }
    float lines = widest / t->size * (float)cells;
    return (uint32_t)clampf(ceilf(lines * lines / VOXEL_LINES), 1, VOXEL_STRIPS);
}

// 0: it plays no part.
static uint32_t flags_of(const voxel_topology *t, const voxel_triangle *tri, voxels_rule rule) {
    bool open = !t->components[tri->component].closed;
    bool shell = rule == VOXELS_SHELL || (rule == VOXELS_AUTO && (open || tri->wall));
    bool crosses = !tri->wall && rule != VOXELS_SHELL && !(rule == VOXELS_AUTO && open);
    uint32_t flags = (shell ? VOXEL_SHELL : 0) | (crosses ? VOXEL_CROSSES : 0);
    return flags ? flags | (uint32_t)half_from_float(tri->behind / t->size) << 16 : 0;
}

static void add_items(voxel_surface *s, size_t *capacity, const voxel_triangle *tri, uint32_t flags,
                      uint32_t strips) {
    MEM_RESERVE(s->items, s->item_count + strips, *capacity);
    for (uint32_t i = 0; i < strips; i++)
        s->items[s->item_count++] = (shared_uvec4){
            {tri->points[0], tri->points[1], tri->points[2], flags | (strips - 1) << 6 | i}};
}

static void add_group(voxel_surface *s, size_t *capacity, const voxel_topology *t, uint32_t group,
                      voxels_rule rule, uint32_t cells) {
    voxel_group g = {.first_item = s->item_count, .box = voxel_no_box(), .thinnest = INFINITY};
    for (size_t i = 0; i < t->triangle_count; i++) {
        const voxel_triangle *tri = &t->triangles[i];
        const voxel_component *c = &t->components[tri->component];
        uint32_t flags = c->group == group ? flags_of(t, tri, rule) : 0;
        if (!flags) continue;
        voxel_add_box(&g.box, c->box);
        g.thinnest = fminf(g.thinnest, flags & VOXEL_SHELL ? 0 : tri->behind / t->size);
        add_items(s, capacity, tri, flags, count_strips(t, tri, cells));
    }
    g.item_count = s->item_count - g.first_item;
    if (g.item_count > 0) s->groups[s->group_count++] = g;
}

void voxel_surface_create(voxel_surface *out, const mesh_data *mesh, voxels_rule rule,
                          uint32_t cells) {
    voxel_topology t;
    size_t capacity = 0;
    *out = (voxel_surface){0};
    voxel_topology_create(&t, mesh);
    choose_groups(&t);
    if (rule == VOXELS_AUTO) voxel_find_thin(&t);
    for (uint32_t g = 0; g < VOXEL_GROUPS; g++) add_group(out, &capacity, &t, g, rule, cells);
    out->box = t.box;
    out->size = t.size;
    out->point_count = t.point_count;
    out->points = mem_alloc(t.point_count * sizeof *out->points);
    for (size_t i = 0; i < t.point_count; i++)
        memcpy(out->points[i].v, t.points[i], sizeof t.points[i]);
    voxel_topology_free(&t);
}

void voxel_surface_free(voxel_surface *s) {
    mem_free(s->points);
    mem_free(s->items);
    *s = (voxel_surface){0};
}
