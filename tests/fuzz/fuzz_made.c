// Recipes of strangers, as `roil repro` reads them: any line gives one whose parts are sane, or a
// message.
#include "base/error.h"
#include "base/memory.h"
#include "roil/roil_impl.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void check(const roil_made *m) {
    if (!isfinite(m->frame) || !isfinite(m->step) || !m->width || m->width > 16384) abort();
    if (m->effect && (m->effect[0] == '/' || strstr(m->effect, "/../"))) abort();
    for (size_t i = 0; i < m->setting_count; i++)
        if (!m->settings[i].name[0] || strchr(m->settings[i].value, '\n')) abort();
    for (size_t i = 0; i < m->option_count; i++)
        if (strncmp(m->options[i], "--output", 8) == 0 || m->options[i][0] != '-') abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    char *line = mem_alloc(size + 1);
    memcpy(line, data, size);
    err_clear();
    roil_made *m = roil_parse_made(line, "fuzz.png");
    if (m)
        check(m);
    else if (!err_get()[0])
        abort();
    roil_free_made(m);
    mem_free(line);
    return 0;
}
