// Collects the triangles of one frame of the interface for roil_show.
#include "base/memory.h"
#include "ui/parts.h"
#include <string.h>

static struct {
    roil_vertex *vertices;
    uint32_t *indices;
    roil_draw *draws;
    size_t vertex_count, index_count, draw_count;
    size_t vertex_capacity, index_capacity, draw_capacity;
} held;

void picture_begin(void) {
    held.vertex_count = held.index_count = held.draw_count = 0;
}

size_t picture_vertices(const roil_vertex *vertices, size_t count) {
    size_t first = held.vertex_count;
    MEM_RESERVE(held.vertices, first + count, held.vertex_capacity);
    if (count) memcpy(held.vertices + first, vertices, count * sizeof *vertices);
    held.vertex_count += count;
    return first;
}

void picture_draw(const roil_texture *texture, const float clip[4], const uint16_t *indices,
                  size_t count, size_t first_vertex) {
    if (!count) return;
    MEM_RESERVE(held.indices, held.index_count + count, held.index_capacity);
    roil_draw *draw = MEM_ADD(held.draws, held.draw_count, held.draw_capacity);
    *draw = (roil_draw){texture, (uint32_t)held.index_count, (uint32_t)count, {0}};
    memcpy(draw->clip, clip, sizeof draw->clip);
    for (size_t i = 0; i < count; i++)
        held.indices[held.index_count++] = (uint32_t)first_vertex + indices[i];
}

void picture_end(roil_picture *out) {
    out->vertices = held.vertices;
    out->indices = held.indices;
    out->draws = held.draws;
    out->vertex_count = held.vertex_count;
    out->index_count = held.index_count;
    out->draw_count = held.draw_count;
}

void picture_free(void) {
    mem_free(held.vertices);
    mem_free(held.indices);
    mem_free(held.draws);
    memset(&held, 0, sizeof held);
}
