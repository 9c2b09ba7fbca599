// Short words for declaring graphs in tests.
#pragma once
#include "base/error.h"
#include "graph/graph.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h> // needs those above

static inline graph_image image(graph *g, const char *name) {
    graph_image made =
        graph_add_image(g, &(graph_image_desc){.name = name, .format = GPU_RGBA16F, .scale = 1});
    assert_int_not_equal(made.id, 0);
    return made;
}

typedef struct uses {
    graph_image at[4]; // zero handles are passed over
} uses;

static inline void pass_keeping(graph *g, const char *name, uses reads, uses writes, bool keep) {
    assert_true(graph_add_pass(g, &(graph_pass_desc){.name = name,
                                                     .reads = reads.at,
                                                     .read_count = 4,
                                                     .writes = writes.at,
                                                     .write_count = 4,
                                                     .keep = keep}));
}

static inline void pass(graph *g, const char *name, uses reads, uses writes) {
    pass_keeping(g, name, reads, writes, false);
}

#define NOTHING ((uses){0})
#define USES(...) ((uses){{__VA_ARGS__}})

static inline void compile(graph *g) {
    if (!graph_compile(g, 640, 360)) fail_msg("graph_compile: %s", err_get());
}

// The order as one text, "a b c".
static inline void assert_order(const graph *g, const char *expected) {
    const char *names[64];
    size_t count = graph_order(g, names, 64);
    strbuf text = {0};
    for (size_t i = 0; i < count; i++) strbuf_add(&text, "%s%s", i ? " " : "", names[i]);
    assert_string_equal(strbuf_text(&text), expected);
    strbuf_free(&text);
}

static inline void assert_error(const char *part) {
    if (!strstr(err_get(), part)) fail_msg("'%s' is not in the message: %s", part, err_get());
}
