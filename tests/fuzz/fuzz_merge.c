// Folders of strangers that `bench --merge` puts together: any two results.json (the input, parted
// by a zero byte) give one that can be read again and pictures beside it, or a message. Nothing
// appears outside the folder that is written.
#include "base/error.h"
#include "base/file.h"
#include "bench/sweep.h"
#include "whole_way.h"
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { FOLDERS = 3 }; // two that are read, one that is written
static char root[] = "/tmp/roil-fuzz-merge-XXXXXX";
static char folders[FOLDERS][PATH_CAP];

// Removes what lies in a folder, and how many there are besides folders.
static int empty(const char *folder) {
    int count = 0;
    struct dirent *entry;
    DIR *list = opendir(folder);
    while (list && (entry = readdir(list))) {
        char path[PATH_CAP];
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0) continue;
        if (!path_join(path, folder, entry->d_name)) abort();
        if (entry->d_type == DT_DIR) {
            count += empty(path);
            rmdir(path);
        } else {
            unlink(path);
            count++;
        }
    }
    if (list) closedir(list);
    return count;
}

static void remove_all(void) {
    empty(root);
    rmdir(root);
}

static void prepare(void) {
    static const char *const NAMES[FOLDERS] = {"a", "b", "all"};
    if (!mkdtemp(root)) abort();
    for (int i = 0; i < FOLDERS; i++)
        if (!path_join(folders[i], root, NAMES[i])) abort();
    atexit(remove_all);
}

static void put(const char *folder, const char *name, const void *data, size_t size) {
    char path[PATH_CAP];
    if (!path_join(path, folder, name) || !file_make_parent_folders(path)) abort();
    fuzz_write(path, data, size);
}

static void put_part(const char *folder, const uint8_t *data, size_t size) {
    put(folder, "results.json", data, size);
    put(folder, "rows/0000.png", "picture", 7);
    put(folder, "rows/0001.png", "another", 7);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (!folders[0][0]) prepare();
    const uint8_t *zero = size ? memchr(data, 0, size) : NULL;
    size_t first = zero ? (size_t)(zero - data) : size;
    put_part(folders[0], data, first);
    put_part(folders[1], zero ? zero + 1 : data, zero ? size - first - 1 : size);
    const char *parts[] = {folders[0], folders[1]};
    bench_results merged = {0}, again = {0};
    err_clear();
    if (bench_merge(parts, 2, folders[2], &merged)) {
        if (!bench_read(folders[2], &again) || again.row_count != merged.row_count) abort();
        bench_results_free(&again);
    } else if (!err_get()[0]) {
        abort();
    }
    bench_results_free(&merged);
    empty(folders[2]);
    if (empty(folders[0]) != 3 || empty(folders[1]) != 3) abort();
    return 0;
}
