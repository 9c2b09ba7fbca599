// Prints what `roil bench` writes to the terminal: a line for each row, a table at the end, and
// changes.
#include "app/bench_print.h"
#include "app/app.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { LABEL_MIN = 8, LABEL_MAX = 64 };
static const char *const MARCH = "march", *const HOST = "host";

static int width_of(size_t longest) {
    return (int)(longest < LABEL_MIN ? LABEL_MIN : longest < LABEL_MAX ? longest : LABEL_MAX);
}

int bench_label_width(const sweep_row *rows, size_t count) {
    size_t longest = 0;
    for (size_t i = 0; i < count; i++)
        if (strlen(rows[i].label) > longest) longest = strlen(rows[i].label);
    return width_of(longest);
}

static int result_width(const bench_results *r) {
    size_t longest = 0;
    for (size_t i = 0; i < r->row_count; i++)
        if (strlen(r->rows[i].label) > longest) longest = strlen(r->rows[i].label);
    return width_of(longest);
}

static void print_label(const char *label, int width) {
    app_print(stdout, "%-*.*s", width, width, label);
}

// Prints the first line of the message; the file has all of it.
static void print_failure(const bench_row *row) {
    app_print(stdout, " failed: %.*s", (int)strcspn(row->message, "\n"), row->message);
}

static void print_error(const bench_row *row) {
    if (!row->compared) return;
    if (isinf(row->psnr))
        app_print(stdout, "  equal");
    else
        app_print(stdout, "  PSNR %5.2f dB  FLIP %.4f", row->psnr, row->flip);
}

void bench_print_line(const bench_row *row, int width) {
    const bench_time *all = bench_main_time(row);
    print_label(row->label, width);
    if (row->state == BENCH_FAILED) {
        print_failure(row);
        app_print(stdout, "\n");
        return;
    }
    const bench_figure *march = bench_get_time(&row->gpu, MARCH);
    if (march) app_print(stdout, "  march %9.3f", march->median);
    if (all) app_print(stdout, "  %s %9.3f ms", all->name, all->ms.median);
    print_error(row);
    if (row->state == BENCH_LIMIT) app_print(stdout, "  %s", row->message);
    app_print(stdout, "\n");
}

// ---- table --------------------------------------------------------------------------------------

static bool any_march(const bench_results *r) {
    for (size_t i = 0; i < r->row_count; i++)
        if (bench_get_time(&r->rows[i].gpu, MARCH)) return true;
    return false;
}

static bool any_host(const bench_results *r) {
    for (size_t i = 0; i < r->row_count; i++)
        if (bench_get_time(&r->rows[i].cpu, HOST)) return true;
    return false;
}

static bool any_compared(const bench_results *r) {
    for (size_t i = 0; i < r->row_count; i++)
        if (r->rows[i].compared) return true;
    return false;
}

static void print_samples(const bench_row *row) {
    for (size_t i = 0; i < row->counters.count; i++)
        if (strcmp(row->counters.items[i].name, "march.samples") == 0) {
            app_print(stdout, " %9.2f", row->counters.items[i].value * 1e-6);
            return;
        }
    app_print(stdout, " %9s", "");
}

static void print_figures(const bench_row *row, bool march, bool compared) {
    const bench_time *all = bench_main_time(row);
    const bench_figure *of_march = bench_get_time(&row->gpu, MARCH);
    const bench_figure *host = bench_get_time(&row->cpu, HOST);
    if (of_march)
        app_print(stdout, " %9.3f", of_march->median);
    else if (march)
        app_print(stdout, " %9s", "");
    if (all)
        app_print(stdout, " %9.3f %9.3f %9.3f %5zu", all->ms.median, all->ms.p5, all->ms.p95,
                  all->ms.count);
    if (host) app_print(stdout, " %8.0f", 1e3 * host->median);
    if (march) print_samples(row);
    if (row->device_bytes) app_print(stdout, " %8.1f", (double)row->device_bytes / (1 << 20));
    if (compared && row->compared)
        app_print(stdout, " %7.2f %7.5f %7.5f", row->psnr, row->ssim, row->flip);
    if (row->state == BENCH_LIMIT) app_print(stdout, "  %s", row->message);
}

void bench_print_table(const bench_results *r) {
    int width = result_width(r);
    bool march = any_march(r), compared = any_compared(r);
    const bench_time *all = r->row_count ? bench_main_time(&r->rows[0]) : NULL;
    app_print(stdout, "\n%s, on %s (%s)\n", r->title, r->device, r->driver);
    app_print(stdout, "%-*s", width, march ? "GPU ms" : "ms");
    if (march) app_print(stdout, " %9s", MARCH);
    app_print(stdout, " %9s %9s %9s %5s", all ? all->name : "all", "5 %", "95 %", "count");
    if (any_host(r)) app_print(stdout, " %8s", "host us");
    if (march) app_print(stdout, " %9s %8s", "samples M", "MiB");
    if (compared) app_print(stdout, " %7s %7s %7s", "PSNR dB", "SSIM", "FLIP");
    app_print(stdout, "\n");
    for (size_t i = 0; i < r->row_count; i++) {
        const bench_row *row = &r->rows[i];
        print_label(row->label, width);
        if (row->state == BENCH_FAILED)
            print_failure(row);
        else
            print_figures(row, march, compared);
        app_print(stdout, "\n");
    }
}

// ---- changes ------------------------------------------------------------------------------------

static void print_change(const bench_change *c, int width) {
    static const char *const words[] = {"", "faster", "slower"};
    const bench_figure *was = bench_get_time(&c->before->gpu, c->name);
    const bench_figure *is = bench_get_time(&c->now->gpu, c->name);
    if (!was || !is) {
        was = bench_get_time(&c->before->times, c->name);
        is = bench_get_time(&c->now->times, c->name);
    }
    print_label(c->now->label, width);
    app_print(stdout, "  %-20.20s %9.3f -> %9.3f ms  x %.3f", c->name, was->median, is->median,
              c->ratio);
    if (c->verdict != BENCH_SAME) app_print(stdout, "  %s", words[c->verdict]);
    if (c->verdict != BENCH_SAME && c->chance >= 0) app_print(stdout, " (p %.2g)", c->chance);
    app_print(stdout, "\n");
}

static bool is_whole(const bench_change *c) { // what a row is judged by
    const bench_time *whole = bench_main_time(c->now);
    return whole && strcmp(whole->name, c->name) == 0;
}

size_t bench_print_changes(const bench_results *before, const bench_results *now, double margin) {
    arena memory = {0};
    bench_change *changes;
    size_t count = bench_compare(before, now, margin, &memory, &changes), slower = 0, faster = 0;
    int width = result_width(now);
    app_print(stdout, "\nAgainst %s%s%s, of %s\n", before->sweep, before->commit[0] ? " at " : "",
              before->commit, before->date);
    if (strcmp(before->device, now->device) != 0)
        app_print(stdout, "which was measured on another device: %s\n", before->device);
    for (size_t i = 0; i < count; i++) {
        const bench_change *c = &changes[i];
        if (!is_whole(c) && c->verdict == BENCH_SAME) continue;
        print_change(c, width);
        if (!is_whole(c)) continue;
        slower += c->verdict == BENCH_SLOWER;
        faster += c->verdict == BENCH_FASTER;
    }
    app_print(stdout, "%zu rows slower, %zu faster, by more than noise and %g %%\n", slower, faster,
              100 * margin);
    arena_free(&memory);
    return slower;
}
