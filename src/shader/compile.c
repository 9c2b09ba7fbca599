// Compiles a shader file: it is flattened, its annotations are read and the prelude is put before
// it. The code then comes from the cache or from glslang, which runs in another process, and is
// reflected. Two compilations share only the library's constant paths and its counter, so threads
// need no lock.
#include "base/memory.h"
#include "gpu/profile.h"
#include "gpu/spirv.h"
#include "shader/compiler.h"
#include "shader/unit.h"
#include <string.h>

enum { SALT = 1 }; // raise when the same text shall give other code

typedef struct job {
    shader_library *library;
    const shader_compile_desc *desc;
    arena *memory; // of the results
    shader_binary *out;
    bool done;
    char *message; // why not
    shader_unit unit;
    arena scratch;
    unit_inserts inserts;
    strbuf source; // what glslang reads
} job;

static void add_text(job *j) {
    const strbuf *text = &j->unit.code;
    size_t done = 0;
    for (size_t i = 0; i < j->inserts.count; i++) {
        const unit_insert *insert = &j->inserts.items[i];
        strbuf_append(&j->source, text->text + done, insert->offset - done);
        strbuf_append(&j->source, insert->text, strlen(insert->text));
        done = insert->offset;
    }
    strbuf_append(&j->source, text->text + done, text->length - done);
}

static hash128 key_of(const job *j) {
    uint32_t salt[] = {SALT, glsl_version(), (uint32_t)j->desc->stage};
    hash128 text = hash_bytes(j->source.text, j->source.length);
    return hash_combine(hash_bytes(salt, sizeof salt), text);
}

static bool reflect(job *j, spirv *code, arena *memory, shader_binary *out) {
    if (!spirv_reflect(code, j->desc->stage, memory, out))
        return err_prefix("%s: ", j->unit.files[0].where.label);
    out->size = code->count * sizeof *code->words;
    out->code = arena_copy(memory, code->words, out->size);
    return true;
}

// Returns whether the effect brings a part of the text. Generated texts and those of the program
// are known to be valid.
static bool is_strange(const shader_unit *unit) {
    for (size_t i = 0; i < unit->file_count; i++)
        if (unit->files[i].where.root < ROOT_PROGRAM && unit->files[i].where.path) return true;
    return false;
}

static bool run_compiler(job *j, spirv *out) {
    glsl_answer answer;
    const compiler_order order = {.stage = j->desc->stage, .strange = is_strange(&j->unit)};
    if (!compiler_run(j->source.text, &order, &answer))
        return err_prefix("%s: ", j->unit.files[0].where.label);
    bool done = glsl_explain(&j->unit, &answer);
    if (done)
        *out = (spirv){.words = answer.data, .count = answer.size / sizeof *out->words};
    else
        mem_free(answer.data);
    return done;
}

static bool translate(job *j, arena *memory, shader_binary *out) {
    hash128 key = key_of(j);
    spirv code;
    if (cache_load(j->library, key, &code)) {
        bool done = reflect(j, &code, memory, out);
        mem_free(code.words);
        if (done) return true;
    }
    atomic_fetch_add(&j->library->compiles, 1);
    if (!run_compiler(j, &code)) return false;
    spirv raw = {.words = mem_copy(code.words, code.count * sizeof *code.words),
                 .count = code.count}; // reflecting edits the code
    bool done = reflect(j, &code, memory, out);
    if (done) cache_store(j->library, key, &raw);
    mem_free(raw.words);
    mem_free(code.words);
    return done;
}

static void list_files(const shader_unit *unit, arena *memory, shader_binary *out) {
    const char **files = arena_alloc(memory, unit->file_count * sizeof *files);
    size_t count = 0;
    for (size_t i = 0; i < unit->file_count; i++)
        if (unit->files[i].where.path)
            files[count++] = arena_string(memory, unit->files[i].where.path);
    out->files = files;
    out->file_count = count;
}

static bool compile_job(job *j) {
    const shader_interface *interface = unit_annotations(&j->unit, &j->scratch, &j->inserts);
    if (!interface || !unit_prelude(&j->unit, interface, j->desc, &j->source)) return false;
    add_text(j);
    if (!translate(j, j->memory, j->out)) return false;
    list_files(&j->unit, j->memory, j->out);
    return true;
}

static void *job_run(void *user) {
    job *j = user;
    j->done = compile_job(j);
    if (!j->done) j->message = arena_string(&j->scratch, err_get()); // messages are per thread
    return NULL;
}

// Without a device as much as with one: what is compiled to be checked is refused here.
static bool meets_limits(const shader_compile_desc *desc, const shader_binary *out) {
    const gpu_limits *limits = &gpu_get_profile(NULL)->limits;
    gpu_demand demand = {0};
    for (size_t i = 0; i < out->slot_count; i++) {
        demand.storage_buffers += out->slots[i].slot.kind == GPU_SLOT_STORAGE_BUFFER;
        demand.storage_images += out->slots[i].slot.kind == GPU_SLOT_STORAGE_IMAGE;
    }
    if (desc->stage == SHADER_COMPUTE && limits->shared_bytes < UINT32_MAX) {
        demand.threads = out->local_size[0] * out->local_size[1] * out->local_size[2];
        spirv_shared_bytes(out->code, out->size / 4, &demand.shared_bytes);
    }
    return gpu_meets_limits(limits, desc->name, &demand);
}

bool shader_compile(shader_library *library, arena *memory, const shader_compile_desc *desc,
                    shader_binary *out) {
    *out = (shader_binary){0};
    if (library->binaries && binary_memo_find(library, desc, memory, out)) return true;
    job j = {.library = library, .desc = desc, .memory = memory, .out = out};
    unit_desc unit = {.name = desc->name,
                      .texts = desc->texts,
                      .text_count = desc->text_count,
                      .reader = desc->reader};
    if (!unit_load(library, &unit, &j.unit)) return false;
    bool done = run_on_large_stack(job_run, &j) ? j.done || err_set("%s", j.message)
                                                : err_prefix("%s: ", desc->name);
    if (done && library->binaries) binary_memo_keep(library, desc, &j.unit, out);
    strbuf_free(&j.source);
    mem_free(j.inserts.items);
    arena_free(&j.scratch);
    unit_free(&j.unit);
    return done && meets_limits(desc, out);
}
