// Statistics of repeated measurements.
#pragma once
#include <stddef.h>

typedef struct stats_summary {
    double median, p5, p95; // percentiles by nearest rank
} stats_summary;

// Summarises `values`, and sorts them. Without values all results are 0.
stats_summary stats_summarise(double *values, size_t count);

// Returns the two-sided probability that differences as far from 0 as these arise by chance, by the
// signed-rank test of Wilcoxon, "Individual Comparisons by Ranking Methods" (1945). It is exact up
// to STATS_EXACT differences and uses the normal distribution beyond. Zeros are left out; equal
// magnitudes get their mean rank.
enum { STATS_EXACT = 40 };
double stats_signed_rank(const double *differences, size_t count);
