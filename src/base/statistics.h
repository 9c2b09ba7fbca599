// What many measurements of one thing come to.
#pragma once
#include <stddef.h>

typedef struct stats_summary {
    double median, p5, p95; // percentiles by nearest rank
} stats_summary;

// Sorts `values`. Of none: zeros.
stats_summary stats_summarise(double *values, size_t count);

// Two-sided probability that differences as far from 0 as these arise by chance: Wilcoxon,
// "Individual Comparisons by Ranking Methods" (1945), the signed-rank test, exact up to
// STATS_EXACT differences and by the normal distribution beyond. Zeros are left out; of equal
// magnitudes each takes the mean rank.
enum { STATS_EXACT = 40 };
double stats_signed_rank(const double *differences, size_t count);
