// Recipes of pictures, for the public interface.
#include "effect/recipe.h"
#include "base/error.h"
#include "base/memory.h"
#include "roil/roil_impl.h"

typedef struct owned_recipe { // a roil_recipe first: what roil_read_recipe gives
    roil_recipe recipe;
    arena memory;
} owned_recipe;

static bool read_recipe(const char *png, arena *memory, recipe *out) {
    png_text texts[PNG_MAX_TEXTS];
    size_t count;
    if (!png_read_texts(png, memory, texts, &count)) return false;
    return recipe_read(texts, count, memory, out) || err_prefix("%s: ", png);
}

static roil_recipe *recipe_of(const char *png) {
    owned_recipe *own = mem_alloc(sizeof *own);
    recipe found;
    if (!read_recipe(png, &own->memory, &found)) {
        roil_free_recipe(&own->recipe);
        return NULL;
    }
    roil_setting *settings = arena_alloc(&own->memory, found.setting_count * sizeof *settings);
    for (size_t i = 0; i < found.setting_count; i++)
        settings[i] = (roil_setting){found.settings[i].name, found.settings[i].text};
    own->recipe = (roil_recipe){.effect = found.file,
                                .frame = found.frame,
                                .width = found.width,
                                .height = found.height,
                                .settings = settings,
                                .setting_count = found.setting_count};
    return &own->recipe;
}

roil_recipe *roil_read_recipe(const char *png) {
    RETURN_MADE(roil_recipe, recipe_of(png), roil_free_recipe(made));
}

void roil_free_recipe(roil_recipe *r) {
    if (!r) return;
    owned_recipe *own = (owned_recipe *)r;
    arena_free(&own->memory);
    mem_free(own);
}
