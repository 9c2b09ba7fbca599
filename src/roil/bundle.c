// Bundles: an effect is packed with all that it reads, and unpacked into a folder of this process.
#include "media/bundle.h"
#include "base/alias.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/str.h"
#include "roil/roil_impl.h"
#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <limits.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

// ---- folders of bundles -----------------------------------------------------------------------

typedef struct opened { // a bundle that this process has unpacked
    struct opened *next;
    char *source, *place, *folder, *file; // as named; what is removed; the effect's folder and file
    int lock;                             // the open folder `place`, locked as long as it is used
    file_stamp stamp;                     // of the source
} opened;

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static opened *all;
static int users;

static int remove_one(const char *path, const struct stat *info, int kind, struct FTW *where) {
    (void)info, (void)where;
    if (kind == FTW_DP || kind == FTW_D)
        rmdir(path);
    else
        unlink(path);
    return 0;
}

static void remove_tree(const char *path) {
    nftw(path, remove_one, 16, FTW_DEPTH | FTW_PHYS);
}

// Opens a folder and locks it. -1: another process uses it.
static int lock_folder(const char *path) {
    int folder = open(path, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    struct stat info;
    if (folder >= 0 && flock(folder, LOCK_EX | LOCK_NB) == 0 && fstat(folder, &info) == 0 &&
        info.st_nlink > 0)
        return folder;
    if (folder >= 0) close(folder);
    return -1;
}

// Removes what processes have left that were killed.
static void remove_left(const char *above) {
    char pattern[PATH_CAP];
    file_list list = {0};
    if (!path_join(pattern, above, "roil-bundle-*") || !file_glob(pattern, &list)) return;
    for (size_t i = 0; i < list.count; i++) {
        int folder = lock_folder(list.paths[i]);
        if (folder < 0) continue;
        remove_tree(list.paths[i]);
        close(folder);
    }
    file_list_free(&list);
}

// Makes a folder that nobody else uses or removes, in the user's cache or the temporary folder.
static bool make_place(char out[PATH_CAP], int *folder) {
    char above[PATH_CAP], real[PATH_MAX];
    const char *temporary = getenv("TMPDIR");
    if (!path_cache_folder(above, "bundles"))
        str_copy(above, sizeof above, temporary && temporary[0] ? temporary : "/tmp");
    if (!realpath(above, real)) return err_set("%s: %s", above, strerror(errno));
    remove_left(real);
    for (int tries = 0; *folder < 0 && tries < 100; tries++) { // who tidies up may be faster
        if (!path_join(out, real, "roil-bundle-XXXXXX")) return false;
        if (!mkdtemp(out)) return err_set("%s: no folder can be made: %s", real, strerror(errno));
        *folder = lock_folder(out);
    }
    return *folder >= 0 || err_set("%s: cannot be locked: %s", out, strerror(errno));
}

static void let_go(opened *o) {
    if (o->folder) alias_remove(o->folder);
    if (o->place) remove_tree(o->place);
    if (o->lock >= 0) close(o->lock);
    mem_free(o->source);
    mem_free(o->place);
    mem_free(o->folder);
    mem_free(o->file);
    mem_free(o);
}

static char *format(const char *a, const char *b, const char *ending) {
    strbuf out = {0};
    strbuf_add(&out, "%s/%s%s", a, b, ending);
    return out.text;
}

static bool unpack(opened *o, int file, const bundle *b) {
    char place[PATH_CAP];
    if (!make_place(place, &o->lock)) return false;
    o->place = mem_copy(place, strlen(place) + 1);
    o->folder = format(place, b->name, "");
    o->file = format(o->folder, b->name, ".lua");
    if (mkdir(o->folder, 0700) != 0) return err_set("%s: %s", o->folder, strerror(errno));
    int folder = open(o->folder, O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (folder < 0) return err_set("%s: %s", o->folder, strerror(errno));
    alias_add(o->folder, o->source);
    bool done = bundle_unpack(file, b, folder);
    close(folder);
    return done;
}

static opened *open_bundle(const char *inside, const char *source) {
    int64_t begin = file_clock_ns();
    size_t size;
    int file = file_open_inside(inside, source, SIZE_MAX, &size);
    if (file < 0) return NULL;
    opened *o = mem_alloc(sizeof *o);
    *o = (opened){.source = mem_copy(source, strlen(source) + 1), .lock = -1};
    bundle b;
    bool done = bundle_read(file, size, &b) && unpack(o, file, &b);
    arena_free(&b.memory);
    close(file);
    o->stamp = file_stamp_of(source, begin);
    if (done) return o;
    err_prefix("%s: ", source);
    let_go(o);
    return NULL;
}

bool roil_find_origin(const char *inside, const char *file, roil_origin *out) {
    *out = (roil_origin){.file = file, .inside = inside};
    if (!str_ends_with(file, ".roil")) return true;
    pthread_mutex_lock(&lock);
    opened *o = all;
    while (o && (strcmp(o->source, file) != 0 || !file_stamp_holds(&o->stamp, file))) o = o->next;
    if (!o && (o = open_bundle(inside, file))) {
        o->next = all;
        all = o;
    }
    pthread_mutex_unlock(&lock);
    if (o) *out = (roil_origin){o->file, o->folder, o->source};
    return o != NULL;
}

void roil_count_users(int change) {
    pthread_mutex_lock(&lock);
    users += change;
    while (users == 0 && all) {
        opened *next = all->next;
        let_go(all);
        all = next;
    }
    pthread_mutex_unlock(&lock);
}

bool roil_may_write(const roil_effect *e) {
    const char *source = effect_get_facts(e->effect)->bundle;
    return !source || err_set("%s is a bundle, which is never changed; `roil new NAME --from %s` "
                              "makes a folder of it",
                              source, source);
}

// ---- what an effect reads ---------------------------------------------------------------------

typedef struct owned_inputs { // a roil_inputs first: what roil_collect gives
    roil_inputs inputs;
    arena memory;
    roil_input *list;
    size_t capacity;
    const char *named;
} owned_inputs;

static bool add_input(owned_inputs *own, const char *name, const char *path, uint64_t size) {
    roil_inputs *in = &own->inputs;
    for (size_t i = 0; i < in->count; i++) {
        if (strcmp(own->list[i].name, name) != 0) continue;
        return strcmp(own->list[i].path, path) == 0 ||
               err_set("%s: two files that it reads are called '%s': %s and %s", own->named, name,
                       own->list[i].path, path);
    }
    *MEM_ADD(own->list, in->count, own->capacity) =
        (roil_input){arena_string(&own->memory, name), arena_string(&own->memory, path), size};
    return true;
}

// Adds a file by its name in that of the effect's folders in which it lies. Those of the program
// are left out.
static bool add_file(owned_inputs *own, const roil_effect *e, const char *path) {
    char root[PATH_CAP], rest[PATH_CAP];
    const char *const *roots;
    size_t size, count = effect_roots(e->effect, &roots);
    if (roil_is_project(path)) return true;
    int file = roil_open_input(e, path, &size);
    if (file < 0) return true; // it was looked for, and is not there
    close(file);
    for (size_t i = 0; i < count; i++)
        if (path_split_inside(root, rest, roots[i], path) && rest[0])
            return add_input(own, rest, path, size);
    return true;
}

static bool add_all(owned_inputs *own, roil_effect *e) {
    const char *const *files;
    size_t count = effect_files(e->effect, &files);
    for (size_t i = 0; i < count; i++)
        if (!add_file(own, e, files[i])) return false;
    return true;
}

// Loads the effect once more for each word of a choice: another word may read other files.
static bool add_choices(owned_inputs *own, roil *r, roil_effect *e) {
    for (size_t i = 0; i < roil_control_count(e); i++) {
        roil_control c;
        roil_get_control(e, i, &c);
        if (!c.parameter || !c.structural || (c.type != ROIL_ENUM && c.type != ROIL_BOOL)) continue;
        static const char *const switches[] = {"false", "true"};
        size_t count = c.type == ROIL_BOOL ? 2 : c.word_count;
        for (size_t w = 0; w < count; w++) {
            if (w == (size_t)c.value[0]) continue;
            const char *word = c.type == ROIL_BOOL ? switches[w] : c.words[w];
            roil_effect *other = roil_load(r, own->named, &(roil_setting){c.name, word}, 1);
            bool done = other && roil_check(other) && add_all(own, other);
            roil_unload(other);
            if (!done) return false;
        }
    }
    return true;
}

static bool add_presets(owned_inputs *own, const roil_effect *e) {
    enum { MOST = 256 };
    char(*names)[64] = mem_alloc(MOST * sizeof *names);
    const char *file = effect_get_facts(e->effect)->file;
    size_t count = roil_presets(file, names, MOST);
    bool done = true;
    for (size_t i = 0; done && i < count && i < MOST; i++) {
        char path[PATH_CAP], root[PATH_CAP], rest[PATH_CAP];
        size_t size;
        done = roil_preset_path(path, file, names[i]);
        int preset =
            done ? file_open_inside(effect_get_facts(e->effect)->root, path, SIZE_MAX, &size) : -1;
        if (preset < 0) continue; // a link that leads out
        close(preset);
        done = path_split_inside(root, rest, effect_get_facts(e->effect)->root, path) &&
               add_input(own, rest, path, size);
    }
    mem_free(names);
    return done;
}

static int by_name(const void *a, const void *b) {
    return strcmp(((const roil_input *)a)->name, ((const roil_input *)b)->name);
}

static void keep_info(owned_inputs *own, const roil_effect *e) {
    roil_effect_info *info = &own->inputs.info;
    *info = roil_get_info(e);
    const char **texts[] = {&info->name, &info->author, &info->licence};
    for (size_t i = 0; i < COUNT_OF(texts); i++)
        if (*texts[i]) *texts[i] = arena_string(&own->memory, *texts[i]);
}

static roil_inputs *collect(roil *r, const char *file) {
    owned_inputs *own = mem_alloc(sizeof *own);
    own->named = arena_string(&own->memory, file);
    roil_effect *e = roil_load(r, file, NULL, 0);
    bool done =
        e && roil_check(e) && add_all(own, e) && add_presets(own, e) && add_choices(own, r, e);
    if (done) {
        qsort(own->list, own->inputs.count, sizeof *own->list, by_name);
        own->inputs.files = own->list;
        own->inputs.effect =
            arena_string(&own->memory, path_name(effect_get_facts(e->effect)->file));
        keep_info(own, e);
    }
    roil_unload(e);
    if (done) return &own->inputs;
    roil_free_inputs(&own->inputs);
    return NULL;
}

roil_inputs *roil_collect(roil *r, const char *file) {
    RETURN_MADE(roil_inputs, collect(r, file), roil_free_inputs(made));
}

void roil_free_inputs(roil_inputs *inputs) {
    if (!inputs) return;
    owned_inputs *own = (owned_inputs *)inputs;
    mem_free(own->list);
    arena_free(&own->memory);
    mem_free(own);
}

// ---- packing ----------------------------------------------------------------------------------

static bool write_bundle(const roil_inputs *in, const char *name, const char *file) {
    bundle_draft d;
    if (!bundle_begin(&d, file, name)) return false;
    for (size_t i = 0; i < in->count && !d.why[0]; i++) {
        size_t size;
        int input = file_open_inside(NULL, in->files[i].path, SIZE_MAX, &size);
        if (input >= 0)
            bundle_add(&d, in->files[i].name, input, size);
        else
            str_copy(d.why, sizeof d.why, err_get());
        if (input >= 0) close(input);
    }
    return bundle_end(&d);
}

static bool write_whole(roil *r, const roil_inputs *in, const char *file) {
    char name[BUNDLE_MAX_NAME + 1];
    if (!str_ends_with(file, ".roil")) return err_set("%s: a bundle's name ends with .roil", file);
    size_t length = strlen(in->effect);
    if (!str_ends_with(in->effect, ".lua") || length >= sizeof name || !bundle_is_name(in->effect))
        return err_set("%s: cannot be the name of an effect in a bundle", in->effect);
    snprintf(name, sizeof name, "%.*s", (int)(length - strlen(".lua")), in->effect);
    if (!write_bundle(in, name, file)) return false;
    // What it reads through links or by changing names is found by nobody else.
    roil_effect *e = roil_load(r, file, NULL, 0);
    bool whole = e && roil_check(e);
    roil_unload(e);
    if (whole) return true;
    unlink(file);
    return err_prefix("%s would not be whole without the effect's folder (does it read files by "
                      "links?): ",
                      file);
}

bool roil_bundle(roil *r, const roil_inputs *in, const char *file) {
    return MEM_CALL(write_whole(r, in, file));
}
