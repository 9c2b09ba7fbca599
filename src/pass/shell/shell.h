// The pass type `shell`: spheres pushed out along their normals, one for each explosion of a list.
// Its uniforms, options and fields are those of shaders/pass/shell/shell.comp.
#pragma once
#include "pass/pass.h"
#include "scene/explosions.h"

enum { PASS_SHELL_MOST = 64 }; // that are drawn at a time: of more, the youngest

// Whose explosions it draws; the list outlives it. Before pass_declare; without: one that begins at
// time 0 in the origin.
void pass_shell_open(pass *p, const scene_explosions *list);
