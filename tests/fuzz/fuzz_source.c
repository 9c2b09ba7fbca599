// Calls and values found in the text of a script: every range lies within the text, and what is
// read ends.
#include "script/source.h"
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { LINES = 24, CALLS = 4 };

static void within(source_range r, size_t size) {
    if (r.begin > r.end || r.end > size) abort();
}

static void try_table(const char *text, source_range table, size_t size) {
    source_entry e = {.next = table.begin + 1};
    source_range value;
    bool first;
    within(table, size);
    for (size_t last = 0; source_read_entry(text, table, e.next, &e); last = e.next) {
        within(e.all, size);
        within(e.key, size);
        within(e.value, size);
        if (e.next <= last || e.next > table.end) abort();
        source_is_literal(text, e.value);
    }
    if (source_table_end(text, table, &first) > table.end) abort();
    if (source_find_value(text, table, "steps", 0, &value)) within(value, size);
    if (source_find_value(text, table, NULL, 2, &value)) within(value, size);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    char *text = malloc(size + 1);
    if (!text) abort();
    if (size) memcpy(text, data, size);
    text[size] = '\0';
    size = strlen(text);
    for (int line = 1; line <= LINES; line++) {
        source_call calls[CALLS];
        size_t count = source_find_calls(text, "param", line, calls, CALLS);
        for (size_t i = 0; i < count && i < CALLS; i++) {
            within(calls[i].name, size);
            within(source_assigned_name(text, &calls[i]), size);
            try_table(text, calls[i].table, size);
            char purpose[16];
            if (source_purpose(text, calls[i].name.begin, purpose, sizeof purpose) &&
                strnlen(purpose, sizeof purpose) == sizeof purpose)
                abort();
        }
    }
    free(text);
    return 0;
}
