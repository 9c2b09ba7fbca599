// Assimp returns triangles with node transforms applied and normals filled in. Here glTF's Y up
// becomes Z up, and texture coordinates start at the top left, as in Vulkan. What the other side
// can check is not checked here.
#include "media/mesh_import.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "media/mesh_io.h"
#include "media/mesh_levels.h"
#include <assimp/cimport.h>
#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const float SMOOTH_ANGLE = 60.0f; // degrees: sharper edges stay hard

typedef struct importer {
    const isolate_call *call;
    mesh_io io;
    arena memory;
    const struct aiScene *scene;
    bool y_up;
    const char *textures[MESH_TEXTURES_MAX]; // as materials name them
    uint32_t texture_count;
} importer;

static bool read_scene(importer *im) {
    struct aiPropertyStore *options = aiCreatePropertyStore();
    aiSetImportPropertyInteger(options, AI_CONFIG_PP_SBP_REMOVE,
                               aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    aiSetImportPropertyFloat(options, AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, SMOOTH_ANGLE);
    unsigned flags = aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_GenSmoothNormals |
                     aiProcess_JoinIdenticalVertices | aiProcess_PreTransformVertices |
                     aiProcess_ValidateDataStructure | aiProcess_FlipUVs;
    im->scene = aiImportFileExWithProperties(im->call->bytes, flags, &im->io.io, options);
    aiReleasePropertyStore(options);
    if (im->io.refused[0]) return err_set("%s: %s", im->call->name, im->io.refused);
    return im->scene ||
           err_set("%s: cannot be read as a mesh: %s", im->call->name, aiGetErrorString());
}

static bool count_elements(const importer *im, const char *path, mesh_blob *out) {
    uint64_t vertices = 0, faces = 0;
    for (unsigned m = 0; m < im->scene->mNumMeshes; m++) {
        vertices += im->scene->mMeshes[m]->mNumVertices;
        faces += im->scene->mMeshes[m]->mNumFaces;
    }
    if (faces == 0 || vertices == 0) return err_set("%s: the mesh has no faces", path);
    if (vertices > MESH_VERTICES_MAX || faces > MESH_INDICES_MAX / 3)
        return err_set("%s: %llu vertices and %llu triangles; at most %d and %d are accepted", path,
                       (unsigned long long)vertices, (unsigned long long)faces, MESH_VERTICES_MAX,
                       MESH_INDICES_MAX / 3);
    out->vertex_count = (uint32_t)vertices;
    out->index_count = (uint32_t)faces * 3;
    out->part_count = im->scene->mNumMeshes;
    return true;
}

static int find_texture(importer *im, const char *name) {
    for (uint32_t i = 0; i < im->texture_count; i++)
        if (strcmp(im->textures[i], name) == 0) return (int)i;
    if (im->texture_count == MESH_TEXTURES_MAX) return -1;
    im->textures[im->texture_count] = arena_string(&im->memory, name);
    return (int)im->texture_count++;
}

// Reads a number of a material; `out` is unchanged when there is none. A key of assimp's stands for
// three arguments.
static bool get_number(const struct aiMaterial *material, const char *key, unsigned type,
                       unsigned index, float *out) {
    float value;
    if (aiGetMaterialFloat(material, key, type, index, &value) != aiReturn_SUCCESS) return false;
    *out = value;
    return true;
}

// Uses roughness and metallic where the file has them (glTF, and MTL's Pr and Pm), else a highlight
// (MTL's Ks and Ns). Both are 1 in a glTF file that does not set them, or sets them by a texture:
// such a part is matte.
static void set_reflection(const struct aiMaterial *material, mesh_part *part) {
    struct aiColor4D c;
    float exponent;
    if (get_number(material, AI_MATKEY_SHININESS, &exponent) && exponent > 0)
        part->roughness = powf(2 / (exponent + 2), 0.25f); // of a highlight as wide
    if (aiGetMaterialColor(material, AI_MATKEY_COLOR_SPECULAR, &c) == aiReturn_SUCCESS)
        part->specular = fmaxf(c.r, fmaxf(c.g, c.b));
    bool measured = get_number(material, AI_MATKEY_ROUGHNESS_FACTOR, &part->roughness);
    measured |= get_number(material, AI_MATKEY_METALLIC_FACTOR, &part->metallic);
    if (!measured) return;
    bool unsaid = part->roughness >= 1 && part->metallic >= 1;
    part->specular = unsaid ? 0.0f : 0.5f;
    if (unsaid) part->metallic = 0;
}

static void set_material(importer *im, unsigned index, mesh_part *part) {
    *part = (mesh_part){.color = {1.0f, 1.0f, 1.0f, 1.0f}, .texture = -1, .roughness = 1};
    if (index >= im->scene->mNumMaterials) return;
    const struct aiMaterial *material = im->scene->mMaterials[index];
    struct aiColor4D c;
    if (aiGetMaterialColor(material, AI_MATKEY_BASE_COLOR, &c) == aiReturn_SUCCESS ||
        aiGetMaterialColor(material, AI_MATKEY_COLOR_DIFFUSE, &c) == aiReturn_SUCCESS) {
        const float color[4] = {c.r, c.g, c.b, c.a};
        memcpy(part->color, color, sizeof color);
    }
    if (aiGetMaterialColor(material, AI_MATKEY_COLOR_EMISSIVE, &c) == aiReturn_SUCCESS)
        memcpy(part->emission, (const float[3]){c.r, c.g, c.b}, sizeof part->emission);
    set_reflection(material, part);
    static const enum aiTextureType TYPES[] = {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE};
    for (size_t i = 0; i < COUNT_OF(TYPES) && part->texture < 0; i++) {
        struct aiString name;
        if (aiGetMaterialTexture(material, TYPES[i], 0, &name, NULL, NULL, NULL, NULL, NULL,
                                 NULL) == aiReturn_SUCCESS)
            part->texture = find_texture(im, name.data);
    }
}

static mesh_vertex convert_vertex(const importer *im, const struct aiMesh *mesh, unsigned i) {
    struct aiVector3D p = mesh->mVertices[i];
    struct aiVector3D n = mesh->mNormals ? mesh->mNormals[i] : (struct aiVector3D){0, 0, 0};
    struct aiVector3D uv = {0, 0, 0};
    if (mesh->mTextureCoords[0]) uv = mesh->mTextureCoords[0][i];
    if (im->y_up) {
        p = (struct aiVector3D){p.x, -p.z, p.y};
        n = (struct aiVector3D){n.x, -n.z, n.y};
    }
    return (mesh_vertex){{p.x, p.y, p.z}, uv.x, {n.x, n.y, n.z}, uv.y};
}

static bool put_all_geometry(importer *im, mesh_blob *head, const mesh_part *parts,
                             const mesh_vertex *vertices, const uint32_t *indices) {
    const mesh_data mesh = {.vertices = vertices,
                            .vertex_count = head->vertex_count,
                            .indices = indices,
                            .index_count = head->index_count,
                            .parts = parts,
                            .part_count = head->part_count};
    mesh_levels levels;
    mesh_levels_make(&mesh, &im->memory, &levels);
    head->texture_count = im->texture_count;
    head->level_count = levels.count;
    head->level_index_count = levels.index_count;
    memcpy(head->errors, levels.errors, sizeof head->errors);
    bool done = isolate_put(im->call, head, sizeof *head) &&
                isolate_put(im->call, parts, head->part_count * sizeof *parts) &&
                isolate_put(im->call, vertices, head->vertex_count * sizeof *vertices) &&
                isolate_put(im->call, indices, head->index_count * sizeof *indices) &&
                isolate_put(im->call, levels.indices, levels.index_count * sizeof *indices);
    for (uint32_t i = 0; i < levels.count && done; i++)
        done = isolate_put(im->call, levels.runs[i], head->part_count * sizeof(mesh_run));
    return done;
}

static bool put_geometry(importer *im, mesh_blob *head) {
    mesh_part *parts = arena_alloc(&im->memory, head->part_count * sizeof *parts);
    mesh_vertex *vertices = arena_alloc(&im->memory, head->vertex_count * sizeof *vertices);
    uint32_t *indices = arena_alloc(&im->memory, head->index_count * sizeof *indices);
    uint32_t vertex = 0, index = 0;
    for (unsigned m = 0; m < head->part_count; m++) {
        const struct aiMesh *mesh = im->scene->mMeshes[m];
        set_material(im, mesh->mMaterialIndex, &parts[m]);
        parts[m].first = index;
        parts[m].count = mesh->mNumFaces * 3;
        for (unsigned f = 0; f < mesh->mNumFaces; f++) {
            if (mesh->mFaces[f].mNumIndices != 3) return err_set("a face is no triangle");
            for (int i = 0; i < 3; i++) indices[index++] = vertex + mesh->mFaces[f].mIndices[i];
        }
        for (unsigned i = 0; i < mesh->mNumVertices; i++)
            vertices[vertex++] = convert_vertex(im, mesh, i);
    }
    return put_all_geometry(im, head, parts, vertices, indices);
}

static bool put_texels(const importer *im, const struct aiTexture *texture) {
    size_t texels = (size_t)texture->mWidth * texture->mHeight;
    mesh_blob_texture head = {MESH_TEXTURE_TEXELS, texture->mWidth, texture->mHeight,
                              (uint32_t)(texels * 4)};
    if (texels > UINT32_MAX / 4) return err_set("an embedded texture is too large");
    if (!isolate_put(im->call, &head, sizeof head)) return false;
    uint8_t *rgba = mem_alloc(texels * 4);
    for (size_t i = 0; i < texels; i++) {
        const struct aiTexel *t = &texture->pcData[i];
        memcpy(rgba + 4 * i, (const uint8_t[4]){t->r, t->g, t->b, t->a}, 4);
    }
    bool done = isolate_put(im->call, rgba, texels * 4);
    mem_free(rgba);
    return done;
}

// "*3" is the fourth texture of the file. Others may be embedded under their file name.
static const struct aiTexture *find_embedded(const struct aiScene *scene, const char *name) {
    unsigned long index = name[0] == '*' ? strtoul(name + 1, NULL, 10) : scene->mNumTextures;
    if (index < scene->mNumTextures) return scene->mTextures[index];
    for (unsigned i = 0; i < scene->mNumTextures; i++)
        if (strcmp(scene->mTextures[i]->mFilename.data, name) == 0) return scene->mTextures[i];
    return NULL;
}

static bool put_texture(const importer *im, const char *name) {
    const struct aiTexture *embedded = find_embedded(im->scene, name);
    if (embedded && embedded->mHeight > 0) return put_texels(im, embedded);
    mesh_blob_texture head = {MESH_TEXTURE_NAME, 0, 0, (uint32_t)strlen(name)};
    const void *bytes = name;
    if (embedded) {
        head = (mesh_blob_texture){MESH_TEXTURE_FILE, 0, 0, embedded->mWidth};
        bytes = embedded->pcData;
    }
    return isolate_put(im->call, &head, sizeof head) && isolate_put(im->call, bytes, head.size);
}

static bool put_all(importer *im) {
    const char *path = im->call->name;
    mesh_blob head = {0};
    if (!count_elements(im, path, &head)) return false;
    if (!put_geometry(im, &head)) return err_prefix("%s: ", path);
    for (uint32_t i = 0; i < im->texture_count; i++)
        if (!put_texture(im, im->textures[i])) return err_prefix("%s: ", path);
    return true;
}

bool mesh_import(const isolate_call *call) {
    importer *im = mem_alloc(sizeof *im);
    im->call = call;
    im->y_up = strcasecmp(path_extension(call->bytes), "obj") != 0;
    mesh_io_open(&im->io, call);
    bool done = read_scene(im) && put_all(im);
    if (im->scene) aiReleaseImport(im->scene);
    arena_free(&im->memory);
    mem_free(im);
    return done;
}
