// What goes between a process and its reader. Private to base/isolate.c and src/reader.
#pragma once
#include "base/file.h"
#include "base/isolate.h"
#include <sys/types.h>

enum {
    WIRE_CONTROL = 3,      // the reader's socket
    WIRE_NO_WORKER = -1,   // in place of a status: fork failed, or nobody knows how it ended
    WIRE_PATIENCE = 10,    // seconds of real time beyond thrice the processor time: other programs
                           // may keep the machine busy
    WIRE_EXIT_REFUSED = 3, // of a worker: the result is a message
    WIRE_EXIT_MEMORY = 4,
};

// To the reader, with three files; without files: get ready for jobs of this kind.
enum { WIRE_CHANNEL, WIRE_OUT, WIRE_INPUT, WIRE_FILES };
typedef struct wire_request {
    char kind[ISOLATE_KIND];
    isolate_limits limits;
    uint64_t size; // of the input
    uint32_t argument_size;
    _Alignas(16) uint8_t arguments[ISOLATE_ARGUMENTS];
    char name[PATH_CAP];
} wire_request;

typedef enum wire_word { // over a job's channel
    WIRE_BEGUN,          // from the reader: the worker runs
    WIRE_OPEN,           // from the worker: open the file `text`
    WIRE_END,            // from the reader: the worker ended, and said `text` on stderr
} wire_word;

typedef struct wire_news {
    uint32_t word;
    int32_t status; // as of waitpid
    uint32_t processor_ms;
    char text[PATH_CAP];
} wire_news;

typedef struct wire_file { // answers WIRE_OPEN, with a file if it may be read
    uint64_t size;
} wire_file;

uint64_t wire_real_limit(const isolate_limits *limits); // milliseconds

// Sends one message with `count` files; false with errno.
bool wire_send(int socket, const void *message, size_t size, const int *files, size_t count,
               int flags);
// Receives one of exactly `size` bytes, with as many files as came, at most `most`, into `files`.
// False at the end of the connection, too.
bool wire_receive(int socket, void *message, size_t size, int *files, size_t most, size_t *count);
// Moves a file to a number above those of stdin, stdout and stderr: who writes to these when the
// host has closed them must not write into it. -1 stays -1.
int wire_keep(int file);

bool wire_ask(const isolate_call *call, const char *name, size_t max, void **data, size_t *size);
bool wire_read(int file, void *out, size_t size); // all of it, from the file's beginning
