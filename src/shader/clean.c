// Small edits of a SPIR-V module, instruction by instruction. A module is five words of header,
// then instructions whose first word holds the word count above the opcode (SPIR-V 1.6, 2.3).
#include "shader/unit.h"
#include <string.h>

typedef struct ids {
    uint32_t *items;
    size_t count, capacity;
} ids;

static bool contains(const uint32_t *items, size_t count, uint32_t id) {
    for (size_t i = 0; i < count; i++)
        if (items[i] == id) return true;
    return false;
}

static uint32_t opcode_at(const spirv *code, size_t i) {
    return code->words[i] & SpvOpCodeMask;
}

static void find_dead(const spirv *code, const uint32_t *live, size_t live_count, ids *dead) {
    for (size_t i = SPIRV_HEADER, length; i < code->count; i += length) {
        length = spirv_length(code->words, code->count, i);
        if (!length || opcode_at(code, i) == SpvOpFunction) return;
        if (opcode_at(code, i) != SpvOpVariable || length < 4) continue;
        uint32_t id = code->words[i + 2], storage = code->words[i + 3];
        bool resource = storage == SpvStorageClassUniformConstant ||
                        storage == SpvStorageClassUniform ||
                        storage == SpvStorageClassStorageBuffer;
        if (!resource || contains(live, live_count, id)) continue;
        *MEM_ADD(dead->items, dead->count, dead->capacity) = id;
    }
}

// OpEntryPoint model function "name" interface...: drops the dead from the interface.
static size_t copy_entry_point(const uint32_t *from, size_t length, const ids *dead, uint32_t *to) {
    size_t kept = 3, i = 3;
    memmove(to, from, 3 * sizeof *to);
    for (bool end = false; i < length && !end; i++) {
        uint32_t letters = to[kept++] = from[i];
        end = letters >> 24 == 0; // the name's last word is the one with a zero byte at its end
    }
    for (; i < length; i++)
        if (!contains(dead->items, dead->count, from[i])) to[kept++] = from[i];
    to[0] = (uint32_t)kept << SpvWordCountShift | SpvOpEntryPoint;
    return kept;
}

static bool names_dead(const uint32_t *at, size_t length, const ids *dead) {
    switch (at[0] & SpvOpCodeMask) {
    case SpvOpName:
    case SpvOpDecorate:
        return length > 1 && contains(dead->items, dead->count, at[1]);
    case SpvOpVariable:
        return length > 2 && contains(dead->items, dead->count, at[2]);
    default:
        return false;
    }
}

// Instructions only become shorter, so the module is rewritten in place.
void spirv_clean(spirv *code, const uint32_t local_size[3], const uint32_t *live,
                 size_t live_count) {
    ids dead = {0};
    find_dead(code, live, live_count, &dead);
    size_t kept = SPIRV_HEADER, i = SPIRV_HEADER, length;
    for (; i < code->count && (length = spirv_length(code->words, code->count, i)) != 0;
         i += length) {
        uint32_t *from = &code->words[i], *to = &code->words[kept];
        uint32_t opcode = opcode_at(code, i);
        if (opcode == SpvOpEntryPoint && length > 3) {
            kept += copy_entry_point(from, length, &dead, to);
        } else if (!names_dead(from, length, &dead)) {
            memmove(to, from, length * sizeof *to);
            kept += length;
        }
        if (opcode == SpvOpExecutionModeId && length == 6 && to[2] == SpvExecutionModeLocalSizeId) {
            to[0] = 6u << SpvWordCountShift | SpvOpExecutionMode;
            to[2] = SpvExecutionModeLocalSize;
            memcpy(&to[3], local_size, 3 * sizeof *to);
        }
    }
    code->count = kept;
    mem_free(dead.items);
}
