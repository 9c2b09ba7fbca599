#include "app/pulse.h"
#include "base/error.h"
#include "base/file.h"
#include "base/json_text.h"
#include "base/memory.h"
#include "base/statistics.h"
#include <jansson.h>
#include <string.h>

void pulse_ask(pulse *p, double when) {
    if (p->asked == 0) p->asked = when;
}

void pulse_turn(pulse *p, double seconds, bool busy) {
    if (busy) p->busy_seconds += seconds;
}

void pulse_show(pulse *p, double now, bool busy) {
    p->times[p->shown++ % PULSE_SHOWN] = now;
    p->busy_shown += busy;
    if (p->asked == 0) return;
    p->answers[p->answered++ % PULSE_ANSWERS] = now - p->asked;
    p->asked = 0;
}

double pulse_rate(const pulse *p, double now) {
    uint64_t kept = p->shown < PULSE_SHOWN ? p->shown : PULSE_SHOWN, count = 0;
    while (count < kept && now - p->times[(p->shown - 1 - count) % PULSE_SHOWN] < 1) count++;
    if (count < 2) return 0;
    double first = p->times[(p->shown - count) % PULSE_SHOWN];
    double last = p->times[(p->shown - 1) % PULSE_SHOWN];
    return last > first ? (double)(count - 1) / (last - first) : 0;
}

pulse_answers pulse_summarise(const pulse *p) {
    size_t count = p->answered < PULSE_ANSWERS ? (size_t)p->answered : PULSE_ANSWERS;
    if (!count) return (pulse_answers){0};
    double *sorted = mem_copy(p->answers, count * sizeof *sorted);
    stats_summary all = stats_summarise(sorted, count);
    pulse_answers out = {all.median * 1000, all.p95 * 1000, sorted[count - 1] * 1000, count};
    mem_free(sorted);
    return out;
}

bool pulse_save(const pulse *p, const char *file, uint64_t drawn) {
    pulse_answers a = pulse_summarise(p);
    double rate = p->busy_seconds > 0 ? (double)p->busy_shown / p->busy_seconds : 0;
    json_t *root = json_pack("{s:I, s:I, s:{s:f, s:I, s:f}, s:{s:I, s:f, s:f, s:f}}", "frames",
                             (json_int_t)drawn, "pictures", (json_int_t)p->shown, "busy", "seconds",
                             p->busy_seconds, "pictures", (json_int_t)p->busy_shown,
                             "pictures_a_second", rate, "answers", "count", (json_int_t)p->answered,
                             "median_ms", a.median, "p95_ms", a.p95, "longest_ms", a.longest);
    char *text = root ? json_text(root, JSON_INDENT(1) | JSON_REAL_PRECISION(6)) : NULL;
    json_decref(root);
    if (!text) return err_set("%s: the statistics cannot be written as JSON", file);
    bool done = file_make_parent_folders(file) && file_write(file, text, strlen(text));
    mem_free(text);
    return done;
}
