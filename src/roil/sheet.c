// Sheets: their maps are read back after each frame and added to a cell; the camera is set so that
// the medium fills it.
#include "roil/sheet.h"
#include "base/budget.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/memory.h"
#include "base/words.h"
#include "media/optical_flow.h"
#include <math.h>
#include <string.h>

enum {
    MOST_SIDE = 64,      // cells
    MOST_PIXELS = 16384, // along a side of a sheet
    WORK = 3             // copies of a map while it is written
};

static const effect_map sources[SHEET_MAPS] = {
    [SHEET_SHOWN] = EFFECT_MAP_SHOWN,
    [SHEET_SCENE] = EFFECT_MAP_COLOR,
    [SHEET_MOTION] = EFFECT_MAP_MOTION,
    [SHEET_RIGHT_TOP_BACK] = EFFECT_MAP_RIGHT_TOP_BACK,
    [SHEET_LEFT_BOTTOM_FRONT] = EFFECT_MAP_LEFT_BOTTOM_FRONT,
    [SHEET_EMISSION] = EFFECT_MAP_EMISSION,
    [SHEET_NORMAL] = EFFECT_MAP_NORMAL,
    [SHEET_HEAT] = EFFECT_MAP_HEAT,
};

// Of these the colours are means, which count as much as their alpha says.
static bool is_mean(sheet_map map) {
    return map == SHEET_MOTION || map == SHEET_NORMAL || map == SHEET_HEAT;
}

// ---- what is wanted ---------------------------------------------------------------------------

typedef struct wish {
    bool maps[SHEET_MAPS];
    bool color, depth, temperature;
} wish;

static bool want(wish *w, const char *name) {
    static const char *const names[] = {"color",  "motion", "six-way",
                                        "normal", "depth",  "temperature"};
    size_t i = 0;
    while (i < COUNT_OF(names) && strcmp(names[i], name) != 0) i++;
    switch (i) {
    case 0:
        return w->color = true;
    case 1:
        return w->maps[SHEET_MOTION] = true;
    case 2:
        w->maps[SHEET_LEFT_BOTTOM_FRONT] = w->maps[SHEET_EMISSION] = true;
        return w->maps[SHEET_RIGHT_TOP_BACK] = true;
    case 3:
        return w->maps[SHEET_NORMAL] = true;
    case 4:
        return w->maps[SHEET_HEAT] = w->depth = true;
    case 5:
        return w->maps[SHEET_HEAT] = w->temperature = true;
    default:
        break;
    }
    return words_refuse(names, COUNT_OF(names), name, NULL, "map '%s'", name);
}

static bool want_all(wish *w, const roil_sheet_desc *desc) {
    const char *light = desc->light ? desc->light : "shown";
    for (const char *at = desc->maps ? desc->maps : "color";; at++) {
        char name[32] = "";
        size_t length = strcspn(at, ",");
        if (length == 0 || length >= sizeof name)
            return err_set("maps '%s'; accepted: names with commas between", desc->maps);
        memcpy(name, at, length);
        if (!want(w, name)) return false;
        at += length;
        if (!*at) break;
    }
    const bool both = strcmp(light, "both") == 0;
    if (!both && strcmp(light, "shown") != 0 && strcmp(light, "scene") != 0)
        return err_set("light '%s'; accepted: shown, scene, both", light);
    w->maps[SHEET_SHOWN] = w->color && (both || strcmp(light, "shown") == 0);
    w->maps[SHEET_SCENE] = w->color && (both || strcmp(light, "scene") == 0);
    return true;
}

static bool check_size(const roil_sheet *s) {
    if (s->columns > MOST_SIDE || s->rows > MOST_SIDE)
        return err_set("a grid of %u x %u cells; accepted: 1 to %d each", s->columns, s->rows,
                       MOST_SIDE);
    if (s->cell < 16 || s->cell > 4096)
        return err_set("cells of %u pixels; accepted: 16 to 4096", s->cell);
    if (2 * s->gutter + 8 > s->cell)
        return err_set("a gutter of %u pixels leaves nothing of cells of %u", s->gutter, s->cell);
    const uint32_t side = s->cell * (s->columns > s->rows ? s->columns : s->rows);
    return side <= MOST_PIXELS ||
           err_set("%u x %u cells of %u pixels are %u pixels along a side; accepted: up to %d",
                   s->columns, s->rows, s->cell, side, MOST_PIXELS);
}

// ---- the camera -------------------------------------------------------------------------------

static bool set_vector(roil_effect *e, const char *name, const vec3 v) {
    char text[96];
    snprintf(text, sizeof text, "%.9g,%.9g,%.9g", (double)v[0], (double)v[1], (double)v[2]);
    return roil_set(e, name, text);
}

static void find_axes(roil_sheet *s, const roil_camera *c) {
    vec3 up = {0, 0, 1};
    for (int i = 0; i < 3; i++) s->axes[2][i] = c->eye[i] - c->target[i];
    if (glm_vec3_norm(s->axes[2]) < 1e-6f) glm_vec3_copy((vec3){0, -1, 0}, s->axes[2]);
    glm_vec3_normalize(s->axes[2]);
    if (hypotf(s->axes[2][0], s->axes[2][1]) < 1e-4f) glm_vec3_copy((vec3){0, 1, 0}, up);
    glm_vec3_crossn(up, s->axes[2], s->axes[0]);
    glm_vec3_cross(s->axes[2], s->axes[0], s->axes[1]);
}

// Sets the middle of what is seen, and returns how far the box goes from there to any side, at
// most.
static float find_middle(const roil_sheet *s, vec3 middle) {
    const box3 *b = &s->passes.box;
    vec3 low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
    for (int i = 0; i < 8; i++) {
        vec3 corner = {i & 1 ? b->max.x : b->min.x, i & 2 ? b->max.y : b->min.y,
                       i & 4 ? b->max.z : b->min.z};
        for (int k = 0; k < 3; k++) {
            float at = glm_vec3_dot(corner, (float *)(uintptr_t)s->axes[k]);
            low[k] = fminf(low[k], at);
            high[k] = fmaxf(high[k], at);
        }
    }
    glm_vec3_zero(middle);
    for (int k = 0; k < 3; k++)
        glm_vec3_muladds((float *)(uintptr_t)s->axes[k], 0.5f * (low[k] + high[k]), middle);
    return 0.5f * fmaxf(high[0] - low[0], high[1] - low[1]);
}

static void find_pivot(roil_sheet *s, const vec3 middle) {
    s->pivot[0] = 0.5f - glm_vec3_dot((float *)(uintptr_t)middle, s->axes[0]) / s->height;
    s->pivot[1] = 0.5f + glm_vec3_dot((float *)(uintptr_t)middle, s->axes[1]) / s->height;
}

// Narrows what is seen to a part of it: moves the middle. Returns half of its longer side.
static float narrow(const roil_sheet *s, const float part[4], float half, vec3 middle) {
    const float width = part[2] - part[0], height = part[3] - part[1];
    if (!(width > 0 && height > 0)) return half;
    const float right = part[0] + part[2] - 1, down = part[1] + part[3] - 1;
    glm_vec3_muladds((float *)(uintptr_t)s->axes[0], right * half, middle);
    glm_vec3_muladds((float *)(uintptr_t)s->axes[1], -down * half, middle);
    return half * fmaxf(width, height);
}

// An orthographic camera that looks the way that the effect's own does at first.
static bool set_camera(roil_sheet *s, bool keep, const float part[4]) {
    roil_camera c;
    vec3 middle, eye;
    char text[32];
    if (!roil_get_camera(s->owner, &c)) return false;
    find_axes(s, &c);
    if (keep) {
        s->distance = c.distance;
        s->height = c.orthographic > 0 ? c.orthographic : 2 * c.distance * tanf(glm_rad(c.fov) / 2);
        find_pivot(s, c.target);
        return true;
    }
    const float whole = find_middle(s, middle), half = narrow(s, part, whole, middle);
    s->height = 2 * half * (float)s->cell / (float)(s->cell - 2 * s->gutter);
    s->distance = fmaxf(4 * whole, 1);
    glm_vec3_copy(middle, eye);
    glm_vec3_muladds(s->axes[2], s->distance, eye);
    find_pivot(s, middle);
    snprintf(text, sizeof text, "%.9g", (double)s->height);
    if (!set_vector(s->owner, "camera.target", middle) ||
        !roil_set(s->owner, "camera.orthographic", text))
        return false;
    size_t index;
    if (roil_find_control(s->owner, "camera.eye", &index))
        return set_vector(s->owner, "camera.eye", eye);
    float distance, yaw, pitch;
    orbit_angles(eye, middle, &distance, &yaw, &pitch);
    const float orbit[] = {distance, yaw, pitch};
    static const char *const names[] = {"camera.distance", "camera.yaw", "camera.pitch"};
    for (int i = 0; i < 3; i++) {
        snprintf(text, sizeof text, "%.9g", (double)orbit[i]);
        if (!roil_set(s->owner, names[i], text)) return false;
    }
    return true;
}

// ---- from begin to end ------------------------------------------------------------------------

// Where nothing says how the medium moves, its pictures may.
static bool can_estimate(const roil_sheet *s, const wish *w) {
    if (w->color && optical_flow_load()) return true;
    if (!w->color) err_set("motion is estimated from the colours: add color to the maps");
    return err_prefix(
        "nothing says how the medium of pass '%s' moves: no grid with a velocity is in its "
        "density, and nothing that `advect` carries; ",
        s->passes.source);
}

static bool add_passes(roil_sheet *s, const roil_sheet_desc *desc, const wish *w) {
    effect *e = s->owner->effect;
    effect_sheet_desc wanted = {.source = desc->source,
                                .temperature = w->temperature,
                                .first = desc->first,
                                .last = desc->last};
    for (int i = 0; i < SHEET_MAPS; i++) wanted.wanted[sources[i]] = w->maps[i];
    if (!effect_add_sheet(e, &wanted, &s->passes)) return false;
    if (w->maps[SHEET_MOTION] && !s->passes.moves && !can_estimate(s, w)) return false;
    for (int i = 0; i < SHEET_MAPS; i++) {
        graph_image image = s->passes.images[sources[i]];
        if (w->maps[i] && image.id &&
            !roil_keep(s->owner, graph_get_desc(effect_graph(e), image)->name))
            return false;
    }
    effect_skip_pictures(e);
    return true;
}

static bool make_maps(roil_sheet *s, const wish *w) {
    const uint64_t size = (uint64_t)s->columns * s->rows * s->cell * s->cell * 4 * sizeof(float);
    uint64_t count = WORK;
    for (int i = 0; i < SHEET_MAPS; i++) count += w->maps[i];
    const uint64_t before = size / (s->columns * s->rows) * s->fade;
    s->memory = budget_take(budget_host(), count * size + (count - WORK) * before, "sheets");
    for (int i = 0; s->memory && i < SHEET_MAPS; i++)
        if (w->maps[i]) s->maps[i] = sheet_create(s->columns, s->rows, s->cell, s->cell);
    for (int i = 0; s->memory && s->fade && i < SHEET_MAPS; i++)
        if (w->maps[i]) s->before[i] = sheet_create(s->fade, 1, s->cell, s->cell);
    s->parts = mem_alloc(s->fade * sizeof *s->parts);
    return s->memory;
}

static roil_sheet *create_sheet(roil_effect *e, const roil_sheet_desc *desc) {
    roil_sheet *s = mem_alloc(sizeof *s);
    wish w = {0};
    s->owner = e;
    s->settings = roil_list_settings(e);
    s->columns = desc->columns ? desc->columns : 8;
    s->rows = desc->rows ? desc->rows : 8;
    s->cell = desc->cell ? desc->cell : 256;
    s->gutter = desc->gutter;
    s->fade = desc->fade < s->columns * s->rows ? desc->fade : 0;
    if (want_all(&w, desc) && check_size(s) && add_passes(s, desc, &w) &&
        set_camera(s, desc->camera, desc->part) && make_maps(s, &w)) {
        s->depth = w.depth;
        s->temperature = w.temperature;
        return s;
    }
    roil_sheet_free(s);
    return NULL;
}

roil_sheet *roil_sheet_create(roil_effect *e, const roil_sheet_desc *desc) {
    RETURN_MADE(roil_sheet, create_sheet(e, desc), roil_sheet_free(made));
}

static bool repeats(roil_effect *e, const char *source, double seconds, char *why,
                    size_t capacity) {
    strbuf text = {0};
    bool done = effect_repeats(e->effect, source, seconds, &text);
    str_copy(why, capacity, strbuf_text(&text));
    strbuf_free(&text);
    return done;
}

bool roil_repeats(roil_effect *e, const char *source, double seconds, char *why, size_t capacity) {
    return MEM_CALL(repeats(e, source, seconds, why, capacity));
}

static bool add_map(roil_sheet *s, sheet *maps, sheet_map map, uint32_t cell, float weight) {
    uint32_t width, height;
    float *pixels = roil_read_linear(s->owner, s->passes.images[sources[map]], &width, &height);
    if (!pixels) return false;
    const bool fits = width == s->cell && height == s->cell;
    for (size_t i = 0; is_mean(map) && i < (size_t)width * height; i++)
        for (int c = 0; c < 3; c++) pixels[4 * i + c] *= pixels[4 * i + 3];
    if (fits) sheet_add(&maps[map], cell, pixels, weight);
    mem_free(pixels);
    return fits || err_set("the effect was not prepared for cells of %u pixels", s->cell);
}

bool sheet_take(roil_sheet *s, sheet *maps, uint32_t cell, float weight) {
    for (int i = 0; i < SHEET_MAPS; i++)
        if (maps[i].pixels && s->passes.images[sources[i]].id &&
            !add_map(s, maps, (sheet_map)i, cell, weight))
            return false;
    return true;
}

bool roil_sheet_add(roil_sheet *s, uint32_t cell, double weight) {
    mem_enter();
    if (cell >= s->columns * s->rows)
        return mem_leave(err_set("cell %u; the sheet has %u", cell, s->columns * s->rows));
    return mem_leave(sheet_take(s, s->maps, cell, (float)weight));
}

bool roil_sheet_find_used(const roil_sheet *s, uint32_t count, float part[4]) {
    const sheet *linear = &s->maps[SHEET_SCENE], *shown = &s->maps[SHEET_SHOWN];
    if (!linear->pixels || !shown->pixels) return err_set("the sheet has not both colours");
    const float whole = (float)s->cell;
    float all[4] = {whole, whole, 0, 0}, step[4] = {0}, before[4];
    bool seen = false;
    for (uint32_t i = 0; i < count; i++) {
        const sheet_area a = sheet_find_used_in(linear, i, SHEET_LEAST, 4),
                         b = sheet_find_used_in(shown, i, SHEET_LEAST, 4);
        const float now[] = {fminf((float)a.left, (float)b.left), fminf((float)a.top, (float)b.top),
                             fmaxf((float)a.right, (float)b.right),
                             fmaxf((float)a.bottom, (float)b.bottom)};
        if (now[0] >= now[2]) continue;
        for (int k = 0; k < 4; k++) {
            if (seen) step[k] = fmaxf(step[k], fabsf(now[k] - before[k]) / 2);
            all[k] = k < 2 ? fminf(all[k], now[k]) : fmaxf(all[k], now[k]);
            before[k] = now[k];
        }
        seen = true;
    }
    for (int k = 0; seen && k < 4; k++) // and a pixel, since edges are seen where their middles are
        part[k] = clampf((all[k] + (k < 2 ? -1 : 1) * (step[k] + 1)) / whole, 0, 1);
    return seen || err_set("nothing of the medium of '%s' is seen", s->passes.source);
}

bool roil_sheet_save(roil_sheet *s, const char *file, const roil_sheet_options *options) {
    mem_enter();
    const sheet_engine *engine = sheet_find_engine(options->engine);
    if (!engine) return mem_leave(false);
    if (s->saved) return mem_leave(err_set("%s: the sheet was written already", file));
    s->saved = true;
    s->made = options->made;
    s->name = path_name(file);
    s->files = json_array();
    s->used = options->count ? options->count : s->columns * s->rows;
    if (!sheet_blend(s, options->fps)) return mem_leave(false);
    if (s->maps[SHEET_MOTION].pixels && !s->passes.moves &&
        !sheet_find_flow(s, s->used, options->loop > 0, options->fps))
        return mem_leave(false);
    if (!sheet_write_all(s, file, options, engine)) return mem_leave(false);
    json_t *description = sheet_describe(s, file, options, engine);
    strbuf path = {0};
    sheet_stem(file, &path);
    strbuf_add(&path, ".json");
    char *text = json_text(description, JSON_INDENT(2) | JSON_REAL_PRECISION(7));
    strbuf whole = {0};
    if (text) sheet_add_recipe(s, strbuf_text(&path), text, &whole);
    bool done = text && file_write(strbuf_text(&path), whole.text, whole.length) &&
                (!options->page || sheet_write_page(s, options->page, file, description));
    mem_free(text);
    strbuf_free(&whole);
    strbuf_free(&path);
    json_decref(description);
    return mem_leave(done);
}

const char *roil_sheet_summary(const roil_sheet *s) {
    return strbuf_text(&s->summary);
}

void roil_sheet_free(roil_sheet *s) {
    if (!s) return;
    for (int i = 0; i < SHEET_MAPS; i++) sheet_free(&s->maps[i]);
    for (int i = 0; i < SHEET_MAPS; i++) sheet_free(&s->before[i]);
    mem_free(s->parts);
    budget_give(s->memory);
    json_decref(s->files);
    json_decref(s->settings);
    strbuf_free(&s->summary);
    mem_free(s);
}
