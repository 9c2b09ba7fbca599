// A Lua state with a sandbox and limits. It does not depend on effects.
#pragma once
#include "base/arena.h"
#include "base/error.h"
#include <lauxlib.h>
#include <lua.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { VM_STRING_MAX = 4 << 20 }; // bytes of one string of a script

typedef struct vm vm;

typedef struct vm_desc {
    const char *root;          // folder that `require` searches first and does not leave
    const char *const *assets; // folders that it searches next
    size_t asset_count;
    const char *library;  // folder that it searches last; NULL: none
    const char *shown;    // how messages name `root`: "" or "effects/"; NULL: ""
    size_t memory;        // bytes
    size_t longest;       // bytes of one string; 0: VM_STRING_MAX
    const arena *objects; // in which bindings make objects; its size counts too; NULL: none
    uint64_t seed;        // of math.random
    void (*on_file)(void *user, const char *path); // called for every file read; may be NULL
    void *user;                                    // passed to on_file; returned by vm_user
} vm_desc;

vm *vm_create(const vm_desc *desc); // NULL with a message when `memory` is too small
void vm_destroy(vm *v);             // NULL is allowed
lua_State *vm_lua(vm *v);
vm *vm_of(lua_State *L);
void *vm_user(lua_State *L);

// Reads and runs a file in the sandbox. False with "file:line: message", and its callers below it.
// `prelude`: errors in its functions name the line of the effect that called them.
bool vm_run_file(vm *v, const char *path, const char *shown, uint64_t instructions, bool prelude);
// The same of a file that must lie in `root` when it is opened; NULL: anywhere.
bool vm_run_file_inside(vm *v, const char *root, const char *path, const char *shown,
                        uint64_t instructions);

// Calls the function on the stack below `args` arguments. False with a message, and nothing is
// pushed. A nested call uses the limit of the outer one.
bool vm_call(vm *v, int args, int results, uint64_t instructions);
// Calls a C function in protected mode with `argument` as its only, light, argument.
bool vm_protect(vm *v, lua_CFunction function, void *argument, uint64_t instructions);

// ---- for C functions that scripts call; these raise Lua errors --------------------------------

// Raises an error at the line of the script that called.
_Noreturn void vm_error(lua_State *L, const char *format, ...) PRINTF_LIKE(2, 3);
// Writes "file:line: " of the running script; "" when none is running.
void vm_locate(lua_State *L, char *out, size_t size);
// Charges work of C functions, in instructions. Checks the limits whenever enough has accumulated,
// so a loop that charges its work checks them often.
void vm_charge(lua_State *L, uint64_t instructions);
void vm_look(lua_State *L);                        // checks the limits now
void vm_charge_memory(lua_State *L, size_t bytes); // memory outside of Lua, kept until the end
void vm_set_seed(lua_State *L, uint64_t seed);
uint64_t vm_random(lua_State *L);

// Returns the text of the file whose line called, and where that line begins in it. NULL when it is
// unknown. Valid as long as the state.
const char *vm_caller_source(lua_State *L, size_t *line);
// Returns the path of the effect's file whose line called, and that line, from 1. NULL when none of
// the effect's files did. Valid as long as the state.
const char *vm_caller_file(lua_State *L, int *line);

// Loads a text chunk and pushes it as a function. `root`: as in file_open_inside. `ours`: as
// `prelude` of vm_run_file.
void vm_load_chunk(lua_State *L, const char *root, const char *path, const char *shown, bool ours);
const vm_desc *vm_get_desc(lua_State *L);

// ---- vm_place.c, for vm.c ---------------------------------------------------------------------

enum { VM_MESSAGE_MAX = 4000 };
#define VM_CALLED_FROM "\ncalled from " // before each of the callers in a message
// Message handler: turns whatever was thrown into text, with its callers below.
int vm_describe_error(lua_State *L);
void vm_set_ours(lua_State *L, bool ours); // what is allocated is out of the script's reach

// The parts of the sandbox; each leaves the stack as it was.
void sandbox_open(lua_State *L); // libraries and strict globals
void pattern_open(lua_State *L); // string.find, match, gmatch, gsub
void library_open(lua_State *L); // other functions of Lua that loop

// Charges for the comparison of the two values at the bottom of the stack.
void library_charge_comparison(lua_State *L);
void module_open(lua_State *L); // require
