// The text that random graphs become: every name is declared before it is used, where it can be
// seen, and once. (tests/gpu/field_graph.c compiles fewer of them, and compares values.)
//
//   unit_field_graph [GRAPHS [SEED]]    3000
#include "field_graph.h"

#include "field/program.h"
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>

enum { MOST_NAMES = 1 << 15, MOST_SCOPES = 256 };

static uint32_t graphs = 3000, first_seed = 1;

typedef struct text_name { // vN or rN
    char letter;
    uint32_t number;
} text_name;

typedef struct reader {
    text_name seen[MOST_NAMES]; // those that can be seen, outer scopes first
    size_t count, scopes[MOST_SCOPES], depth;
} reader;

static bool is_seen(const reader *r, text_name n, size_t from) {
    for (size_t i = from; i < r->count; i++)
        if (r->seen[i].letter == n.letter && r->seen[i].number == n.number) return true;
    return false;
}

// A word of the text; `declares`: the one before was a type. NULL or what is wrong.
static const char *read_word(reader *r, const char *word, size_t length, bool declares) {
    bool ours = (word[0] == 'v' || word[0] == 'r') && length > 1;
    for (size_t i = 1; i < length; i++) ours = ours && isdigit((unsigned char)word[i]);
    if (!ours || r->depth == 0) return NULL;
    text_name n = {word[0], (uint32_t)strtoul(word + 1, NULL, 10)};
    if (!declares) return is_seen(r, n, 0) ? NULL : "is not declared";
    if (is_seen(r, n, r->scopes[r->depth - 1])) return "is declared twice";
    assert_true(r->count < MOST_NAMES);
    r->seen[r->count++] = n;
    return NULL;
}

static bool is_type(const char *word, size_t length) {
    static const char *const types[] = {"float",  "vec3",   "vec4",  "range1",
                                        "range3", "range4", "range2"};
    for (size_t i = 0; i < COUNT_OF(types); i++)
        if (strlen(types[i]) == length && strncmp(word, types[i], length) == 0) return true;
    return false;
}

static void check_text(const char *text, uint32_t seed) {
    static reader r;
    bool declares = false;
    r.count = r.depth = 0;
    for (const char *c = text; *c;) {
        size_t length = 0;
        while (isalnum((unsigned char)c[length]) || c[length] == '_') length++;
        if (*c == '/' && c[1] == '/') length = strcspn(c, "\n");
        if (*c == '{') {
            assert_true(r.depth < MOST_SCOPES);
            r.scopes[r.depth++] = r.count;
        } else if (*c == '}') {
            assert_true(r.depth > 0);
            r.count = r.scopes[--r.depth];
        } else if (length && *c != '/') {
            const char *wrong = read_word(&r, c, length, declares);
            if (wrong)
                fail_msg("seed %u: %.*s %s:\n%.*s\n%s", seed, (int)length, c, wrong,
                         (int)strcspn(c, "\n"), c, text);
        }
        if (length || !isspace((unsigned char)*c)) declares = is_type(c, length);
        c += length ? length : 1;
    }
    assert_int_equal(r.depth, 0);
}

static void names_are_declared_once_before_they_are_used(void **state) {
    (void)state;
    size_t whole = 0;
    for (uint32_t i = 0; i < graphs; i++) {
        graph g;
        arena memory = {0};
        graph_grow(&g, first_seed + i);
        field_root roots[] = {{"a", graph_root(&g, 1), 1, ""}, {"b", graph_root(&g, 3), 3, "a"}};
        const field_program *p = field_program_create(&memory, roots, COUNT_OF(roots));
        if (p) check_text(field_program_text(p), first_seed + i);
        whole += p != NULL;
        arena_free(&memory);
        arena_free(build_memory());
    }
    assert_true(whole > graphs * 9 / 10); // others have too many operations
}

int main(int count, char **words) {
    if (count > 1) graphs = (uint32_t)strtoul(words[1], NULL, 0);
    if (count > 2) first_seed = (uint32_t)strtoul(words[2], NULL, 0);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_are_declared_once_before_they_are_used),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
