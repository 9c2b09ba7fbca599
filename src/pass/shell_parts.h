// The inside of the pass type `shell`, for its own files only.
#pragma once
#include "pass/pass_impl.h"
#include "pass/shell.h"

enum { SHELL_RECORD = 48, SHELL_VERTEX = 16 }; // bytes, as shell/surface.glsl has them
static const float SHELL_LEAST = -0.95f;       // of the displacement: the sphere stays one

typedef enum shell_stage {
    SHELL_GATHER,
    SHELL_VERTICES,
    SHELL_FRONT,
    SHELL_RAYS,
    SHELL_STAGES
} shell_stage;

typedef struct shell_state {
    const scene_explosions *list; // NULL: one from time 0 on
    bool drawn;                   // as meshes
    shader_binary binary[SHELL_STAGES];
    gpu_pipeline *pipeline[SHELL_STAGES];
    unsigned char *block[SHELL_STAGES];
    uint32_t count;                   // of the frame being recorded,
    float places[PASS_SHELL_MOST][3]; // and where they are
    gpu_buffer *records, *vertices;

    // Drawn.
    graph_image z, drawn_front;
    shader_binary vertex, fragment;
    unsigned char *vertex_block, *fragment_block;
    gpu_pipeline *draw;
} shell_state;

shell_state *shell_state_of(pass *p);
bool shell_run(pass *p, shell_stage stage, uint32_t x, uint32_t y);

// ---- shell_mesh.c: drawn ------------------------------------------------------------------------

shader_define shell_corners_define(const pass *p);
bool shell_declare_mesh(pass *p);
bool shell_check_mesh(pass *p);
bool shell_build_mesh(pass *p);
bool shell_record_mesh(pass *p);
