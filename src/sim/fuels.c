// Sources: heats, soot and radiated shares of vapours and wood are rounded from Tewarson, SFPE
// Handbook of Fire Protection Engineering (4th edition, table 3-4.16); temperatures of ignition and
// flame speeds from Glassman and Yetter, Combustion (4th edition, appendices E and F); oxygen is
// what the formula of the fuel needs (petrol as C8H15, wood as CH1.7O0.74, which is given by its
// volatiles, starch dust as C6H10O5). Black powder: Kosanke, Pyrotechnic Chemistry (2004).
#include "sim/fuels.h"

const sim_fuel sim_fuels[] = {
    {"petrol", 43.7e6, 3.40, 105, 553, 0.060, 0.35, 0.40},
    {"kerosene", 43.0e6, 3.43, 170, 483, 0.090, 0.35, 0.38},
    {"propane", 46.0e6, 3.63, 44.1, 743, 0.024, 0.29, 0.43},
    {"methane", 50.1e6, 3.99, 16.0, 810, 0.005, 0.15, 0.38},
    {"ethanol", 27.7e6, 2.08, 46.1, 636, 0.008, 0.24, 0.42},
    {"wood", 14.0e6, 1.20, 30, 600, 0.015, 0.30, 0.30},
    {"dust", 16.0e6, 1.18, 162, 650, 0.020, 0.30, 0.30},
    {"black_powder", 3.0e6, 0, 80, 700, 0.100, 0.20, 0.50},
};
const size_t sim_fuel_count = sizeof sim_fuels / sizeof *sim_fuels;
