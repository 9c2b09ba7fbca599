// Hooks of the built-in pass types (pass.h says when each is called).
#pragma once
#include "pass/pass.h"

bool geometry_declare(pass *p);
bool geometry_check(pass *p);
bool geometry_build(pass *p);
bool geometry_allocate(pass *p);
void geometry_list_memory(const pass *p, budget_list *out);
bool geometry_fill(pass *p, const shader_binary *binary, unsigned char *block);
bool geometry_record(pass *p);
void geometry_destroy(pass *p);

bool shade_declare(pass *p);
bool shade_check(pass *p);
bool shade_build(pass *p);
bool shade_record(pass *p);
void shade_destroy(pass *p);

bool shadow_maps_declare(pass *p);
bool shadow_maps_complete(pass *p);
bool shadow_maps_check(pass *p);
bool shadow_maps_build(pass *p);
bool shadow_maps_allocate(pass *p);
void shadow_maps_list_memory(const pass *p, budget_list *out);
bool shadow_maps_fill(pass *p, const shader_binary *binary, unsigned char *block);
bool shadow_maps_record(pass *p);
void shadow_maps_destroy(pass *p);

bool forward_declare(pass *p);
bool forward_check(pass *p);
bool forward_build(pass *p);
bool forward_allocate(pass *p);
void forward_list_memory(const pass *p, budget_list *out);
bool forward_fill(pass *p, const shader_binary *binary, unsigned char *block);
bool forward_record(pass *p);
void forward_destroy(pass *p);
