// Fuel that comes out of the ground at a known rate, and what is seen above it: means over time of
// what the gas does on its axis and around it.
#pragma once
#include "theory.h"

typedef struct burner_desc {
    uint32_t size[3];
    double cell;  // m
    double width; // diameter of the disc, or side of the square, m
    bool square;
    double power;    // of all heat, W
    double radiated; // share of it that does not warm the gas
    double heat;     // of combustion, J/kg
    double oxygen;   // kg that 1 kg of fuel takes
    double molar_mass;
    double dt;
    double settle, last; // s before anything is looked at, and while it is
    double look;         // s between looks
    double flame;        // K above the surroundings, from which gas is seen as a flame
} burner_desc;

// Means over time, by height in cells. Those of the axis are of the four cells around it.
typedef struct burner_level {
    double w, warmth;    // on the axis, m/s and K
    double volume;       // flux, m^3/s, within where it is a twentieth of the axis's
    double momentum;     // flux of the mean flow, m^4/s^2
    double momentum_all; // and with all that varies, over the whole width
    double lift;         // buoyancy of the mean gas, over the whole width, m^3/s^2
    double heat;         // flux, W, over the whole width
    double flame;        // share of the time in which there is one at this height
} burner_level;

typedef struct burner_seen {
    burner_level *levels; // a height for each layer of cells
    double (*series)[2];  // upwards velocity on the axis by looks, at half and at a whole width
    size_t looks, count;  // times, and heights
    double step;          // s between looks
} burner_seen;

// What it returns lies in the check's memory.
burner_seen burner_run(const theory_order *order, theory_check *c, const burner_desc *desc);
// A plot of the heat that passes each height, by what is given, and a line in it.
theory_plot *burner_plot_heat(theory_check *c);
void burner_draw_heat(theory_check *c, theory_plot *p, const char *name, const burner_desc *desc,
                      const burner_seen *s);
