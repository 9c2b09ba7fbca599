// Runs a fuzz target without libFuzzer: replays every file of the corpus, then mutates them until
// the time is over. The same seed gives the same inputs in the same order.
//
//   fuzz_texture [--seconds 10] [--seed 1] FILE_OR_FOLDER...
//
// Nothing guides the mutations: the point is that each run of the tests throws some thousand new
// inputs, near to good ones, at each parser. The input at hand lies in a file that is mapped into
// memory, so that it survives a crash of this process at no cost; its name is printed at the start.
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <limits.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { INPUT_CAP = 1 << 20, SEED_CAP = 4096 };

typedef struct seed {
    uint8_t *data;
    size_t size;
} seed;

static seed seeds[SEED_CAP];
static size_t seed_count;

// ---- the input at hand ------------------------------------------------------------------------

typedef struct record { // layout of the mapped file
    uint64_t size;
    uint8_t data[INPUT_CAP];
} record;

static record *last; // NULL while replaying
static char last_name[PATH_MAX];

static void give_up(const char *what) {
    fprintf(stderr, "%s: %s\n", what, strerror(errno));
    exit(2);
}

static void map_last(const char *program) {
    const char *folder = getenv("ROIL_BINARY_DIR"), *slash = strrchr(program, '/');
    snprintf(last_name, sizeof last_name, "%s/%s-last-input", folder ? folder : ".",
             slash ? slash + 1 : program);
    int fd = open(last_name, O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (fd < 0 || ftruncate(fd, sizeof *last) != 0) give_up(last_name);
    last = mmap(NULL, sizeof *last, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
    if (last == MAP_FAILED) give_up(last_name);
    close(fd);
}

// The target gets a copy of its own in a block of the exact size: an overrun by one byte is caught.
static void run(const uint8_t *data, size_t size) {
    if (last) {
        last->size = size;
        memcpy(last->data, data, size);
    }
    uint8_t *exact = malloc(size ? size : 1);
    if (!exact) give_up("malloc");
    memcpy(exact, data, size);
    LLVMFuzzerTestOneInput(exact, size);
    free(exact);
}

// A file of an earlier crash begins with its size: it can be given again as it is.
static void replay_record(const char *path) {
    int fd = open(path, O_RDONLY | O_CLOEXEC);
    record *found = malloc(sizeof *found);
    if (fd < 0 || !found) give_up(path);
    ssize_t got = read(fd, found, sizeof *found);
    close(fd);
    if (got != sizeof *found || found->size > INPUT_CAP) {
        fprintf(stderr, "%s: not the input of an earlier run\n", path);
        exit(2);
    }
    run(found->data, found->size);
    free(found);
}

// ---- corpus -----------------------------------------------------------------------------------

static void load_file(const char *path) {
    int fd = open(path, O_RDONLY | O_CLOEXEC);
    struct stat info;
    if (fd < 0 || fstat(fd, &info) != 0) give_up(path);
    size_t size = (size_t)info.st_size;
    if (size > INPUT_CAP || seed_count == SEED_CAP) {
        fprintf(stderr, "%s: more than the %d files of %d bytes accepted\n", path, SEED_CAP,
                INPUT_CAP);
        exit(2);
    }
    uint8_t *data = malloc(size ? size : 1);
    if (!data || read(fd, data, size) != (ssize_t)size) give_up(path);
    close(fd);
    seeds[seed_count++] = (seed){data, size};
}

static int visible(const struct dirent *entry) {
    return entry->d_name[0] != '.';
}

static void load(const char *path) {
    struct stat info;
    if (stat(path, &info) != 0) give_up(path);
    if (!S_ISDIR(info.st_mode)) {
        load_file(path);
        return;
    }
    struct dirent **entries;
    int count = scandir(path, &entries, visible, alphasort);
    if (count < 0) give_up(path);
    for (int i = 0; i < count; i++) {
        char inner[PATH_MAX];
        snprintf(inner, sizeof inner, "%s/%s", path, entries[i]->d_name);
        load_file(inner);
        free(entries[i]);
    }
    free(entries);
}

// ---- mutation ---------------------------------------------------------------------------------

static uint64_t random_state;

static uint64_t random_bits(void) { // splitmix64
    uint64_t z = random_state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return z ^ z >> 31;
}

static size_t below(size_t end) { // 0 when end is 0
    return end ? (size_t)(random_bits() % end) : 0;
}

// Often short: one to a few bytes do most harm.
static size_t some_length(size_t most) {
    size_t length = 1 + below((size_t)1 << below(12));
    return length < most ? length : most;
}

static size_t remove_range(uint8_t *data, size_t size) {
    size_t at = below(size), length = some_length(size - at);
    memmove(data + at, data + at + length, size - at - length);
    return size - length;
}

static size_t insert_range(uint8_t *data, size_t size, const uint8_t *from, size_t length) {
    size_t at = below(size + 1);
    if (at > size) return size; // never: gcc cannot see what below() promises
    if (length > INPUT_CAP - size) length = INPUT_CAP - size;
    memmove(data + at + length, data + at, size - at);
    if (from)
        memcpy(data + at, from, length);
    else
        for (size_t i = 0; i < length; i++) data[at + i] = (uint8_t)random_bits();
    return size + length;
}

// Numbers that break size arithmetic, in the widths that file formats use.
static void write_number(uint8_t *data, size_t size) {
    static const uint64_t numbers[] = {0,
                                       1,
                                       UINT64_MAX,
                                       0x7f,
                                       0x80,
                                       0x7fff,
                                       0x8000,
                                       0xffff,
                                       0x7fffffff,
                                       0x80000000,
                                       UINT64_C(0x7fffffffffffffff),
                                       UINT64_C(0x8000000000000000)};
    uint64_t number = numbers[below(sizeof numbers / sizeof *numbers)];
    size_t width = (size_t)1 << below(4);
    if (width > size) return;
    uint8_t bytes[8];
    bool big_endian = below(2);
    for (size_t i = 0; i < width; i++)
        bytes[i] = (uint8_t)(number >> 8 * (big_endian ? width - 1 - i : i));
    memcpy(data + below(size - width + 1), bytes, width);
}

static size_t join_seeds(uint8_t *data, size_t size) {
    const seed *other = &seeds[below(seed_count)];
    if (!other->size) return size;
    size_t from = below(other->size);
    if (below(2))
        return insert_range(data, size, other->data + from, some_length(other->size - from));
    size_t at = below(size + 1), length = other->size - from; // our head, the other's tail
    if (length > INPUT_CAP - at) length = INPUT_CAP - at;
    memcpy(data + at, other->data + from, length);
    return at + length;
}

static size_t mutate(uint8_t *data, size_t size) {
    if (!size) return insert_range(data, size, NULL, 1 + below(64));
    switch (below(8)) {
    case 0:
        return below(size); // truncation
    case 1:
        return remove_range(data, size);
    case 2:
        return insert_range(data, size, NULL, some_length(64));
    case 3: { // a piece of itself, once more
        uint8_t piece[64];
        size_t from = below(size), length = some_length(size - from);
        if (length > sizeof piece) length = sizeof piece;
        memcpy(piece, data + from, length);
        return insert_range(data, size, piece, length);
    }
    case 4:
        return join_seeds(data, size);
    case 5:
        write_number(data, size);
        return size;
    case 6:
        data[below(size)] = (uint8_t)random_bits();
        return size;
    default:
        data[below(size)] ^= (uint8_t)(1u << below(8));
        return size;
    }
}

static size_t next_input(uint8_t *data) {
    const seed *from = &seeds[below(seed_count)];
    size_t size = from->size;
    memcpy(data, from->data, size);
    for (size_t left = 1 + below(8); left > 0; left--) size = mutate(data, size);
    return size;
}

// ---- program ----------------------------------------------------------------------------------

static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + (double)time.tv_nsec * 1e-9;
}

static double number_after(char **args, int *i) {
    char *end = NULL, *text = args[++*i];
    double number = text ? strtod(text, &end) : 0;
    if (text && end != text && !*end && number >= 0) return number;
    fprintf(stderr, "%s wants a number\n", args[*i - 1]);
    exit(2);
}

int main(int argc, char **argv) {
    double seconds = 10;
    random_state = 1;
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--seconds") == 0)
            seconds = number_after(argv, &i);
        else if (strcmp(argv[i], "--seed") == 0)
            random_state = (uint64_t)number_after(argv, &i);
        else if (strcmp(argv[i], "--replay") == 0 && i + 1 < argc)
            return replay_record(argv[i + 1]), 0;
        else
            load(argv[i]);
    }
    if (!seed_count) {
        fprintf(stderr, "usage: %s [--seconds 10] [--seed 1] FILE_OR_FOLDER... | --replay FILE\n",
                argv[0]);
        return 2;
    }
    map_last(argv[0]);
    printf("on a crash: %s --replay %s\n", argv[0], last_name);
    fflush(stdout);
    for (size_t i = 0; i < seed_count; i++) run(seeds[i].data, seeds[i].size);
    static uint8_t input[INPUT_CAP];
    double end = now() + seconds;
    uint64_t runs = 0;
    for (; now() < end; runs++) run(input, next_input(input));
    printf("%zu seeds and %" PRIu64 " mutations run\n", seed_count, runs);
    fflush(stdout); // the leak sanitizer ends the process without
    for (size_t i = 0; i < seed_count; i++) free(seeds[i].data);
    unlink(last_name);
    return 0;
}
