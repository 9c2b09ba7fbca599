// Numbers in sliders: their position on the bar, their rounding, their text.
#include "base/str.h"
#include "ui/parts.h"
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// A logarithmic bar over a range that reaches zero is linear below this share of it.
static const double LINEAR_SHARE = 1e-3;
static const double DRAG_SHARE = 0.01; // of an unbounded value, a pixel

// A range that is wider is a limit: on a bar of it nothing could be found.
static const double WIDE = 1e5, TIMES = 1e11;

bool number_is_bounded(const number_range *r) {
    if (!isfinite(r->min) || !isfinite(r->max) || !(r->max > r->min)) return false;
    return r->log_scale && r->min > 0 ? r->max <= TIMES * r->min : r->max - r->min <= WIDE;
}

static double clamped(const number_range *r, double value) {
    if (value < r->min) return r->min;
    return value > r->max ? r->max : value;
}

double number_to_share(const number_range *r, double value) {
    double v = clamped(r, value), span = r->max - r->min;
    if (!r->log_scale) return (v - r->min) / span;
    if (r->min > 0) return log(v / r->min) / log(r->max / r->min);
    return log1p((v - r->min) / (span * LINEAR_SHARE)) / log1p(1 / LINEAR_SHARE);
}

double number_from_share(const number_range *r, double share) {
    double s = share < 0 ? 0 : share > 1 ? 1 : share, span = r->max - r->min;
    if (!r->log_scale) return r->min + s * span;
    if (r->min > 0) return r->min * pow(r->max / r->min, s);
    return r->min + span * LINEAR_SHARE * expm1(s * log1p(1 / LINEAR_SHARE));
}

// Returns the digits after the point: a 500th of the range is visible; of a logarithmic or an
// unbounded range, three digits of the value.
static int decimals(const number_range *r, double value) {
    if (r->whole) return 0;
    bool linear = number_is_bounded(r) && !r->log_scale;
    double size = linear ? (r->max - r->min) / 500 : fabs(value) / 200;
    if (!linear && !(size > 1e-5)) size = 5e-3;
    int digits = (int)ceil(-log10(size) - 1e-9);
    return digits < 0 ? 0 : digits > 7 ? 7 : digits;
}

double number_round(const number_range *r, double value) {
    double scale = pow(10, decimals(r, value));
    return clamped(r, round(value * scale) / scale);
}

double number_drag(const number_range *r, double value, double pixels, double width) {
    if (number_is_bounded(r))
        return number_from_share(r, number_to_share(r, value) + pixels / fmax(width, 1));
    double least = r->whole ? 20 : 0.5; // so that zero can be left
    return clamped(r, value + pixels * DRAG_SHARE * fmax(fabs(value), least));
}

// A typed number may be finer than dragging allows; it is shown in full.
void number_text(const number_range *r, double value, char *out, size_t capacity) {
    int digits = decimals(r, value);
    double scale = pow(10, digits), seen = round(value * scale) / scale;
    if (fabs(seen - value) <= 1e-5 * fabs(value) || fabs(value) < 1e-7)
        snprintf(out, capacity, "%.*f", digits, seen == 0 ? 0.0 : seen);
    else
        snprintf(out, capacity, "%.5g", value);
}

bool number_parse(const number_range *r, const char *text, double *out) {
    char *end;
    double value = strtod(text, &end);
    if (end == text || !isfinite(value)) return false;
    while (isspace((unsigned char)*end)) end++;
    if (*end) return false;
    *out = clamped(r, r->whole ? round(value) : value);
    return true;
}

// ---- typing -----------------------------------------------------------------------------------

void number_type_begin(number_typing *t, uint32_t id, const number_range *r, double value) {
    if (t->id == id) return;
    number_type_leave(t);
    t->id = id;
    number_text(r, value, t->text, sizeof t->text);
    str_copy(t->first, sizeof t->first, t->text);
}

void number_type_leave(number_typing *t) {
    if (t->id && strcmp(t->text, t->first) != 0) {
        t->left_id = t->id;
        str_copy(t->left, sizeof t->left, t->text);
    }
    t->id = 0;
}

bool number_type_take(number_typing *t, uint32_t id, const number_range *r, double *value) {
    double typed;
    if (t->left_id != id) return false;
    t->left_id = 0;
    if (!number_parse(r, t->left, &typed) || typed == *value) return false;
    *value = typed;
    return true;
}
