// The inside of the pass type `shell`, for its own files only.
#pragma once
#include "pass/pass_impl.h"
#include "pass/shell/shell.h"

enum { SHELL_RECORD = 48, SHELL_VERTEX = 16 }; // bytes, as shell/surface.glsl has them
static const float SHELL_LEAST = -0.95f;       // of the displacement: the sphere stays one

typedef enum shell_stage {
    SHELL_GATHER,
    SHELL_RAYS,
    SHELL_VERTICES, // of what is drawn, as those that follow
    SHELL_DRAW,
    SHELL_FRONT,
    SHELL_STAGES
} shell_stage;

#define SHELL_NAMES(NAME)                                                                          \
    NAME(mode), NAME(corners), NAME(sides), NAME(displacement), NAME(life), NAME(reach),           \
        NAME(image), NAME(front), NAME(drawn_front), NAME(shells), NAME(shell_count),              \
        NAME(bounds), NAME(picture), NAME(shell_at), NAME(far_side), NAME(ShellRecords),           \
        NAME(ShellVertices)
enum { SHELL_NAMES(KERNEL_NAME_ID) };

typedef struct shell_state {
    const scene_explosions *list;     // NULL: one from time 0 on
    bool drawn;                       // as meshes,
    bool both_sides;                  // of them
    uint32_t corners;                 // along a side of the cube that a mesh is made of
    uint32_t count;                   // of the frame being recorded,
    float places[PASS_SHELL_MOST][3]; // and where they are
    gpu_buffer *records, *vertices;
    graph_image z, drawn_front; // of what is drawn
} shell_state;

shell_state *shell_state_of(pass *p);
kernel *shell_use(pass *p, shell_stage stage);
bool shell_run(pass *p, shell_stage stage, uint32_t x, uint32_t y);

// ---- shell_mesh.c: drawn ------------------------------------------------------------------------

bool shell_declare_mesh(pass *p);
uint64_t shell_vertices_bytes(const shell_state *s); // of as many shells as there may be
void shell_target(const pass *p, size_t index, gpu_graphics_desc *out);
bool shell_record_mesh(pass *p);
