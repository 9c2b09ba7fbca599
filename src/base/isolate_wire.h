// The protocol between a process and its reader. Private to base/isolate.c and src/reader.
#pragma once
#include "base/file.h"
#include "base/isolate.h"
#include <sys/types.h>

enum {
    WIRE_CONTROL = 3,      // descriptor of the reader's socket
    WIRE_NO_WORKER = -1,   // instead of a status: fork failed, or the status is lost
    WIRE_PATIENCE = 10,    // seconds of real time beyond thrice the processor time, since other
                           // programs may keep the machine busy
    WIRE_EXIT_REFUSED = 3, // exit status of a worker whose result is a message
    WIRE_EXIT_MEMORY = 4,  // exit status of a worker that ran out of memory
};

// A request to the reader, with three files. Without files it means: prepare for jobs of this kind.
enum { WIRE_CHANNEL, WIRE_OUT, WIRE_INPUT, WIRE_FILES };
typedef struct wire_request {
    char kind[ISOLATE_KIND];
    isolate_limits limits;
    uint64_t size; // of the input
    uint32_t argument_size;
    _Alignas(16) uint8_t arguments[ISOLATE_ARGUMENTS];
    char name[PATH_CAP];
} wire_request;

typedef enum wire_word { // messages over a job's channel
    WIRE_BEGUN,          // from the reader: the worker runs
    WIRE_OPEN,           // from the worker: open the file `text`
    WIRE_END,            // from the reader: the worker ended, and wrote `text` to stderr
} wire_word;

typedef struct wire_news {
    uint32_t word;
    int32_t status; // as of waitpid
    uint32_t processor_ms;
    char text[PATH_CAP];
} wire_news;

typedef struct wire_file { // the answer to WIRE_OPEN, with a file if it may be read
    uint64_t size;
} wire_file;

uint64_t wire_real_limit(const isolate_limits *limits); // milliseconds

// Sends one message with `count` files. False with errno.
bool wire_send(int socket, const void *message, size_t size, const int *files, size_t count,
               int flags);
// Receives one message of exactly `size` bytes, and up to `most` files. False with errno, and at
// the end of the connection.
bool wire_receive(int socket, void *message, size_t size, int *files, size_t most, size_t *count);
// Moves a file to a number above 2. When the host has closed stdin, stdout or stderr, whoever
// writes to these must not write into the file. -1 stays -1.
int wire_keep(int file);

bool wire_ask(const isolate_call *call, const char *name, size_t max, void **data, size_t *size);
bool wire_read(int file, void *out, size_t size); // reads `size` bytes from the beginning
