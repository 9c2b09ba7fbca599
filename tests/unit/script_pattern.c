// Patterns: the same results as Lua's own library, and an end to every search.
#include "script/vm.h"
#include <lualib.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// Runs every function on a text and a pattern and writes all results, errors too, as one string.
static const char probe[] =
    "local out, text, pattern, template = {}, ...\n"
    "local function note(...) for i = 1, select('#', ...) do\n"
    "  out[#out + 1] = tostring((select(i, ...))) end out[#out + 1] = ';' end\n"
    "local function bare(f, ...) local r = table.pack(pcall(f, ...))\n"
    "  if not r[1] then r[2] = tostring(r[2]):gsub('^[^:]*:%d+: ', '') end\n"
    "  note(table.unpack(r, 1, r.n)) end\n"
    "bare(string.find, text, pattern) bare(string.match, text, pattern)\n"
    "bare(string.find, text, pattern, 2) bare(string.find, text, pattern, -2)\n"
    "bare(string.find, text, pattern, 1, true) bare(string.find, text, pattern, 99)\n"
    "bare(string.gsub, text, pattern, template) bare(string.gsub, text, pattern, '<%0>', 2)\n"
    "bare(string.gsub, text, pattern, function(a, b) return b and b .. a end)\n"
    "bare(string.gsub, text, pattern, {a = 'A', b = false, ['1'] = 'one'})\n"
    "bare(function() local n = 0 for a, b in string.gmatch(text, pattern) do note(a, b)\n"
    "  n = n + 1 if n > 50 then break end end end)\n"
    "return table.concat(out, ' ')";

static const char *const texts[] = {
    "",           "a",       "hello world", "key = value  ", "  trim me  ",
    "(a(b)c)(d)", "aaaaab",  "THE (quick)", "2024-02-29",    "a.b.c",
    "%d%%",       "x\ny\tz", "[set]^-]",    "abab abab",     "f(g(x), y)",
};
static const char *const patterns[] = {
    "",
    "a",
    "l+",
    "(%w+)",
    "(%w+)%s*=%s*(%w+)",
    "^%s*(.-)%s*$",
    "%b()",
    "a*",
    "a-b",
    "(a*(b))",
    "%f[%a]%a+",
    "(%d+)-(%d+)",
    "[^%s]+",
    "[%]%-^]",
    "[a-c]+",
    "[]]",
    "[^]]*",
    "()",
    "()a()",
    "(ab)%1",
    "a?b?c?",
    ".",
    "^a",
    "b$",
    "a$b",
    "%",
    "[a",
    "(a",
    "a)",
    "%1",
    "%b",
    "%f",
    "(()())",
    "%u%l*",
    "%x+",
    "[%w_%.]+",
    ".-$",
    "(.)(.)",
    "%.",
    "[%a-z]",
    "((((((a))))))",
    "^",
    "$",
    "%g+",
    "%W",
    "%p%P",
    "[a-]",
    "[^a-z%d]",
};

static void results_agree_with_luas_own_library(void **state) {
    (void)state;
    vm_desc desc = {.root = ".", .memory = 64 << 20};
    vm *v = vm_create(&desc);
    lua_State *ours = vm_lua(v), *theirs = luaL_newstate();
    assert_non_null(theirs);
    luaL_openlibs(theirs);
    assert_int_equal(luaL_loadbuffer(ours, probe, strlen(probe), "=probe"), LUA_OK);
    assert_int_equal(luaL_loadbuffer(theirs, probe, strlen(probe), "=probe"), LUA_OK);
    static const char *const templates[] = {"[%1]", "%%%0", "%2", "%x", "plain"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        for (size_t j = 0; j < sizeof patterns / sizeof *patterns; j++) {
            const char *template = templates[(i + j) % (sizeof templates / sizeof *templates)];
            lua_State *states[2] = {ours, theirs};
            for (int k = 0; k < 2; k++) {
                lua_pushvalue(states[k], 1);
                lua_pushstring(states[k], texts[i]);
                lua_pushstring(states[k], patterns[j]);
                lua_pushstring(states[k], template);
            }
            if (!vm_call(v, 3, 1, 1000000)) fail_msg("%s", err_get());
            assert_int_equal(lua_pcall(theirs, 3, 1, 0), LUA_OK);
            if (strcmp(lua_tostring(ours, -1), lua_tostring(theirs, -1)) != 0)
                fail_msg("text '%s', pattern '%s', template '%s':\n ours  %s\n Lua's %s", texts[i],
                         patterns[j], template, lua_tostring(ours, -1), lua_tostring(theirs, -1));
            lua_pop(ours, 1);
            lua_pop(theirs, 1);
        }
    lua_close(theirs);
    vm_destroy(v);
}

static void is_stopped(const char *text) {
    vm_desc desc = {.root = ".", .memory = 64 << 20};
    vm *v = vm_create(&desc);
    assert_int_equal(luaL_loadstring(vm_lua(v), text), LUA_OK);
    if (vm_call(v, 0, 0, 5000000)) fail_msg("not stopped: %s", text);
    if (!strstr(err_get(), "instruction limit")) fail_msg("%s", err_get());
    vm_destroy(v);
}

static void catastrophic_patterns_are_stopped(void **state) {
    (void)state;
    is_stopped("string.find(('a'):rep(200), ('a*'):rep(20) .. 'b')");
    is_stopped("string.match(('a'):rep(3000), ('.-'):rep(10) .. 'b')");
    is_stopped("string.gsub(('a'):rep(200), ('a?'):rep(100) .. ('a'):rep(100) .. 'b', '')");
    is_stopped("for _ in string.gmatch(('a'):rep(200), ('a-'):rep(20) .. 'b') do end");
    is_stopped("string.find(('('):rep(100000), '%b()')");
    is_stopped("local s = ('a'):rep(1 << 20) string.find(s, '[' .. ('bc'):rep(1000) .. ']')");
    is_stopped("while true do pcall(string.find, ('a'):rep(200), ('a*'):rep(20) .. 'b') end");
}

static void plain_search_is_linear(void **state) {
    (void)state;
    vm_desc desc = {.root = ".", .memory = 64 << 20};
    vm *v = vm_create(&desc);
    assert_int_equal(luaL_loadstring(vm_lua(v), "local a = ('a'):rep(1 << 20)\n"
                                                "assert(not string.find(a, ('a'):rep(1 << 19) .. "
                                                "'b', 1, true))"),
                     LUA_OK);
    if (!vm_call(v, 0, 0, 5000000)) fail_msg("%s", err_get());
    vm_destroy(v);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(results_agree_with_luas_own_library),
        cmocka_unit_test(catastrophic_patterns_are_stopped),
        cmocka_unit_test(plain_search_is_linear),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
