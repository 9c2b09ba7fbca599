// From a pass to the graph: its outputs become images, what it reads becomes edges.
#include "base/error.h"
#include "base/memory.h"
#include "pass/pass_impl.h"
#include <string.h>

graph_image pass_add_target(pass *p, const char *name, gpu_format format) {
    return graph_add_image(p->host->graph,
                           &(graph_image_desc){
                               .name = arena_format(p->host->memory, "%s.%s", p->label, name),
                               .format = format,
                               .scale = p->scale,
                               .target = true,
                           });
}

static bool declare_output(pass *p, size_t index) {
    const shader_image *image = &p->face->images[index];
    bool drawn = str_ends_with(p->shader, ".frag");
    p->images[index] = graph_add_image(
        p->host->graph, &(graph_image_desc){
                            .name = arena_format(p->host->memory, "%s.%s", p->label, image->name),
                            .format = p->formats[index],
                            .scale = p->scale,
                            .target = drawn,
                            .optional = image->optional && !drawn,
                        });
    return p->images[index].id != 0;
}

bool pass_add_output(pass *p, int name, graph_image_desc desc) {
    graph_image *image = pass_image(p, name);
    const size_t index = (size_t)(image - p->images);
    desc.format = p->formats[index];
    if (!desc.name)
        desc.name = arena_format(p->host->memory, "%s.%s", p->label, p->face->images[index].name);
    *image = graph_add_image(p->host->graph, &desc);
    return image->id != 0;
}

bool pass_declare_images(pass *p) {
    const shader_interface *face = p->face;
    for (size_t i = 0; i < face->image_count; i++)
        if (face->images[i].output && !p->images[i].id && !declare_output(p, i)) return false;
    for (size_t i = 0; i < face->image_count; i++) {
        const shader_image *image = &face->images[i];
        if (image->output || p->images[i].id) continue;
        if (image->history) {
            int output = pass_find_image(p, image->history_of);
            if (output < 0 || !face->images[output].output)
                return err_set("%s: input '%s' is the history of '%s', which is no output",
                               face->path, image->name, image->history_of);
            p->images[i] = graph_add_history(p->host->graph, p->images[output]);
        } else if (!image->optional) {
            return err_set("%s: input '%s' is missing (%s)", p->label, image->name, image->help);
        }
    }
    return true;
}

static bool record(void *user, graph *g, gpu *device) {
    (void)g;
    (void)device;
    pass *p = user;
    return p->type && p->type->record ? p->type->record(p) : pass_record(p);
}

typedef struct image_list {
    graph_image *at;
    size_t count, capacity;
} image_list;

static void list_image(image_list *list, graph_image image) {
    *MEM_ADD(list->at, list->count, list->capacity) = image;
}

static void list_grid(const pass *p, size_t index, const field_grid *grid, image_list *list) {
    for (int k = 0; k < FIELD_GRID_IMAGES; k++) {
        graph_image image = pass_grid_image(p->host, grid, k);
        if (image.id && field_samples(p->fields[index], grid, k)) list_image(list, image);
    }
}

// Grids that passes of the graph make and the pass's fields sample.
static void list_grids(const pass *p, image_list *list) {
    for (size_t i = 0; i < p->face->field_count; i++) {
        const field_grid *grids[64];
        size_t count = p->fields[i] ? field_grids(p->fields[i], grids, COUNT_OF(grids)) : 0;
        for (size_t g = 0; g < count && g < COUNT_OF(grids); g++) list_grid(p, i, grids[g], list);
    }
}

static bool add_to_graph(pass *p, const graph_image *more_reads, size_t more_read_count,
                         const graph_image *more_writes, size_t more_write_count) {
    const shader_interface *face = p->face;
    image_list reads = {0};
    size_t write_count = 0;
    graph_image *writes = mem_alloc((face->image_count + more_write_count) * sizeof *writes);
    for (size_t i = 0; i < more_write_count; i++) writes[write_count++] = more_writes[i];
    for (size_t i = 0; i < more_read_count; i++) list_image(&reads, more_reads[i]);
    for (size_t i = 0; i < face->image_count; i++) {
        if (face->images[i].output) {
            writes[write_count++] = p->images[i];
        } else {
            list_image(&reads, p->images[i]);
        }
    }
    list_grids(p, &reads);
    bool done = graph_add_pass(p->host->graph, &(graph_pass_desc){
                                                   .name = p->label,
                                                   .reads = reads.at,
                                                   .read_count = reads.count,
                                                   .writes = writes,
                                                   .write_count = write_count,
                                                   .record = record,
                                                   .user = p,
                                               });
    mem_free(reads.at);
    mem_free(writes);
    return done;
}

bool pass_add_to_graph(pass *p) {
    return pass_add_to_graph_with(p, NULL, 0);
}

bool pass_add_to_graph_with(pass *p, const graph_image *more, size_t more_count) {
    return add_to_graph(p, NULL, 0, more, more_count);
}

bool pass_add_to_graph_after(pass *p, const graph_image *more, size_t more_count) {
    return add_to_graph(p, more, more_count, NULL, 0);
}

typedef struct part_record {
    pass *p;
    bool (*record)(pass *p);
} part_record;

static bool record_part(void *user, graph *g, gpu *device) {
    (void)g;
    (void)device;
    const part_record *part = user;
    return part->record(part->p);
}

bool pass_add_part(pass *p, const pass_part *part) {
    image_list reads = {0};
    part_record *user = arena_alloc(p->host->memory, sizeof *user);
    *user = (part_record){p, part->record};
    for (size_t i = 0; i < part->read_count; i++) list_image(&reads, part->reads[i]);
    if (part->fields) list_grids(p, &reads);
    for (size_t i = 0; i < part->with_count; i++) list_grids(part->with[i], &reads);
    bool done = graph_add_pass(
        p->host->graph, &(graph_pass_desc){
                            .name = arena_format(p->host->memory, "%s.%s", p->label, part->name),
                            .reads = reads.at,
                            .read_count = reads.count,
                            .writes = part->writes,
                            .write_count = part->write_count,
                            .simulates = part->simulates,
                            .record = record_part,
                            .user = user,
                        });
    mem_free(reads.at);
    return done;
}

pass *pass_writer(const pass_host *host, graph_image image) {
    for (size_t i = 0; i < host->declared_count; i++) {
        pass *p = host->declared[i];
        for (size_t k = 0; k < p->face->image_count; k++)
            if (p->face->images[k].output && p->images[k].id == image.id) return p;
    }
    return NULL;
}

void pass_redirect(pass_host *host, graph_image from, graph_image to, const pass *but) {
    for (size_t i = 0; i < host->declared_count; i++) {
        pass *p = host->declared[i];
        for (size_t k = 0; k < p->face->image_count && p != but; k++)
            if (!p->face->images[k].output && p->images[k].id == from.id) p->images[k] = to;
    }
    graph_redirect(host->graph, from, to, but->label);
}

// `seen`: passes of the host that were looked at.
static bool follows(const pass *p, graph_image image, bool *seen) {
    const pass_host *host = p->host;
    for (size_t i = 0; i < p->face->image_count; i++) {
        const shader_image *declared = &p->face->images[i];
        if (declared->output || declared->history || !p->images[i].id) continue;
        if (p->images[i].id == image.id) return true;
        const pass *writer = pass_writer(host, p->images[i]);
        size_t k = 0;
        while (k < host->declared_count && host->declared[k] != writer) k++;
        if (k == host->declared_count || seen[k]) continue;
        seen[k] = true;
        if (follows(writer, image, seen)) return true;
    }
    return false;
}

bool pass_follows(const pass *p, graph_image image) {
    bool *seen = mem_alloc((p->host->declared_count + 1) * sizeof *seen);
    bool found = follows(p, image, seen);
    mem_free(seen);
    return found;
}

bool pass_declare(pass *p) {
    const shader_interface *face = p->face;
    pass_host *host = p->host;
    *MEM_ADD(host->declared, host->declared_count, host->declared_capacity) = p;
    if (p->host->before_declare && !p->host->before_declare(p->host->user, p)) return false;
    for (size_t i = 0; i < face->field_count; i++)
        if (face->fields[i].required && !p->fields[i])
            return err_set("%s: field '%s' is missing (%s)", p->label, face->fields[i].name,
                           face->fields[i].help);
    for (size_t i = 0; i < PASS_PROVIDERS; i++)
        if (pass_providers[i]->find && !pass_providers[i]->find(p)) return false;
    if (p->type && p->type->declare) return p->type->declare(p);
    if (p->type && p->type->runs_inside) return true;
    return pass_declare_images(p) && pass_add_to_graph(p);
}

bool pass_complete(pass *p) {
    if (p->completed) return true;
    p->completed = true;
    return !p->type || !p->type->complete || p->type->complete(p) || pass_locate_error(p);
}

void pass_host_add_grid_image(pass_host *host, const field_grid *grid, int index,
                              graph_image image) {
    *MEM_ADD(host->grid_images, host->grid_image_count, host->grid_image_capacity) =
        (pass_grid){grid, index, image};
}

graph_image pass_grid_image(const pass_host *host, const field_grid *grid, int index) {
    for (size_t i = 0; i < host->grid_image_count; i++)
        if (host->grid_images[i].grid == grid && host->grid_images[i].index == index)
            return host->grid_images[i].image;
    return (graph_image){0};
}
