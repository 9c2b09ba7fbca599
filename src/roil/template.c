// Templates as files: in `templates/` of the effect's folder, and in effects/templates of the
// library. A file that was read is kept until the effect is unloaded, because the flow refers to
// it.
#include "roil/template.h"
#include "base/error.h"
#include "base/file.h"
#include "base/maths.h"
#include "base/memory.h"
#include "base/words.h"
#include "pass/slices/slices.h"
#include "pass/slices/slices_templates.h"
#include "roil_slices.h"
#include <ctype.h>
#include <math.h>
#include <string.h>

enum { SIDE_MAX = 4096, FILE_MAX = 64 << 20 };
static const char *const kinds[] = {"exr", "png"};

struct template_file { // one that was read
    char file[64];
    int64_t changed;
    bool square;
    picture image; // as large as the flow takes it
    float rgba[4 * TEMPLATE_TILE * TEMPLATE_TILE];
};

// ---- names ------------------------------------------------------------------------------------

static bool is_name(const char *text, size_t length) {
    if (length == 0 || *text == '-') return false;
    for (size_t i = 0; i < length; i++)
        if (!isalnum((unsigned char)text[i]) && text[i] != '_' && text[i] != '-') return false;
    return true;
}

// Returns whether `file` is a name with a known ending, such as "source.exr". It then cannot lead
// to another folder.
static bool is_file(const char *file) {
    size_t length = strlen(file);
    return length < sizeof((roil_template *)NULL)->file &&
           words_find(kinds, COUNT_OF(kinds), path_extension(file)) >= 0 &&
           is_name(file, length - 4);
}

static bool library_root(const roil_effect *e, char out[PATH_CAP]) {
    return path_join(out, e->owner->home, "effects");
}

// Returns the path of a file in templates/ of a root. It need not exist.
static bool place_in(const char *root, const char *file, char out[PATH_CAP]) {
    char inside[PATH_CAP];
    return path_join(inside, "templates", file) && path_confine(out, root, inside);
}

static bool find_file(const roil_effect *e, const char *file, char root[PATH_CAP],
                      char out[PATH_CAP]) {
    if (!is_file(file))
        return err_set("template '%.64s' is not a name (letters, digits, _ and -) with .exr or "
                       ".png",
                       file);
    if (str_copy(root, PATH_CAP, effect_get_facts(e->effect)->root) && place_in(root, file, out) &&
        file_exists(out))
        return true;
    if (library_root(e, root) && place_in(root, file, out) && file_exists(out)) return true;
    return err_set("there is no template '%s', neither in templates/ beside the effect nor in the "
                   "library",
                   file);
}

bool template_new_path(const roil_effect *e, const char *name, char out[PATH_CAP]) {
    char file[64];
    size_t length = strlen(name);
    if (length + 5 > sizeof file || !is_name(name, length))
        return err_set("template '%.64s' is not a name (letters, digits, _ and -, at most %zu)",
                       name, sizeof file - 5);
    memcpy(file, name, length);
    memcpy(file + length, ".exr", 5);
    if (!place_in(effect_get_facts(e->effect)->root, file, out)) return false;
    return !file_exists(out) || err_set("templates/%s is there already: take another name", file);
}

// ---- listing ----------------------------------------------------------------------------------

typedef struct listing {
    roil_template *out;
    size_t count, capacity;
} listing;

static bool listing_has(const listing *l, const char *file) {
    size_t known = l->count < l->capacity ? l->count : l->capacity;
    for (size_t i = 0; i < known; i++)
        if (strcmp(l->out[i].file, file) == 0) return true;
    return false;
}

static void add_folder(listing *l, const char *root, const char *kind, bool library) {
    strbuf pattern = {0};
    file_list files;
    strbuf_add(&pattern, "%s/templates/*.%s", root, kind);
    bool done = pattern.length < PATH_CAP && file_glob(strbuf_text(&pattern), &files);
    strbuf_free(&pattern);
    for (size_t i = 0; done && i < files.count; i++) {
        const char *file = path_name(files.paths[i]);
        if (!is_file(file) || listing_has(l, file)) continue;
        if (l->count < l->capacity) {
            roil_template *t = &l->out[l->count];
            *t = (roil_template){.library = library, .changed = file_changed_ns(files.paths[i])};
            str_copy(t->file, sizeof t->file, file);
        }
        l->count++;
    }
    if (done) file_list_free(&files);
}

static int by_file(const void *a, const void *b) {
    return strcmp(((const roil_template *)a)->file, ((const roil_template *)b)->file);
}

static size_t list_templates(const roil_effect *e, roil_template *out, size_t capacity) {
    char library[PATH_CAP];
    listing l = {.out = out, .capacity = capacity};
    bool more = library_root(e, library);
    for (size_t i = 0; i < COUNT_OF(kinds); i++)
        add_folder(&l, effect_get_facts(e->effect)->root, kinds[i], false);
    for (size_t i = 0; more && i < COUNT_OF(kinds); i++) add_folder(&l, library, kinds[i], true);
    qsort(out, l.count < capacity ? l.count : capacity, sizeof *out, by_file);
    return l.count;
}

size_t roil_templates(const roil_effect *e, roil_template *out, size_t capacity) {
    mem_enter();
    return roil_leave_count(list_templates(e, out, capacity));
}

// ---- reading ----------------------------------------------------------------------------------

void roil_free_templates(roil_effect *e) {
    for (size_t i = 0; i < e->template_count; i++) mem_free(e->templates[i]);
    mem_free(e->templates);
}

// Makes the tile that the flow takes; read as a picture again, it gives the same tile.
static void take_tile(template_file *t, const picture *read) {
    t->square = read->width == read->height;
    template_tile(read, t->rgba);
    for (int i = 0; i < TEMPLATE_TILE * TEMPLATE_TILE; i++) {
        float *texel = t->rgba + 4 * i;
        for (int c = 0; c < 3 && texel[3] > 0; c++) texel[c] /= texel[3];
    }
    t->image = (picture){TEMPLATE_TILE, TEMPLATE_TILE, 0, t->rgba};
}

static const template_file *read_template(roil_effect *e, const char *file) {
    char root[PATH_CAP], path[PATH_CAP];
    if (!find_file(e, file, root, path)) return NULL;
    int64_t changed = file_changed_ns(path);
    for (size_t i = 0; i < e->template_count; i++) {
        const template_file *t = e->templates[i];
        if (t->changed == changed && strcmp(t->file, file) == 0) return t;
    }
    arena memory = {0};
    picture read;
    template_file *t = NULL;
    if (picture_read(path, root, SIDE_MAX, &memory, &read)) {
        t = mem_alloc(sizeof *t);
        t->changed = changed;
        str_copy(t->file, sizeof t->file, file);
        take_tile(t, &read);
        *MEM_ADD(e->templates, e->template_count, e->template_capacity) = t;
    }
    arena_free(&memory);
    return t;
}

// ---- icons ------------------------------------------------------------------------------------

static uint8_t byte_of(float value) {
    return (uint8_t)(clampf(value, 0, 1) * 255 + 0.5f);
}

// Colours as in shaders/view/slices.comp, times the square root of alpha, which is how visible they
// are.
static void color_of(const float texel[4], bool velocity, uint8_t out[4]) {
    const float third = 2.0943951f, ground = 0.08f;
    float rgb[3] = {ground, ground, ground};
    float weight = sqrtf(texel[3]);
    float angle = atan2f(texel[1], texel[0]), p = texel[2] * weight;
    float speed = fminf(hypotf(texel[0], texel[1]) * weight, 1);
    for (int i = 0; i < 3 && velocity; i++) {
        float hue = 0.5f + 0.5f * cosf(angle - third * (float)(i == 2 ? -1 : i));
        rgb[i] += 0.8f * powf(speed, 0.7f) * (0.25f + 0.75f * hue);
    }
    if (!velocity) rgb[0] += 0.9f * fmaxf(-p, 0), rgb[1] += 0.75f * fmaxf(p, 0);
    for (int i = 0; i < 3; i++) out[i] = byte_of(rgb[i]);
    out[3] = 255;
}

bool roil_template_icon(roil_effect *e, const char *file, bool velocity, uint32_t side,
                        uint8_t *out) {
    mem_enter();
    const template_file *t = read_template(e, file);
    if (!t) return mem_leave(false);
    if (!t->square) return mem_leave(err_set("%s is no template: it is not square", file));
    for (uint32_t y = 0; y < side; y++)
        for (uint32_t x = 0; x < side; x++) {
            uint32_t i = x * TEMPLATE_TILE / side, j = y * TEMPLATE_TILE / side;
            color_of(t->rgba + 4 * (j * TEMPLATE_TILE + i), velocity, out + 4 * (y * side + x));
        }
    return mem_leave(true);
}

// ---- putting ----------------------------------------------------------------------------------

static slices_hand hand_of(const roil_template_use *use, const picture *image) {
    const float *middle = use->where.middle;
    return (slices_hand){
        .image = image,
        .pushes = use->velocity,
        .slice = use->everywhere ? SLICES_ALL : (int)use->where.slice,
        .place = {middle[0], middle[1]},
        .size = use->where.side,
        .angle = use->angle,
        .strength = use->strength,
        .blend = use->blend,
        .lifetime = use->lifetime,
    };
}

bool roil_template_put(roil_effect *e, const roil_template_use *use) {
    mem_enter();
    pass *p = roil_slices_find_square(e, &use->where);
    const template_file *t = p ? read_template(e, use->file) : NULL;
    if (!t) return mem_leave(false);
    const slices_hand hand = hand_of(use, &t->image);
    return mem_leave(slices_put(p, &hand));
}

// Copies a template of the library into the effect's folder, so that the effect's file can name it.
static bool adopt_template(const roil_effect *e, const char *file) {
    char root[PATH_CAP], from[PATH_CAP], to[PATH_CAP];
    void *bytes;
    size_t size;
    if (!find_file(e, file, root, from) || !place_in(effect_get_facts(e->effect)->root, file, to))
        return false;
    if (file_exists(to)) return true;
    if (!file_read_inside(root, from, FILE_MAX, &bytes, &size)) return false;
    bool done = file_write_inside(effect_get_facts(e->effect)->root, to, bytes, size);
    mem_free(bytes);
    return done;
}

char *roil_template_lua(roil_effect *e, const roil_template_use *use) {
    mem_enter();
    const pass *p = roil_slices_find(e, use->where.flow, use->where.slice);
    if (!p || !adopt_template(e, use->file)) return roil_leave_text(NULL);
    const slices_hand hand = hand_of(use, NULL);
    strbuf line = {0}, file = {0};
    strbuf_add(&file, "templates/%s", use->file);
    slices_hand_line(&hand, pass_slices_variable(p), strbuf_text(&file), &line);
    strbuf_free(&file);
    return roil_leave_text(line.text);
}
