// Making a pass and setting what it takes: every name is looked up in the shader's own
// declarations, so that built-in passes and a user's shader behave alike.
#include "base/error.h"
#include "base/memory.h"
#include "base/words.h"
#include "pass/pass_impl.h"
#include <stdio.h>
#include <string.h>

pass *pass_create(pass_host *host, const pass_type *type, const char *shader, const char *label) {
    const char *file = type ? type->shader : shader;
    const shader_interface *face =
        shader_interface_load(host->library, host->memory, file, host->reader);
    if (!face) return NULL;
    arena *memory = host->memory;
    pass *p = arena_alloc(memory, sizeof *p);
    *p = (pass){
        .host = host,
        .type = type,
        .label = arena_string(memory, label),
        .place = "",
        .shader = arena_string(memory, file),
        .face = face,
        .uniforms = arena_alloc(memory, face->uniform_count * sizeof *p->uniforms),
        .warned = arena_alloc(memory, face->uniform_count * sizeof *p->warned),
        .options = arena_alloc(memory, face->option_count * sizeof *p->options),
        .chosen = arena_alloc(memory, face->option_count * sizeof *p->chosen),
        .fields = arena_alloc(memory, face->field_count * sizeof *p->fields),
        .images = arena_alloc(memory, face->image_count * sizeof *p->images),
        .formats = arena_alloc(memory, face->image_count * sizeof *p->formats),
        .unread = arena_alloc(memory, face->image_count * sizeof(gpu_image *)),
        .scale = 1,
    };
    pass_find_names(p);
    for (size_t i = 0; i < face->option_count; i++)
        p->options[i] = (size_t)face->options[i].value[0];
    for (size_t i = 0; i < face->image_count; i++) p->formats[i] = face->images[i].format;
    return p;
}

void pass_set_place(pass *p, const char *place) {
    p->place = arena_string(p->host->memory, place);
}

bool pass_locate_error(const pass *p) {
    return !str_has_place(err_get()) && err_prefix("%s", p->place);
}

const char *pass_label(const pass *p) {
    return p->label;
}

const pass *pass_runner(const pass *p) {
    return p->runs_in ? p->runs_in : p;
}

bool pass_is(const pass *p, const char *type) {
    return p->type && strcmp(p->type->name, type) == 0;
}
const shader_interface *pass_interface(const pass *p) {
    return p->face;
}
size_t pass_get_option(const pass *p, size_t index) {
    return p->options[index];
}
bool pass_is_scaled(const pass *p) {
    return !p->type || !p->type->unscaled;
}
float pass_get_scale(const pass *p) {
    return p->scale;
}

const field *pass_get_uniform(const pass *p, size_t index) {
    return p->uniforms[index];
}

const field *pass_get_field(const pass *p, size_t index) {
    return p->fields[index];
}

// ---- names ------------------------------------------------------------------------------------

pass_key pass_find_key(const pass *p, const char *name, size_t *index) {
    const shader_interface *face = p->face;
    for (*index = 0; *index < face->uniform_count; ++*index)
        if (strcmp(face->uniforms[*index].name, name) == 0) return PASS_UNIFORM;
    for (*index = 0; *index < face->option_count; ++*index)
        if (strcmp(face->options[*index].name, name) == 0) return PASS_OPTION;
    for (*index = 0; *index < face->field_count; ++*index)
        if (strcmp(face->fields[*index].name, name) == 0) return PASS_FIELD;
    for (*index = 0; *index < face->image_count; ++*index)
        if (!face->images[*index].output && strcmp(face->images[*index].name, name) == 0)
            return PASS_IMAGE;
    return PASS_UNKNOWN;
}

size_t pass_most_keys(const pass *p) {
    const shader_interface *face = p->face;
    return face->uniform_count + face->option_count + face->field_count + face->image_count;
}

size_t pass_list_keys(const pass *p, const char **out) {
    const shader_interface *face = p->face;
    size_t count = 0;
    for (size_t i = 0; i < face->uniform_count; i++) out[count++] = face->uniforms[i].name;
    for (size_t i = 0; i < face->option_count; i++) out[count++] = face->options[i].name;
    for (size_t i = 0; i < face->field_count; i++) out[count++] = face->fields[i].name;
    for (size_t i = 0; i < face->image_count; i++)
        if (!face->images[i].output) out[count++] = face->images[i].name;
    return count;
}

// "march: unknown uniform 'stepz'; did you mean 'steps'?" over all names of the pass.
static bool unknown(const pass *p, const char *what, const char *name) {
    const char **names = mem_alloc((pass_most_keys(p) + 1) * sizeof *names);
    size_t count = pass_list_keys(p, names);
    names[count++] = "resolution";
    words_refuse(names, count, name, NULL, "%s: unknown %s '%s'", p->label, what, name);
    mem_free(names);
    return false;
}

// ---- setting ----------------------------------------------------------------------------------

bool pass_set_uniform(pass *p, const char *name, const field *value) {
    size_t index;
    if (pass_find_key(p, name, &index) != PASS_UNIFORM) return unknown(p, "uniform", name);
    const value_desc *uniform = &p->face->uniforms[index];
    if (!value->uniform) return err_set("%s: uniform '%s' must not vary in space", p->label, name);
    int wanted = uniform->components;
    bool fits = value->components == wanted || value->components == 1 ||
                (wanted == 3 && value->components == 4) || (wanted == 2 && value->components == 3);
    if (!fits)
        return err_set("%s: uniform '%s' takes %d component%s, not %d", p->label, name, wanted,
                       wanted == 1 ? "" : "s", value->components);
    int count = value->components < wanted ? value->components : wanted;
    int wrong = field_is_constant(value) ? value_find_wrong(uniform, value->value, count) : -1;
    if (wrong >= 0)
        return value_refuse(uniform, value->value[wrong], "%s: uniform '%s'", p->label, name);
    p->uniforms[index] = value;
    return true;
}

const field **pass_uniform_slot(pass *p, size_t index) {
    return &p->uniforms[index];
}

bool pass_refuse_uniform(const pass *p, const char *name) {
    return unknown(p, "uniform", name);
}

bool pass_set_option(pass *p, const char *name, const char *word) {
    size_t index;
    if (pass_find_key(p, name, &index) != PASS_OPTION) return unknown(p, "option", name);
    const value_desc *option = &p->face->options[index];
    float value[4];
    char who[192];
    snprintf(who, sizeof who, "%s: option '%s'", p->label, name);
    if (!value_parse(option, who, word, value)) return false;
    p->options[index] = (size_t)value[0];
    p->chosen[index] = true;
    return true;
}

const char *pass_word(const pass *p, const char *option) {
    size_t index;
    if (pass_find_key(p, option, &index) != PASS_OPTION) return "";
    return p->face->options[index].words[p->options[index]];
}

bool pass_has_word(const pass *p, const char *option, const char *word) {
    return strcmp(pass_word(p, option), word) == 0;
}

const char *pass_most_threads(const pass *p) {
    uint32_t most = gpu_get_profile(p->host->device)->limits.group_threads;
    return most >= 512 ? "512" : most >= 256 ? "256" : "128"; // the least of any device
}

bool pass_set_field(pass *p, const char *name, const field *value) {
    size_t index;
    if (pass_find_key(p, name, &index) != PASS_FIELD) return unknown(p, "field", name);
    const shader_field *slot = &p->face->fields[index];
    bool fits = value->components == slot->components || value->components == 1 ||
                (slot->components == 3 && value->components == 4);
    if (!fits)
        return err_set("%s: field '%s' has %d components, not %d", p->label, name, slot->components,
                       value->components);
    p->fields[index] = value;
    return true;
}

bool pass_set_image(pass *p, const char *name, graph_image image) {
    size_t index;
    if (pass_find_key(p, name, &index) != PASS_IMAGE) return unknown(p, "input", name);
    bool volume = graph_get_desc(p->host->graph, image)->depth > 0;
    if (volume != p->face->images[index].volume)
        return err_set("%s: input '%s' takes a %dD image", p->label, name, volume ? 2 : 3);
    p->images[index] = image;
    return true;
}

const value_desc pass_scale_desc = {"resolution",
                                    .components = 1,
                                    .value = {1},
                                    .min = 0.001f,
                                    .max = 1,
                                    .unit = "",
                                    .help = "size of its outputs relative to the picture"};

bool pass_set_scale(pass *p, float scale) {
    if (value_find_wrong(&pass_scale_desc, &scale, 1) >= 0)
        return value_refuse(&pass_scale_desc, scale, "%s: resolution", p->label);
    if (!p->stands_for) p->scale = scale;
    return true;
}

int pass_find_image(const pass *p, const char *name) {
    for (size_t i = 0; i < p->face->image_count; i++)
        if (strcmp(p->face->images[i].name, name) == 0) return (int)i;
    return -1;
}

bool pass_set_format(pass *p, const char *output, gpu_format format) {
    int index = pass_find_image(p, output);
    if (index < 0 || !p->face->images[index].output)
        return err_set("%s: no output '%s'", p->label, output);
    p->formats[index] = format;
    return true;
}

bool pass_add_mesh(pass *p, scene_mesh *mesh) {
    if (!p->type || p->type->meshes == PASS_REFUSES_MESHES)
        return err_set("%s: takes no meshes; pass them to geometry", p->label);
    *MEM_ADD(p->meshes, p->mesh_count, p->mesh_capacity) = mesh;
    return true;
}

// As shapes each is a mesh by itself, of the kind that it begins as.
static bool add_shapes(pass *p, const scene_instances *instances) {
    for (uint32_t i = 0; i < scene_instances_count(instances); i++) {
        scene_mesh *mesh = scene_instances_mesh(instances, i, p->host->memory);
        if (mesh && !pass_add_mesh(p, mesh)) return false;
    }
    return true;
}

bool pass_add_instances(pass *p, scene_instances *instances) {
    if (!p->type || p->type->meshes == PASS_REFUSES_MESHES)
        return err_set("%s: takes no instances; pass them to geometry", p->label);
    if (!pass_draws_meshes(p)) return add_shapes(p, instances);
    *MEM_ADD(p->instances, p->instances_count, p->instances_capacity) = instances;
    return true;
}

bool pass_draws_meshes(const pass *p) {
    return p->type && p->type->meshes == PASS_DRAWS_MESHES;
}

const pass_simulation *pass_get_simulation(const pass *p) {
    return p->type ? p->type->simulation : NULL;
}

size_t pass_meshes(const pass *p, scene_mesh *const **out) {
    *out = p->meshes;
    return p->mesh_count;
}

size_t pass_instances(const pass *p, scene_instances *const **out) {
    *out = p->instances;
    return p->instances_count;
}

graph_image pass_input(const pass *p, const char *name) {
    int index = pass_find_image(p, name);
    return index >= 0 && !p->face->images[index].output ? p->images[index] : (graph_image){0};
}

graph_image pass_output(const pass *p, const char *name) {
    int index = pass_find_image(p, name);
    return index >= 0 && p->face->images[index].output ? p->images[index] : (graph_image){0};
}
