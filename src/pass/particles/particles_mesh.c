// Places on a mesh's surface, evenly over its area: an alias table of its triangles (Walker, "An
// efficient method for generating discrete random variables with general distributions", 1977),
// made as in Vose, "A linear algorithm for generating random numbers with a given distribution",
// 1991: a choice costs the same whatever the areas.
#include "base/error.h"
#include "base/memory.h"
#include "pass/particles/particles_parts.h"

static double area_of(const particles_triangle *t) {
    vec3 across;
    glm_vec3_cross((float *)(uintptr_t)t->first, (float *)(uintptr_t)t->second, across);
    return 0.5 * (double)glm_vec3_norm(across);
}

static uint32_t list(const mesh_data *mesh, particles_triangle *out) {
    uint32_t count = 0;
    for (uint32_t i = 0; i + 2 < mesh->index_count; i += 3) {
        const float *corners[3];
        for (int k = 0; k < 3; k++) corners[k] = mesh->vertices[mesh->indices[i + k]].position;
        particles_triangle *t = &out[count];
        *t = (particles_triangle){.chance = 1, .other = count};
        for (int k = 0; k < 3; k++) {
            t->corner[k] = corners[0][k];
            t->first[k] = corners[1][k] - corners[0][k];
            t->second[k] = corners[2][k] - corners[0][k];
        }
        if (area_of(t) > 0) count++;
    }
    return count;
}

// Those that are chosen too often as they are give the rest to those that are too seldom.
static void balance(particles_triangle *out, double *share, uint32_t *stack, uint32_t count) {
    uint32_t small = 0, large = count; // the stack has the small ones below, the large ones above
    for (uint32_t i = 0; i < count; i++)
        if (share[i] < 1)
            stack[small++] = i;
        else
            stack[--large] = i;
    while (small > 0 && large < count) {
        uint32_t few = stack[--small], many = stack[large];
        out[few].chance = (float)share[few];
        out[few].other = many;
        share[many] -= 1 - share[few];
        if (share[many] >= 1) continue;
        large++;
        stack[small++] = many;
    }
}

uint32_t particles_list_triangles(const mesh_data *mesh, particles_triangle *out) {
    uint32_t count = list(mesh, out);
    double *share = mem_alloc((count + 1) * sizeof *share), sum = 0;
    uint32_t *stack = mem_alloc((count + 1) * sizeof *stack);
    for (uint32_t i = 0; i < count; i++) sum += share[i] = area_of(&out[i]);
    for (uint32_t i = 0; i < count; i++) share[i] *= count / sum;
    balance(out, share, stack, count);
    mem_free(share);
    mem_free(stack);
    if (!count) err_set("its triangles have no area");
    return count;
}
