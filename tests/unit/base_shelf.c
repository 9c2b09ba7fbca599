// The shelf: what is held is shared while its files stay the same.
#include "base_test.h"

#include "base/memory.h"
#include "base/shelf.h"

static int64_t later; // no file has changed since then

static shelf_item *put_text(shelf *s, const char *key, const char *text, const char *file) {
    arena memory = {0};
    const char *copy = arena_string(&memory, text);
    return shelf_put(s, key, copy, memory, &file, 1, later);
}

static void held_thing_is_shared(void **state) {
    put(*state, "a", "1");
    later = file_clock_ns() + 1000000000;
    path_text file = in(*state, "a");
    shelf *s = shelf_create();
    shelf_item *item = put_text(s, "key", "text", file.text);
    assert_ptr_equal(shelf_take(s, "key"), item);
    assert_string_equal(item->data, "text");
    assert_null(shelf_take(s, "other"));
    shelf_release(s, item);
    assert_ptr_equal(shelf_take(s, "key"), item); // still held once
    shelf_release(s, item);
    shelf_release(s, item);
    assert_null(shelf_take(s, "key")); // nobody holds it
    shelf_release(s, NULL);
    shelf_destroy(s);
}

static void changed_file_makes_it_stale(void **state) {
    put(*state, "a", "1");
    later = file_clock_ns() + 1000000000;
    path_text file = in(*state, "a");
    shelf *s = shelf_create();
    shelf_item *old = put_text(s, "key", "old", file.text);
    put(*state, "a", "2"); // as long as before; another file by rename
    assert_null(shelf_take(s, "key"));
    shelf_item *fresh = put_text(s, "key", "new", file.text);
    assert_ptr_equal(shelf_take(s, "key"), fresh);
    assert_string_equal(old->data, "old"); // its holder has it still
    shelf_release(s, old);
    shelf_release(s, fresh);
    assert_int_equal(unlink(file.text), 0);
    assert_null(shelf_take(s, "key"));
    shelf_release(s, fresh);
    shelf_destroy(s);
}

static void file_that_may_have_changed_while_it_was_read_is_not_trusted(void **state) {
    path_text file = in(*state, "a");
    shelf *s = shelf_create();
    later = file_clock_ns();
    put(*state, "a", "1");
    shelf_item *item = put_text(s, "key", "text", file.text);
    assert_null(shelf_take(s, "key"));
    shelf_release(s, item);
    shelf_destroy(s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        SCRATCH_TEST(held_thing_is_shared),
        SCRATCH_TEST(changed_file_makes_it_stale),
        SCRATCH_TEST(file_that_may_have_changed_while_it_was_read_is_not_trusted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
