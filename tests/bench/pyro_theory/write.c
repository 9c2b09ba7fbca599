#include "write.h"
#include "base/str.h"
#include <unistd.h>

// ---- a check ----------------------------------------------------------------------------------

// JSON has no number for what is none.
static json_t *number(double value) {
    return isfinite(value) ? json_real(value) : json_null();
}

static json_t *write_figure(const theory_figure *f) {
    return json_pack("{s:s, s:o, s:o, s:o, s:o, s:s, s:b}", "name", f->name, "seen",
                     number(f->seen), "wanted", number(f->wanted), "low", number(f->low), "high",
                     number(f->high), "unit", f->unit, "holds", theory_holds(f));
}

static json_t *write_series(const theory_series *s) {
    json_t *points = json_array();
    for (size_t i = 0; i < s->count; i++)
        json_array_append_new(points, json_pack("[f, f]", s->points[i][0], s->points[i][1]));
    return json_pack("{s:s, s:b, s:b, s:o}", "name", s->name, "expected", s->expected, "marks",
                     s->marks, "points", points);
}

static json_t *write_plot(const theory_plot *p) {
    json_t *series = json_array();
    for (size_t i = 0; i < p->count; i++)
        json_array_append_new(series, write_series(&p->series[i]));
    return json_pack("{s:s, s:s, s:s, s:b, s:b, s:o}", "title", p->title, "x", p->x, "y", p->y,
                     "log_x", p->log_x, "log_y", p->log_y, "series", series);
}

json_t *write_check(const theory_check *c, double seconds) {
    json_t *notes = json_array(), *figures = json_array(), *plots = json_array();
    for (size_t i = 0; i < c->note_count; i++)
        json_array_append_new(notes, json_string(c->notes[i]));
    for (size_t i = 0; i < c->figure_count; i++)
        json_array_append_new(figures, write_figure(&c->figures[i]));
    for (size_t i = 0; i < c->plot_count; i++)
        json_array_append_new(plots, write_plot(&c->plots[i]));
    return json_pack("{s:s, s:s, s:s, s:o, s:o, s:o, s:f, s:f}", "name", c->name, "title", c->title,
                     "source", c->source, "notes", notes, "figures", figures, "plots", plots,
                     "seconds", seconds, "million_cell_steps", 1e-6 * c->cells);
}

void write_text(const theory_check *c, double seconds) {
    printf("%s: %s (%.0f s, %.1f million cell steps)\n", c->name, c->title, seconds,
           1e-6 * c->cells);
    for (size_t i = 0; i < c->figure_count; i++) {
        const theory_figure *f = &c->figures[i];
        printf("  %-6s %-52s %10.4g  %10.4g to %.4g %s\n", theory_holds(f) ? "holds" : "MISSED",
               f->name, f->seen, f->low, f->high, f->unit);
    }
    fflush(stdout);
}

// ---- tests ------------------------------------------------------------------------------------

json_t *write_test(const char *folder, const char *name) {
    char command[4200], line[1024];
    snprintf(command, sizeof command, "%s/gpu_%s", folder, name);
    if (access(command, X_OK) != 0) return NULL;
    snprintf(command, sizeof command, "'%s/gpu_%s' 2>&1", folder, name);
    FILE *pipe = popen(command, "r");
    if (!pipe) return NULL;
    json_t *lines = json_array();
    while (fgets(line, sizeof line, pipe)) {
        line[strcspn(line, "\n")] = 0;
        if (line[0] && line[0] != '[') json_array_append_new(lines, json_string(line));
    }
    const bool passed = pclose(pipe) == 0;
    printf("%-6s %s\n", passed ? "passed" : "FAILED", name);
    return json_pack("{s:s, s:b, s:o}", "name", name, "passed", passed, "lines", lines);
}
