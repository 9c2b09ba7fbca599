// Pictures from files: image "templates/source.exr". The function that takes one says what its
// numbers mean.
#include "media/picture.h"
#include "script/binding.h"
#include <string.h>

enum { SIDE_MAX = 4096 };

const picture_object *value_picture(lua_State *L, int index) {
    return object_test(L, index, "picture");
}

// image { "templates/source.exr" }, or image "templates/source.exr".
int l_image(lua_State *L) {
    script_require_loading(L, "image");
    if (value_is_plain_table(L, 1)) {
        value_check_keys(L, 1, "image", NULL, 0);
        if (lua_rawlen(L, 1) == 1) lua_rawgeti(L, 1, 1);
    }
    size_t length;
    if (lua_type(L, -1) != LUA_TSTRING)
        vm_error(L, "image takes a file, as in image \"templates/source.exr\"; got %s",
                 object_kind(L, -1));
    const char *file = lua_tolstring(L, -1, &length);
    if (strlen(file) != length) vm_error(L, "image: the file name contains a zero byte");
    vm_charge_memory(L, length + 1);
    picture_object *object = object_new(L, "picture", sizeof *object);
    object->pass = NULL;
    object->file = arena_string(script_memory(L), file);
    object->picture = effect_read_picture(script_of(L)->effect, file, SIDE_MAX);
    if (!object->picture) script_raise(L);
    vm_charge_memory(L, 4 * sizeof(float) * object->picture->width * object->picture->height);
    return 1;
}
