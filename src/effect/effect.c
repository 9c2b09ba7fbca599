// Declarations of an effect: checks and stores what the script declares.
#include "effect/effect.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/time_limit.h"
#include "effect/effect_impl.h"
#include "media/picture.h"
#include "media/texture.h"
#include "scene/bvh.h"
#include "scene/sky_image.h"
#include <math.h>
#include <string.h>
#include <unistd.h>

// Several threads may call it, since shaders of several passes are read in parallel.
static void add_read_file(void *user, const char *path) {
    effect *e = user;
    pthread_mutex_lock(&e->reading);
    effect_add_file(e, path);
    pthread_mutex_unlock(&e->reading);
}

effect *effect_create(const effect_desc *desc) {
    effect *e = mem_alloc(sizeof *e);
    char folder[PATH_CAP], shader_cache[PATH_CAP];
    pthread_mutex_init(&e->reading, NULL);
    path_folder(folder, desc->file);
    e->device = desc->device;
    e->reference = desc->reference;
    e->never_waits = desc->never_waits;
    e->facts.seconds = desc->seconds > 0 ? desc->seconds : TIME_LIMIT_LOAD_SECONDS;
    e->facts.file = arena_string(&e->memory, desc->file);
    e->facts.inside = desc->inside ? arena_string(&e->memory, desc->inside) : NULL;
    e->facts.bundle = desc->bundle ? arena_string(&e->memory, desc->bundle) : NULL;
    e->facts.source = desc->bundle ? e->facts.bundle : e->facts.file;
    e->facts.root = e->roots[e->root_count++] = arena_string(&e->memory, folder);
    for (size_t i = 0; i < desc->asset_count; i++)
        e->roots[e->root_count++] = arena_string(&e->memory, desc->assets[i]);
    e->facts.name = arena_string(&e->memory, path_name(desc->file));
    e->facts.fps = 24;
    e->updated = e->partly = (double)NAN;
    e->facts.frames = 1;
    e->facts.first = 1;
    scene_init(&e->scene, &e->memory);
    e->contents = desc->contents ? desc->contents : (e->own_contents = content_cache_create());
    e->library = desc->library;
    if (!e->library) {
        bool cached = desc->cache_dir && path_join(shader_cache, desc->cache_dir, "spirv");
        e->library = e->own_library = shader_library_create(&(shader_library_desc){
            .shader_root = desc->shader_root,
            .effect_root = e->roots[0],
            .assets = desc->assets,
            .asset_count = desc->asset_count,
            .cache_dir = cached ? shader_cache : NULL,
            .remembers = true,
        });
    }
    if (!e->library) {
        effect_destroy(e);
        return NULL;
    }
    shader_library_forget(e->library);
    e->graph = graph_create();
    e->reader = (shader_reader){add_read_file, e};
    e->host = (pass_host){
        .device = e->device,
        .library = e->library,
        .graph = e->graph,
        .memory = &e->memory,
        .context = &e->context,
        .frame = &e->frame,
        .lights = &e->lights,
        .scene = &e->scene,
        .counters = desc->counters,
        .interaction = desc->interaction,
        .reader = &e->reader,
        .before_declare = effect_apply_settings,
        .user = e,
    };
    effect_copy_settings(e, desc->settings, desc->setting_count);
    effect_add_file(e, desc->file);
    if (desc->project) effect_add_file(e, desc->project);
    return e;
}

void effect_destroy(effect *e) {
    if (!e) return;
    effect_free_snapshots(&e->snapshots);
    mem_free(e->ahead_times);
    if (e->probe) pass_destroy(e->probe);
    for (size_t i = 0; i < e->pass_count; i++) pass_destroy(e->passes[i]);
    for (size_t i = 0; i < e->grid_count; i++)
        if (e->grids[i]->destroy) e->grids[i]->destroy(e->grids[i], e->device);
    for (size_t i = 0; i < e->mesh_count; i++) scene_mesh_destroy(e->meshes[i], e->device);
    for (size_t i = 0; i < e->instances_count; i++)
        scene_instances_destroy(e->instances[i], e->device);
    scene_bvh_destroy(e->host.bvh, e->device);
    if (e->sky) sky_image_destroy(e->sky, e->device);
    if (e->graph) graph_destroy(e->graph, e->device);
    if (e->hooks.destroy) e->hooks.destroy(e->hooks.user);
    shader_library_destroy(e->own_library);
    pass_host_free(&e->host);
    effect_free_systems(e);
    effect_free_clocks(e);
    pthread_mutex_destroy(&e->reading);
    mem_free(e->params);
    mem_free(e->values);
    mem_free(e->passes);
    mem_free(e->grids);
    for (size_t i = 0; i < e->held_count; i++) content_cache_release(e->contents, e->held[i]);
    content_cache_destroy(e->own_contents);
    mem_free(e->held);
    mem_free(e->meshes);
    mem_free(e->materials);
    mem_free(e->nodes);
    mem_free(e->shapes);
    mem_free(e->layers);
    mem_free(e->instances);
    mem_free(e->files);
    mem_free(e->places);
    arena_free(&e->memory);
    mem_free(e);
}

arena *effect_memory(effect *e) {
    return &e->memory;
}

const effect_facts *effect_get_facts(const effect *e) {
    return &e->facts;
}

size_t effect_roots(const effect *e, const char *const **out) {
    *out = e->roots;
    return e->root_count;
}

bool effect_draws(const effect *e) {
    return e->device != NULL;
}

scene *effect_scene(effect *e) {
    return &e->scene;
}
pass_host *effect_pass_host(effect *e) {
    return &e->host;
}
size_t effect_pass_count(const effect *e) {
    return e->pass_count;
}
pass *effect_get_pass(effect *e, size_t index) {
    return e->passes[index];
}
graph *effect_graph(effect *e) {
    return e->graph;
}
content_cache *effect_content_cache(effect *e) {
    return e->contents;
}
shader_library *effect_library(effect *e) {
    return e->library;
}

void effect_set_name(effect *e, const char *name) {
    e->facts.name = arena_string(&e->memory, name);
}
void effect_set_author(effect *e, const char *author, const char *licence) {
    e->facts.author = author ? arena_string(&e->memory, author) : NULL;
    e->facts.licence = licence ? arena_string(&e->memory, licence) : NULL;
}
void effect_set_seed(effect *e, uint32_t seed) {
    e->seed = seed;
}

bool effect_set_timeline(effect *e, double fps, uint32_t frames, uint32_t first) {
    if (!(fps > 0 && fps <= 1000)) return err_set("fps is %g; accepted: above 0, up to 1000", fps);
    if (frames < 1 || frames > 1000000)
        return err_set("frames is %u; accepted: 1 to 1000000", frames);
    e->facts.fps = fps;
    e->facts.frames = frames;
    e->facts.first = first;
    return true;
}

void effect_set_hooks(effect *e, const effect_hooks *hooks) {
    e->hooks = *hooks;
    e->context.call = hooks->call;
    e->context.user = hooks->user;
}

void effect_add_file(effect *e, const char *path) {
    char here[PATH_CAP], whole[PATH_CAP];
    if (path[0] != '/' && getcwd(here, sizeof here) && path_join(whole, here, path)) path = whole;
    for (size_t i = 0; i < e->file_count; i++)
        if (strcmp(e->files[i], path) == 0) return;
    *MEM_ADD(e->files, e->file_count, e->file_capacity) = arena_string(&e->memory, path);
}

const char *effect_find_file(effect *e, const char *name, char path[PATH_CAP]) {
    const char *root = path_find(path, e->roots, e->root_count, name);
    if (root) {
        effect_add_file(e, path);
        return root;
    }
    char why[512];
    str_copy(why, sizeof why, err_get());
    return ERR_NULL(
        "%s. Put a copy there, or give its folder as --assets DIR and here its name in that "
        "folder",
        why);
}

size_t effect_files(const effect *e, const char *const **out) {
    *out = e->files;
    return e->file_count;
}

// ---- passes -----------------------------------------------------------------------------------

static bool label_taken(const effect *e, const char *label) {
    for (size_t i = 0; i < e->pass_count; i++)
        if (strcmp(pass_label(e->passes[i]), label) == 0) return true;
    return false;
}

// Makes "march", then "march_2", ...; for a shader file, from its name without the extension.
static const char *make_label(effect *e, const char *stem) {
    int length = (int)strcspn(stem, ".");
    const char *label = arena_format(&e->memory, "%.*s", length, stem);
    for (int i = 2; label_taken(e, label); i++)
        label = arena_format(&e->memory, "%.*s_%d", length, stem, i);
    return label;
}

// Makes a reference in place of a march. The other passes also run in each execution, which
// therefore computes several samples, but not so many that one takes long.
static pass *make_reference(effect *e, const pass_type *march, const char *label) {
    pass *p = pass_create(&e->host, pass_type_find("reference"), NULL, label);
    uint32_t samples = 8;
    while (e->reference % samples != 0) samples--;
    const field *each = field_constant(&e->memory, 1, (float[4]){(float)samples});
    return p && pass_stand_for(p, march) && pass_set_uniform(p, "samples", each) ? p : NULL;
}

pass *effect_add_pass(effect *e, const char *type, const char *shader, const char *label) {
    bool traced = e->reference && type && strcmp(type, "march") == 0;
    const pass_type *known = type ? pass_type_find(type) : NULL;
    if (type && !known) return NULL;
    if (label && (!str_is_identifier(label) || label_taken(e, label)))
        return ERR_NULL("pass name '%s' %s", label,
                        label_taken(e, label) ? "is taken"
                                              : "is not a name (letters, digits and _)");
    if (!label) label = make_label(e, type ? type : path_name(shader));
    pass *p =
        traced ? make_reference(e, known, label) : pass_create(&e->host, known, shader, label);
    if (!p) return NULL;
    char place[96] = "";
    if (e->hooks.locate) e->hooks.locate(e->hooks.user, place, sizeof place);
    pass_set_place(p, place);
    *MEM_ADD(e->passes, e->pass_count, e->pass_capacity) = p;
    return p;
}

void effect_add_grid(effect *e, field_grid *grid) {
    *MEM_ADD(e->grids, e->grid_count, e->grid_capacity) = grid;
    grid->never_waits = e->never_waits;
}

static bool grid_named(const effect *e, const char *name) {
    for (size_t i = 0; i < e->grid_count; i++)
        if (e->grids[i]->label && strcmp(e->grids[i]->label, name) == 0) return true;
    return false;
}

void effect_name_grid(effect *e, field_grid *grid, const char *name) {
    const char *free = name;
    for (int i = 2; grid_named(e, free); i++) free = arena_format(&e->memory, "%s_%d", name, i);
    grid->label = arena_string(&e->memory, free);
}

// ---- scene and outputs ------------------------------------------------------------------------

// The load of a file whose content loads of the same effect share.
typedef struct shared_load {
    const char *path, *root;
    uint32_t side_max;        // of a picture, in pixels
    arena *memory;            // for what is made of the file
    const char *const *files; // all files that were read; before the load, the file alone
    size_t file_count;
} shared_load;

typedef const void *loader(shared_load *load); // NULL with a message

// Returns what is cached under the key, or else loaded now; NULL with a message.
static const void *load_shared(effect *e, const char *key, const char *root, const char *path,
                               uint32_t side_max, loader *read) {
    content_cache_item *item = content_cache_take(e->contents, key);
    if (!item) {
        arena memory = {0};
        shared_load load = {path, root, side_max, &memory, &path, 1};
        int64_t begin = file_clock_ns();
        const void *data = read(&load);
        if (!data) {
            arena_free(&memory);
            return NULL;
        }
        item =
            content_cache_put(e->contents, key, data, memory, load.files, load.file_count, begin);
    }
    *MEM_ADD(e->held, e->held_count, e->held_capacity) = item;
    return item->data;
}

static const void *load_mesh(shared_load *l) {
    mesh_data *data = arena_alloc(l->memory, sizeof *data);
    if (!mesh_load(l->path, l->root, l->memory, data)) return NULL;
    l->files = data->files;
    l->file_count = data->file_count;
    return data;
}

scene_mesh *effect_add_mesh(effect *e, const char *file) {
    char path[PATH_CAP];
    arena *memory = &e->memory;
    const char *root = effect_find_file(e, file, path);
    if (!root) return NULL;
    const mesh_data *data = load_shared(e, path, root, path, 0, load_mesh);
    if (!data) return NULL;
    scene_mesh *mesh = arena_alloc(memory, sizeof *mesh);
    mesh->data = *data;
    for (size_t i = 0; i < mesh->data.file_count; i++) effect_add_file(e, mesh->data.files[i]);
    mesh->name = arena_string(memory, file);
    scene_set_defaults(scene_mesh_values, SCENE_ALL, mesh, memory);
    *MEM_ADD(e->meshes, e->mesh_count, e->mesh_capacity) = mesh;
    return mesh;
}

scene_instances *effect_add_instances(effect *e, const scene_instances_desc *desc) {
    size_t all = desc->count;
    for (size_t i = 0; i < e->instances_count; i++) all += scene_instances_count(e->instances[i]);
    if (all > SCENE_INSTANCES_ALL) {
        err_set("%s: with these there are %zu instances; at most %d are possible", desc->name, all,
                SCENE_INSTANCES_ALL);
        return NULL;
    }
    MEM_RESERVE(e->instances, e->instances_count + 1, e->instances_capacity);
    return e->instances[e->instances_count++] = scene_instances_create(desc);
}

void effect_reset_instances(effect *e) {
    for (size_t i = 0; i < e->instances_count; i++) scene_instances_reset(e->instances[i]);
}

void effect_add_node(effect *e, scene_node *node) {
    *MEM_ADD(e->nodes, e->node_count, e->node_capacity) = node;
}

void effect_add_material(effect *e, scene_material *material) {
    *MEM_ADD(e->materials, e->material_count, e->material_capacity) = material;
}

static const void *load_texture(shared_load *l) {
    mesh_texture *texture = arena_alloc(l->memory, sizeof *texture);
    return texture_read_inside(l->root, l->path, l->memory, texture) ? texture : NULL;
}

const mesh_texture *effect_add_texture(effect *e, const char *file) {
    char path[PATH_CAP];
    const char *root = effect_find_file(e, file, path);
    if (!root) return NULL;
    const char *key = arena_format(&e->memory, "texture %s", path);
    return load_shared(e, key, root, path, 0, load_texture);
}

static const void *load_sky(shared_load *l) {
    return sky_image_load(l->path, l->root, l->memory);
}

const sky_image *effect_add_sky_image(effect *e, const char *file) {
    char path[PATH_CAP];
    const char *root = effect_find_file(e, file, path);
    if (!root) return NULL;
    if (e->sky && strcmp(e->sky_file, path) == 0) return e->sky;
    if (e->sky) {
        err_set("%s: a second image for the sky; an effect has one", file);
        return NULL;
    }
    const sky_image *image = load_shared(e, path, root, path, 0, load_sky);
    e->sky = image ? sky_image_share(image, &e->memory) : NULL;
    e->sky_file = arena_string(&e->memory, path);
    return e->sky;
}

static const void *load_picture(shared_load *l) {
    picture *data = arena_alloc(l->memory, sizeof *data);
    return picture_read(l->path, l->root, l->side_max, l->memory, data) ? data : NULL;
}

const picture *effect_read_picture(effect *e, const char *file, uint32_t side_max) {
    char path[PATH_CAP];
    const char *root = effect_find_file(e, file, path);
    if (!root) return NULL;
    const char *key = arena_format(&e->memory, "picture up to %u: %s", side_max, path);
    return load_shared(e, key, root, path, side_max, load_picture);
}

bool effect_set_picture(effect *e, effect_picture which, graph_image image) {
    if (graph_get_desc(e->graph, image)->depth) return err_set("the picture of an effect is 2D");
    e->pictures[which] = image;
    return true;
}

graph_image effect_get_picture(const effect *e, effect_picture which) {
    return e->unseen ? (graph_image){0} : e->pictures[which];
}
