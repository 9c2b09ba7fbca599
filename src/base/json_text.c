#include "base/json_text.h"
#include "base/memory.h"

char *json_text(const json_t *root, size_t flags) {
    size_t size = root ? json_dumpb(root, NULL, 0, flags) : 0;
    if (!size) return NULL;
    char *text = mem_alloc(size + 1);
    json_dumpb(root, text, size, flags);
    return text;
}
