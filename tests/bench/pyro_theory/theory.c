// What checks share: figures, plots, worlds.
#include "theory.h"
#include <stdarg.h>

// ---- results ----------------------------------------------------------------------------------

static void add_figure(theory_check *c, theory_figure f) {
    if (c->figure_count < THEORY_FIGURES) c->figures[c->figure_count++] = f;
}

void theory_near(theory_check *c, const char *name, double seen, double wanted, double share,
                 const char *unit) {
    add_figure(c,
               (theory_figure){arena_format(&c->memory, "%s", name), seen, wanted,
                               wanted - share * fabs(wanted), wanted + share * fabs(wanted), unit});
}

void theory_between(theory_check *c, const char *name, double seen, double low, double high,
                    const char *unit) {
    add_figure(c,
               (theory_figure){arena_format(&c->memory, "%s", name), seen, NAN, low, high, unit});
}

bool theory_holds(const theory_figure *f) {
    return f->seen >= f->low && f->seen <= f->high;
}

void theory_note(theory_check *c, const char *format, ...) {
    char text[1024];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    if (c->note_count < THEORY_NOTES)
        c->notes[c->note_count++] = arena_format(&c->memory, "%s", text);
}

theory_plot *theory_add_plot(theory_check *c, const char *title, const char *x, const char *y) {
    assert_true(c->plot_count < THEORY_PLOTS);
    theory_plot *p = &c->plots[c->plot_count++];
    *p = (theory_plot){.title = title, .x = x, .y = y};
    return p;
}

theory_series *theory_add_series(theory_check *c, theory_plot *p, const char *name, size_t most) {
    assert_true(p->count < THEORY_SERIES);
    theory_series *s = &p->series[p->count++];
    *s = (theory_series){.name = arena_format(&c->memory, "%s", name),
                         .points = arena_alloc(&c->memory, most * sizeof *s->points)};
    return s;
}

void theory_add(theory_series *s, double x, double y) {
    if (!isfinite(x) || !isfinite(y)) return;
    s->points[s->count][0] = x;
    s->points[s->count++][1] = y;
}

void theory_fit(const double *x, const double *y, size_t count, double *a, double *b) {
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (size_t i = 0; i < count; i++)
        n += 1, sx += x[i], sy += y[i], sxx += x[i] * x[i], sxy += x[i] * y[i];
    *b = (n * sxy - sx * sy) / (n * sxx - sx * sx);
    *a = (sy - *b * sx) / n;
}

// ---- worlds -----------------------------------------------------------------------------------

uint32_t theory_cells(const theory_order *order, double coarse) {
    const double n = round(coarse * order->fine / PYRO_BRICK) * PYRO_BRICK;
    return (uint32_t)fmax(n, PYRO_LEAST_SIZE);
}

void theory_open(const theory_order *order, theory_check *c, pyro_world *w, const pyro_desc *desc,
                 double cell) {
    pyro_desc own = *desc;
    own.advection = order->advection;
    own.variable_density = order->variable_density;
    pyro_open(w, order->device, &own);
    w->numbers.cell = (float)cell;
    theory_note(c, "%u x %u x %u cells of %.3g m", own.size[0], own.size[1], own.size[2], cell);
}

void theory_step(theory_check *c, pyro_world *w, int steps) {
    pyro_run_steps(w, steps);
    c->cells += (double)w->cells * steps;
}
