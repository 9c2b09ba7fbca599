// The Lua state and its two limits.
//
// Memory: Lua's allocator counts bytes and refuses growth beyond the limit; objects that bindings
// make elsewhere are counted by vm_charge_memory, and those in the arena of all objects are never
// less than it holds. The same bytes are taken from the host's budget, in steps. Time: a count hook
// adds up instructions; C functions whose work depends on their arguments add theirs by vm_charge,
// and allocations count too, so that few instructions cannot do much work. Processor time is
// limited as well, far above what the instructions take, and so is what the thread's time limit has
// left (base/time_limit.h).
//
// Between two looks at these limits lie at most TICK instructions, or charges and allocations worth
// as much. What one instruction can touch is bounded by the largest block that the script has: a
// string is compared or copied (VM_STRING_MAX, at worst 15 ns a byte, where it is full of zeros), a
// table searched, an argument list copied (1 ns a slot). So the larger the largest block, the fewer
// instructions lie between two looks: STRING_WORK bytes of strings, 63 ms, or BLOCK_WORK of others,
// 34 ms. C functions that loop over more than their arguments' length look from within
// (script/library.c, script/match.c).
//
// Invariant: once a limit was hit (`stop`), the hook fails at every instruction, so no pcall of
// the script can go on; it ends when the outermost vm_call returns.
#include "script/vm.h"
#include "base/budget.h"
#include "base/clock.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/str.h"
#include "base/time_limit.h"
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    TICK = 1000,      // instructions between two looks at the limits, at most
    STRING_HEAD = 64, // more than Lua puts before a string
    STRING_WORK = VM_STRING_MAX + STRING_HEAD, // bytes of strings between two looks
    BLOCK_WORK = 512 << 20,                    // of other blocks
    STOPPED_MARGIN = 1 << 20, // bytes beyond the limit for the message of a stopped script
    STOPPED_BLOCK = 1 << 16,  // largest block that a stopped script still gets
    BUDGET_STEP = 1 << 20,
    BYTES_PER_INSTRUCTION = 256, // allocating so many costs as much as an instruction
};

typedef enum vm_stop {
    STOP_NONE,
    STOP_MEMORY,
    STOP_BUDGET,
    STOP_STRING,
    STOP_INSTRUCTIONS,
    STOP_TIME,
} vm_stop;

struct vm {
    lua_State *lua;
    vm_desc desc;
    arena memory;      // strings of `desc`
    size_t used;       // by Lua
    size_t charged;    // by bindings
    budget_part *part; // of both, `reserved` bytes
    size_t reserved;
    bool over_budget;   // the last refusal was the budget's
    bool starved;       // it was the heap's
    char refusal[1024]; // of STOP_BUDGET
    int refusals;       // growth requests refused in a row: Lua collects garbage after the first
    vm_stop stop;
    size_t stopped_at; // bytes that were taken then, or the limit if that is more
    uint64_t spent, budget;
    uint64_t seen;   // `spent` at the last look
    double deadline; // processor seconds of the thread
    double patience; // clock_seconds before which they cannot have come that far
    int interval;    // instructions between two calls of the hook
    int passed;      // instructions since `where` was noted
    bool ours;       // what is allocated is out of the script's reach
    int depth;       // vm_calls that are running
    char where[96];  // "file:line: " of the last tick, or where `stop` was set
    uint64_t random;
};

// ---- limits -----------------------------------------------------------------------------------

static void vm_tick(lua_State *L, lua_Debug *ar);

static size_t taken(const vm *v) { // not Lua's only
    size_t held = v->desc.objects ? v->desc.objects->held : 0;
    return v->used + (held > v->charged ? held : v->charged);
}

static void vm_stop_for(vm *v, vm_stop reason) {
    if (!v->stop) {
        v->stop = reason;
        v->stopped_at = taken(v) > v->desc.memory ? taken(v) : v->desc.memory;
    }
    lua_sethook(v->lua, vm_tick, LUA_MASKCOUNT, 1);
}

static void stop_message(const vm *v, char *out, size_t size) {
    char time[160];
    time_limit_tell(time, sizeof time);
    if (v->stop == STOP_MEMORY)
        snprintf(out, size, "%smemory limit of %zu MiB exceeded", v->where, v->desc.memory >> 20);
    else if (v->stop == STOP_BUDGET)
        snprintf(out, size, "%s%s", v->where, v->refusal);
    else if (v->stop == STOP_STRING)
        snprintf(out, size, "%smemory limit of %zu MiB for one string exceeded", v->where,
                 v->desc.longest >> 20);
    else if (v->stop == STOP_TIME)
        snprintf(out, size, "%s%s", v->where, time);
    else
        snprintf(out, size, "%sinstruction limit of %llu exceeded: endless loop?", v->where,
                 (unsigned long long)v->budget);
}

static void raise_stop(lua_State *L) {
    char text[VM_MESSAGE_MAX];
    stop_message(vm_of(L), text, sizeof text);
    lua_pushstring(L, text);
    lua_error(L);
}

// Returns whether all limits are kept. The thread's processor time needs a system call, and cannot
// have grown by more than the clock.
static bool vm_check_limits(vm *v) {
    v->seen = v->spent;
    if (v->spent > v->budget) vm_stop_for(v, STOP_INSTRUCTIONS);
    if (time_limit_left() <= 0) vm_stop_for(v, STOP_TIME);
    double now = clock_seconds();
    if (now > v->patience) {
        double left = v->deadline - time_limit_thread_seconds();
        if (left <= 0) vm_stop_for(v, STOP_INSTRUCTIONS);
        v->patience = now + left;
    }
    return !v->stop;
}

static void vm_tick(lua_State *L, lua_Debug *ar) {
    (void)ar;
    vm *v = vm_of(L);
    if (!v->stop) {
        v->spent += (uint64_t)v->interval;
        v->passed += v->interval;
        if (v->passed >= TICK || !vm_check_limits(v)) {
            v->passed = 0;
            vm_locate(L, v->where, sizeof v->where);
            vm_check_limits(v);
        }
    }
    if (v->stop) raise_stop(L);
}

// Takes memory from the budget, which gets none back before the end, so that scripts that make
// garbage in every frame do not ask each time. The message of a refusal is kept.
static bool vm_take(vm *v, size_t bytes) {
    if (bytes <= v->reserved) return true;
    size_t wanted = (bytes + BUDGET_STEP - 1) / BUDGET_STEP * BUDGET_STEP;
    if (budget_resize(v->part, wanted)) {
        v->reserved = wanted;
        return true;
    }
    str_copy(v->refusal, sizeof v->refusal, err_get());
    return false;
}

// Notes the size of a new block: the larger it is, the fewer instructions may run between two
// checks.
static void note_block(vm *v, size_t size, bool string) {
    if (v->ours || size <= (string ? STRING_WORK : BLOCK_WORK) / TICK) return;
    int interval = (int)((string ? STRING_WORK : BLOCK_WORK) / size);
    if (interval < 1) interval = 1;
    if (interval >= v->interval) return;
    v->interval = interval;
    if (v->lua && !v->stop) lua_sethook(v->lua, vm_tick, LUA_MASKCOUNT, interval);
}

static bool may_grow(vm *v, size_t size, size_t grow) {
    size_t all = taken(v);
    if (v->stop) return size <= STOPPED_BLOCK && all + grow <= v->stopped_at + STOPPED_MARGIN;
    v->over_budget = v->starved = false;
    if (all > v->desc.memory || grow > v->desc.memory - all) return false;
    v->over_budget = !vm_take(v, all + grow);
    if (v->over_budget) return false;
    v->spent += grow / BYTES_PER_INSTRUCTION;
    if (v->depth == 0) return true;
    return v->spent - v->seen < TICK && v->spent <= v->budget ? true : vm_check_limits(v);
}

static void *vm_allocate(void *user, void *block, size_t old, size_t size) {
    vm *v = user;
    size_t held = block ? old : 0;
    if (size == 0) {
        mem_free(block);
        v->used -= held;
        return NULL;
    }
    bool string = !block && old == LUA_TSTRING; // a new object: its type is in `old`
    if (string && size > v->desc.longest + STRING_HEAD && v->depth > 0) {
        if (!v->stop && v->lua) vm_locate(v->lua, v->where, sizeof v->where);
        vm_stop_for(v, STOP_STRING);
        return NULL;
    }
    if (size > held && !may_grow(v, size, size - held)) {
        // A new object (its type is in `old`): the stack is in order and can say where we are.
        if (!block && old != 0 && v->lua && v->refusals == 0)
            vm_locate(v->lua, v->where, sizeof v->where);
        if (++v->refusals >= 2 && v->depth > 0)
            vm_stop_for(v, v->over_budget ? STOP_BUDGET : STOP_MEMORY);
        return NULL;
    }
    void *result = mem_try(block, size);
    if (!result && size <= held) result = block; // Lua does not expect that to fail
    v->starved = !result;
    if (!result) return NULL;
    if (size > held) {
        v->refusals = 0;
        note_block(v, size, string);
    }
    v->used = v->used - held + size;
    return result;
}

void vm_charge(lua_State *L, uint64_t instructions) {
    vm *v = vm_of(L);
    if (instructions > UINT64_MAX / 2) instructions = UINT64_MAX / 2;
    v->spent += instructions;
    if (!v->stop && v->spent - v->seen < TICK && v->spent <= v->budget) return;
    if (!v->stop && vm_check_limits(v)) return;
    vm_locate(L, v->where, sizeof v->where);
    raise_stop(L);
}

void vm_look(lua_State *L) {
    vm *v = vm_of(L);
    v->seen = v->spent - TICK;
    vm_charge(L, 0);
}

void vm_charge_memory(lua_State *L, size_t bytes) {
    vm *v = vm_of(L);
    size_t all = taken(v);
    bool within = !v->stop && all <= v->desc.memory && bytes <= v->desc.memory - all;
    if (!within || !vm_take(v, all + bytes)) {
        if (!v->stop) vm_locate(L, v->where, sizeof v->where);
        vm_stop_for(v, within ? STOP_BUDGET : STOP_MEMORY);
        raise_stop(L);
    }
    v->charged += bytes;
}

// ---- errors -----------------------------------------------------------------------------------

// Removes control characters, since scripts come from strangers and terminals obey them.
static void set_error(const char *text) {
    char clean[VM_MESSAGE_MAX];
    size_t n = 0;
    for (; text[n] && n < sizeof clean - 1; n++) {
        unsigned char c = (unsigned char)text[n];
        clean[n] = iscntrl(c) && c != '\n' && c != '\t' ? '?' : (char)c;
    }
    clean[n] = 0;
    err_set("%s", clean);
}

static bool refuse_memory(const vm *v) {
    if (v->over_budget) return err_set("%s", v->refusal);
    if (v->starved) return err_set("out of memory, wanted by a script");
    return err_set("memory limit of %zu MiB exceeded", v->desc.memory >> 20);
}

static void vm_report(vm *v, int status) {
    lua_State *L = v->lua;
    const char *text = lua_type(L, -1) == LUA_TSTRING ? lua_tostring(L, -1) : NULL;
    if (v->stop) {
        char message[VM_MESSAGE_MAX];
        stop_message(v, message, sizeof message);
        const char *callers = text ? strstr(text, VM_CALLED_FROM) : NULL;
        size_t n = strlen(message);
        if (callers) snprintf(message + n, sizeof message - n, "%s", callers);
        set_error(message);
    } else if (status == LUA_ERRMEM) {
        refuse_memory(v);
    } else {
        set_error(text ? text : "(error without a message)");
    }
    lua_pop(L, 1);
}

// ---- calling ----------------------------------------------------------------------------------

bool vm_call(vm *v, int args, int results, uint64_t instructions) {
    lua_State *L = v->lua;
    if (!lua_checkstack(L, results + 8)) {
        lua_pop(L, args + 1);
        return refuse_memory(v);
    }
    if (v->depth == 0) {
        v->stop = STOP_NONE;
        v->refusals = 0;
        v->spent = v->seen = 0;
        v->passed = 0;
        v->budget = instructions;
        v->where[0] = 0;
        // A common machine runs 100 million a second; 2 million a second is not a slow machine but
        // instructions that each do too much.
        v->deadline = time_limit_thread_seconds() + 1 + (double)instructions * 5e-7;
        v->patience = clock_seconds() + 1;
        lua_sethook(L, vm_tick, LUA_MASKCOUNT, v->interval);
    }
    int function = lua_gettop(L) - args;
    lua_pushcfunction(L, vm_describe_error);
    lua_insert(L, function);
    v->depth++;
    locale_t before = str_enter_c_locale(); // tostring and string.format follow the locale
    int status = lua_pcall(L, args, results, function);
    str_leave_c_locale(before);
    v->depth--;
    lua_remove(L, function);
    if (status != LUA_OK) {
        vm_report(v, status);
        return false;
    }
    return true;
}

bool vm_protect(vm *v, lua_CFunction function, void *argument, uint64_t instructions) {
    if (!lua_checkstack(v->lua, 8)) return err_set("the script's stack is full");
    lua_pushcfunction(v->lua, function);
    lua_pushlightuserdata(v->lua, argument);
    return vm_call(v, 1, 0, instructions);
}

// ---- random numbers ---------------------------------------------------------------------------

void vm_set_seed(lua_State *L, uint64_t seed) {
    vm_of(L)->random = seed;
}

// SplitMix64 (Steele, Lea, Flood 2014): the same numbers on every machine.
uint64_t vm_random(lua_State *L) {
    uint64_t z = vm_of(L)->random += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

// ---- life -------------------------------------------------------------------------------------

static int open_sandbox(lua_State *L) {
    sandbox_open(L);
    library_open(L);
    pattern_open(L);
    module_open(L);
    return 0;
}

static int vm_panic(lua_State *L) {
    log_write(LOG_ERROR, "script error outside of a call: %s", lua_tostring(L, -1));
    return 0; // Lua aborts
}

vm *vm_create(const vm_desc *desc) {
    vm *v = mem_alloc(sizeof *v);
    v->desc = *desc;
    if (!desc->longest) v->desc.longest = VM_STRING_MAX;
    v->desc.root = arena_string(&v->memory, desc->root);
    const char **assets = arena_alloc(&v->memory, desc->asset_count * sizeof *assets);
    for (size_t i = 0; i < desc->asset_count; i++)
        assets[i] = arena_string(&v->memory, desc->assets[i]);
    v->desc.assets = assets;
    v->desc.library = desc->library ? arena_string(&v->memory, desc->library) : NULL;
    v->desc.shown = arena_string(&v->memory, desc->shown ? desc->shown : "");
    v->random = desc->seed;
    v->part = budget_take(budget_host(), 0, "the script and what it declares");
    v->interval = TICK;
    lua_State *L = lua_newstate(vm_allocate, v);
    if (!L) {
        if (v->over_budget || v->starved)
            refuse_memory(v);
        else
            err_set("a memory limit of %zu bytes is too small for a script", desc->memory);
        vm_destroy(v);
        return NULL;
    }
    v->lua = L;
    memcpy(lua_getextraspace(L), &v, sizeof v);
    lua_atpanic(L, vm_panic);
    if (!vm_protect(v, open_sandbox, NULL, 1000000)) {
        vm_destroy(v);
        return NULL;
    }
    return v;
}

void vm_destroy(vm *v) {
    if (!v) return;
    if (v->lua) {
        lua_sethook(v->lua, NULL, 0, 0);
        v->stop = STOP_NONE;
        lua_close(v->lua);
    }
    budget_give(v->part);
    arena_free(&v->memory);
    mem_free(v);
}

lua_State *vm_lua(vm *v) {
    return v->lua;
}

vm *vm_of(lua_State *L) {
    vm *v;
    memcpy(&v, lua_getextraspace(L), sizeof v);
    return v;
}

void vm_set_ours(lua_State *L, bool ours) {
    vm_of(L)->ours = ours;
}

void *vm_user(lua_State *L) {
    return vm_of(L)->desc.user;
}

const vm_desc *vm_get_desc(lua_State *L) {
    return &vm_of(L)->desc;
}
