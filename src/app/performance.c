// The window of times: GPU time by pass, as bars and over the last frames, and what the host adds.
#include "app/history.h"
#include "app/label.h"
#include "app/live.h"
#include "base/clock.h"
#include "base/memory.h"
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

// Units.
static const float WIDTH = 440, HEIGHT = 554; // of the window
static const float PLOT_HEIGHT = 120, NAME_WIDTH = 124, MS_WIDTH = 74, SHARE_WIDTH = 46, ROW = 22;
static const float FRAME_MS = 16.7f; // of a display that shows 60 pictures a second
static const float IDLE_MS = 3000;   // between pictures: nothing wanted to be drawn

struct performance {
    history past;
    roil_time times[HISTORY_PASSES]; // of the last frame
    size_t time_count;
};

performance *performance_create(void) {
    return mem_alloc(sizeof(performance));
}

void performance_destroy(performance *p) {
    mem_free(p);
}

void performance_add(performance *p, roil_effect *e, double cpu, double interval) {
    size_t count = roil_times(e, p->times, HISTORY_PASSES);
    p->time_count = count < HISTORY_PASSES ? count : HISTORY_PASSES;
    history_add(&p->past, p->times, count, cpu, interval);
}

double performance_time(const performance *p, const char *pass) {
    for (size_t i = 0; i < p->time_count; i++)
        if (strcmp(p->times[i].pass, pass) == 0) return p->times[i].milliseconds;
    return -1;
}

double performance_rate(const performance *p) {
    return history_rate(&p->past);
}

// Passes keep their place in the history, and therefore their colour.
static uint32_t pass_color(size_t pass, float alpha) {
    static const uint8_t colors[][3] = {
        {232, 126, 60},  {86, 148, 214}, {226, 184, 76}, {74, 170, 132},  {206, 90, 126},
        {140, 112, 206}, {70, 172, 188}, {164, 176, 80}, {186, 132, 100}, {128, 144, 168}};
    const uint8_t *c = colors[pass % (sizeof colors / sizeof *colors)];
    return (uint32_t)c[0] | (uint32_t)c[1] << 8 | (uint32_t)c[2] << 16 |
           (uint32_t)(alpha * 255) << 24;
}

// ---- plot over time ---------------------------------------------------------------------------

typedef struct plot {
    const history *past;
    ui_rect area;
    float top;  // milliseconds at its upper edge
    float step; // pixels for a frame
} plot;

// Rounds up to 1, 2 or 5 times a power of ten, so that the scale rarely changes.
static float round_up(float ms) {
    float power = powf(10, floorf(log10f(fmaxf(ms, 0.01f))));
    if (ms <= power) return power;
    if (ms <= 2 * power) return 2 * power;
    return ms <= 5 * power ? 5 * power : 10 * power;
}

static float plot_y(const plot *p, float ms) {
    return p->area.bottom - ms / p->top * (p->area.bottom - p->area.top);
}

static float plot_left(const plot *p, size_t ago) { // of the column of a frame
    return p->area.right - (float)(ago + 1) * p->step;
}

// Returns the frame under the pointer. False: there is none.
static bool plot_frame(const plot *p, const ui_canvas *c, size_t *ago) {
    if (!c->hovered || c->x < p->area.left || c->x >= p->area.right) return false;
    *ago = (size_t)((p->area.right - c->x) / p->step);
    return *ago < history_length(p->past);
}

// Bars thinner than half a pixel are drawn together with the next one.
static void draw_column(const plot *p, size_t ago, float alpha) {
    size_t list[HISTORY_PASSES], count = history_list(p->past, ago, list);
    float left = plot_left(p, ago), below = p->area.bottom, sum = 0;
    for (size_t i = 0; i < count; i++) {
        sum += history_pass_ms(p->past, list[i], ago);
        float y = plot_y(p, sum);
        if (below - y < 0.5f && i + 1 < count) continue;
        ui_fill((ui_rect){left, y, left + p->step, below}, pass_color(list[i], alpha), 0);
        below = y;
    }
}

// Draws text that is readable over the plot.
static void plot_label(float left, float top, ui_color color, const char *text) {
    float s = ui_scale();
    ui_rect behind = {left - 3 * s, top, left + ui_text_width(text) + 3 * s, top + label_height()};
    ui_fill(behind, ui_rgba(UI_FIELD, 0.8f), 2 * s);
    ui_label(left, top, ui_rgba(color, 1), text);
}

static void draw_scale(const plot *p) {
    static const char goal[] = "16.7 ms";
    float s = ui_scale(), height = label_height();
    char text[32];
    float y = roundf(plot_y(p, p->top / 2));
    ui_line(p->area.left, y, p->area.right, y, ui_rgba(UI_LINE, 0.7f), s);
    snprintf(text, sizeof text, "%g ms", (double)p->top);
    plot_label(p->area.left + 6 * s, p->area.top + 3 * s, UI_DIM, text);
    y = roundf(plot_y(p, FRAME_MS));
    if (y < p->area.top || p->area.bottom - y < 4 * s) return; // out of range
    ui_line(p->area.left, y, p->area.right, y, ui_rgba(UI_GOOD, 0.7f), s);
    float top = y - height - 2 * s < p->area.top ? y + 2 * s : y - height - 2 * s;
    plot_label(p->area.right - 6 * s - ui_text_width(goal), top, UI_GOOD, goal);
}

// True when the pointer is over a frame, `ago`.
static bool draw_plot(const history *past, size_t *ago) {
    float s = ui_scale();
    ui_canvas c = ui_canvas_begin("history", 0, PLOT_HEIGHT * s);
    float width = c.area.right - c.area.left;
    const plot p = {past, c.area, round_up(history_peak(past) * 1.05f), width / HISTORY_FRAMES};
    bool chosen = plot_frame(&p, &c, ago);
    ui_fill(c.area, ui_rgba(UI_FIELD, 1), 4 * s);
    size_t length = history_length(past);
    for (size_t i = 0; i < length; i++) draw_column(&p, i, chosen && i != *ago ? 0.45f : 0.95f);
    draw_scale(&p);
    ui_canvas_end();
    return chosen;
}

// ---- passes -----------------------------------------------------------------------------------

typedef struct rows {
    const history *past;
    bool chosen; // a frame's numbers, else medians
    size_t ago;
    float total, longest; // milliseconds
} rows;

static float row_ms(const rows *r, size_t pass) {
    return r->chosen ? history_pass_ms(r->past, pass, r->ago) : history_pass_median(r->past, pass);
}

static void draw_pass(const rows *r, size_t pass, float ms, ui_rect at) {
    float s = ui_scale(), line = at.top + 2 * s;
    ui_rect dot = {at.left, at.top + 7 * s, at.left + 8 * s, at.top + 15 * s};
    ui_fill(dot, pass_color(pass, 1), 2 * s);
    float left = at.left + NAME_WIDTH * s, right = at.right - (MS_WIDTH + SHARE_WIDTH) * s;
    label_within(at.left + 16 * s, line, fminf(left, right) - at.left - 22 * s, ui_rgba(UI_TEXT, 1),
                 r->past->passes[pass].name);
    ui_rect bar = {left, at.top + 6 * s, fmaxf(right, left), at.top + 16 * s};
    ui_fill(bar, ui_rgba(UI_FIELD, 1), 3 * s);
    bar.right = left + (bar.right - left) * (r->longest > 0 ? ms / r->longest : 0);
    if (bar.right - bar.left >= s) ui_fill(bar, pass_color(pass, 1), 3 * s);
    char text[32];
    snprintf(text, sizeof text, ms < 10 ? "%.2f ms" : "%.1f ms", (double)ms);
    label_right(at.right - SHARE_WIDTH * s, line, ui_rgba(UI_TEXT, 1), text);
    snprintf(text, sizeof text, "%.0f %%", r->total > 0 ? (double)(100 * ms / r->total) : 0.0);
    label_right(at.right, line, ui_rgba(UI_DIM, 1), text);
}

static void draw_passes(const history *past, bool chosen, size_t ago) {
    size_t list[HISTORY_PASSES], count = history_list(past, chosen ? ago : 0, list);
    float ms[HISTORY_PASSES], s = ui_scale();
    rows r = {past, chosen, ago, 0, 0};
    for (size_t i = 0; i < count; i++) {
        ms[i] = row_ms(&r, list[i]);
        r.total += ms[i];
        r.longest = fmaxf(r.longest, ms[i]);
    }
    ui_canvas c = ui_canvas_begin("passes", 0, fmaxf((float)count, 1) * ROW * s);
    if (count == 0) ui_label(c.area.left, c.area.top, ui_rgba(UI_DIM, 1), "No frame was drawn yet");
    for (size_t i = 0; i < count; i++) {
        float top = c.area.top + (float)i * ROW * s;
        draw_pass(&r, list[i], ms[i], (ui_rect){c.area.left, top, c.area.right, top + ROW * s});
    }
    ui_canvas_end();
    size_t row = c.hovered ? (size_t)((c.y - c.area.top) / (ROW * s)) : count;
    if (row < count) ui_tooltip(past->passes[list[row]].name); // it may be cut
}

// ---- numbers ----------------------------------------------------------------------------------

static float heading(float left, float top, const char *name, const char *value) {
    ui_label(left, top, ui_rgba(UI_DIM, 1), name);
    left += ui_text_width(name) + 6 * ui_scale();
    ui_label(left, top, ui_rgba(UI_TEXT, 1), value);
    return left + ui_text_width(value) + 16 * ui_scale();
}

static void draw_heading(const history *past, bool chosen, size_t ago) {
    history_frame f = chosen ? *history_get(past, ago) : history_median(past);
    char gpu[32], cpu[32], rate[32] = "", which[48];
    size_t recent = history_length(past) < HISTORY_RECENT ? history_length(past) : HISTORY_RECENT;
    snprintf(gpu, sizeof gpu, f.gpu < 100 ? "%.2f ms" : "%.0f ms", (double)f.gpu);
    snprintf(cpu, sizeof cpu, f.cpu < 100 ? "%.2f ms" : "%.0f ms", (double)f.cpu);
    if (f.interval > 0 && f.interval < IDLE_MS)
        snprintf(rate, sizeof rate, "%.1f fps", 1000 / (double)f.interval);
    if (!chosen)
        snprintf(which, sizeof which, "median of %zu frame%s", recent, recent == 1 ? "" : "s");
    else if (ago == 0)
        snprintf(which, sizeof which, "the last frame");
    else
        snprintf(which, sizeof which, "%zu frame%s ago", ago, ago == 1 ? "" : "s");
    ui_canvas c = ui_canvas_begin("heading", 0, ROW * ui_scale());
    float left = heading(c.area.left, c.area.top, "GPU", gpu);
    left = heading(left, c.area.top, "CPU", cpu);
    ui_label(left, c.area.top, ui_rgba(UI_TEXT, 1), rate);
    if (left + ui_text_width(rate) + ui_text_width(which) < c.area.right)
        label_right(c.area.right, c.area.top, ui_rgba(chosen ? UI_ACCENT : UI_DIM, 1), which);
    ui_canvas_end();
}

static void fact(ui_rect *at, const char *name, const char *value) {
    float s = ui_scale(), left = at->left + NAME_WIDTH * s;
    ui_label(at->left, at->top + 2 * s, ui_rgba(UI_DIM, 1), name);
    label_within(left, at->top + 2 * s, at->right - left, ui_rgba(UI_TEXT, 1), value);
    at->top += ROW * s;
}

static const double MIB = 1024 * 1024;

static size_t count_parts(const roil_memory *memory) {
    size_t count = 0;
    while (count < COUNT_OF(memory->largest) && memory->largest[count].bytes) count++;
    return count;
}

static void draw_account(ui_rect *at, const roil_memory *memory) {
    char text[64];
    snprintf(text, sizeof text, "%.0f of %.0f MiB, of which", (double)memory->sum / MIB,
             (double)memory->limit / MIB);
    fact(at, "all memory", text);
    for (size_t i = 0; i < count_parts(memory); i++) {
        snprintf(text, sizeof text, "    %.0f MiB", (double)memory->largest[i].bytes / MIB);
        fact(at, text, memory->largest[i].label);
    }
}

static void draw_facts(const live *l) {
    char text[128], failed[32] = "";
    roil_playback played;
    bool plays = l->effect && roil_get_playback(l->effect, &played);
    roil_memory memory = roil_get_memory(l->r);
    size_t lines = 6 + plays + count_parts(&memory);
    ui_rect at = ui_canvas_begin("facts", 0, (float)lines * ROW * ui_scale()).area;
    snprintf(text, sizeof text, "%.1f MiB, of %.0f MiB taken", (double)memory.device / MIB,
             (double)memory.reserved / MIB);
    fact(&at, "device memory", text);
    draw_account(&at, &memory);
    if (plays) {
        snprintf(text, sizeof text, "%" PRIu64 " frames, %" PRIu64 " late, %.1f MiB each",
                 played.shown, played.late, (double)played.frame_bytes / MIB);
        fact(&at, "sequences", text);
    }
    roil_live_count count = roil_live_counts(l->follow);
    if (count.failures) snprintf(failed, sizeof failed, ", %" PRIu64 " failed", count.failures);
    snprintf(text, sizeof text, "%" PRIu64 ", the last in %.0f ms%s", count.reloads,
             count.last * 1000, failed);
    fact(&at, "reloads", text);
    pulse_answers answers = pulse_summarise(&l->pulse);
    snprintf(text, sizeof text, "%.0f a second, answers in %.0f ms (95 %%: %.0f)",
             pulse_rate(&l->pulse, clock_seconds()), answers.median, answers.p95);
    fact(&at, "window", text);
    snprintf(text, sizeof text, "%u \u00d7 %u", l->width, l->height);
    fact(&at, "picture", text);
    fact(&at, "device", roil_device_name(l->r));
    ui_canvas_end();
}

void performance_draw(live *l) {
    if (!l->session.performance) return;
    const ui_rect where = label_place(l->view, WIDTH, HEIGHT, false);
    if (ui_window_begin("Performance", &l->session.performance, where, false)) {
        const history *past = &l->performance->past;
        size_t ago = 0;
        bool chosen = draw_plot(past, &ago);
        draw_heading(past, chosen, ago);
        draw_passes(past, chosen, ago);
        ui_separator();
        draw_facts(l);
    }
    ui_window_end();
}
