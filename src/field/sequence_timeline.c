// The timeline of a sequence: which file is of which frame, and what is shown when.
//
// Numbers in the names of files are frames: they are what differs, so all that is before and behind
// them must be the same. The least one is the first of the timeline. A frame without a file shows
// the one before it, or, where frames are mixed, both its neighbours by how near they are.
#include "base/log.h"
#include "base/memory.h"
#include "base/str.h"
#include "field/sequence_parts.h"
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// ---- numbers in names -------------------------------------------------------------------------

enum { MOST_DIGITS = 15 };

typedef struct numbered {
    const char *path, *name;
    size_t before, after; // of the name: the bytes before its number, and where what follows begins
    int64_t number;
} numbered;

static bool is_digit(char c) {
    return isdigit((unsigned char)c);
}

// The last number before the extension. A '-' belongs to it where it separates nothing, as in
// "smoke.-0010.vdb". False when there is none.
static bool find_number(numbered *n) {
    const char *dot = strrchr(n->name, '.');
    size_t end = dot ? (size_t)(dot - n->name) : strlen(n->name);
    while (end > 0 && !is_digit(n->name[end - 1])) end--;
    size_t begin = end;
    while (begin > 0 && is_digit(n->name[begin - 1])) begin--;
    if (end == begin || end - begin > MOST_DIGITS) return false;
    n->number = 0;
    for (size_t i = begin; i < end; i++) n->number = 10 * n->number + (n->name[i] - '0');
    bool minus = begin > 0 && n->name[begin - 1] == '-';
    if (minus && (begin == 1 || !isalnum((unsigned char)n->name[begin - 2]))) {
        n->number = -n->number;
        begin--;
    }
    n->before = begin;
    n->after = end;
    return true;
}

static bool same_but_number(const numbered *a, const numbered *b) {
    return a->before == b->before && memcmp(a->name, b->name, a->before) == 0 &&
           strcmp(a->name + a->after, b->name + b->after) == 0;
}

static int by_number(const void *a, const void *b) {
    const numbered *l = a, *r = b;
    return (l->number > r->number) - (l->number < r->number);
}

static void complain(const sequence_data *s, const numbered *a, const numbered *b,
                     const char *why) {
    log_write(LOG_WARNING, "%s: '%s' and '%s' %s: frames in the order of their names", s->name,
              a->name, b->name, why);
}

// Sorts files by their numbers. False where names have none that could be frames: with a warning
// unless none has any.
static bool number_files(const sequence_data *s, numbered *list, size_t count) {
    const numbered *with = NULL, *without = NULL;
    for (size_t i = 0; i < count; i++) {
        if (find_number(&list[i]))
            with = &list[i];
        else
            without = &list[i];
    }
    if (with && without) complain(s, with, without, "do not both have a number");
    if (without) return false;
    for (size_t i = 1; i < count; i++) {
        if (same_but_number(&list[0], &list[i])) continue;
        complain(s, &list[0], &list[i], "differ in more than their last number");
        return false;
    }
    qsort(list, count, sizeof *list, by_number);
    for (size_t i = 1; i < count; i++) {
        if (list[i - 1].number != list[i].number) continue;
        complain(s, &list[i - 1], &list[i], "have the same number");
        return false;
    }
    return true;
}

// "2, 4, 7 to 9"
static void say_gaps(const sequence_data *s, int64_t first) {
    enum { MOST = 6 };
    strbuf text = {0};
    size_t gaps = 0;
    for (size_t i = 1; i < s->file_count; i++) {
        int64_t from = first + s->times[i - 1] + 1, to = first + s->times[i] - 1;
        if (from > to || ++gaps > MOST) continue;
        strbuf_add(&text, "%s%lld", gaps > 1 ? ", " : "", (long long)from);
        if (to > from) strbuf_add(&text, " to %lld", (long long)to);
    }
    if (gaps > MOST) strbuf_add(&text, " and in %zu more gaps", gaps - MOST);
    if (gaps > 0)
        log_write(LOG_WARNING, "%s: there is no file for %s %s; %s", s->name,
                  s->span - (int64_t)s->file_count > 1 ? "frames" : "frame", strbuf_text(&text),
                  s->desc.blend ? "the files around are mixed" : "the file before goes on");
    strbuf_free(&text);
}

void sequence_number_files(sequence_data *s) {
    size_t count = s->file_count;
    numbered *list = mem_alloc(count * sizeof *list);
    int64_t *times = arena_alloc(&s->memory, count * sizeof *times);
    for (size_t i = 0; i < count; i++)
        list[i] = (numbered){.path = s->files[i], .name = path_name(s->files[i])};
    bool done = count > 1 && number_files(s, list, count);
    for (size_t i = 0; i < count; i++) {
        times[i] = done ? list[i].number - list[0].number : (int64_t)i;
        if (done) s->files[i] = list[i].path;
    }
    s->times = times;
    s->span = times[count - 1] + 1;
    if (done) say_gaps(s, list[0].number);
    mem_free(list);
}

// ---- playback ---------------------------------------------------------------------------------

static int64_t fold(const sequence_data *s, int64_t frame) { // into the span, as the loop says
    int64_t count = s->span;
    switch (s->desc.loop) {
    case SEQUENCE_REPEAT:
        return ((frame % count) + count) % count;
    case SEQUENCE_PING_PONG: {
        int64_t round = count > 1 ? 2 * count - 2 : 1, at = ((frame % round) + round) % round;
        return at < count ? at : round - at;
    }
    default:
        return frame < 0 ? 0 : frame >= count ? count - 1 : frame;
    }
}

// Times are mostly frame / fps: without the slack, rounding would show the frame before.
static int64_t whole_frame(double position) {
    return (int64_t)floor(position + 1e-6);
}

static int64_t time_of(const sequence_data *s, uint32_t index) {
    return s->times ? s->times[index] : (int64_t)index;
}

// The last one that is not later than a frame of the span.
static uint32_t find(const sequence_data *s, int64_t frame) {
    if (!s->times) return (uint32_t)frame;
    uint32_t low = 0, high = s->frame_count;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if (s->times[middle] <= frame)
            low = middle;
        else
            high = middle;
    }
    return low;
}

double sequence_position(const sequence_data *s, double time) {
    double at = (time - s->desc.start) * s->desc.fps * s->desc.speed;
    if (!(fabs(at) < 1e15)) at = 0;
    return at;
}

// Mixed: what lies before and behind a position, in the order in which they are shown. A round that
// is repeated goes from its last file to its first.
static void mix(const sequence_data *s, double position, uint32_t frames[2], float *blend) {
    int64_t whole = whole_frame(position), here = fold(s, whole), next = fold(s, whole + 1);
    bool around = s->desc.loop == SEQUENCE_REPEAT && next <= here, back = next < here && !around;
    double way = fmin(fmax(position - (double)whole, 0), 1);
    double at = (double)here + (next == here ? 0 : back ? -way : way);
    uint32_t low = find(s, (int64_t)at), last = s->frame_count - 1;
    uint32_t high = low < last ? low + 1 : around ? 0 : last;
    double from = (double)time_of(s, low);
    double to = low < last ? (double)time_of(s, high) : (double)s->span;
    float share = high != low ? clampf((float)((at - from) / (to - from)), 0, 1) : 0;
    if (share < 1e-5f) share = 0;
    if (back && share > 0) {
        frames[0] = high;
        frames[1] = low;
        *blend = 1 - share;
        return;
    }
    frames[0] = low;
    frames[1] = !back ? high : low > 0 ? low - 1 : 0;
    *blend = share;
}

bool sequence_frames_at(const sequence_data *s, double position, uint32_t frames[2], float *blend) {
    int64_t whole = whole_frame(position);
    frames[0] = frames[1] = find(s, fold(s, whole));
    *blend = 0;
    if (s->desc.blend) mix(s, position, frames, blend);
    return s->desc.loop != SEQUENCE_CLIP || (whole >= 0 && whole < s->span);
}

size_t sequence_file_at(const sequence *s, int64_t frame) {
    return find(s->data, frame);
}
