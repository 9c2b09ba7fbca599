// Meshes through assimp's C API. Assimp sees the file system only through mesh_files. It returns
// triangles with node transforms applied and normals filled in; what is left here is to check,
// turn glTF's Y up into Z up, and lay everything out as one vertex and one index array.
// Texture coordinates run from the top left, as Vulkan samples.
#include "media/mesh.h"
#include "base/error.h"
#include "base/log.h"
#include "base/str.h"
#include "media/mesh_files.h"
#include "media/png.h"
#include <assimp/cimport.h>
#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { VERTICES_MAX = 8 << 20, INDICES_MAX = 64 << 20, TEXTURES_MAX = 256, TEXEL_SIDE_MAX = 16384 };
static const float SMOOTH_ANGLE = 60.0f; // degrees: sharper edges stay hard

typedef struct loader {
    const char *path;
    mesh_files files;
    arena *memory;
    const struct aiScene *scene;
    bool y_up;
    const char *texture_names[TEXTURES_MAX];
    mesh_texture *textures;
    uint32_t texture_count;
} loader;

static const struct aiScene *import(loader *l) {
    static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER; // assimp has one error text for all
    struct aiPropertyStore *options = aiCreatePropertyStore();
    aiSetImportPropertyInteger(options, AI_CONFIG_PP_SBP_REMOVE,
                               aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    aiSetImportPropertyFloat(options, AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, SMOOTH_ANGLE);
    unsigned flags = aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_GenSmoothNormals |
                     aiProcess_JoinIdenticalVertices | aiProcess_PreTransformVertices |
                     aiProcess_ValidateDataStructure | aiProcess_FlipUVs;
    pthread_mutex_lock(&lock);
    const struct aiScene *scene =
        aiImportFileExWithProperties(l->files.first, flags, &l->files.io, options);
    if (!scene) err_set("%s: cannot be read as a mesh: %s", l->path, aiGetErrorString());
    pthread_mutex_unlock(&lock);
    aiReleasePropertyStore(options);
    return scene;
}

static bool count(const loader *l, mesh_data *out) {
    uint64_t vertices = 0, faces = 0;
    for (unsigned m = 0; m < l->scene->mNumMeshes; m++) {
        vertices += l->scene->mMeshes[m]->mNumVertices;
        faces += l->scene->mMeshes[m]->mNumFaces;
    }
    if (faces == 0) return err_set("%s: the mesh has no faces", l->path);
    if (vertices > VERTICES_MAX || faces * 3 > INDICES_MAX)
        return err_set("%s: %llu vertices and %llu triangles; at most %d and %d are accepted",
                       l->path, (unsigned long long)vertices, (unsigned long long)faces,
                       VERTICES_MAX, INDICES_MAX / 3);
    out->vertex_count = (uint32_t)vertices;
    out->index_count = (uint32_t)faces * 3;
    out->part_count = l->scene->mNumMeshes;
    return true;
}

static float finite_or(float value, float other) {
    return isfinite(value) ? value : other;
}

static void set_normal(const loader *l, const struct aiMesh *mesh, unsigned i, mesh_vertex *v) {
    struct aiVector3D n = mesh->mNormals ? mesh->mNormals[i] : (struct aiVector3D){0, 0, 0};
    float length = sqrtf(n.x * n.x + n.y * n.y + n.z * n.z);
    if (!isfinite(length) || length < 1e-12f) { // of a triangle without area
        v->normal[2] = 1.0f;
        return;
    }
    v->normal[0] = n.x / length;
    v->normal[1] = (l->y_up ? -n.z : n.y) / length;
    v->normal[2] = (l->y_up ? n.y : n.z) / length;
}

static bool add_vertices(const loader *l, const struct aiMesh *mesh, mesh_vertex *out, box3 *box) {
    for (unsigned i = 0; i < mesh->mNumVertices; i++) {
        struct aiVector3D p = mesh->mVertices[i];
        mesh_vertex *v = &out[i];
        v->position[0] = p.x;
        v->position[1] = l->y_up ? -p.z : p.y;
        v->position[2] = l->y_up ? p.y : p.z;
        float3 at = {v->position[0], v->position[1], v->position[2]};
        // Beyond 1e18 areas and dot products overflow.
        if (!(fabsf(at.x) < 1e18f && fabsf(at.y) < 1e18f && fabsf(at.z) < 1e18f))
            return err_set("%s: a vertex position is not finite, or beyond 1e18", l->path);
        box->min =
            (float3){fminf(box->min.x, at.x), fminf(box->min.y, at.y), fminf(box->min.z, at.z)};
        box->max =
            (float3){fmaxf(box->max.x, at.x), fmaxf(box->max.y, at.y), fmaxf(box->max.z, at.z)};
        set_normal(l, mesh, i, v);
        const struct aiVector3D *uv = mesh->mTextureCoords[0];
        v->u = uv ? finite_or(uv[i].x, 0.0f) : 0.0f;
        v->v = uv ? finite_or(uv[i].y, 0.0f) : 0.0f;
    }
    return true;
}

static bool add_indices(const loader *l, const struct aiMesh *mesh, uint32_t base, uint32_t *out) {
    for (unsigned f = 0; f < mesh->mNumFaces; f++) {
        const struct aiFace *face = &mesh->mFaces[f];
        if (face->mNumIndices != 3) return err_set("%s: a face is no triangle", l->path);
        for (int i = 0; i < 3; i++) {
            if (face->mIndices[i] >= mesh->mNumVertices)
                return err_set("%s: a face names a vertex that is not there", l->path);
            *out++ = base + face->mIndices[i];
        }
    }
    return true;
}

static bool decode_texels(loader *l, const struct aiTexture *source, mesh_texture *out) {
    if (source->mWidth > TEXEL_SIDE_MAX || source->mHeight > TEXEL_SIDE_MAX) return false;
    size_t texels = (size_t)source->mWidth * source->mHeight;
    uint8_t *pixels = arena_alloc(l->memory, texels * 4);
    for (size_t i = 0; i < texels; i++) {
        const struct aiTexel *t = &source->pcData[i];
        const uint8_t rgba[4] = {t->r, t->g, t->b, t->a};
        memcpy(pixels + 4 * i, rgba, sizeof rgba);
    }
    *out = (mesh_texture){source->mWidth, source->mHeight, pixels};
    return true;
}

// 16-bit pictures lose their low bytes: textures are shown, not measured.
static mesh_texture texture_from_png(loader *l, const png_image *image) {
    if (image->bits == 8) return (mesh_texture){image->width, image->height, image->pixels};
    size_t values = (size_t)image->width * image->height * 4;
    const uint16_t *wide = image->pixels;
    uint8_t *pixels = arena_alloc(l->memory, values);
    for (size_t i = 0; i < values; i++) pixels[i] = (uint8_t)(wide[i] >> 8);
    return (mesh_texture){image->width, image->height, pixels};
}

static bool load_texture(loader *l, const char *name, mesh_texture *out) {
    png_image image;
    const struct aiTexture *embedded = NULL;
    if (name[0] == '*') {
        long index = strtol(name + 1, NULL, 10);
        if (index < 0 || index >= (long)l->scene->mNumTextures)
            return err_set("texture %s is not in the file", name);
        embedded = l->scene->mTextures[index];
    }
    if (embedded && embedded->mHeight > 0) return decode_texels(l, embedded, out);
    if (embedded) {
        if (!png_read_memory(embedded->pcData, embedded->mWidth, name, l->memory, &image))
            return false;
    } else {
        char file[PATH_CAP];
        if (!mesh_files_resolve_beside(&l->files, name, file)) return false;
        if (strcasecmp(path_extension(file), "png") != 0)
            return err_set("%s: is not a PNG file", file);
        if (!png_read(file, l->memory, &image)) return false;
        mesh_files_note(&l->files, file);
    }
    *out = texture_from_png(l, &image);
    return true;
}

// Index of the texture named by a material, or -1 with a warning.
static int find_texture(loader *l, const char *name) {
    for (uint32_t i = 0; i < l->texture_count; i++)
        if (strcmp(l->texture_names[i], name) == 0) return (int)i;
    mesh_texture texture;
    if (l->texture_count == TEXTURES_MAX)
        err_set("more than %d textures", TEXTURES_MAX);
    else if (load_texture(l, name, &texture)) {
        l->textures[l->texture_count] = texture;
        l->texture_names[l->texture_count] = arena_string(l->memory, name);
        return (int)l->texture_count++;
    }
    if (!l->files.refused[0])
        log_write(LOG_WARNING, "%s: drawn without its texture: %s", l->path, err_get());
    return -1;
}

static void set_material(loader *l, unsigned index, mesh_part *part) {
    static const float WHITE[4] = {1.0f, 1.0f, 1.0f, 1.0f};
    memcpy(part->color, WHITE, sizeof WHITE);
    part->texture = -1;
    if (index >= l->scene->mNumMaterials) return;
    const struct aiMaterial *material = l->scene->mMaterials[index];
    struct aiColor4D c;
    if (aiGetMaterialColor(material, AI_MATKEY_BASE_COLOR, &c) == aiReturn_SUCCESS ||
        aiGetMaterialColor(material, AI_MATKEY_COLOR_DIFFUSE, &c) == aiReturn_SUCCESS) {
        const float values[4] = {c.r, c.g, c.b, c.a};
        for (int i = 0; i < 4; i++) part->color[i] = clampf(finite_or(values[i], 1.0f), 0.0f, 1.0f);
    }
    static const enum aiTextureType TYPES[] = {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE};
    for (size_t i = 0; i < sizeof TYPES / sizeof *TYPES; i++) {
        struct aiString name;
        if (aiGetMaterialTexture(material, TYPES[i], 0, &name, NULL, NULL, NULL, NULL, NULL,
                                 NULL) != aiReturn_SUCCESS)
            continue;
        part->texture = find_texture(l, name.data);
        return;
    }
}

static bool convert(loader *l, mesh_data *out) {
    mesh_data d = {0};
    if (!count(l, &d)) return false;
    mesh_vertex *vertices = arena_alloc(l->memory, d.vertex_count * sizeof *vertices);
    uint32_t *indices = arena_alloc(l->memory, d.index_count * sizeof *indices);
    mesh_part *parts = arena_alloc(l->memory, d.part_count * sizeof *parts);
    l->textures = arena_alloc(l->memory, TEXTURES_MAX * sizeof *l->textures);
    d.box = (box3){{1e30f, 1e30f, 1e30f}, {-1e30f, -1e30f, -1e30f}};
    uint32_t vertex = 0, index = 0;
    for (unsigned m = 0; m < d.part_count; m++) {
        const struct aiMesh *mesh = l->scene->mMeshes[m];
        parts[m].first = index;
        parts[m].count = mesh->mNumFaces * 3;
        if (!add_vertices(l, mesh, vertices + vertex, &d.box)) return false;
        if (!add_indices(l, mesh, vertex, indices + index)) return false;
        set_material(l, mesh->mMaterialIndex, &parts[m]);
        vertex += mesh->mNumVertices;
        index += mesh->mNumFaces * 3;
    }
    if (l->files.refused[0])
        return err_set("%s: names a file that it may not read: %s", l->path, l->files.refused);
    d.vertices = vertices;
    d.indices = indices;
    d.parts = parts;
    d.textures = l->textures;
    d.texture_count = l->texture_count;
    d.file_count = l->files.opened_count;
    d.files = arena_copy(l->memory, l->files.opened, d.file_count * sizeof *d.files);
    *out = d;
    return true;
}

bool mesh_load(const char *path, const char *root, arena *memory, mesh_data *out) {
    const char *extension = path_extension(path);
    bool gltf = strcasecmp(extension, "gltf") == 0 || strcasecmp(extension, "glb") == 0;
    if (!gltf && strcasecmp(extension, "obj") != 0)
        return err_set("%s: not a mesh that is read; .obj, .gltf and .glb are", path);
    loader *l = arena_alloc(memory, sizeof *l);
    *l = (loader){.path = path, .memory = memory, .y_up = gltf};
    if (!mesh_files_open(&l->files, path, root, memory)) return false;
    l->scene = import(l);
    if (!l->scene) {
        if (l->files.refused[0])
            err_set("%s: names a file that it may not read: %s", path, l->files.refused);
        return false;
    }
    bool done = convert(l, out);
    aiReleaseImport(l->scene);
    return done;
}
