// Fuels that a combustion solver knows by name.
#pragma once
#include <stddef.h>

typedef struct sim_fuel {
    const char *name;
    double heat;        // net heat of combustion, J/kg
    double oxygen;      // kg that 1 kg of fuel takes to burn wholly; 0: it brings its own
    double molar_mass;  // of its vapour, kg/kmol
    double ignition;    // temperature at which it catches fire by itself in air, K
    double soot;        // kg of soot that 1 kg leaves where it burns freely
    double radiated;    // share of the heat that the flame radiates while it burns
    double flame_speed; // laminar, in the mixture with air that burns fastest, m/s
} sim_fuel;

// In the order of the words that an effect chooses from.
extern const sim_fuel sim_fuels[];
extern const size_t sim_fuel_count;
