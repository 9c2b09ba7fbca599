// A cavity under a lid that slides: what is known of its flow.
#pragma once

// Ghia, Ghia, Shin, "High-Re solutions for incompressible flow using the Navier-Stokes equations
// and a multigrid method", 1982, table I: velocity along the lid's, on the line through the middle.
typedef struct ghia_row {
    double height, re100, re400, re1000;
} ghia_row;
static const ghia_row ghia[] = {
    {0.9766, 0.84123, 0.75837, 0.65928},    {0.9688, 0.78871, 0.68439, 0.57492},
    {0.9609, 0.73722, 0.61756, 0.51117},    {0.9531, 0.68717, 0.55892, 0.46604},
    {0.8516, 0.23151, 0.29093, 0.33304},    {0.7344, 0.00332, 0.16256, 0.18719},
    {0.6172, -0.13641, 0.02135, 0.05702},   {0.5000, -0.20581, -0.11477, -0.06080},
    {0.4531, -0.21090, -0.17119, -0.10648}, {0.2813, -0.15662, -0.32726, -0.27805},
    {0.1719, -0.10150, -0.24299, -0.38289}, {0.1016, -0.06434, -0.14612, -0.29730},
    {0.0703, -0.04775, -0.10338, -0.22220}, {0.0625, -0.04192, -0.09266, -0.20196},
    {0.0547, -0.03717, -0.08186, -0.18109},
};

static inline double ghia_value(const ghia_row *row, double reynolds) {
    return reynolds < 200 ? row->re100 : reynolds < 500 ? row->re400 : row->re1000;
}
