// Chooses the controls that affect an effect's quality, and values to try.
#include "base/error.h"
#include "base/memory.h"
#include "base/swap.h"
#include "base/words.h"
#include "bench/tune.h"
#include <math.h>
#include <string.h>

// What the reference has: the best value, or the effect's own, as for the octaves of a noise, which
// are a matter of its look.
typedef enum truth { TRUTH_MORE, TRUTH_NOW } truth;

typedef struct rule {
    const char *name;   // of a control behind its dot; of a parameter also the end of its name
    const char *group;  // of a pass: its name begins so; NULL: any
    const char *unless; // of a pass: only if there is none whose name begins so; NULL: always
    bool factors;       // `values` are factors of what it is now
    truth truth;
    const float *values; // rising; ends with a negative one. NULL: the words of an option
} rule;

static const float parts[] = {0.125f, 0.1875f, 0.25f, 0.375f, 0.5f, 0.75f, 1, 1.5f, 2, 4, -1};
static const float scales[] = {0.25f, 0.35f, 0.5f, 0.7f, 1, -1};
static const float few[] = {0, 1, 2, 3, 4, 6, 8, -1};
static const float octaves[] = {1, 2, 3, 4, 5, 6, 7, 8, -1};
static const float amounts[] = {0, 0.5f, 1, -1};
static const float powers[] = {1, 2, 4, 8, 16, -1};

// A march that takes its light from `lighting` computes neither shadows nor scattering.
static const rule rules[] = {
    {"steps", NULL, NULL, true, TRUTH_MORE, parts},
    {"resolution", "march", NULL, false, TRUTH_MORE, scales},
    {"shadow_resolution", NULL, NULL, false, TRUTH_MORE, NULL},
    {"glow_resolution", NULL, NULL, false, TRUTH_MORE, NULL},
    {"shadow_steps", NULL, "lighting", true, TRUTH_MORE, parts},
    {"sweeps", NULL, NULL, false, TRUTH_MORE, few},
    {"octaves", NULL, "lighting", false, TRUTH_NOW, octaves},
    {"jitter", NULL, NULL, false, TRUTH_NOW, amounts},
    {"frames", "accumulate", NULL, false, TRUTH_NOW, powers},
    {"bake", NULL, NULL, false, TRUTH_MORE, NULL},
    {"baked", NULL, NULL, false, TRUTH_MORE, NULL},
    {"quality", NULL, NULL, false, TRUTH_MORE, NULL},
};

static bool begins(const char *text, const char *with) {
    return strncmp(text, with, strlen(with)) == 0;
}

static bool has_pass(roil_effect *e, const char *name) {
    size_t controls = roil_control_count(e);
    for (size_t i = 0; i < controls; i++) {
        roil_control c;
        roil_get_control(e, i, &c);
        if (!c.parameter && begins(c.group, name)) return true;
    }
    return false;
}

static bool fits(roil_effect *e, const rule *r, const roil_control *c) {
    size_t length = strlen(c->label), end = strlen(r->name);
    if (strcmp(c->label, r->name) == 0)
        return c->parameter || ((!r->group || begins(c->group, r->group)) &&
                                (!r->unless || !has_pass(e, r->unless)));
    return c->parameter && !r->group && length > end && c->label[length - end - 1] == '_' &&
           str_ends_with(c->label, r->name);
}

static const rule *find_rule(roil_effect *e, const roil_control *c) {
    for (size_t i = 0; i < COUNT_OF(rules); i++)
        if (fits(e, &rules[i], c)) return &rules[i];
    return NULL;
}

// ---- values -------------------------------------------------------------------------------------

static const char *number_text(float value, arena *memory) {
    strbuf text = {0};
    strbuf_add_float(&text, value);
    const char *kept = arena_string(memory, text.text);
    strbuf_free(&text);
    return kept;
}

// Adds a number in rising order, if it is not in the list. The value of now is always in it.
static void add_number(float *all, size_t *count, float value) {
    size_t at = *count;
    while (at > 0 && all[at - 1] > value) at--;
    bool known = at > 0 && all[at - 1] == value;
    if (known || *count == SEARCH_MAX_RUNGS) return;
    for (size_t i = (*count)++; i > at; i--) all[i] = all[i - 1];
    all[at] = value;
}

static void take_numbers(const roil_control *c, const float *values, bool factors, truth t,
                         arena *memory, tune_axis *out) {
    float all[SEARCH_MAX_RUNGS], now = c->value[0];
    size_t count = 0;
    add_number(all, &count, now);
    for (const float *v = values; *v >= 0; v++) {
        float value = factors ? *v * now : *v;
        if (c->type == ROIL_INT) value = roundf(value);
        if (value < c->min || value > c->max || (t == TRUTH_NOW && value > now)) continue;
        add_number(all, &count, value);
    }
    for (size_t i = 0; i < count; i++) {
        out->values[i] = number_text(all[i], memory);
        if (all[i] == now) out->start = i;
    }
    out->count = count;
    out->reference = t == TRUTH_NOW ? out->start : count - 1;
}

// Takes words in their order, from cheap to expensive, and numbers up to the second above that of
// now, since what doubles in three dimensions soon exceeds any device.
static void take_words(const roil_control *c, truth t, tune_axis *out) {
    static const char *const truths[] = {"false", "true"};
    const char *const *words = c->type == ROIL_BOOL ? truths : c->words;
    size_t all = c->type == ROIL_BOOL ? 2 : c->word_count, now = (size_t)c->value[0];
    bool numbers = strspn(words[0], "0123456789") == strlen(words[0]);
    size_t end = numbers && now + 3 < all ? now + 3 : all;
    size_t first = end > SEARCH_MAX_RUNGS ? end - SEARCH_MAX_RUNGS : 0;
    for (size_t i = first; i < end; i++) out->values[out->count++] = words[i];
    out->start = now - first;
    out->reference = t == TRUTH_NOW ? out->start : out->count - 1;
}

static void axis_swap(tune_axis *a, size_t i, size_t k) {
    SWAP(a->values[i], a->values[k]);
    a->start = a->start == i ? k : a->start == k ? i : a->start;
}

// Baking is cheaper than not baking, so the word for the latter is moved to the end.
static void put_exact_last(tune_axis *a) {
    static const char *const words[] = {"false", "off", "none", "exact"};
    for (size_t i = 0; i + 1 < a->count; i++)
        if (words_find(words, COUNT_OF(words), a->values[i]) >= 0) axis_swap(a, i, i + 1);
}

static bool has_words(const roil_control *c) {
    return c->type == ROIL_BOOL || c->type == ROIL_ENUM;
}

static bool has_number(const roil_control *c) {
    return (c->type == ROIL_FLOAT || c->type == ROIL_INT) && c->components == 1;
}

// False when there is nothing to choose from.
static bool take_values(const roil_control *c, const rule *r, arena *memory, tune_axis *out) {
    *out = (tune_axis){.name = arena_string(memory, c->name)};
    if (has_words(c))
        take_words(c, r ? r->truth : TRUTH_MORE, out);
    else if (has_number(c) && (!r || r->values))
        take_numbers(c, r ? r->values : parts, r ? r->factors : true, r ? r->truth : TRUTH_MORE,
                     memory, out);
    if (r && begins(r->name, "bake")) put_exact_last(out);
    for (size_t i = 0; i < out->count; i++) out->values[i] = arena_string(memory, out->values[i]);
    return out->count > 1;
}

// ---- axes ---------------------------------------------------------------------------------------

static bool same_value(const roil_control *c, const char *text) {
    char *end;
    double value = str_double(text, &end);
    if (has_words(c)) {
        size_t now = (size_t)c->value[0];
        const char *word = c->type == ROIL_ENUM ? c->words[now] : now ? "true" : "false";
        return strcmp(word, text) == 0;
    }
    return end != text && !*end && (float)value == c->value[0];
}

// Parses "16:32:64". When the effect's value is not in the list, the search begins with the best
// one.
static bool take_given(const roil_control *c, const char *text, arena *memory, tune_axis *out) {
    *out = (tune_axis){.name = arena_string(memory, c->name), .start = SEARCH_MAX_RUNGS};
    char *at = arena_string(memory, text), *colon;
    for (;; at = colon + 1) {
        colon = strchr(at, ':');
        if (colon) *colon = '\0';
        if (out->count == SEARCH_MAX_RUNGS)
            return err_set("--axes %s: at most %d values", c->name, SEARCH_MAX_RUNGS);
        if (!*at) return err_set("--axes %s=%s: a value is empty", c->name, text);
        if (same_value(c, at)) out->start = out->count;
        out->values[out->count++] = at;
        if (!colon) break;
    }
    out->elsewhere = out->start == SEARCH_MAX_RUNGS;
    if (out->elsewhere) out->start = out->count - 1;
    out->reference = out->count - 1;
    return out->count > 1 || err_set("--axes %s=%s: two values at least", c->name, text);
}

static bool add_wanted(roil_effect *e, const char *text, arena *memory, tune_axis *out) {
    char *name = arena_string(memory, text), *values = strchr(name, '=');
    if (values) *values++ = '\0';
    size_t index;
    roil_control c;
    if (!roil_find_control(e, name, &index)) return err_prefix("--axes: ");
    roil_get_control(e, index, &c);
    if (!has_words(&c) && !has_number(&c))
        return err_set("--axes: '%s' is neither a number nor a word", name);
    if (values) return take_given(&c, values, memory, out);
    return take_values(&c, find_rule(e, &c), memory, out) ||
           err_set("--axes: '%s' has no other values to try; write %s=1:2:3", name, name);
}

static void add_all(roil_effect *e, arena *memory, tune_axis out[SEARCH_MAX_AXES], size_t *count) {
    size_t controls = roil_control_count(e);
    for (size_t i = 0; i < controls && *count < SEARCH_MAX_AXES; i++) {
        roil_control c;
        roil_get_control(e, i, &c);
        const rule *r = find_rule(e, &c);
        if (r && !c.driven && take_values(&c, r, memory, &out[*count])) ++*count;
    }
}

bool tune_find_axes(roil_effect *e, const char *const *wanted, size_t wanted_count, arena *memory,
                    tune_axis out[SEARCH_MAX_AXES], size_t *count) {
    *count = 0;
    if (wanted_count > SEARCH_MAX_AXES)
        return err_set("--axes: %zu axes; at most %d", wanted_count, SEARCH_MAX_AXES);
    for (; *count < wanted_count; ++*count)
        if (!add_wanted(e, wanted[*count], memory, &out[*count])) return false;
    if (!wanted_count) add_all(e, memory, out, count);
    return *count > 0 || err_set("the effect has no parameter, uniform or option that is known to "
                                 "be of its quality; name some with --axes");
}
