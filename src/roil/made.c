// How outputs were made: a line of JSON in every picture, film and volume, and how it is read from
// files that may be a stranger's.
#include "base/error.h"
#include "base/hash.h"
#include "base/json_text.h"
#include "base/memory.h"
#include "effect/recipe.h"
#include "roil/roil_impl.h"
#include <errno.h>
#include <fcntl.h>
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { LINE_MAX = 256 << 10, BLOCK = 1 << 20, PIECES = 16, OPTIONS_MAX = 16 };

// ---- inputs -----------------------------------------------------------------------------------

// Hashes what is in a file; of one larger than 16 MiB, its size and 16 pieces.
static bool hash_file(int file, uint64_t size, hash128 *out) {
    uint64_t step = size > (uint64_t)BLOCK * PIECES ? (size - BLOCK) / (PIECES - 1) : BLOCK;
    uint8_t *block = mem_alloc(BLOCK);
    bool done = true;
    *out = hash_bytes(&size, sizeof size);
    for (uint64_t at = 0; done && at < size; at += step) {
        ssize_t count = pread(file, block, BLOCK, (off_t)at);
        done = count >= 0;
        if (done) *out = hash_combine(*out, hash_bytes(block, (size_t)count));
    }
    mem_free(block);
    return done;
}

int roil_open_input(const roil_effect *e, const char *path, size_t *size) {
    const char *inside = effect_get_facts(e->effect)->inside;
    const char *const *roots, *const *files;
    effect_files(e->effect, &files);
    if (path == files[0]) return file_open_inside(inside, path, SIZE_MAX, size); // its own
    size_t count = effect_roots(e->effect, &roots);
    for (size_t i = 0; i < count; i++) {
        int file = file_open_inside(i == 0 && inside ? inside : roots[i], path, SIZE_MAX, size);
        if (file >= 0) return file;
    }
    return file_open_inside(e->owner->home, path, SIZE_MAX, size);
}

static int by_value(const void *a, const void *b) {
    return memcmp(a, b, sizeof(hash128));
}

// Hashes what is in the files, whatever they are called.
static const char *hash_inputs(roil_effect *e) {
    if (e->inputs[0]) return e->inputs;
    const char *const *files;
    size_t count = effect_files(e->effect, &files), found = 0;
    hash128 *hashes = mem_alloc(count * sizeof *hashes);
    for (size_t i = 0; i < count; i++) {
        size_t size;
        int file = roil_is_project(files[i]) ? -1 : roil_open_input(e, files[i], &size);
        if (file < 0) continue;
        found += hash_file(file, size, &hashes[found]);
        close(file);
    }
    qsort(hashes, found, sizeof *hashes, by_value);
    hash_to_hex(hash_bytes(hashes, found * sizeof *hashes), e->inputs);
    mem_free(hashes);
    return e->inputs;
}

const char *roil_hash_inputs(roil_effect *e) {
    mem_enter();
    const char *hash = hash_inputs(e);
    return mem_leave(true) ? hash : NULL;
}

// ---- writing ----------------------------------------------------------------------------------

json_t *roil_list_settings(const roil_effect *e) {
    json_t *settings = json_object();
    for (size_t i = 0; i < effect_control_count(e->effect); i++) {
        const effect_control *c = effect_get_control(e->effect, i);
        if (c->moved)
            json_object_set_new(settings, c->name, json_string(effect_control_setting(c)));
    }
    return settings;
}

char *roil_describe(roil_effect *e, const roil_making *how) {
    json_t *settings = how->settings ? json_incref(how->settings) : roil_list_settings(e);
    json_t *options = json_array();
    for (size_t i = 0; how->options[i]; i++)
        json_array_append_new(options, json_string(how->options[i]));
    const char *source = effect_get_facts(e->effect)->source;
    json_t *root = json_pack(
        "{s:i, s:s, s:s, s:s, s:f, s:[f,f,f], s:[i,i], s:o, s:o, s:s, s:s, s:s}", "roil-recipe", 1,
        "roil", ROIL_VERSION, "kind", how->kind, "effect", source, "frame", e->shown, "frames",
        how->first, how->last, how->step, "size", (int)e->width, (int)e->height, "settings",
        settings, "options", options, "device", roil_device_name(e->owner), "driver",
        roil_device_driver(e->owner), "inputs", hash_inputs(e));
    if (how->sheet) json_object_set_new(root, "sheet", json_string(how->sheet));
    if (how->part) json_object_set_new(root, "part", json_string(how->part));
    char *text = root ? json_text(root, JSON_COMPACT | JSON_ENSURE_ASCII) : NULL;
    json_decref(root);
    return text;
}

// ---- reading ----------------------------------------------------------------------------------

typedef struct owned_made { // a roil_made first: what roil_read_made gives
    roil_made made;
    arena memory;
} owned_made;

// Finds the line in a file of any size, and reads it with what follows.
static bool find_line(const char *path, char line[LINE_MAX + 1]) {
    static const char begin[] = ROIL_RECIPE_BEGIN;
    enum { OVERLAP = sizeof begin - 1 };
    struct stat info;
    int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (file < 0) return err_set("%s: %s", path, strerror(errno));
    if (fstat(file, &info) != 0 || !S_ISREG(info.st_mode)) {
        close(file);
        return err_set("%s: not a regular file", path);
    }
    char *block = mem_alloc(BLOCK);
    ssize_t count = 0;
    bool found = false;
    for (off_t at = 0; !found && (count = pread(file, block, BLOCK, at)) >= OVERLAP;
         at += count - OVERLAP + 1) {
        const char *here = memmem(block, (size_t)count, begin, OVERLAP);
        found = here != NULL;
        if (!found) continue;
        count = pread(file, line, LINE_MAX, at + (here - block));
        line[count > 0 ? count : 0] = '\0';
        break;
    }
    mem_free(block);
    close(file);
    return found || err_set("%s: it does not say how it was made; pictures, films and volumes of "
                            "roil do",
                            path);
}

static const char *take_text(owned_made *own, const json_t *root, const char *key) {
    const char *text = json_string_value(json_object_get(root, key));
    if (!text || !recipe_is_plain(text) || strlen(text) >= PATH_CAP) return NULL;
    return arena_string(&own->memory, text);
}

static bool is_frame(double value) {
    return isfinite(value) && fabs(value) <= 1e9;
}

static bool take_frames(roil_made *m, const json_t *root) {
    const json_t *frames = json_object_get(root, "frames"), *size = json_object_get(root, "size");
    m->frame = json_number_value(json_object_get(root, "frame"));
    m->first = json_number_value(json_array_get(frames, 0));
    m->last = json_number_value(json_array_get(frames, 1));
    m->step = json_number_value(json_array_get(frames, 2));
    json_int_t width = json_integer_value(json_array_get(size, 0));
    json_int_t height = json_integer_value(json_array_get(size, 1));
    m->width = (uint32_t)width;
    m->height = (uint32_t)height;
    return is_frame(m->frame) && is_frame(m->first) && is_frame(m->last) && is_frame(m->step) &&
           width >= 1 && height >= 1 && width <= 16384 && height <= 16384;
}

static bool take_settings(owned_made *own, json_t *root) {
    json_t *settings = json_object_get(root, "settings"), *value;
    const char *name;
    size_t count = json_object_size(settings), i = 0;
    if (count > RECIPE_MAX_SETTINGS) return false;
    roil_setting *out = arena_alloc(&own->memory, count * sizeof *out);
    json_object_foreach(settings, name, value) {
        const char *text = json_string_value(value);
        if (!recipe_is_name(name) || !text || !recipe_is_plain(text)) return false;
        out[i++] =
            (roil_setting){arena_string(&own->memory, name), arena_string(&own->memory, text)};
    }
    own->made.settings = out;
    own->made.setting_count = count;
    return true;
}

// Takes nothing but options that change what is drawn.
static bool is_option(const char *text) {
    static const char *const known[] = {
        "--alpha",      "--premultiplied", "--16",       "--float",    "--shown",   "--dump-pass=",
        "--reference=", "--warmup=",       "--fps=",     "--source=",  "--fields=", "--size=",
        "--box=",       "--tolerance=",    "--grid=",    "--cell=",    "--gutter=", "--frames=",
        "--loop=",      "--maps=",         "--for=",     "--light=",   "--alpha=",  "--format=",
        "--crop",       "--camera",        "--samples=", "--shutter=", "--all"};
    for (size_t i = 0; i < COUNT_OF(known); i++) {
        size_t length = strlen(known[i]);
        bool value = known[i][length - 1] == '=';
        if (value ? strncmp(text, known[i], length) == 0 : strcmp(text, known[i]) == 0) return true;
    }
    return false;
}

static bool take_options(owned_made *own, const json_t *root) {
    const json_t *options = json_object_get(root, "options");
    size_t count = json_array_size(options);
    if (count > OPTIONS_MAX) return false;
    const char **out = arena_alloc(&own->memory, (count + 1) * sizeof *out);
    for (size_t i = 0; i < count; i++) {
        const char *text = json_string_value(json_array_get(options, i));
        if (!text || !recipe_is_plain(text) || !is_option(text)) return false;
        out[i] = arena_string(&own->memory, text);
    }
    own->made.options = out;
    own->made.option_count = count;
    return true;
}

// Takes the name of a file, which leads to no other folder.
static const char *take_name(owned_made *own, const json_t *root, const char *key) {
    const char *text = take_text(own, root, key);
    bool plain = text && text[0] && strlen(text) < 200 && text[0] != '-' && text[0] != '.';
    return plain && !strchr(text, '/') ? text : NULL;
}

static bool take_sheet(owned_made *own, const json_t *root) {
    own->made.sheet = own->made.part = "";
    if (strcmp(own->made.kind, "sheet") != 0) return true;
    own->made.sheet = take_name(own, root, "sheet");
    own->made.part = take_name(own, root, "part");
    return own->made.sheet && own->made.part;
}

static bool take_all(owned_made *own, json_t *root) {
    roil_made *m = &own->made;
    const char *file = take_text(own, root, "effect");
    m->kind = take_text(own, root, "kind");
    m->version = take_text(own, root, "roil");
    m->device = take_text(own, root, "device");
    m->driver = take_text(own, root, "driver");
    m->inputs = take_text(own, root, "inputs");
    if (!file || !recipe_is_effect(file) || !m->kind || !m->version || !m->device || !m->driver ||
        !m->inputs)
        return false;
    m->effect = recipe_stays_below(file) ? file : NULL;
    return take_sheet(own, root) && take_frames(m, root) && take_settings(own, root) &&
           take_options(own, root);
}

roil_made *roil_parse_made(const char *line, const char *name) {
    owned_made *own = mem_alloc(sizeof *own);
    json_t *root = json_loads(line, JSON_DISABLE_EOF_CHECK, NULL);
    bool done = root && take_all(own, root);
    json_decref(root);
    if (done) return &own->made;
    err_set("%s: its recipe is damaged", name);
    roil_free_made(&own->made);
    return NULL;
}

static roil_made *read_made(const char *file) {
    char *line = mem_alloc(LINE_MAX + 1);
    roil_made *m = find_line(file, line) ? roil_parse_made(line, file) : NULL;
    mem_free(line);
    return m;
}

roil_made *roil_read_made(const char *file) {
    RETURN_MADE(roil_made, read_made(file), roil_free_made(made));
}

void roil_free_made(roil_made *m) {
    if (!m) return;
    owned_made *own = (owned_made *)m;
    arena_free(&own->memory);
    mem_free(own);
}
