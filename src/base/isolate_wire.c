// Messages with attached files, over sockets that preserve the boundaries of messages. See
// isolate.h.
#include "base/isolate_wire.h"
#include "base/memory.h"
#include "base/str.h"
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

enum { FILES_MAX = 4 };

uint64_t wire_real_limit(const isolate_limits *limits) {
    return 3 * (uint64_t)limits->processor_ms + WIRE_PATIENCE * 1000;
}

int wire_keep(int file) {
    if (file < 0 || file > STDERR_FILENO) return file;
    int kept = fcntl(file, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    close(file);
    return kept;
}

bool wire_send(int socket, const void *message, size_t size, const int *files, size_t count,
               int flags) {
    _Alignas(struct cmsghdr) char space[CMSG_SPACE(FILES_MAX * sizeof(int))] = {0};
    struct iovec data = {.iov_base = (void *)(uintptr_t)message, .iov_len = size};
    struct msghdr head = {.msg_iov = &data, .msg_iovlen = 1};
    if (count) {
        head.msg_control = space;
        head.msg_controllen = CMSG_SPACE(count * sizeof(int));
        struct cmsghdr *attached = CMSG_FIRSTHDR(&head);
        attached->cmsg_level = SOL_SOCKET;
        attached->cmsg_type = SCM_RIGHTS;
        attached->cmsg_len = CMSG_LEN(count * sizeof(int));
        memcpy(CMSG_DATA(attached), files, count * sizeof(int));
    }
    ssize_t sent;
    do sent = sendmsg(socket, &head, flags | MSG_NOSIGNAL);
    while (sent < 0 && errno == EINTR);
    return sent == (ssize_t)size;
}

static size_t take_files(struct msghdr *head, int *files, size_t most) {
    size_t count = 0;
    for (struct cmsghdr *a = CMSG_FIRSTHDR(head); a; a = CMSG_NXTHDR(head, a)) {
        if (a->cmsg_level != SOL_SOCKET || a->cmsg_type != SCM_RIGHTS) continue;
        size_t here = (a->cmsg_len - CMSG_LEN(0)) / sizeof(int);
        for (size_t i = 0; i < here; i++) {
            int file;
            memcpy(&file, CMSG_DATA(a) + i * sizeof file, sizeof file);
            if (count < most)
                files[count++] = file;
            else
                close(file);
        }
    }
    return count;
}

bool wire_receive(int socket, void *message, size_t size, int *files, size_t most, size_t *count) {
    _Alignas(struct cmsghdr) char space[CMSG_SPACE(FILES_MAX * sizeof(int))];
    struct iovec data = {.iov_base = message, .iov_len = size};
    struct msghdr head = {
        .msg_iov = &data, .msg_iovlen = 1, .msg_control = space, .msg_controllen = sizeof space};
    ssize_t got;
    do got = recvmsg(socket, &head, MSG_CMSG_CLOEXEC);
    while (got < 0 && errno == EINTR);
    *count = got < 0 ? 0 : take_files(&head, files, most);
    for (size_t i = 0; i < *count; i++) files[i] = wire_keep(files[i]);
    return got == (ssize_t)size && !(head.msg_flags & MSG_TRUNC);
}

bool wire_read(int file, void *out, size_t size) {
    char *at = out;
    for (off_t done = 0; size > 0;) {
        ssize_t got = pread(file, at, size, done);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return false;
        at += got;
        done += got;
        size -= (size_t)got;
    }
    return true;
}

bool wire_ask(const isolate_call *call, const char *name, size_t max, void **data, size_t *size) {
    wire_news question = {.word = WIRE_OPEN};
    wire_file answer;
    int file;
    size_t count;
    if (!str_copy(question.text, sizeof question.text, name)) return path_too_long(name);
    if (!wire_send(call->channel, &question, sizeof question, NULL, 0, 0) ||
        !wire_receive(call->channel, &answer, sizeof answer, &file, 1, &count) || count == 0)
        return err_set("%s: cannot be read", name);
    bool fits = answer.size <= max || err_set("%s: %llu bytes, more than the %zu accepted", name,
                                              (unsigned long long)answer.size, max);
    char *bytes = fits ? mem_alloc((size_t)answer.size + 1) : NULL;
    bool done = fits && (wire_read(file, bytes, (size_t)answer.size) ||
                         err_set("%s: cannot be read whole", name));
    close(file);
    *data = bytes;
    *size = (size_t)answer.size;
    if (!done) mem_free(bytes);
    return done;
}

bool isolate_put(const isolate_call *call, const void *data, size_t size) {
    const char *at = data;
    while (size > 0) {
        ssize_t put = write(call->out, at, size);
        if (put < 0 && errno == EINTR) continue;
        if (put <= 0) return err_set("the result cannot be written: %s", strerror(errno));
        at += put;
        size -= (size_t)put;
    }
    return true;
}

bool isolate_cut(const isolate_call *call, size_t size) {
    return ftruncate(call->out, (off_t)size) == 0 ||
           err_set("the result cannot be written: %s", strerror(errno));
}

void *isolate_map(const isolate_call *call, size_t at, size_t size) {
    if (!isolate_cut(call, at + size)) return NULL;
    void *data = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_SHARED, call->out, (off_t)at);
    if (data != MAP_FAILED) return data;
    return ERR_NULL("the result cannot be written: %s", strerror(errno));
}
