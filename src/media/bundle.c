// Archives are read header by header here, and not by a library: a header of ustar is 512 bytes of
// fixed fields, and whatever is more than plain files and folders is refused.
#include "media/bundle.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/str.h"
#include "base/time_limit.h"
#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { BLOCK = 512, PIECE = 1 << 20 };
static const uint64_t SIZE_MOST = (uint64_t)8 << 30; // what 11 octal digits hold, and not more

typedef struct header {
    char name[100], mode[8], uid[8], gid[8], size[12], mtime[12], sum[8], type, link[100];
    char magic[6], version[2], user[32], group[32], major[8], minor[8], prefix[155], rest[12];
} header;
_Static_assert(sizeof(header) == BLOCK, "fields of ustar");

// ---- names ------------------------------------------------------------------------------------

// Returns the length of a part of a path: "a/b" has two. 0: it can be no name.
static size_t part_length(const char *at) {
    size_t length = strcspn(at, "/");
    if (length > BUNDLE_MAX_NAME || at[0] == '-') return 0;
    if (at[0] == '.' && (length == 1 || (length == 2 && at[1] == '.'))) return 0;
    for (size_t i = 0; i < length; i++)
        if (iscntrl((unsigned char)at[i]) || at[i] == '\\') return 0;
    return length;
}

bool bundle_is_name(const char *text) {
    if (strlen(text) > BUNDLE_MAX_BYTES) return false;
    for (;;) {
        size_t length = part_length(text);
        if (!length) return false;
        text += length;
        if (!*text++) return true;
    }
}

// ---- reading ----------------------------------------------------------------------------------

static bool read_block(int file, uint64_t at, void *out, size_t size) {
    for (size_t done = 0; done < size;) {
        ssize_t got = pread(file, (char *)out + done, size - done, (off_t)(at + done));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return err_set("%s", strerror(errno));
        if (got == 0) return err_set("it ends too early");
        done += (size_t)got;
    }
    return true;
}

// Reads octal digits, which a space or NUL may follow or precede.
static bool read_octal(const char *text, size_t size, uint64_t *out) {
    size_t i = 0, digits = 0;
    *out = 0;
    while (i < size && text[i] == ' ') i++;
    for (; i < size && text[i] >= '0' && text[i] <= '7'; i++, digits++)
        *out = *out * 8 + (uint64_t)(text[i] - '0');
    while (i < size && (text[i] == ' ' || text[i] == '\0')) i++;
    return digits > 0 && i == size;
}

static unsigned sum_of(const header *h) {
    unsigned sum = 8 * ' '; // the sum's own field counts as spaces
    for (size_t i = 0; i < BLOCK; i++) sum += ((const unsigned char *)h)[i];
    for (size_t i = 0; i < sizeof h->sum; i++) sum -= (unsigned char)h->sum[i];
    return sum;
}

static bool is_empty(const header *h) {
    for (size_t i = 0; i < BLOCK; i++)
        if (((const char *)h)[i]) return false;
    return true;
}

static bool check_header(const header *h) {
    uint64_t sum;
    if (memcmp(h->magic, "ustar", 5) != 0 || !read_octal(h->sum, sizeof h->sum, &sum) ||
        sum != sum_of(h))
        return err_set("it is no bundle; `roil bundle` makes them");
    return true;
}

// Takes the whole name of an entry, without a '/' at the end.
static const char *take_name(bundle *b, const header *h) {
    bool posix = memcmp(h->magic, "ustar", 6) == 0; // of GNU's the prefix is something else
    const char *name = arena_format(&b->memory, "%.*s%s%.*s", posix ? 155 : 0, h->prefix,
                                    posix && h->prefix[0] ? "/" : "", 100, h->name);
    size_t length = strlen(name);
    return length && name[length - 1] == '/'
               ? arena_format(&b->memory, "%.*s", (int)length - 1, name)
               : name;
}

// Takes the folder from the first entry; all others must lie in it. NULL: the entry is that folder.
static bool take_place(bundle *b, const char *name, const char **out) {
    size_t length = strcspn(name, "/");
    if (!b->name) b->name = arena_format(&b->memory, "%.*s", (int)length, name);
    if (strlen(b->name) != length || strncmp(name, b->name, length) != 0)
        return err_set("'%.200s' does not lie in its folder '%.200s'", name, b->name);
    *out = name[length] ? name + length + 1 : NULL;
    return true;
}

static bool add_entry(bundle *b, const header *h, size_t *capacity, uint64_t at, uint64_t size) {
    const char *name = take_name(b, h);
    bool folder = h->type == '5';
    if (!folder && h->type != '0' && h->type != '\0')
        return err_set("'%.200s' is an entry of type '%c'; plain files and folders are accepted, "
                       "as `tar --format=ustar` packs them",
                       name, isprint((unsigned char)h->type) ? h->type : '?');
    if (!bundle_is_name(name)) return err_set("'%.200s' can be no name of a file", name);
    if (!take_place(b, name, &name)) return false;
    if (folder) return size == 0 || err_set("'%.200s' is a folder with content", name ? name : "");
    if (!name) return err_set("'%.200s' does not lie in a folder", b->name);
    if (b->count == BUNDLE_MAX_FILES) return err_set("it has more than %d files", BUNDLE_MAX_FILES);
    *MEM_ADD(b->files, b->count, *capacity) = (bundle_file){name, at, size};
    return true;
}

static bool read_entries(int file, uint64_t size, bundle *b, size_t *capacity) {
    header h;
    for (uint64_t at = 0, entries = 0;; entries++) {
        uint64_t content;
        if (size - at < BLOCK) return err_set("it ends too early");
        if (!read_block(file, at, &h, BLOCK)) return false;
        if (is_empty(&h)) return b->count > 0 || err_set("there is no file in it");
        if (entries == 2 * BUNDLE_MAX_FILES) return err_set("it has too many folders");
        if (!check_header(&h)) return false;
        at += BLOCK;
        if (!read_octal(h.size, sizeof h.size, &content) || content > SIZE_MOST)
            return err_set("the size of an entry is damaged");
        uint64_t whole = (content + BLOCK - 1) / BLOCK * BLOCK;
        if (size - at < whole) return err_set("it ends too early");
        if (!add_entry(b, &h, capacity, at, content)) return false;
        at += whole;
    }
}

static int by_name(const void *a, const void *b) {
    return strcmp(((const bundle_file *)a)->name, ((const bundle_file *)b)->name);
}

// Sorts the files. Refuses names that are there twice, and a bundle without an effect.
static bool check_names(bundle *b) {
    bool found = false;
    const char *wanted = arena_format(&b->memory, "%s.lua", b->name);
    qsort(b->files, b->count, sizeof *b->files, by_name);
    for (size_t i = 0; i < b->count; i++) {
        if (i && strcmp(b->files[i].name, b->files[i - 1].name) == 0)
            return err_set("'%.200s' is in it twice", b->files[i].name);
        found |= strcmp(b->files[i].name, wanted) == 0;
    }
    return found || err_set("there is no effect '%s' in it", wanted);
}

bool bundle_read(int file, uint64_t size, bundle *out) {
    size_t capacity = 0;
    *out = (bundle){0};
    bool done = read_entries(file, size, out, &capacity) && check_names(out);
    bundle_file *kept = done ? arena_alloc(&out->memory, out->count * sizeof *kept) : NULL;
    if (done) memcpy(kept, out->files, out->count * sizeof *kept);
    mem_free(out->files);
    out->files = kept;
    return done;
}

// ---- unpacking --------------------------------------------------------------------------------

// Opens the folder of a name below `folder`, and makes it where it is missing. -1: errno says why.
static int enter_folders(int folder, const char *name) {
    int now = dup(folder);
    for (const char *next; now >= 0 && (next = strchr(name, '/')); name = next + 1) {
        char part[BUNDLE_MAX_NAME + 1];
        snprintf(part, sizeof part, "%.*s", (int)(next - name), name);
        bool made = mkdirat(now, part, 0700) == 0 || errno == EEXIST;
        int inner = made ? openat(now, part, O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC) : -1;
        int reason = errno;
        close(now);
        errno = reason;
        now = inner;
    }
    return now;
}

static bool copy_content(int from, uint64_t at, uint64_t size, int to) {
    off_t place = (off_t)at;
    while (size) {
        ssize_t got = copy_file_range(from, &place, to, NULL, size < PIECE ? size : PIECE, 0);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) break;
        size -= (uint64_t)got;
    }
    char *block = size ? mem_alloc(PIECE) : NULL; // of two file systems, or of one that cannot
    while (size) {
        size_t part = size < PIECE ? (size_t)size : PIECE;
        ssize_t got = pread(from, block, part, place);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0 || write(to, block, (size_t)got) != got) break;
        place += got;
        size -= (uint64_t)got;
    }
    mem_free(block);
    return size == 0;
}

static bool unpack_file(int file, const bundle_file *f, int folder) {
    int above = enter_folders(folder, f->name);
    int out = above < 0 ? -1
                        : openat(above, path_name(f->name),
                                 O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0400);
    bool done = out >= 0 && copy_content(file, f->at, f->size, out);
    if (!done) err_set("'%.200s' cannot be unpacked: %s", f->name, strerror(errno));
    if (out >= 0) close(out);
    if (above >= 0) close(above);
    return done;
}

bool bundle_unpack(int file, const bundle *b, int folder) {
    for (size_t i = 0; i < b->count; i++)
        if (!unpack_file(file, &b->files[i], folder) ||
            !time_limit_progress((double)i + 1, (double)b->count))
            return false;
    return true;
}

// ---- writing ----------------------------------------------------------------------------------

static void fail(bundle_draft *d) {
    if (!d->why[0]) str_copy(d->why, sizeof d->why, err_get());
}

bool bundle_begin(bundle_draft *d, const char *path, const char *name) {
    *d = (bundle_draft){.name = name};
    return file_draft_begin(&d->file, path);
}

// Splits a name that is too long for one field at a '/'.
static bool put_name(header *h, const char *folder, const char *name) {
    char whole[2 * BUNDLE_MAX_BYTES];
    int length = snprintf(whole, sizeof whole, "%s/%s", folder, name);
    const char *rest = whole;
    while (length < (int)sizeof whole && strlen(rest) > sizeof h->name)
        if (!(rest = strchr(rest, '/')) || (size_t)(rest++ - whole) > sizeof h->prefix) break;
    if (!rest || strlen(rest) > sizeof h->name || (size_t)(rest - whole) > sizeof h->prefix + 1 ||
        !bundle_is_name(whole))
        return err_set("'%s' can be no name in a bundle: it is too long, or no plain text", name);
    if (rest > whole) memcpy(h->prefix, whole, (size_t)(rest - whole) - 1);
    memcpy(h->name, rest, strlen(rest));
    return true;
}

static bool put_header(bundle_draft *d, const char *name, uint64_t size) {
    header h = {.type = '0', .mode = "0000644", .uid = "0000000", .gid = "0000000"};
    if (size >= SIZE_MOST) return err_set("'%s' has more than the 8 GiB that a bundle takes", name);
    if (!put_name(&h, d->name, name)) return false;
    memcpy(h.magic, "ustar", 6);
    memcpy(h.version, "00", 2);
    memcpy(h.mtime, "00000000000", 12);
    snprintf(h.size, sizeof h.size, "%011llo", (unsigned long long)size);
    snprintf(h.sum, sizeof h.sum, "%06o", sum_of(&h));
    h.sum[7] = ' ';
    file_draft_add(&d->file, &h, sizeof h);
    return true;
}

void bundle_add(bundle_draft *d, const char *name, int file, uint64_t size) {
    static const char zeros[BLOCK];
    if (d->why[0]) return;
    if (!put_header(d, name, size)) {
        fail(d);
        return;
    }
    char *block = mem_alloc(PIECE);
    for (uint64_t at = 0; at < size && !d->why[0]; at += PIECE) {
        size_t part = size - at < PIECE ? (size_t)(size - at) : PIECE;
        if (read_block(file, at, block, part))
            file_draft_add(&d->file, block, part);
        else if (err_prefix("'%s' cannot be read: ", name), true)
            fail(d);
    }
    mem_free(block);
    file_draft_add(&d->file, zeros, (BLOCK - size % BLOCK) % BLOCK);
}

bool bundle_end(bundle_draft *d) {
    static const char zeros[2 * BLOCK];
    if (d->why[0]) {
        file_draft_drop(&d->file);
        return err_set("%s", d->why);
    }
    file_draft_add(&d->file, zeros, sizeof zeros);
    return file_draft_end(&d->file);
}
