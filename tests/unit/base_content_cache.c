// The content cache: what is held is shared while its files stay the same.
#include "base_test.h"

#include "base/content_cache.h"
#include "base/memory.h"

static int64_t later; // no file has changed since then

static content_cache_item *put_text(content_cache *s, const char *key, const char *text,
                                    const char *file) {
    arena memory = {0};
    const char *copy = arena_string(&memory, text);
    return content_cache_put(s, key, copy, memory, &file, 1, later);
}

static void held_thing_is_shared(void **state) {
    put(*state, "a", "1");
    later = file_clock_ns() + 1000000000;
    path_text file = in(*state, "a");
    content_cache *s = content_cache_create();
    content_cache_item *item = put_text(s, "key", "text", file.text);
    assert_ptr_equal(content_cache_take(s, "key"), item);
    assert_string_equal(item->data, "text");
    assert_null(content_cache_take(s, "other"));
    content_cache_release(s, item);
    assert_ptr_equal(content_cache_take(s, "key"), item); // still held once
    content_cache_release(s, item);
    content_cache_release(s, item);
    assert_null(content_cache_take(s, "key")); // nobody holds it
    content_cache_release(s, NULL);
    content_cache_destroy(s);
}

static void changed_file_makes_it_stale(void **state) {
    put(*state, "a", "1");
    later = file_clock_ns() + 1000000000;
    path_text file = in(*state, "a");
    content_cache *s = content_cache_create();
    content_cache_item *old = put_text(s, "key", "old", file.text);
    put(*state, "a", "2"); // as long as before; another file by rename
    assert_null(content_cache_take(s, "key"));
    content_cache_item *fresh = put_text(s, "key", "new", file.text);
    assert_ptr_equal(content_cache_take(s, "key"), fresh);
    assert_string_equal(old->data, "old"); // its holder has it still
    content_cache_release(s, old);
    content_cache_release(s, fresh);
    assert_int_equal(unlink(file.text), 0);
    assert_null(content_cache_take(s, "key"));
    content_cache_release(s, fresh);
    content_cache_destroy(s);
}

static void file_that_may_have_changed_while_it_was_read_is_not_trusted(void **state) {
    path_text file = in(*state, "a");
    content_cache *s = content_cache_create();
    later = file_clock_ns();
    put(*state, "a", "1");
    content_cache_item *item = put_text(s, "key", "text", file.text);
    assert_null(content_cache_take(s, "key"));
    content_cache_release(s, item);
    content_cache_destroy(s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        SCRATCH_TEST(held_thing_is_shared),
        SCRATCH_TEST(changed_file_makes_it_stale),
        SCRATCH_TEST(file_that_may_have_changed_while_it_was_read_is_not_trusted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
