#include "base/statistics.h"
#include "base/memory.h"
#include <math.h>
#include <stdlib.h>

static int by_size(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// Returns the percentile by nearest rank: the smallest value that at least `percent` of all values
// do not exceed.
static double percentile(const double *sorted, size_t count, size_t percent) {
    size_t rank = (count * percent + 99) / 100;
    return sorted[rank ? rank - 1 : 0];
}

stats_summary stats_summarise(double *values, size_t count) {
    if (!count) return (stats_summary){0};
    qsort(values, count, sizeof *values, by_size);
    double median =
        count % 2 ? values[count / 2] : 0.5 * (values[count / 2 - 1] + values[count / 2]);
    return (stats_summary){median, percentile(values, count, 5), percentile(values, count, 95)};
}

static int by_magnitude(const void *a, const void *b) {
    double x = fabs(*(const double *)a), y = fabs(*(const double *)b);
    return (x > y) - (x < y);
}

// Returns twice the sum of the ranks of positive differences. It is doubled so that mean ranks are
// integers.
static size_t positive_ranks(const double *sorted, size_t count, double *ties) {
    size_t sum = 0;
    *ties = 0;
    for (size_t first = 0, next; first < count; first = next) {
        for (next = first + 1; next < count && fabs(sorted[next]) == fabs(sorted[first]);) next++;
        double equal = (double)(next - first);
        *ties += equal * equal * equal - equal;
        for (size_t i = first; i < next; i++)
            if (sorted[i] > 0) sum += first + 1 + next;
    }
    return sum;
}

// Each of the 2^count assignments of signs is equally likely. Counts those whose doubled rank sum
// is at most `sum`, by taking or leaving one rank after the other. Ties keep their mean ranks.
static double exact(const double *sorted, size_t count, size_t sum) {
    double ways[2 * STATS_EXACT * (STATS_EXACT + 1) / 2 + 1] = {1}, below = 0;
    size_t most = 0;
    for (size_t first = 0, next; first < count; first = next) {
        for (next = first + 1; next < count && fabs(sorted[next]) == fabs(sorted[first]);) next++;
        size_t rank = first + 1 + next;
        for (size_t i = first; i < next; i++) {
            most += rank;
            for (size_t at = most; at >= rank; at--) ways[at] += ways[at - rank];
        }
    }
    for (size_t at = 0; at <= sum; at++) below += ways[at];
    return below / exp2((double)count);
}

double stats_signed_rank(const double *differences, size_t count) {
    double *sorted = mem_alloc(count * sizeof *sorted), ties, chance = 1;
    size_t used = 0;
    for (size_t i = 0; i < count; i++)
        if (differences[i] != 0) sorted[used++] = differences[i];
    qsort(sorted, used, sizeof *sorted, by_magnitude);
    size_t sum = positive_ranks(sorted, used, &ties), all = used * (used + 1);
    if (all - sum < sum) sum = all - sum; // the smaller of both signs
    if (used && used <= STATS_EXACT) {
        chance = 2 * exact(sorted, used, sum);
    } else if (used) {
        double n = (double)used, spread = n * (n + 1) * (2 * n + 1) / 24 - ties / 48;
        chance = erfc((n * (n + 1) / 4 - (double)sum / 2) / sqrt(2 * spread));
    }
    mem_free(sorted);
    return fmin(chance, 1);
}
