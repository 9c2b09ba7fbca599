// Loads a mesh. Assimp reads the file in the reader (mesh_import). This side trusts nothing that
// comes back: it checks every length, index and number, and has the textures read.
#include "media/mesh.h"
#include "base/error.h"
#include "base/file.h"
#include "base/isolate.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/str.h"
#include "media/mesh_import.h"
#include "media/texture.h"
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { TEXEL_SIDE_MAX = 16384, MESH_FILES_MAX = 256 };
static const size_t FILE_BYTES_MAX = (size_t)64 << 20;
// Beyond this, areas and dot products overflow.
static const float POSITION_MAX = 1e18f;
static const float MESH_EMISSION_MAX = 1e4f; // that a half float holds several times over

// Whole files below one folder. The importer names them, and this process opens them. Names are
// first normalised as text ("a/../b" becomes "b", '\' becomes '/'), so that a name that leaves the
// root is refused before the file system is asked. path_confine then follows symbolic links.
typedef struct mesh_files {
    char root[PATH_CAP];  // resolved
    char first[PATH_CAP]; // the mesh as assimp names it: "./" and its path below `root`
    arena *memory;        // holds `opened`
    const char *opened[MESH_FILES_MAX]; // resolved paths of all files read
    size_t opened_count;
    char refused[512]; // why a file outside `root` was refused; "" when none was
} mesh_files;

typedef struct loader {
    const char *path;
    mesh_files files;
    arena *memory;
    const uint8_t *bytes; // of the blob
    size_t size, at;
} loader;

// ---- files that a mesh may read ---------------------------------------------------------------

static bool mesh_files_open(mesh_files *f, const char *path, const char *root, arena *memory) {
    *f = (mesh_files){.memory = memory};
    char real[PATH_MAX];
    if (!realpath(root, real)) return err_set("%s: %s", root, strerror(errno));
    if (!str_copy(f->root, sizeof f->root, real)) return err_set("%s: path too long", root);
    if (!realpath(path, real)) return err_set("%s: cannot be read: %s", path, strerror(errno));
    size_t length = strlen(f->root);
    bool inside = strncmp(real, f->root, length) == 0;
    if (inside && f->root[length - 1] != '/') inside = real[length] == '/';
    if (!inside) return err_set("%s: lies outside %s", path, root);
    const char *relative = real + length;
    while (*relative == '/') relative++;
    int written = snprintf(f->first, sizeof f->first, "./%s", relative);
    return written < (int)sizeof f->first || err_set("%s: path too long", path);
}

// Appends the parts of `name` to `out`, which stays relative. False when ".." leaves it.
static bool make_plain(const char *name, char out[PATH_CAP]) {
    size_t length = 0;
    out[0] = '\0';
    if (name[0] == '/' || name[0] == '\\') return false;
    while (*name) {
        size_t part = strcspn(name, "/\\");
        if (part == 2 && name[0] == '.' && name[1] == '.') {
            if (length == 0) return false;
            while (length > 0 && out[--length] != '/') {
            }
        } else if (part > 0 && !(part == 1 && name[0] == '.')) {
            if (length + part + 2 > PATH_CAP) return false;
            if (length > 0) out[length++] = '/';
            memcpy(out + length, name, part);
            length += part;
        }
        out[length] = '\0';
        name += part;
        if (*name) name++;
    }
    return length > 0;
}

static bool resolve_name(mesh_files *f, const char *name, char out[PATH_CAP]) {
    char plain[PATH_CAP];
    if (!make_plain(name, plain))
        err_set("%s: leads out of %s", name, f->root);
    else if (path_confine(out, f->root, plain))
        return true;
    if (!f->refused[0]) str_copy(f->refused, sizeof f->refused, err_get());
    return false;
}

static void mesh_files_note(mesh_files *f, const char *path) { // adds it to `opened`
    for (size_t i = 0; i < f->opened_count; i++)
        if (strcmp(f->opened[i], path) == 0) return;
    if (f->opened_count < MESH_FILES_MAX)
        f->opened[f->opened_count++] = arena_string(f->memory, path);
}

// Opens a file for the importer, by a name below the root: `open` of an isolate_job, whose user is
// a mesh_files. -1, and a reason in `refused`, when the name leads out of the root.
static int mesh_files_give(void *files, const char *name, size_t *size) {
    mesh_files *f = files;
    char path[PATH_CAP];
    if (!resolve_name(f, name, path)) return -1;
    int file = file_open_inside(f->root, path, FILE_BYTES_MAX, size);
    if (file >= 0) mesh_files_note(f, path);
    return file;
}

// Resolves a name relative to the mesh's folder, as materials have them.
static bool mesh_files_resolve_beside(mesh_files *f, const char *name, char out[PATH_CAP]) {
    char folder[PATH_CAP], joined[PATH_CAP];
    path_folder(folder, f->first);
    if (!path_join(joined, folder, name)) return false;
    return resolve_name(f, joined, out);
}

// ---- what the reader sends --------------------------------------------------------------------

static const void *blob_take(loader *l, size_t count) {
    if (count > l->size - l->at) return NULL;
    const void *p = l->bytes + l->at;
    l->at += count;
    return p;
}

static bool broken(const loader *l) {
    return err_set("%s: damaged: its reader returned nonsense", l->path);
}

// Copies the next `count` elements to the arena.
static void *take_array(loader *l, size_t count, size_t element) {
    const void *p = blob_take(l, count * element);
    return p ? arena_copy(l->memory, p, count * element) : NULL;
}

static float finite_or(float value, float other) {
    return isfinite(value) ? value : other;
}

static void normalize(float n[3]) {
    float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    bool usable = isfinite(length) && length > 1e-12f; // else: of a triangle without area
    for (int i = 0; i < 3; i++) n[i] = usable ? n[i] / length : i == 2 ? 1.0f : 0.0f;
}

static bool check_vertices(const loader *l, mesh_vertex *vertices, uint32_t count, box3 *box) {
    float min[3] = {INFINITY, INFINITY, INFINITY}, max[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t v = 0; v < count; v++) {
        for (int i = 0; i < 3; i++) {
            float p = vertices[v].position[i];
            if (!(fabsf(p) < POSITION_MAX)) // so that NaN fails too
                return err_set("%s: a vertex position is not finite, or beyond %g", l->path,
                               (double)POSITION_MAX);
            min[i] = fminf(min[i], p);
            max[i] = fmaxf(max[i], p);
        }
        normalize(vertices[v].normal);
        vertices[v].u = finite_or(vertices[v].u, 0.0f);
        vertices[v].v = finite_or(vertices[v].v, 0.0f);
    }
    *box = (box3){{min[0], min[1], min[2]}, {max[0], max[1], max[2]}};
    return true;
}

static bool check_parts(const loader *l, mesh_part *parts, const mesh_blob *head) {
    uint32_t index = 0;
    for (uint32_t i = 0; i < head->part_count; i++) {
        if (parts[i].first != index || parts[i].count > head->index_count - index) return broken(l);
        if (parts[i].texture < -1 || parts[i].texture >= (int)head->texture_count) return broken(l);
        for (int c = 0; c < 4; c++)
            parts[i].color[c] = clampf(finite_or(parts[i].color[c], 1.0f), 0.0f, 1.0f);
        float *const shares[] = {&parts[i].specular, &parts[i].roughness, &parts[i].metallic};
        for (size_t s = 0; s < COUNT_OF(shares); s++)
            *shares[s] = clampf(finite_or(*shares[s], 0.0f), 0.0f, 1.0f);
        for (int c = 0; c < 3; c++)
            parts[i].emission[c] =
                clampf(finite_or(parts[i].emission[c], 0.0f), 0.0f, MESH_EMISSION_MAX);
        index += parts[i].count;
    }
    return index == head->index_count || broken(l);
}

// Runs of the levels follow each other, after the mesh's own indices.
static bool take_levels(loader *l, const mesh_blob *head, mesh_data *out) {
    uint32_t index = head->index_count, last = head->index_count + head->level_index_count;
    for (uint32_t i = 0; i < head->level_count; i++) {
        const mesh_run *runs = take_array(l, head->part_count, sizeof *runs);
        float before = i > 0 ? head->errors[i - 1] : 0.0f;
        if (!runs || !(head->errors[i] >= before && head->errors[i] <= POSITION_MAX))
            return broken(l);
        for (uint32_t k = 0; k < head->part_count; k++) {
            if (runs[k].first != index || runs[k].count > last - index) return broken(l);
            index += runs[k].count;
        }
        out->levels[i] = (mesh_level){head->errors[i], runs};
    }
    out->level_count = head->level_count;
    out->level_index_count = head->level_index_count;
    return index == last || broken(l);
}

static bool take_geometry(loader *l, const mesh_blob *head, mesh_part **parts, mesh_data *out) {
    mesh_part *p = take_array(l, head->part_count, sizeof *p);
    mesh_vertex *vertices = take_array(l, head->vertex_count, sizeof *vertices);
    uint32_t index_count = head->index_count + head->level_index_count;
    uint32_t *indices = take_array(l, index_count, sizeof *indices);
    if (!p || !vertices || !indices) return broken(l);
    for (uint32_t i = 0; i < index_count; i++)
        if (indices[i] >= head->vertex_count) return broken(l);
    if (!take_levels(l, head, out) || !check_parts(l, p, head) ||
        !check_vertices(l, vertices, head->vertex_count, &out->box))
        return false;
    *parts = p;
    out->vertices = vertices;
    out->vertex_count = head->vertex_count;
    out->indices = indices;
    out->index_count = head->index_count;
    out->parts = p;
    out->part_count = head->part_count;
    return true;
}

static bool load_texture(loader *l, const mesh_blob_texture *t, const void *bytes,
                         mesh_texture *out) {
    if (t->kind == MESH_TEXTURE_TEXELS) {
        if (t->width > TEXEL_SIDE_MAX || t->height > TEXEL_SIDE_MAX || t->width == 0 ||
            t->size != (uint64_t)t->width * t->height * 4)
            return err_set("embedded texture: %ux%u texels", t->width, t->height);
        *out = (mesh_texture){t->width, t->height, arena_copy(l->memory, bytes, t->size)};
        return true;
    }
    if (t->kind == MESH_TEXTURE_FILE)
        return texture_read_memory(bytes, t->size, "embedded texture", l->memory, out);
    char *name = arena_alloc(l->memory, (size_t)t->size + 1), file[PATH_CAP];
    memcpy(name, bytes, t->size);
    if (!mesh_files_resolve_beside(&l->files, name, file)) return false;
    mesh_files_note(&l->files, file); // even if it is missing: it may come
    return texture_read_inside(l->files.root, file, l->memory, out);
}

// A texture that cannot be read is left out with a warning; one outside of the root is an error.
static bool take_textures(loader *l, const mesh_blob *head, mesh_part *parts, mesh_data *out) {
    mesh_texture *textures = arena_alloc(l->memory, head->texture_count * sizeof *textures);
    int *place = arena_alloc(l->memory, head->texture_count * sizeof *place);
    for (uint32_t i = 0; i < head->texture_count; i++) {
        mesh_blob_texture t;
        const void *p = blob_take(l, sizeof t);
        if (p) memcpy(&t, p, sizeof t);
        if (!p || !(p = blob_take(l, t.size))) return broken(l);
        place[i] = -1;
        if (load_texture(l, &t, p, &textures[out->texture_count]))
            place[i] = (int)out->texture_count++;
        else if (l->files.refused[0])
            return err_set("%s: names a file that it may not read: %s", l->path, l->files.refused);
        else
            log_write(LOG_WARNING, "%s: drawn without a texture: %s", l->path, err_get());
    }
    for (uint32_t i = 0; i < head->part_count; i++)
        if (parts[i].texture >= 0) parts[i].texture = place[parts[i].texture];
    out->textures = textures;
    return true;
}

static bool take_mesh(loader *l, mesh_data *out) {
    mesh_blob head;
    const void *p = blob_take(l, sizeof head);
    if (!p) return broken(l);
    memcpy(&head, p, sizeof head);
    if (head.vertex_count > MESH_VERTICES_MAX || head.index_count > MESH_INDICES_MAX ||
        head.texture_count > MESH_TEXTURES_MAX || head.level_count > MESH_LEVELS ||
        head.level_index_count > MESH_INDICES_MAX)
        return broken(l);
    mesh_part *parts = NULL;
    if (!take_geometry(l, &head, &parts, out) || !take_textures(l, &head, parts, out)) return false;
    out->file_count = l->files.opened_count;
    out->files = arena_copy(l->memory, l->files.opened, out->file_count * sizeof *out->files);
    return true;
}

static bool import_mesh(loader *l, isolate_result *blob) {
    static const isolate_limits limits = {
        .processor_ms = 60000, .memory = (uint64_t)4 << 30, .result = (uint64_t)2 << 30};
    const isolate_job job = {.kind = "mesh",
                             .name = l->path,
                             .bytes = l->files.first,
                             .size = strlen(l->files.first),
                             .open = mesh_files_give,
                             .user = &l->files,
                             .limits = limits};
    bool done = isolate_run(&job, blob);
    if (!l->files.refused[0]) return done;
    if (done) isolate_free(blob);
    return err_set("%s: names a file that it may not read: %s", l->path, l->files.refused);
}

mesh_run mesh_get_run(const mesh_data *mesh, uint32_t part, uint32_t level) {
    if (level > 0) return mesh->levels[level - 1].runs[part];
    return (mesh_run){mesh->parts[part].first, mesh->parts[part].count};
}

void mesh_get_ball(const mesh_data *mesh, float out[4]) {
    const float3 *low = &mesh->box.min, *high = &mesh->box.max;
    vec3 centre = {(low->x + high->x) / 2, (low->y + high->y) / 2, (low->z + high->z) / 2};
    glm_vec3_copy(centre, out);
    out[3] = glm_vec3_distance(centre, (vec3){high->x, high->y, high->z});
}

bool mesh_load(const char *path, const char *root, arena *memory, mesh_data *out) {
    static const char *const KINDS[] = {"obj", "gltf", "glb"};
    bool known = false;
    for (size_t i = 0; i < COUNT_OF(KINDS); i++)
        known = known || strcasecmp(path_extension(path), KINDS[i]) == 0;
    if (!known) return err_set("%s: not a mesh that is read; .obj, .gltf and .glb are", path);
    loader *l = arena_alloc(memory, sizeof *l);
    l->path = path;
    l->memory = memory;
    if (!mesh_files_open(&l->files, path, root, memory)) return false;
    isolate_result blob;
    if (!import_mesh(l, &blob)) return false;
    l->bytes = blob.data;
    l->size = blob.size;
    *out = (mesh_data){0};
    bool done = take_mesh(l, out);
    isolate_free(&blob);
    if (!done) *out = (mesh_data){0};
    return done;
}
