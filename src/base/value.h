// What a number is, or a word among several: its name, default, range, unit and help. Whoever takes
// one says it once; checks, text, references and interfaces go by that.
#pragma once
#include "base/str.h"
#include <stdint.h>

typedef enum value_type {
    VALUE_NUMBER, // as many as there are components
    VALUE_WHOLE,
    VALUE_BOOL,  // 0 or 1
    VALUE_WORD,  // an index into the words
    VALUE_COLOR, // three numbers, linear Rec.709
    VALUE_OTHER, // no number: an object, a list, a palette
} value_type;

typedef struct value_desc {
    const char *name;
    value_type type;
    int components;           // 1 to 4; 0: as many as are given
    float value[4];           // default
    float min, max;           // of each component; -INFINITY, INFINITY or both 0: any finite number
    const char *unit, *help;  // "" when there is none
    const char *const *words; // in order of their values
    size_t word_count;
    const char *form; // how the default is written, where `value` is none; NULL: as `value` is
    bool required;    // it has no default
} value_desc;

// The first component that is not finite or out of range; -1: all are accepted.
int value_find_wrong(const value_desc *d, const float *value, int count);
enum { VALUE_RANGE = 96 };
void value_range(const value_desc *d, char out[VALUE_RANGE]); // "0 to 4 m", "0 W or more"
// Sets the message "WHO is 5; accepted: 0 to 4 m". Returns false.
bool value_refuse(const value_desc *d, float wrong, const char *who, ...) PRINTF_LIKE(3, 4);
int value_find_word(const value_desc *d, const char *text); // -1: not among the words

// The text that --set, presets and panels give: "1.5", "1,2,3" or "1 2 3" (one number stands for
// all components), "#rrggbb" for three, a word, true or false. False with a message that begins
// with `who`; `out` is then undefined.
bool value_parse(const value_desc *d, const char *who, const char *text, float out[4]);
void value_print(const value_desc *d, const float value[4], strbuf *out); // as value_parse takes it
// "steps = 64 [1, 4096] m", "mode = soft* | hard", as references show it. `name`: instead of its
// own. `value` NULL: the default.
void value_show(const value_desc *d, const char *name, const float *value, strbuf *out);

// "#rgb", "#rrggbb", "#rrggbbaa" in sRGB to linear Rec.709. False with a message.
bool value_parse_color(const char *text, float out[4]);
// The "#rrggbb" that value_parse_color makes exactly this colour of; false when there is none.
bool value_color_hex(const float linear[3], char out[8]);
