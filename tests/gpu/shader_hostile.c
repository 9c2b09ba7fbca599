// Shaders that reach for what is not theirs, compiled, rewritten and run: whatever they do, the
// process of the driver must live on. Each runs in a child, so that a crash is seen as one.
//
//   gpu_shader_hostile [SECONDS [SEED [FIRST]]]    for how long each: 5 s
#include "gpu_test.h"
#include "shader/unit.h"
#include <signal.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { SIZE = 32, MOST_WORDS = 1 << 16, SECONDS = 5, SECONDS_FOR_A_CHILD = 120 };
enum { SECONDS_OF_A_FRAME = 20, HUNG = 3 }; // HUNG: how a child ends whose device hangs

static int seconds = SECONDS;
static uint64_t seed = 1, first_number;

typedef struct text {
    const char *name, *globals, *body;
} text;

// `i` is a number from 1 to 32 that no compiler knows, `zero` is 0, `c` is what is drawn.
static const text texts[] = {
    {"reads shared memory", "shared float s[64];",
     "s[gl_LocalInvocationIndex & 63u] = 1.0; barrier(); c = vec4(s[i * 100003]);"},
    {"writes shared memory", "shared float s[64];",
     "s[i * 100003] = 1.0; s[-i * 70001] = 2.0; barrier(); c = vec4(s[3]);"},
    {"adds to shared memory", "shared uint s[64];",
     "atomicAdd(s[i * 100003], 1u); atomicMax(s[uint(-i)], 1u); c = vec4(s[3]);"},
    {"shares structs", "struct S { float a[4]; mat4 m; vec4 v; }; shared S s[8];",
     "s[i * 99999].a[i * 7777] = 1.0; s[1].m[i * 99999][i * 7777] = 2.0; s[2].v[i * 8888888] = 1.0;"
     "barrier(); c = vec4(s[3].m[i * 99999999]);"},
    {"reads a variable", "float t[16];",
     "for (int k = 0; k < 16; k++) t[k] = zero + float(k); c = vec4(t[i * 1000003]);"},
    {"writes a variable", "float t[16];",
     "for (int k = 0; k < 16; k++) t[k + i * 100003] = float(k); c = vec4(t[3]);"},
    {"writes a large variable", "",
     "float t[1000]; for (int k = 0; k < 1000; k++) t[k - i * 100003] = float(k); c = vec4(t[3]);"},
    {"hands an array to functions",
     "float f(float t[8], int k) { t[k * 99999] = 1.0; return t[-k * 7777]; }",
     "float t[8]; t[i & 7] = 1.0; c = vec4(f(t, i));"},
    {"reads a table", "const float t[8] = float[8](1, 2, 3, 4, 5, 6, 7, 8);",
     "c = vec4(t[i * 1000003]);"},
    {"indexes a matrix", "",
     "mat4 m = mat4(zero + 1.0); m[i * 99999][i * 77777] = 3.0; c = m[i * 12345] + m[1][i * "
     "3333];"},
    {"indexes a vector", "", "vec4 v = vec4(zero); v[i * 99999] = 3.0; c = vec4(v[-i * 12345]);"},
    {"reads uniforms", "uniform vec4 a[4];", "c = a[i * 1000003] + a[-i * 7777777];"},
    {"fetches far away", "",
     "c = texelFetch(from, ivec2(i * 1000003, -i * 999999), i * 77777) +"
     "texelFetch(from, ivec2(0), -i * 88888) +"
     "texelFetch(from, ivec2(0x7fffffff, 0x80000000), 0x7fffffff);"},
    {"samples what is no number", "",
     "c = textureLod(from, vec2(1.0 / zero, 0.0 / zero), 1.0 / zero) +"
     "textureLod(from, vec2(1e38), -1e38) + textureLod(from, vec2(0.0 / zero), 0.0 / zero) +"
     "textureGrad(from, vec2(0.5), vec2(1e38), vec2(0.0 / zero)) +"
     "textureGather(from, vec2(1e30, -1.0 / zero)) + textureSize(from, i * 777777).xyxy;"},
    {"stores far away", "",
     "imageStore(to, ivec2(i * 1000003, -i * 1003), vec4(1)); imageStore(to, ivec2(-1), vec4(1));"
     "imageStore(to, ivec2(0x7fffffff), vec4(1)); c = vec4(1);"},
    {"divides by nothing", "",
     "int a = 0x80000000 + int(zero), b = -1 + int(zero), z = int(zero);"
     "c = vec4(a / b, a % b, a / z, a % z) + vec4(uint(a) / uint(z), uint(a) % uint(z), 0, 0);"
     "for (int k = 1; k < 40; k++) c += float(a << (k * i)) + float(a >> (k * -i));"},
    {"leaves before a barrier", "shared float s[64];",
     "s[i & 63] = 1.0; if (gl_LocalInvocationIndex > 100u + uint(zero)) return; barrier();"
     "c = vec4(s[1]); barrier(); c += vec4(s[2]);"},
    {"waits unevenly", "shared float s[64];",
     "for (int k = 0; k < int(gl_LocalInvocationIndex >> 3); k++) { s[k] = 1.0; barrier(); }"
     "c = vec4(s[1]);"},
    {"takes bits that are not there", "",
     "c = vec4(ldexp(zero + 1.0, i * 99999), bitfieldExtract(i, i * 77, i * 9999),"
     "bitfieldInsert(i, i, -5 * i, 4000 * i), findMSB(i - i));"},
};

// A text as a shader of some stage, where that makes sense of it.
typedef struct source {
    const text *text;
    shader_stage stage;
} source;

static const char *const stage_names[] = {"hostile.comp", "hostile.vert", "hostile.frag"};
static source sources[3 * COUNT_OF(texts)];
static size_t source_count;

static void list_sources(void) {
    for (int stage = SHADER_COMPUTE; stage <= SHADER_FRAGMENT; stage++)
        for (size_t i = 0; i < COUNT_OF(texts); i++) {
            const text *t = &texts[i];
            bool computes = strstr(t->globals, "shared") || strstr(t->body, "imageStore");
            if (stage == SHADER_COMPUTE || !computes)
                sources[source_count++] = (source){t, (shader_stage)stage};
        }
}

static void write_source(const source *s, strbuf *out) {
    static const char *const frames[][3] = {
        {"writeonly uniform image2D to; //= output rgba32f : x\n",
         "ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);\n", "imageStore(to, pixel, c);\n"},
        {"layout(location = 0) out vec4 color;\n", "ivec2 pixel = ivec2(gl_VertexIndex, 0);\n",
         "color = c;\nvec2 uv = vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2);\n"
         "gl_Position = vec4(uv * 2.0 - 1.0, 0.0, 1.0) + zero * c;\n"},
        {"layout(location = 0) out vec4 image;\n", "ivec2 pixel = ivec2(gl_FragCoord.xy);\n",
         "image = c;\n"},
    };
    const char *const *frame = frames[s->stage];
    strbuf_add(out,
               "%s\nuniform float zero;\nuniform sampler2D from;\n%s"
               "void main() {\n%sint i = pixel.x + 1 + int(zero);\nvec4 c = vec4(0);\n%s\n%s}\n",
               s->text->globals, frame[0], frame[1], s->text->body, frame[2]);
}

static bool compile_source(const char *whole, shader_stage stage, arena *memory,
                           shader_binary *out) {
    shader_library *library = shader_library_create(&(shader_library_desc){0});
    const shader_text given = {stage_names[stage], whole};
    shader_compile_desc desc = {
        .name = given.name, .stage = stage, .texts = &given, .text_count = 1};
    bool done = shader_compile(library, memory, &desc, out);
    shader_library_destroy(library);
    return done;
}

static void compile(const source *s, arena *memory, shader_binary *out) {
    strbuf whole = {0};
    write_source(s, &whole);
    if (!compile_source(whole.text, s->stage, memory, out))
        fail_msg("%s, %s: %s", stage_names[s->stage], s->text->name, err_get());
    strbuf_free(&whole);
}

// Of the other stage, for what is drawn.
static shader_binary plain_vertex, plain_fragment;

static void compile_plain(arena *memory) {
    gpu_test_ok(compile_source("layout(location = 0) out vec4 color;\nvoid main() {\n"
                               "vec2 uv = vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2);\n"
                               "color = uv.xyxy;\n"
                               "gl_Position = vec4(uv * 2.0 - 1.0, 0.0, 1.0);\n}\n",
                               SHADER_VERTEX, memory, &plain_vertex));
    gpu_test_ok(compile_source("layout(location = 0) in vec4 color;\n"
                               "layout(location = 0) out vec4 image;\n"
                               "void main() { image = color; }\n",
                               SHADER_FRAGMENT, memory, &plain_fragment));
}

// ---- in a child -------------------------------------------------------------------------------

typedef struct canvas {
    gpu *g;
    gpu_image *from, *to, *target;
} canvas;

static gpu_image *make_image(gpu *g, const char *label, unsigned use) {
    gpu_image *image = gpu_image_create(g, &(gpu_image_desc){.label = label,
                                                             .format = GPU_RGBA32F,
                                                             .width = SIZE,
                                                             .height = SIZE,
                                                             .mips = 1,
                                                             .use = GPU_USE_SAMPLED | use});
    gpu_test_ok(image);
    return image;
}

// Modules that were changed are valid, but may do what a device's limits or features rule out: of
// these the validation layers speak.
static void open_canvas(canvas *c, bool validate) {
    c->g = gpu_create(&(gpu_desc){.validate = validate, .timeout = SECONDS_OF_A_FRAME});
    gpu_test_ok(c->g);
    c->from = make_image(c->g, "from", GPU_USE_STORAGE);
    c->to = make_image(c->g, "to", GPU_USE_STORAGE);
    c->target = make_image(c->g, "target", GPU_USE_TARGET);
}

static void close_canvas(canvas *c) {
    gpu_image_destroy(c->g, c->from);
    gpu_image_destroy(c->g, c->to);
    gpu_image_destroy(c->g, c->target);
    if (gpu_test_finish(c->g)) _exit(2);
}

typedef struct work { // a pipeline, and what is bound to it
    gpu_slot slots[GPU_MAX_SLOTS];
    gpu_binding bindings[GPU_MAX_SLOTS];
    size_t count;
    gpu_pipeline *pipeline;
} work;

static bool bind(const canvas *c, const shader_binary *binary, work *w) {
    static const float zeros[4096];
    for (w->count = 0; w->count < binary->slot_count; w->count++) {
        const shader_slot *slot = &binary->slots[w->count];
        gpu_binding *b = &w->bindings[w->count];
        w->slots[w->count] = slot->slot;
        *b = (gpu_binding){.binding = slot->slot.binding};
        if (slot->slot.kind == GPU_SLOT_UNIFORM) {
            if (slot->size > sizeof zeros) return false;
            b->uniform = zeros;
            b->uniform_size = slot->size;
        } else {
            b->image = slot->slot.kind == GPU_SLOT_SAMPLED_IMAGE ? c->from : c->to;
        }
    }
    return true;
}

static gpu_pipeline *create(const canvas *c, const shader_binary *binary, shader_stage stage,
                            const work *w) {
    if (stage == SHADER_COMPUTE) {
        gpu_compute_desc desc = {.label = "hostile",
                                 .code = binary->code,
                                 .code_size = binary->size,
                                 .slots = w->slots,
                                 .slot_count = w->count};
        memcpy(desc.local_size, binary->local_size, sizeof desc.local_size);
        return gpu_pipeline_create_compute(c->g, &desc);
    }
    const shader_binary *vertex = stage == SHADER_VERTEX ? binary : &plain_vertex;
    const shader_binary *fragment = stage == SHADER_FRAGMENT ? binary : &plain_fragment;
    return gpu_pipeline_create_graphics(c->g, &(gpu_graphics_desc){.label = "hostile",
                                                                   .vertex_code = vertex->code,
                                                                   .vertex_size = vertex->size,
                                                                   .fragment_code = fragment->code,
                                                                   .fragment_size = fragment->size,
                                                                   .slots = w->slots,
                                                                   .slot_count = w->count,
                                                                   .colors = {GPU_RGBA32F}});
}

static bool submit(const canvas *c, shader_stage stage, const work *w) {
    if (stage == SHADER_COMPUTE)
        return gpu_dispatch(c->g, &(gpu_dispatch_desc){.pipeline = w->pipeline,
                                                       .bindings = w->bindings,
                                                       .binding_count = w->count,
                                                       .threads = {SIZE, SIZE, 1}});
    const gpu_draw one = {.bindings = w->bindings, .binding_count = w->count, .vertices = 30};
    return gpu_draw_all(c->g, &(gpu_draw_desc){.pipeline = w->pipeline,
                                               .colors = {c->target},
                                               .clear = true,
                                               .draws = &one,
                                               .draw_count = 1});
}

// False when it was refused.
static bool draw(canvas *c, const shader_binary *binary, shader_stage stage) {
    work w;
    if (!bind(c, binary, &w)) return false;
    w.pipeline = create(c, binary, stage, &w);
    if (!w.pipeline) return false;
    bool drawn = gpu_frame_begin(c->g) && submit(c, stage, &w);
    drawn = gpu_frame_end(c->g) && drawn && gpu_idle(c->g);
    gpu_pipeline_destroy(c->g, w.pipeline);
    return drawn;
}

static int wait_for(pid_t child) {
    int status = 0;
    assert_true(child > 0);
    assert_int_equal(waitpid(child, &status, 0), child);
    return status;
}

static void begin_child(void) { // the library of the tests catches faults
    static const int faults[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
    for (size_t i = 0; i < COUNT_OF(faults); i++) signal(faults[i], SIG_DFL);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    alarm(SECONDS_FOR_A_CHILD);
}

static void hostile_shaders_only_hurt_themselves(void **state) {
    (void)state;
    for (size_t i = 0; i < source_count; i++) {
        arena memory = {0};
        shader_binary binary;
        const char *name = sources[i].text->name, *stage = stage_names[sources[i].stage];
        compile(&sources[i], &memory, &binary);
        pid_t child = fork();
        if (child == 0) {
            canvas c;
            begin_child();
            open_canvas(&c, true);
            bool drawn = draw(&c, &binary, sources[i].stage);
            if (!drawn) fprintf(stderr, "%s, %s: %s\n", stage, name, err_get());
            close_canvas(&c);
            _exit(drawn ? 0 : 1);
        }
        int status = wait_for(child);
        if (status)
            fail_msg("%s that %s ends its process (status %#x)", stage, name, (unsigned)status);
        arena_free(&memory);
    }
}

// ---- modules changed word by word --------------------------------------------------------------

typedef struct tally { // shared with the child, which may die
    uint64_t number, tried, valid, drawn, hung;
} tally;

static uint64_t next_random(uint64_t *random) { // SplitMix64
    uint64_t z = *random += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

// One to three words after the header: another id, a number near it, another opcode of that length,
// a bit, a word of elsewhere, or an instruction twice or never.
static size_t change(uint32_t *words, size_t count, uint64_t *random) {
    uint64_t changes = 1 + next_random(random) % 3;
    for (uint64_t i = 0; i < changes; i++) {
        size_t at = SPIRV_HEADER + next_random(random) % (count - SPIRV_HEADER);
        uint32_t bound = words[SPIRV_BOUND], length = words[at] >> 16;
        switch (next_random(random) % 6) {
        case 0:
            words[at] = (uint32_t)(next_random(random) % bound);
            break;
        case 1:
            words[at] += (uint32_t)(next_random(random) % 9) - 4;
            break;
        case 2:
            words[at] = (words[at] & 0xffff0000u) | (uint32_t)(next_random(random) % 420);
            break;
        case 3:
            words[at] ^= 1u << next_random(random) % 32;
            break;
        case 4:
            words[at] = words[SPIRV_HEADER + next_random(random) % (count - SPIRV_HEADER)];
            break;
        default:
            if (length && length <= count - at && count - length > SPIRV_HEADER + 8) {
                memmove(words + at, words + at + length, (count - at - length) * sizeof *words);
                count -= length;
            }
            break;
        }
    }
    return count;
}

static void try_module(canvas *c, const shader_binary *from, shader_stage stage, uint64_t number,
                       tally *t) {
    static uint32_t words[MOST_WORDS];
    uint64_t random = seed * 1000003 + number;
    arena memory = {0};
    shader_binary binary;
    spirv code = {.words = words, .count = from->size / 4};
    assert_true(code.count <= MOST_WORDS);
    memcpy(words, from->code, from->size);
    code.count = change(words, code.count, &random);
    if (spirv_gate(&code) && spirv_validate(&code)) {
        t->valid++;
        if (spirv_reflect(&code, stage, &memory, &binary)) {
            binary.code = code.words;
            binary.size = code.count * sizeof *code.words;
            t->drawn += draw(c, &binary, stage);
        }
    }
    arena_free(&memory);
}

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
}

typedef void trial(canvas *c, uint64_t number, tally *t);

// Until the time is over. What takes a device longer than a frame may is given up, as ever: the
// next child goes on after it.
static void try_in_child(trial *one, tally *t, double end) {
    canvas c;
    begin_child();
    open_canvas(&c, false);
    while (now() < end) {
        alarm(SECONDS_FOR_A_CHILD);
        t->tried++;
        one(&c, t->number++, t);
        if (!gpu_is_lost(c.g)) continue;
        t->hung++;
        _exit(HUNG);
    }
    _exit(0);
}

// Runs trials in children.
static void try_many(const char *what, trial *one) {
    tally *t = mmap(NULL, sizeof *t, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    assert_true(t != MAP_FAILED);
    double end = now() + seconds;
    int status;
    t->number = first_number;
    do {
        pid_t child = fork();
        if (child == 0) try_in_child(one, t, end);
        status = wait_for(child);
    } while (WIFEXITED(status) && WEXITSTATUS(status) == HUNG);
    print_message("%llu %s changed, %llu valid, %llu drawn, %llu given up\n",
                  (unsigned long long)t->tried, what, (unsigned long long)t->valid,
                  (unsigned long long)t->drawn, (unsigned long long)t->hung);
    if (status)
        fail_msg("%s: number %llu of seed %llu ends its process (status %#x)", what,
                 (unsigned long long)t->number - 1, (unsigned long long)seed, status);
    assert_true(t->drawn + t->hung > 0 && (first_number || t->tried > t->valid));
    munmap(t, sizeof *t);
}

static shader_binary binaries[COUNT_OF(sources)];

static void try_binary(canvas *c, uint64_t number, tally *t) {
    size_t i = number % source_count;
    try_module(c, &binaries[i], sources[i].stage, number, t);
}

static void changed_modules_only_hurt_themselves(void **state) {
    (void)state;
    arena memory = {0};
    for (size_t i = 0; i < source_count; i++) compile(&sources[i], &memory, &binaries[i]);
    try_many("modules", try_binary);
    arena_free(&memory);
}

// ---- texts changed word by word ----------------------------------------------------------------

// Numbers become extreme ones, operators others, and words of elsewhere stand in for words.
static void change_text(char *from, strbuf *out, uint64_t *random) {
    static const char *const numbers[] = {"0",  "1",    "-1",    "2147483647", "(-2147483647-1)",
                                          "64", "1e38", "1e-38", "0xffffffffu"};
    static const char operators[] = "+-*/%&|^<>";
    size_t length = strlen(from), main_at = (size_t)(strstr(from, "void main") - from);
    for (int i = 0; i < 3; i++) { // operators, in place
        size_t at = main_at + next_random(random) % (length - main_at);
        if (strchr("+-*/&", from[at]) && from[at + 1] == ' ')
            from[at] = operators[next_random(random) % (sizeof operators - 1)];
    }
    size_t chosen = main_at + next_random(random) % (length - main_at);
    while (from[chosen] && !(from[chosen] >= '0' && from[chosen] <= '9')) chosen++;
    size_t end = chosen;
    while (from[end] >= '0' && from[end] <= '9') end++;
    strbuf_append(out, from, chosen);
    if (end > chosen) strbuf_add(out, "%s", numbers[next_random(random) % COUNT_OF(numbers)]);
    strbuf_add(out, "%s", from + end);
}

static void try_text(canvas *c, uint64_t number, tally *t) {
    uint64_t random = seed * 1000033 + number;
    strbuf whole = {0}, changed = {0};
    arena memory = {0};
    shader_binary binary;
    shader_stage stage = sources[number % source_count].stage;
    write_source(&sources[number % source_count], &whole);
    change_text(whole.text, &changed, &random);
    if (compile_source(changed.text, stage, &memory, &binary)) {
        t->valid++;
        t->drawn += draw(c, &binary, stage);
    }
    arena_free(&memory);
    strbuf_free(&whole);
    strbuf_free(&changed);
}

static void changed_texts_only_hurt_themselves(void **state) {
    (void)state;
    try_many("texts", try_text);
}

int main(int count, char **words) {
    if (count > 1) seconds = atoi(words[1]);
    if (count > 2) seed = strtoull(words[2], NULL, 0);
    if (count > 3) first_number = strtoull(words[3], NULL, 0);
    gpu_test_need_device();
    arena memory = {0};
    list_sources();
    compile_plain(&memory);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hostile_shaders_only_hurt_themselves),
        cmocka_unit_test(changed_modules_only_hurt_themselves),
        cmocka_unit_test(changed_texts_only_hurt_themselves),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    arena_free(&memory);
    return failed;
}
