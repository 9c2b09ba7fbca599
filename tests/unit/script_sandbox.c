// The sandbox: what a script cannot reach, and how it is stopped.
#include "base/file.h"
#include "base/log.h"
#include "base/time_limit.h"
#include "script/vm.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

enum { MEMORY = 128 << 20, INSTRUCTIONS = 5000000 };

static char folder[PATH_CAP], outside[PATH_CAP], library[PATH_CAP];
static int files_read;

static void count_file(void *user, const char *path) {
    (void)user, (void)path;
    files_read++;
}

static void put(const char *in, const char *name, const char *text, size_t size) {
    char path[PATH_CAP];
    assert_true(path_join(path, in, name));
    assert_true(file_make_parent_folders(path));
    assert_true(file_write(path, text, size));
}

static vm *machine(void) {
    vm_desc desc = {.root = folder, .library = library, .memory = MEMORY, .on_file = count_file};
    vm *v = vm_create(&desc);
    assert_non_null(v);
    return v;
}

static bool run_bytes(const char *text, size_t size) {
    put(folder, "effect.lua", text, size);
    char path[PATH_CAP];
    assert_true(path_join(path, folder, "effect.lua"));
    vm *v = machine();
    err_clear();
    bool ok = vm_run_file(v, path, "effect.lua", INSTRUCTIONS, false);
    assert_int_equal(lua_gettop(vm_lua(v)), 0);
    vm_destroy(v);
    return ok;
}

static void passes(const char *text) {
    if (!run_bytes(text, strlen(text))) fail_msg("%s\n  in: %s", err_get(), text);
}

static void fails(const char *text, const char *message) {
    if (run_bytes(text, strlen(text))) fail_msg("no error in: %s", text);
    if (!strstr(err_get(), message))
        fail_msg("error \"%s\"\n  lacks: %s\n  in: %s", err_get(), message, text);
}

// The message must begin with this.
static void fails_with(const char *text, const char *start) {
    fails(text, start);
    if (strncmp(err_get(), start, strlen(start)) != 0)
        fail_msg("error \"%s\"\n  does not begin with: %s", err_get(), start);
}

// ---- reach ------------------------------------------------------------------------------------

static void system_libraries_are_missing_and_say_so(void **state) {
    (void)state;
    static const char *const names[] = {"io",     "os",       "debug",          "package",  "load",
                                        "dofile", "loadfile", "collectgarbage", "coroutine"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char text[100], message[100];
        snprintf(text, sizeof text, "local x = %s", names[i]);
        snprintf(message, sizeof message, "effect.lua:1: '%s' is not available", names[i]);
        fails_with(text, message);
        snprintf(text, sizeof text, "assert(rawget(_G, '%s') == nil)", names[i]);
        passes(text);
    }
    passes("assert(string.dump == nil)");
}

static void binary_chunks_are_refused(void **state) {
    (void)state;
    static const char chunk[] = "\x1bLua\x54\x00\x19\x93\r\n\x1a\n\x04\x08\x08";
    assert_false(run_bytes(chunk, sizeof chunk));
    assert_non_null(strstr(err_get(), "effect.lua: compiled Lua"));
    put(folder, "module.lua", chunk, sizeof chunk);
    fails("require 'module'", "compiled Lua");
}

static void a_byte_order_mark_is_skipped(void **state) {
    (void)state;
    passes("\xef\xbb\xbflocal x = 1");
}

static void misspelt_globals_get_a_suggestion(void **state) {
    (void)state;
    fails_with("\nlocal s = pritn('x')",
               "effect.lua:2: unknown name 'pritn'; did you mean 'print'?");
    fails_with("wholly_unlike_anything()", "effect.lua:1: unknown name 'wholly_unlike_anything'");
    assert_null(strstr(err_get(), "did you mean"));
    passes("x = 1; assert(x == 1)");
}

static void protected_metatables_stay(void **state) {
    (void)state;
    passes("assert(getmetatable('') == false)");
    passes("assert(getmetatable(_G) == false)");
    fails("setmetatable(_G, {})", "protected metatable");
    fails("setmetatable('x', {})", "table expected");
    fails("setmetatable({}, {__gc = print})", "finalizers");
    fails("setmetatable({}, 3)", "nil or table");
    passes("local t = setmetatable({}, {__index = {a = 1}}); assert(t.a == 1)");
}

// ---- require ----------------------------------------------------------------------------------

static void require_finds_modules_in_effect_then_library(void **state) {
    (void)state;
    put(folder, "parts/smoke.lua", "count = (rawget(_G, 'count') or 0) + 1 return {name = ...}",
        58);
    put(library, "shared_part.lua", "return 42", 9);
    files_read = 0;
    passes("local a, b = require 'parts.smoke', require 'parts/smoke'\n"
           "assert(a.name == 'parts.smoke' and require('parts.smoke') == a)\n"
           "assert(require 'shared_part' == 42)");
    assert_int_equal(files_read, 4); // effect, the module under two names, the library's
    put(folder, "empty.lua", "", 0);
    passes("assert(require 'empty' == true)");
}

static void require_stays_inside(void **state) {
    (void)state;
    put(outside, "secret.lua", "return 'secret'", 15);
    static const char *const names[] = {"../x",  "..", "/etc/passwd", "a/../b", "./x", "a//b",
                                        "a\\0b", "",   "a b",         "~/x"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char text[100];
        snprintf(text, sizeof text, "require '%s'", names[i]);
        fails(text, "bad module name");
    }
    char target[PATH_CAP], link[PATH_CAP];
    assert_true(path_join(target, outside, "secret.lua"));
    assert_true(path_join(link, folder, "escape.lua"));
    assert_int_equal(symlink(target, link), 0);
    fails("require 'escape'", "effect.lua:1: require:");
    assert_int_equal(unlink(link), 0);
    fails("require 'missing_one'", "no module 'missing_one'");
}

static void modules_that_require_each_other_are_reported(void **state) {
    (void)state;
    put(folder, "one.lua", "require 'two'", 13);
    put(folder, "two.lua", "require 'one'", 13);
    fails_with("require 'one'", "two.lua:1: require: 'one' failed to load, or requires itself");
}

static void errors_in_modules_name_their_line(void **state) {
    (void)state;
    put(folder, "broken.lua", "\n\nerror 'bad'", 13);
    fails_with("require 'broken'", "broken.lua:3: bad");
    put(folder, "syntax.lua", "\nlocal = 3", 10);
    fails_with("require 'syntax'", "syntax.lua:2: ");
}

// ---- limits -----------------------------------------------------------------------------------

static void endless_loops_end(void **state) {
    (void)state;
    fails_with("\n\nwhile true do end", "effect.lua:3: instruction limit of 5000000 exceeded");
    fails("local function f() return f() end f()", "instruction limit");
    fails("for i = 1, math.maxinteger do end", "instruction limit");
    fails("repeat until false", "instruction limit");
    fails("goto a ::b:: ::a:: goto b", "instruction limit");
}

static void pcall_cannot_outlive_a_limit(void **state) {
    (void)state;
    fails("while true do pcall(function() while true do end end) end", "instruction limit");
    fails("local function f() while true do pcall(f) end end f()", "instruction limit");
    fails("local function f() while true do end end\n"
          "while true do xpcall(f, function() while true do end end) end",
          "instruction limit");
    fails("local function loop() while true do end end\n"
          "local x <close> = setmetatable({}, {__close = loop}) loop()",
          "instruction limit");
    fails("while true do pcall(string.rep, 'x', 1 << 40) pcall(string.rep, 'x', 130 << 20) end",
          "limit");
    fails("local t = {} while true do pcall(function() while true do t[#t + 1] = #t end end) end",
          "limit");
}

static void memory_bombs_end(void **state) {
    (void)state;
    fails_with("\nlocal s = string.rep('x', 1 << 30)",
               "effect.lua:2: string.rep: memory limit of 4 MiB for one string exceeded");
    fails("string.rep('x', math.maxinteger)", "string.rep: memory limit of 4 MiB");
    fails_with("local s = 'x'\nwhile true do\ns = s .. s\nend",
               "effect.lua:3: memory limit of 4 MiB for one string exceeded");
    fails_with("local t = {}\nlocal s = ('x'):rep(1 << 20)\nfor i = 1, 1e9 do t[i] = s .. i end",
               "effect.lua:3: memory limit of 128 MiB exceeded");
    fails("local t = {} while true do t = {t} end", "limit");
    fails("local t = {} for i = 1, 1e9 do t[i] = i end", "limit");
    fails("string.format('%s%s', ('x'):rep(60 << 20), ('x'):rep(60 << 20))", "memory limit");
    fails("local s, t = ('x'):rep(99999), {} for i = 1, 2000 do t[i] = s end table.concat(t)",
          "memory limit");
    fails("local f = ('x'):rep(1 << 20) f:gsub('.', ('y'):rep(1000))", "memory limit");
}

static void a_caught_small_refusal_does_not_end_the_script(void **state) {
    (void)state;
    passes("assert(not pcall(error, 'x')) assert(not pcall(string.rep, 'x', 1 << 62))");
}

static void garbage_does_not_count(void **state) {
    (void)state;
    passes("local k = ('x'):rep(1 << 10) for i = 1, 160 do local s = k:rep(1 << 10) end");
}

static void loops_inside_c_functions_are_charged(void **state) {
    (void)state;
    fails("table.move({}, 1, 1 << 60, 2)", "instruction limit");
    fails("table.concat(setmetatable({}, {__index = type}), '', 1, 1 << 60)", "instruction limit");
    fails("table.insert(setmetatable({}, {__len = function() return 1 << 60 end}), 1, 0)", "__len");
    fails("while true do local a = ('x'):rep(1 << 22) end", "instruction limit");
    fails("while true do select('#', table.unpack({}, 1, 900000)) end", "instruction limit");
    fails("while true do print() end", "instruction limit");
    passes("local t = {3, 1, 2} table.sort(t) assert(table.concat(t, ',') == '1,2,3')\n"
           "table.insert(t, 4) table.insert(t, 1, 0) assert(table.remove(t) == 4)\n"
           "assert(select('#', table.unpack(t)) == 4 and #table.move(t, 1, 4, 2) == 5)");
}

static void long_comparisons_are_stopped_by_processor_time(void **state) {
    (void)state;
    fails("local a = ('x'):rep(1 << 22) local b = ('x'):rep(1 << 22)\n"
          "while true do local c = a == b end",
          "instruction limit");
}

static double processor_seconds(void) {
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
}

// Within a budget that is shorter than all other limits, each ends soon after it: what it can do
// between two looks at the limits is bounded.
static void nothing_runs_long_between_two_looks(void **state) {
    (void)state;
#define LONG                                                                                       \
    "local n, s, t, e = 1 << 22, ('x'):rep(1 << 22), {}, setmetatable({}, {__index = rawlen}) "
    static const char *const attacks[] = {
        "while true do end",
        LONG "local a, b = s:sub(2), s:sub(2) while true do local c = a < b end",
        LONG "local a = ('\\0'):rep(n) local b = a:sub(2) .. 'x' while true do local c = a < b end",
        LONG "for i = 1, 500000 do t[i] = s end table.sort(t)",
        LONG "for i = 1, 500000 do t[i] = s end while true do pcall(table.sort, t, rawequal) end",
        LONG "for i = 1, 1000000 do t[i] = -i end while true do table.sort(t) end",
        LONG "for i = 1, 20 do t[('\\0'):rep(n // 2) .. i] = i end while true do pairs(t) end",
        LONG "while true do table.concat(e, '', 1, 1 << 60) end",
        LONG "table.concat(setmetatable({}, {__index = function() return '' end}), '', 1, 1 << 60)",
        LONG "while true do pcall(table.move, e, 1, 1 << 60, 1, {}) end",
        LONG "for i = 1, 2000000 do t[i] = i end while true do table.insert(t, 1, 0) end",
        LONG "for i = 1, 2000000 do t[i] = i end while true do table.remove(t, 1) end",
        LONG "while true do pcall(table.unpack, e, 1, 900000) end",
        LONG "for i = 1, 4000000 do t[i] = i end for i = 1, 4000000 do t[i] = nil end "
             "while true do next(t) end",
        LONG
        "local function f(...) while true do math.max(...) end end f(table.unpack(e, 1, 490000))",
        LONG
        "local function f(...) while true do utf8.char(...) end end f(table.unpack(e, 1, 60000))",
        LONG "while true do pcall(string.pack, 'c2000000000', '') end",
        LONG "while true do string.pack('c4000000', '') end",
        LONG "local f = ('%.99f'):rep(9000) for i = 1, 9000 do t[i] = 1e308 end "
             "while true do f:format(table.unpack(t)) end",
        LONG "while true do utf8.len(s) end",
        LONG "while true do tonumber(s, 36) end",
        LONG "while true do s:gsub('', rawlen) end",
        LONG "while true do s:find('[' .. s .. 'y]y') end",
        LONG "while true do s:gsub('x', '%%0%%0') end",
        LONG "while true do s:rep(1) s:upper() s:reverse() end",
        LONG "while true do ('x'):rep(n) end",
        LONG "while true do local q = t[s .. 'x'] end",
        LONG "while true do pcall(string.rep, '', 1 << 62) end",
    };
    for (size_t i = 0; i < sizeof attacks / sizeof *attacks; i++) {
        time_limit b = {.what = "load", .limit = 0.3};
        put(folder, "effect.lua", attacks[i], strlen(attacks[i]));
        char path[PATH_CAP];
        assert_true(path_join(path, folder, "effect.lua"));
        vm *v = machine();
        time_limit *before = time_limit_enter(&b);
        double start = processor_seconds();
        bool ended = vm_run_file(v, path, "effect.lua", UINT64_MAX / 2, false);
        double took = processor_seconds() - start;
        time_limit_leave(before);
        vm_destroy(v);
        if (ended) fail_msg("no error in: %s", attacks[i]);
        // Of the thread's processor time; what is wrong here takes minutes, or never ends.
        if (took > 10) fail_msg("%g s, instead of 0.3 s: %s", took, attacks[i]);
        // Most end by the time limit; where the machine is fast enough, by one of memory.
        if (!strstr(err_get(), "time limit of 0.3 s for a load exceeded; --time-limit") &&
            !strstr(err_get(), "memory limit of"))
            fail_msg("error \"%s\"\n  in: %s", err_get(), attacks[i]);
    }
}

static void repeating_nothing_ends_at_once(void **state) {
    (void)state;
    passes("assert(string.rep('', 1 << 62) == '' and string.rep('', 1 << 62, '') == '')");
    passes("assert(string.rep('ab', 3, '-') == 'ab-ab-ab' and string.rep('x', -1) == '')");
}

static void deep_recursion_is_an_error(void **state) {
    (void)state;
    fails("local function f() return 1 + f() end f()", "stack overflow");
    fails(
        "local t = setmetatable({}, {}) getmetatable(t).__index = function(a, k) return a[k] end\n"
        "local x = t.x",
        "C stack overflow");
    fails("local function f() return (('x'):gsub('.', f)) end f()", "C stack overflow");
    char text[3000] = "local x = ";
    memset(text + strlen(text), '(', 1000);
    fails(text, "C stack overflow");
}

static void memory_too_small_for_lua_is_refused(void **state) {
    (void)state;
    for (size_t size = 0; size < 60000; size += 997) {
        vm_desc desc = {.root = folder, .memory = size};
        vm *v = vm_create(&desc);
        if (!v) assert_non_null(strstr(err_get(), "memory limit"));
        vm_destroy(v);
    }
}

// ---- messages ---------------------------------------------------------------------------------

static void errors_carry_line_and_callers(void **state) {
    (void)state;
    fails_with("local function f()\n  local x = nil + 1\nend\nf()", "effect.lua:2: attempt to");
    assert_non_null(strstr(err_get(), "\ncalled from effect.lua:4"));
    fails_with("error('plain', 0)", "effect.lua:1: plain");
    assert_null(strchr(err_get(), '\n')); // no word of Lua's insides
    fails_with("\ntable.insert({}, 5, 1)", "effect.lua:2: bad argument");
}

static void errors_that_are_no_strings_are_described(void **state) {
    (void)state;
    fails_with("error({})", "effect.lua:1: (error object is a table value)");
    fails_with("error()", "effect.lua:1: (error object is a nil value)");
    fails_with("error(setmetatable({}, {__tostring = function() return 'mine' end}))",
               "effect.lua:1: mine");
    fails("error(setmetatable({}, {__tostring = function() error('again') end}))", "");
    fails("error(('x'):rep(1 << 20))", "xxxx");
}

static void messages_are_no_formats_and_no_terminal_codes(void **state) {
    (void)state;
    fails("error '%s%n%s'", "%s%n%s");
    fails("error '\\27[2Jx'", "?[2Jx");
    passes("print('%s%n', '\\27[2J', {}, nil)");
}

// ---- the same every time ----------------------------------------------------------------------

static void random_numbers_repeat(void **state) {
    (void)state;
    passes("math.randomseed(7) local a, b = math.random(), math.random(1 << 62)\n"
           "math.randomseed(7) assert(a == math.random() and b == math.random(1 << 62))\n"
           "for i = 1, 1000 do local r = math.random(3, 5) assert(r >= 3 and r <= 5) end\n"
           "for i = 1, 1000 do local r = math.random() assert(r >= 0 and r < 1) end\n"
           "math.random(math.mininteger, math.maxinteger)");
    passes("assert(string.format('%.17g', math.random()) == '0.88331080821364261')");
    fails("math.random(2, 1)", "interval is empty");
}

static void pairs_goes_in_order(void **state) {
    (void)state;
    passes(
        "local t = {z = 1, b = 2, [3] = 3, a = 4, [1.5] = 5, [true] = 6, 10, 20}\n"
        "local keys = {} for k, v in pairs(t) do keys[#keys + 1] = tostring(k) "
        "assert(t[k] == v) end\n"
        "assert(table.concat(keys, ' ') == '1 1.5 2 3 a b z true', table.concat(keys, ' '))\n"
        "for k in pairs(t) do t[k] = nil end assert(next(t) == nil)\n"
        "local n = 0 for k, v in pairs(setmetatable({}, {__pairs = function() "
        "return function(_, i) if i < 3 then return i + 1 end end, nil, 0 end})) do n = n + k end "
        "assert(n == 6)");
    fails("pairs()", "bad argument");
    fails("for k in pairs(3) do end", "bad argument");
}

// ---- calls ------------------------------------------------------------------------------------

static void a_call_has_its_own_budget(void **state) {
    (void)state;
    put(folder, "effect.lua", "function f(n) for i = 1, n do end return n end", 46);
    char path[PATH_CAP];
    assert_true(path_join(path, folder, "effect.lua"));
    vm *v = machine();
    assert_true(vm_run_file(v, path, "effect.lua", INSTRUCTIONS, false));
    lua_State *L = vm_lua(v);
    for (int i = 0; i < 100; i++) {
        assert_int_equal(lua_getglobal(L, "f"), LUA_TFUNCTION);
        lua_pushinteger(L, 50000);
        assert_true(vm_call(v, 1, 1, 100000));
        assert_int_equal(lua_tointeger(L, -1), 50000);
        lua_pop(L, 1);
    }
    for (int i = 0; i < 3; i++) {
        lua_getglobal(L, "f");
        lua_pushinteger(L, 1000000);
        assert_false(vm_call(v, 1, 1, 100000));
        assert_non_null(strstr(err_get(), "instruction limit of 100000 exceeded"));
        assert_int_equal(lua_gettop(L), 0);
    }
    lua_getglobal(L, "f");
    lua_pushinteger(L, 1);
    assert_true(vm_call(v, 1, 0, 100000));
    vm_destroy(v);
}

static int make_folders(void **state) {
    (void)state;
    log_set_level(LOG_WARNING);
    const char *temporary = getenv("TMPDIR");
    char base[PATH_CAP];
    snprintf(base, sizeof base, "%s/roil-sandbox-XXXXXX", temporary ? temporary : "/tmp");
    assert_non_null(mkdtemp(base));
    return path_join(folder, base, "effect") && path_join(outside, base, "outside") &&
                   path_join(library, base, "library")
               ? 0
               : 1;
}

static int remove_folders(void **state) {
    (void)state;
    char base[PATH_CAP], command[PATH_CAP + 20];
    path_folder(base, folder);
    snprintf(command, sizeof command, "rm -rf '%s'", base);
    return system(command);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(system_libraries_are_missing_and_say_so),
        cmocka_unit_test(binary_chunks_are_refused),
        cmocka_unit_test(a_byte_order_mark_is_skipped),
        cmocka_unit_test(misspelt_globals_get_a_suggestion),
        cmocka_unit_test(protected_metatables_stay),
        cmocka_unit_test(require_finds_modules_in_effect_then_library),
        cmocka_unit_test(require_stays_inside),
        cmocka_unit_test(modules_that_require_each_other_are_reported),
        cmocka_unit_test(errors_in_modules_name_their_line),
        cmocka_unit_test(endless_loops_end),
        cmocka_unit_test(pcall_cannot_outlive_a_limit),
        cmocka_unit_test(nothing_runs_long_between_two_looks),
        cmocka_unit_test(repeating_nothing_ends_at_once),
        cmocka_unit_test(memory_bombs_end),
        cmocka_unit_test(a_caught_small_refusal_does_not_end_the_script),
        cmocka_unit_test(garbage_does_not_count),
        cmocka_unit_test(loops_inside_c_functions_are_charged),
        cmocka_unit_test(long_comparisons_are_stopped_by_processor_time),
        cmocka_unit_test(deep_recursion_is_an_error),
        cmocka_unit_test(memory_too_small_for_lua_is_refused),
        cmocka_unit_test(errors_carry_line_and_callers),
        cmocka_unit_test(errors_that_are_no_strings_are_described),
        cmocka_unit_test(messages_are_no_formats_and_no_terminal_codes),
        cmocka_unit_test(random_numbers_repeat),
        cmocka_unit_test(pairs_goes_in_order),
        cmocka_unit_test(a_call_has_its_own_budget),
    };
    return cmocka_run_group_tests(tests, make_folders, remove_folders);
}
