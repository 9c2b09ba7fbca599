// Reflection: slots, access, block sizes, members of every type, group sizes.
#include "shader_helper.h"

static void members_have_std140_offsets(void **state) {
    static const struct {
        const char *name;
        uint32_t offset, size;
        shader_type type;
        uint32_t array;
    } expected[] = {
        {"a", 0, 4, SHADER_FLOAT, 0},       {"b", 8, 8, SHADER_VEC2, 0},
        {"c", 16, 12, SHADER_VEC3, 0},      {"d", 28, 4, SHADER_INT, 0},
        {"e", 32, 4, SHADER_INT, 0},        {"f", 48, 16, SHADER_VEC4, 0},
        {"g", 64, 4, SHADER_INT, 0},        {"h", 80, 64, SHADER_MAT4, 0},
        {"i", 144, 48, SHADER_FLOAT, 3},    {"j", 192, 32, SHADER_VEC3, 2},
        {"input", 224, 4, SHADER_FLOAT, 0},
    };
    place *p = *state;
    shader_binary binary;
    place_write(p, "program/a.comp",
                "const int N = 3;\n"
                "uniform float a; //= 1 : x\nuniform vec2 b;\nuniform vec3 c; //= 1 : x\n"
                "uniform int d; //= u {u, v} : x\nuniform bool e; //= true : x\n"
                "uniform vec4 f;\nuniform uint g;\nuniform mat4 h;\nuniform float i[N];\n"
                "uniform vec3 j[2];\nuniform float input_;\n"
                "writeonly uniform image2D color; //= output rgba32f : x\n"
                "void main() { imageStore(color, ivec2(d), e ? f : h[0]); }\n");
    place_compile(p, &(shader_compile_desc){.name = "a.comp"}, &binary);
    const size_t count = sizeof expected / sizeof *expected;
    assert_int_equal(binary.member_count, count);
    for (size_t i = 0; i < count; i++) {
        const shader_member *member = find_member(&binary, expected[i].name);
        if (!member) fail_msg("%s is missing", expected[i].name);
        if (member->offset != expected[i].offset || member->size != expected[i].size ||
            member->type != expected[i].type || member->array != expected[i].array)
            fail_msg("%s: offset %u, size %u, type %d, array %u", member->name, member->offset,
                     member->size, (int)member->type, member->array);
    }
    const shader_slot *block = find_slot(&binary, "Uniforms");
    assert_non_null(block);
    assert_int_equal(block->size, 240); // std140 rounds to 16
    assert_int_equal(block->slot.kind, GPU_SLOT_UNIFORM);
}

static void slots_tell_kind_and_access(void **state) {
    static const struct {
        const char *name;
        gpu_slot_kind kind;
        bool reads, writes, volume;
    } expected[] = {
        {"Frame", GPU_SLOT_UNIFORM, true, false, false},
        {"Free", GPU_SLOT_STORAGE_BUFFER, true, true, false},
        {"Given", GPU_SLOT_STORAGE_BUFFER, true, false, false},
        {"Taken", GPU_SLOT_STORAGE_BUFFER, false, true, false},
        {"flat_", GPU_SLOT_SAMPLED_IMAGE, true, false, false},
        {"deep", GPU_SLOT_SAMPLED_IMAGE, true, false, true},
        {"both", GPU_SLOT_STORAGE_IMAGE, true, true, false},
        {"only_read", GPU_SLOT_STORAGE_IMAGE, true, false, true},
        {"only_written", GPU_SLOT_STORAGE_IMAGE, false, true, true},
    };
    place *p = *state;
    shader_binary binary;
    place_write(
        p, "program/a.comp",
        "layout(std140) uniform Frame { vec4 x; float y; } frame;\n"
        "layout(std430) buffer Free { uint a[]; };\n"
        "layout(std430) readonly buffer Given { uint b[]; };\n"
        "layout(std430) writeonly buffer Taken { uint c[]; };\n"
        "uniform sampler2D flat_;\nuniform sampler3D deep;\n"
        "layout(r32f) uniform image2D both;\nlayout(r32f) readonly uniform image3D only_read;\n"
        "writeonly uniform image3D only_written; //= output r16f : x\n"
        "void main() {\n"
        "    a[0] = b[0]; c[0] = 1u;\n"
        "    vec4 v = texture(flat_, vec2(0)) + texture(deep, vec3(0)) + frame.y;\n"
        "    v += imageLoad(both, ivec2(0)) + imageLoad(only_read, ivec3(0));\n"
        "    imageStore(both, ivec2(0), v); imageStore(only_written, ivec3(0), v);\n"
        "}\n");
    place_compile(p, &(shader_compile_desc){.name = "a.comp"}, &binary);
    const size_t count = sizeof expected / sizeof *expected;
    assert_int_equal(binary.slot_count, count);
    uint32_t used = 0;
    for (size_t i = 0; i < count; i++) {
        const shader_slot *slot = find_slot(&binary, expected[i].name);
        if (!slot) fail_msg("%s is missing", expected[i].name);
        if (slot->slot.kind != expected[i].kind || slot->slot.reads != expected[i].reads ||
            slot->slot.writes != expected[i].writes || slot->volume != expected[i].volume)
            fail_msg("%s: kind %d, reads %d, writes %d, volume %d", slot->name,
                     (int)slot->slot.kind, slot->slot.reads, slot->slot.writes, slot->volume);
        assert_true(slot->slot.binding < GPU_MAX_SLOTS);
        used |= 1u << slot->slot.binding;
    }
    assert_int_equal(__builtin_popcount(used), count); // no two at one binding
    assert_int_equal(find_slot(&binary, "Frame")->size, 32);
}

static void only_what_is_used_takes_a_slot(void **state) {
    place *p = *state;
    shader_binary binary;
    place_write(p, "program/a.comp",
                "uniform sampler2D unused; //= input : x\nuniform float never; //= 1 : x\n"
                "layout(binding = 0) uniform sampler2D one;\n"
                "layout(binding = 0) writeonly uniform image2D two; //= output r8 : x\n"
                "vec4 dead() { return texture(unused, vec2(never)); }\n"
                "void main() { imageStore(two, ivec2(0), texture(one, vec2(0))); }\n");
    place_compile(p, &(shader_compile_desc){.name = "a.comp"}, &binary);
    assert_int_equal(binary.slot_count, 2);
    assert_int_equal(binary.member_count, 0);
    assert_int_not_equal(binary.slots[0].slot.binding, binary.slots[1].slot.binding);
}

static void group_size_is_read_or_given(void **state) {
    place *p = *state;
    shader_binary binary;
    place_write(p, "program/a.comp", "// local_size_x\nvoid main() {}\n");
    place_compile(p, &(shader_compile_desc){.name = "a.comp"}, &binary);
    assert_int_equal(binary.local_size[0], 16);
    assert_int_equal(binary.local_size[1], 16);
    assert_int_equal(binary.local_size[2], 1);
    place_write(
        p, "program/b.comp",
        "layout(local_size_x = 4, local_size_y = 2, local_size_z = 8) in;\nvoid main() {}\n");
    place_compile(p, &(shader_compile_desc){.name = "b.comp"}, &binary);
    assert_int_equal(binary.local_size[0], 4);
    assert_int_equal(binary.local_size[1], 2);
    assert_int_equal(binary.local_size[2], 8);
}

static void too_many_slots_are_refused(void **state) {
    place *p = *state;
    char text[4096] = "writeonly uniform image2D c; //= output r8 : x\n", *at = text + strlen(text);
    for (int i = 0; i < GPU_MAX_SLOTS; i++) at += sprintf(at, "uniform sampler2D s%d;\n", i);
    at += sprintf(at, "void main() { vec4 v = vec4(0);\n");
    for (int i = 0; i < GPU_MAX_SLOTS; i++) at += sprintf(at, "v += texture(s%d, vec2(0));\n", i);
    sprintf(at, "imageStore(c, ivec2(0), v); }\n");
    place_write(p, "program/a.comp", text);
    place_refuses(p, "a.comp", "more than 32 blocks, samplers and images");
}

static void what_cannot_be_bound_is_refused(void **state) {
    place *p = *state;
    place_write(p, "program/a.comp",
                "uniform sampler2D s[4];\nwriteonly uniform image2D c; //= output r8 : x\n"
                "void main() { imageStore(c, ivec2(0), texture(s[1], vec2(0))); }\n");
    place_refuses(p, "a.comp", "a.comp: s: arrays of");
    place_write(p, "program/b.comp",
                "layout(push_constant) uniform P { float x; };\n"
                "writeonly uniform image2D c; //= output r8 : x\n"
                "void main() { imageStore(c, ivec2(0), vec4(x)); }\n");
    place_refuses(p, "b.comp", "a resource of this kind is not supported");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        PLACE_TEST(members_have_std140_offsets),    PLACE_TEST(slots_tell_kind_and_access),
        PLACE_TEST(only_what_is_used_takes_a_slot), PLACE_TEST(group_size_is_read_or_given),
        PLACE_TEST(too_many_slots_are_refused),     PLACE_TEST(what_cannot_be_bound_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
