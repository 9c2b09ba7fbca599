// The script host on hostile effect files: the input is an effect, loaded without a device under
// small limits. What loads is asked for the values of all its passes at a few times.
#include "base/file.h"
#include "base/log.h"
#include "script/script.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static char folder[] = "/tmp/roil-fuzz-XXXXXX";
static char file[PATH_CAP], shaders[PATH_CAP], scripts[PATH_CAP];

static void remove_folder(void) {
    unlink(file);
    rmdir(folder);
}

static void prepare(void) {
    const char *source = getenv("ROIL_SOURCE_DIR");
    if (!source) source = "..";
    if (!mkdtemp(folder) || !path_join(file, folder, "e.lua") ||
        !path_join(shaders, source, "shaders") || !path_join(scripts, source, "scripts"))
        abort();
    log_set_level(LOG_ERROR);
    atexit(remove_folder);
}

static void put(const uint8_t *data, size_t size) {
    FILE *out = fopen(file, "wb");
    if (!out || (size && fwrite(data, 1, size, out) != size) || fclose(out)) abort();
}

static void ask(effect *e) {
    field_context context = *effect_pass_host(e)->context;
    for (size_t i = 0; i < effect_pass_count(e); i++) {
        pass *p = effect_get_pass(e, i);
        size_t count = pass_interface(p)->uniform_count;
        for (size_t u = 0; u < count; u++) {
            const field *node = pass_get_uniform(p, u);
            float out[4];
            for (context.time = 0; node && context.time < 3; context.time += 1.25)
                (void)field_eval(node, &context, (float3){0.5f, 0.25f, 0.125f}, out);
        }
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static const script_limits limits = {.memory = 8 << 20, .load = 300000, .frame = 10000};
    if (!file[0]) prepare();
    put(data, size);
    effect *e = effect_create(&(effect_desc){.file = file, .shader_root = shaders});
    if (!e) abort();
    if (script_load_limited(e, scripts, &limits))
        ask(e);
    else if (!err_get()[0])
        abort();
    effect_destroy(e);
    return 0;
}
