#include "app/arguments.h"
#include "base/memory.h"
#include "base/str.h"
#include <stdio.h>
#include <string.h>

void arguments_add(arguments *a, const char *text) {
    MEM_RESERVE(a->list, a->count + 2, a->capacity);
    a->list[a->count++] = mem_copy(text, strlen(text) + 1);
    a->list[a->count] = NULL;
}

void arguments_add_number(arguments *a, double number) {
    char text[32];
    snprintf(text, sizeof text, "%.9g", number);
    arguments_add(a, text);
}

void arguments_add_moved(arguments *a, roil_effect *e) {
    for (size_t i = 0; i < roil_control_count(e); i++) {
        roil_control c;
        roil_get_control(e, i, &c);
        char *text = c.moved ? roil_control_text(e, c.name) : NULL;
        if (!text) continue;
        strbuf setting = {0};
        strbuf_add(&setting, "%s=%s", c.name, text);
        arguments_add(a, "--set");
        arguments_add(a, strbuf_text(&setting));
        strbuf_free(&setting);
        roil_free(text);
    }
}

static void add_option(arguments *a, const char *name, double number) {
    if (!(number > 0)) return;
    arguments_add(a, name);
    arguments_add_number(a, number);
}

void arguments_add_device(arguments *a, const app_device *d) {
    if (d->name) arguments_add(a, "--device");
    if (d->name) arguments_add(a, d->name);
    if (d->memory) arguments_add(a, "--memory");
    if (d->memory) arguments_add(a, d->memory);
    for (size_t i = 0; d->assets && d->assets[i]; i++) {
        arguments_add(a, "--assets");
        arguments_add(a, d->assets[i]);
    }
    if (d->validate) arguments_add(a, "--validate");
    if (d->no_cache) arguments_add(a, "--no-cache");
    add_option(a, "--timeout", d->timeout);
    add_option(a, "--time-limit", d->time_limit);
}

void arguments_free(arguments *a) {
    for (size_t i = 0; i < a->count; i++) mem_free(a->list[i]);
    mem_free(a->list);
    *a = (arguments){0};
}
