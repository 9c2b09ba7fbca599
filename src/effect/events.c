// Events as text, for `--event`, settings and recipes.
#include "effect/events.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/words.h"
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const char form[] = "SECONDS click X Y, or SECONDS key NAME, as 2.5 click 0.4 0.6";

// Other keys belong to the live window.
static bool is_key(const char *name) {
    static const char *const long_names[] = {"enter", "up", "down"};
    return words_find(long_names, COUNT_OF(long_names), name) >= 0 ||
           ((islower((unsigned char)name[0]) || isdigit((unsigned char)name[0])) && !name[1]);
}

static bool check_key(const char *name) {
    return is_key(name) ||
           err_set("key '%s'; accepted: a letter as f, a digit, enter, up, down", name);
}

static bool check_place(const effect_event *event) {
    float length = 0;
    for (int i = 0; i < event->numbers; i++)
        if (!isfinite(event->at[i])) return err_set("a place of an event is no number");
    if (event->numbers == 2)
        for (int i = 0; i < 2; i++)
            if (!(event->at[i] >= 0 && event->at[i] <= 1))
                return err_set("an event is at %g, %g of the picture; accepted: 0 to 1, from its "
                               "top left",
                               (double)event->at[0], (double)event->at[1]);
    for (int i = 3; i < 6; i++) length += fabsf(event->at[i]);
    return event->numbers != 6 || length > 1e-6f || err_set("the ray of an event has no direction");
}

bool events_check(const effect_event *event) {
    if (!(event->time >= 0 && event->time <= 1e6))
        return err_set("an event is at %g s; accepted: 0 to 1e6", event->time);
    if (event->key[0] && !check_key(event->key)) return false;
    if (!event->key[0] && !event->numbers)
        return err_set("a click needs a place: two numbers, 0 to 1 from the top left of the "
                       "picture, or three of a point (m)");
    return check_place(event);
}

// ---- reading ----------------------------------------------------------------------------------

static const char *skip_spaces(const char *text) {
    return text + strspn(text, " \t,");
}

// Reads the next word, as far as there is room for it, up to the end of the event.
static const char *take_word(const char *text, char *out, size_t capacity) {
    text = skip_spaces(text);
    size_t length = strcspn(text, " \t,;");
    snprintf(out, capacity, "%.*s", (int)(length < capacity ? length : capacity), text);
    return text + length;
}

// Reads a list of 0, 2, 3 or 6 numbers; NULL when there is something else.
static const char *take_place(const char *text, effect_event *out) {
    for (text = skip_spaces(text); *text && *text != ';'; text = skip_spaces(text)) {
        char *end;
        if (out->numbers == 6) return NULL;
        out->at[out->numbers] = str_float(text, &end);
        if (end == text) return NULL;
        out->numbers++;
        text = end;
    }
    bool known = out->numbers == 0 || out->numbers == 2 || out->numbers == 3 || out->numbers == 6;
    return known ? text : NULL;
}

static const char *refuse_event(const char *text) {
    err_set("event '%.*s'; accepted: %s", (int)strcspn(text, ";"), text, form);
    return NULL;
}

static const char *take_event(const char *text, effect_event *out) {
    char word[2 * EFFECT_KEY_SIZE], *end;
    *out = (effect_event){.time = str_double(text, &end)};
    if (end == text) return refuse_event(text);
    const char *next = take_word(end, word, sizeof word);
    if (strcmp(word, "key") == 0) {
        next = take_word(next, word, sizeof word);
        if (!word[0]) return refuse_event(text);
        if (!check_key(word)) return NULL;
        memcpy(out->key, word, EFFECT_KEY_SIZE);
    } else if (strcmp(word, "click") != 0) {
        return refuse_event(text);
    }
    next = take_place(next, out);
    return next ? next : refuse_event(text);
}

bool events_parse(const char *text, effect_event *out, size_t *count) {
    *count = 0;
    for (text = skip_spaces(text); *text; text = skip_spaces(text)) {
        effect_event event;
        const char *end = take_event(text, &event);
        if (!end || !events_check(&event)) return false;
        if (*count == EFFECT_MOST_EVENTS) return err_set("more than %d events", EFFECT_MOST_EVENTS);
        out[(*count)++] = event;
        text = *end ? end + 1 : end;
    }
    return true;
}

// ---- writing ----------------------------------------------------------------------------------

void events_print(const effect_event *list, size_t count, strbuf *out) {
    for (size_t i = 0; i < count; i++) {
        const effect_event *event = &list[i];
        strbuf_add(out, "%s%.9g %s%s", i ? "; " : "", event->time, event->key[0] ? "key " : "click",
                   event->key);
        for (int k = 0; k < event->numbers; k++) {
            strbuf_add(out, " ");
            strbuf_add_float(out, event->at[k]);
        }
    }
}
