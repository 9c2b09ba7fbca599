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

static void write_source(const text *t, strbuf *out) {
    strbuf_add(out,
               "%s\nuniform float zero;\nuniform sampler2D from;\n"
               "writeonly uniform image2D to; //= output rgba32f : x\n"
               "void main() {\nivec2 pixel = ivec2(gl_GlobalInvocationID.xy);\n"
               "int i = pixel.x + 1 + int(zero);\nvec4 c = vec4(0);\n%s\n"
               "imageStore(to, pixel, c);\n}\n",
               t->globals, t->body);
}

static bool compile_source(const char *source, arena *memory, shader_binary *out) {
    shader_library *library = shader_library_create(&(shader_library_desc){0});
    const shader_text given = {"hostile.comp", source};
    shader_compile_desc desc = {.name = given.name, .texts = &given, .text_count = 1};
    bool done = shader_compile(library, memory, &desc, out);
    shader_library_destroy(library);
    return done;
}

static void compile(const text *t, arena *memory, shader_binary *out) {
    strbuf source = {0};
    write_source(t, &source);
    if (!compile_source(source.text, memory, out)) fail_msg("%s: %s", t->name, err_get());
    strbuf_free(&source);
}

// ---- in a child -------------------------------------------------------------------------------

typedef struct canvas {
    gpu *g;
    gpu_image *from, *to;
} canvas;

static gpu_image *make_image(gpu *g, const char *label) {
    gpu_image *image =
        gpu_image_create(g, &(gpu_image_desc){.label = label,
                                              .format = GPU_RGBA32F,
                                              .width = SIZE,
                                              .height = SIZE,
                                              .mips = 1,
                                              .use = GPU_USE_SAMPLED | GPU_USE_STORAGE});
    gpu_test_ok(image);
    return image;
}

// Modules that were changed are valid, but may do what a device's limits or features rule out: of
// these the validation layers speak.
static void open_canvas(canvas *c, bool validate) {
    c->g = gpu_create(&(gpu_desc){.validate = validate, .timeout = SECONDS_FOR_A_CHILD});
    gpu_test_ok(c->g);
    c->from = make_image(c->g, "from");
    c->to = make_image(c->g, "to");
}

static void close_canvas(canvas *c) {
    gpu_image_destroy(c->g, c->from);
    gpu_image_destroy(c->g, c->to);
    if (gpu_test_finish(c->g)) _exit(2);
}

// False when it was refused.
static bool draw(canvas *c, const shader_binary *binary) {
    static const float zeros[4096];
    gpu_slot slots[GPU_MAX_SLOTS];
    gpu_binding bindings[GPU_MAX_SLOTS];
    for (size_t i = 0; i < binary->slot_count; i++) {
        const shader_slot *slot = &binary->slots[i];
        slots[i] = slot->slot;
        bindings[i] = (gpu_binding){.binding = slot->slot.binding};
        if (slot->slot.kind == GPU_SLOT_UNIFORM) {
            if (slot->size > sizeof zeros) return false;
            bindings[i].uniform = zeros;
            bindings[i].uniform_size = slot->size;
        } else {
            bindings[i].image = slot->slot.kind == GPU_SLOT_SAMPLED_IMAGE ? c->from : c->to;
        }
    }
    gpu_compute_desc desc = {.label = "hostile",
                             .code = binary->code,
                             .code_size = binary->size,
                             .slots = slots,
                             .slot_count = binary->slot_count};
    memcpy(desc.local_size, binary->local_size, sizeof desc.local_size);
    gpu_pipeline *pipeline = gpu_pipeline_create_compute(c->g, &desc);
    if (!pipeline) return false;
    bool drawn = gpu_frame_begin(c->g) &&
                 gpu_dispatch(c->g, &(gpu_dispatch_desc){.pipeline = pipeline,
                                                         .bindings = bindings,
                                                         .binding_count = binary->slot_count,
                                                         .threads = {SIZE, SIZE, 1}});
    drawn = gpu_frame_end(c->g) && drawn && gpu_idle(c->g);
    gpu_pipeline_destroy(c->g, pipeline);
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
    for (size_t i = 0; i < COUNT_OF(texts); i++) {
        arena memory = {0};
        shader_binary binary;
        compile(&texts[i], &memory, &binary);
        pid_t child = fork();
        if (child == 0) {
            canvas c;
            begin_child();
            open_canvas(&c, true);
            bool drawn = draw(&c, &binary);
            if (!drawn) fprintf(stderr, "%s: %s\n", texts[i].name, err_get());
            close_canvas(&c);
            _exit(drawn ? 0 : 1);
        }
        int status = wait_for(child);
        if (status)
            fail_msg("a shader that %s ends its process (status %#x)", texts[i].name, status);
        arena_free(&memory);
    }
}

// ---- modules changed word by word --------------------------------------------------------------

typedef struct tally { // shared with the child, which may die
    uint64_t number, tried, valid, drawn;
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

static void try_module(canvas *c, const shader_binary *from, uint64_t number, tally *t) {
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
        if (spirv_reflect(&code, SHADER_COMPUTE, &memory, &binary)) {
            binary.code = code.words;
            binary.size = code.count * sizeof *code.words;
            t->drawn += draw(c, &binary);
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

// Runs trials in a child until the time is over.
static void try_many(const char *what, trial *one) {
    tally *t = mmap(NULL, sizeof *t, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    assert_true(t != MAP_FAILED);
    pid_t child = fork();
    if (child == 0) {
        canvas c;
        begin_child();
        open_canvas(&c, false);
        double end = now() + seconds;
        for (uint64_t number = first_number; now() < end; number++) {
            alarm(SECONDS_FOR_A_CHILD);
            t->number = number;
            t->tried++;
            one(&c, number, t);
        }
        _exit(0);
    }
    int status = wait_for(child);
    print_message("%llu %s changed, %llu valid, %llu drawn\n", (unsigned long long)t->tried, what,
                  (unsigned long long)t->valid, (unsigned long long)t->drawn);
    if (status)
        fail_msg("%s: number %llu of seed %llu ends its process (status %#x)", what,
                 (unsigned long long)t->number, (unsigned long long)seed, status);
    assert_true(t->tried > t->valid && t->drawn > 0);
    munmap(t, sizeof *t);
}

static shader_binary binaries[COUNT_OF(texts)];

static void try_binary(canvas *c, uint64_t number, tally *t) {
    try_module(c, &binaries[number % COUNT_OF(binaries)], number, t);
}

static void changed_modules_only_hurt_themselves(void **state) {
    (void)state;
    arena memory = {0};
    for (size_t i = 0; i < COUNT_OF(texts); i++) compile(&texts[i], &memory, &binaries[i]);
    try_many("modules", try_binary);
    arena_free(&memory);
}

// ---- texts changed word by word ----------------------------------------------------------------

// Numbers become extreme ones, operators others, and words of elsewhere stand in for words.
static void change_text(char *source, strbuf *out, uint64_t *random) {
    static const char *const numbers[] = {"0",  "1",    "-1",    "2147483647", "(-2147483647-1)",
                                          "64", "1e38", "1e-38", "0xffffffffu"};
    static const char operators[] = "+-*/%&|^<>";
    size_t length = strlen(source), main_at = (size_t)(strstr(source, "void main") - source);
    for (int i = 0; i < 3; i++) { // operators, in place
        size_t at = main_at + next_random(random) % (length - main_at);
        if (strchr("+-*/&", source[at]) && source[at + 1] == ' ')
            source[at] = operators[next_random(random) % (sizeof operators - 1)];
    }
    size_t chosen = main_at + next_random(random) % (length - main_at);
    while (source[chosen] && !(source[chosen] >= '0' && source[chosen] <= '9')) chosen++;
    size_t end = chosen;
    while (source[end] >= '0' && source[end] <= '9') end++;
    strbuf_append(out, source, chosen);
    if (end > chosen) strbuf_add(out, "%s", numbers[next_random(random) % COUNT_OF(numbers)]);
    strbuf_add(out, "%s", source + end);
}

static void try_text(canvas *c, uint64_t number, tally *t) {
    uint64_t random = seed * 1000033 + number;
    strbuf source = {0}, changed = {0};
    arena memory = {0};
    shader_binary binary;
    write_source(&texts[number % COUNT_OF(texts)], &source);
    change_text(source.text, &changed, &random);
    if (compile_source(changed.text, &memory, &binary)) {
        t->valid++;
        t->drawn += draw(c, &binary);
    }
    arena_free(&memory);
    strbuf_free(&source);
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
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hostile_shaders_only_hurt_themselves),
        cmocka_unit_test(changed_modules_only_hurt_themselves),
        cmocka_unit_test(changed_texts_only_hurt_themselves),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
