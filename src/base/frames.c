#include "base/frames.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/str.h"
#include <ctype.h>
#include <math.h>
#include <strings.h>

typedef struct list {
    double *numbers;
    size_t count, capacity;
} list;

static bool parse_number(const char **text, double *out) {
    char *end;
    if (!isdigit((unsigned char)**text) || strncasecmp(*text, "0x", 2) == 0) return false;
    *out = str_double(*text, &end);
    *text = end;
    return isfinite(*out);
}

static bool add_range(list *l, double first, double last, double step) {
    if (!(step > 0) || last < first || (last - first) / step > FRAMES_MAX) return false;
    size_t count = (size_t)floor((last - first) / step + 1e-9) + 1;
    if (l->count + count > FRAMES_MAX) return false;
    MEM_RESERVE(l->numbers, l->count + count, l->capacity);
    for (size_t i = 0; i < count; i++) l->numbers[l->count++] = first + (double)i * step;
    return true;
}

static bool parse_list(const char *at, list *l) {
    for (;; at++) {
        double first, last, step = 1;
        if (!parse_number(&at, &first)) return false;
        last = first;
        if (*at == '-') {
            at++;
            if (!parse_number(&at, &last)) return false;
        }
        if (*at == ':') {
            at++;
            if (!parse_number(&at, &step)) return false;
        }
        if (!add_range(l, first, last, step)) return false;
        if (!*at) return true;
        if (*at != ',') return false;
    }
}

bool frames_parse(const char *text, double **numbers, size_t *count) {
    list l = {0};
    if (!parse_list(text, &l)) {
        mem_free(l.numbers);
        return err_set("frames '%s'; accepted: 30, or 10,30,50, or 1-100, or 1-100:2", text);
    }
    *numbers = l.numbers;
    *count = l.count;
    return true;
}
