// Checks of burning gas against theory and published data: what each comes to, as figures within
// bounds and plots beside what is expected. main.c runs them and writes the page.
#pragma once
#include "gpu/pyro_test.h"

enum { THEORY_FIGURES = 16, THEORY_PLOTS = 5, THEORY_SERIES = 10, THEORY_NOTES = 6 };

typedef struct theory_figure {
    const char *name;
    double seen, wanted, low, high; // it holds from `low` to `high`
    const char *unit;               // "": none
} theory_figure;

typedef struct theory_series {
    const char *name;
    bool expected; // by theory, or measured by others
    bool marks;    // points rather than a line
    double (*points)[2];
    size_t count;
} theory_series;

typedef struct theory_plot {
    const char *title, *x, *y;
    bool log_x, log_y;
    theory_series series[THEORY_SERIES];
    size_t count;
} theory_plot;

typedef struct theory_check { // texts live as long as `memory`
    arena memory;
    const char *name, *title, *source;
    const char *notes[THEORY_NOTES];
    size_t note_count;
    theory_figure figures[THEORY_FIGURES];
    size_t figure_count;
    theory_plot plots[THEORY_PLOTS];
    size_t plot_count;
    double cells; // cells times steps
} theory_check;

typedef struct theory_order {
    gpu *device;
    const char *shaders; // folder of burner.comp
    double fine;         // cells along a side, by those of the coarse size
    pyro_advection advection;
    bool variable_density;
} theory_order;

typedef void theory_run(const theory_order *order, theory_check *out);
theory_run theory_plume, theory_flames, theory_pool, theory_fireball, theory_vortex, theory_rings;

// Adds a figure that holds within a share of what is wanted, or from `low` to `high`.
void theory_near(theory_check *c, const char *name, double seen, double wanted, double share,
                 const char *unit);
void theory_between(theory_check *c, const char *name, double seen, double low, double high,
                    const char *unit);
bool theory_holds(const theory_figure *f);
void theory_note(theory_check *c, const char *format, ...) __attribute__((format(printf, 2, 3)));

theory_plot *theory_add_plot(theory_check *c, const char *title, const char *x, const char *y);
// `name` is copied; points are added one by one.
theory_series *theory_add_series(theory_check *c, theory_plot *p, const char *name, size_t most);
void theory_add(theory_series *s, double x, double y);

// The nearest multiple of 8 cells that is `fine` times as many, at least 16.
uint32_t theory_cells(const theory_order *order, double coarse);
// Opens a world of full precision, with a size that is noted.
void theory_open(const theory_order *order, theory_check *c, pyro_world *w, const pyro_desc *desc,
                 double cell);
void theory_step(theory_check *c, pyro_world *w, int steps);

// Fits y = a + b x by least squares; both are given back.
void theory_fit(const double *x, const double *y, size_t count, double *a, double *b);
