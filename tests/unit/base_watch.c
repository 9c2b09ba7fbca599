// Watching files: every way in which editors and tools write one is seen, once it is complete.
#include "base_test.h"

#include "base/memory.h"
#include "base/watch.h"
#include <fcntl.h>
#include <pthread.h>
#include <time.h>

typedef struct seen { // what a watch told; the test waits on it
    pthread_mutex_t mutex;
    pthread_cond_t changed;
    char paths[2048][128]; // since the last `forget`
    size_t count, settled;
} seen;

static void on_changed(void *user, const char *path, double when) {
    seen *s = user;
    pthread_mutex_lock(&s->mutex);
    assert_true(when > 0 && s->count < 2048);
    snprintf(s->paths[s->count++], sizeof *s->paths, "%s", path);
    pthread_mutex_unlock(&s->mutex);
}

static void on_settled(void *user) {
    seen *s = user;
    pthread_mutex_lock(&s->mutex);
    s->settled++;
    pthread_cond_broadcast(&s->changed);
    pthread_mutex_unlock(&s->mutex);
}

static bool knows(const seen *s, const char *path) { // with the mutex held
    for (size_t i = 0; i < s->count; i++)
        if (strcmp(s->paths[i], path) == 0) return true;
    return false;
}

// Until `path` has been reported.
static void expect(seen *s, path_text path) {
    struct timespec end;
    clock_gettime(CLOCK_REALTIME, &end);
    end.tv_sec += 10;
    int late = 0;
    pthread_mutex_lock(&s->mutex);
    while (!knows(s, path.text) && !late)
        late = pthread_cond_timedwait(&s->changed, &s->mutex, &end);
    pthread_mutex_unlock(&s->mutex);
    if (late) fail_msg("no change of %s was seen", path.text);
}

static bool has_seen(seen *s, path_text path) {
    pthread_mutex_lock(&s->mutex);
    bool known = knows(s, path.text);
    pthread_mutex_unlock(&s->mutex);
    return known;
}

static size_t count_seen(seen *s) {
    pthread_mutex_lock(&s->mutex);
    size_t count = s->count;
    pthread_mutex_unlock(&s->mutex);
    return count;
}

static void forget(seen *s) {
    pthread_mutex_lock(&s->mutex);
    s->count = s->settled = 0;
    pthread_mutex_unlock(&s->mutex);
}

static watch *open_watch(seen *s) {
    *s = (seen){.mutex = PTHREAD_MUTEX_INITIALIZER, .changed = PTHREAD_COND_INITIALIZER};
    watch *w = watch_create(&(watch_desc){on_changed, on_settled, s});
    if (!w) fail_msg("%s", err_get());
    return w;
}

static void follow(watch *w, const path_text *paths, size_t count) {
    const char **list = mem_alloc(count * sizeof *list);
    for (size_t i = 0; i < count; i++) list[i] = paths[i].text;
    if (!watch_set(w, list, count)) fail_msg("%s", err_get());
    mem_free(list);
}

// In place, as `echo >` does.
static void write_over(path_text path, const char *text) {
    int file = open(path.text, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    assert_true(file >= 0);
    assert_int_equal(write(file, text, strlen(text)), (ssize_t)strlen(text));
    close(file);
}

static seen news; // too large for a stack

static void change_is_seen_however_it_is_written(void **state) {
    path_text file = in(*state, "a.lua"), other = in(*state, "a.lua~");
    put(*state, "a.lua", "1");
    watch *w = open_watch(&news);
    follow(w, &file, 1);
    put(*state, "a.lua", "2"); // written beside it, renamed over it
    expect(&news, file);
    forget(&news);
    write_over(file, "3");
    write_over(file, "4"); // twice
    expect(&news, file);
    forget(&news);
    assert_int_equal(rename(file.text, other.text), 0); // moved away, then written anew
    expect(&news, file);
    forget(&news);
    write_over(file, "5");
    expect(&news, file);
    forget(&news);
    assert_int_equal(unlink(file.text), 0);
    expect(&news, file);
    forget(&news);
    assert_int_equal(link(other.text, file.text), 0);
    expect(&news, file);
    watch_destroy(w);
}

// The order of events is that of the writes: what is reported before the second file's change is
// all that the first one gave.
static void truncated_file_is_seen_when_it_is_closed(void **state) {
    path_text files[] = {in(*state, "slow"), in(*state, "quick")};
    put(*state, "slow", "1");
    watch *w = open_watch(&news);
    follow(w, files, 2);
    int slow = open(files[0].text, O_WRONLY | O_TRUNC | O_CLOEXEC);
    assert_true(slow >= 0);
    put(*state, "quick", "1");
    expect(&news, files[1]);
    assert_false(has_seen(&news, files[0]));
    assert_int_equal(write(slow, "2", 1), 1);
    close(slow);
    expect(&news, files[0]);
    watch_destroy(w);
}

static void file_that_is_created_is_seen_when_it_is_closed(void **state) {
    path_text files[] = {in(*state, "slow"), in(*state, "quick")};
    watch *w = open_watch(&news);
    follow(w, files, 2);
    int slow = open(files[0].text, O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
    put(*state, "quick", "1");
    expect(&news, files[1]);
    assert_false(has_seen(&news, files[0]));
    close(slow);
    expect(&news, files[0]);
    watch_destroy(w);
}

static void files_beside_it_are_not_reported(void **state) {
    path_text file = in(*state, "a"), last = in(*state, "b");
    watch *w = open_watch(&news);
    follow(w, (path_text[]){file, last}, 2);
    put(*state, "a.swp", "1");
    put(*state, "4913", "1");
    put(*state, "b", "1");
    expect(&news, last);
    assert_int_equal(count_seen(&news), 1);
    watch_destroy(w);
}

static void target_of_a_link_is_watched_too(void **state) {
    path_text shown = in(*state, "shown.lua"), target = in(*state, "real/target.lua");
    put(*state, "real/target.lua", "1");
    assert_int_equal(symlink(target.text, shown.text), 0);
    watch *w = open_watch(&news);
    follow(w, &shown, 1);
    put(*state, "real/target.lua", "2");
    expect(&news, shown);
    watch_destroy(w);
}

static void pattern_is_watched(void **state) {
    path_text pattern = in(*state, "data/*.vdb"), last = in(*state, "last");
    put(*state, "data/1.vdb", "1");
    watch *w = open_watch(&news);
    follow(w, (path_text[]){pattern, last}, 2);
    put(*state, "data/1.txt", "1");
    put(*state, "last", "1");
    expect(&news, last);
    assert_int_equal(count_seen(&news), 1);
    put(*state, "data/2.vdb", "1");
    expect(&news, pattern);
    watch_destroy(w);
}

static void list_is_replaced(void **state) {
    path_text one = in(*state, "one/a"), two = in(*state, "two/b");
    put(*state, "one/a", "1");
    put(*state, "two/b", "1");
    watch *w = open_watch(&news);
    follow(w, &one, 1);
    follow(w, &two, 1);
    put(*state, "one/a", "2");
    put(*state, "two/b", "2");
    expect(&news, two);
    assert_false(has_seen(&news, one));
    forget(&news);
    follow(w, (path_text[]){one, two}, 2);
    put(*state, "one/a", "3");
    expect(&news, one);
    watch_destroy(w);
}

static void folder_is_found_again(void **state) {
    path_text folder = in(*state, "data"), away = in(*state, "away"), file = in(*state, "data/a");
    watch *w = open_watch(&news);
    put(*state, "data/a", "1");
    follow(w, &file, 1);
    assert_int_equal(unlink(file.text), 0);
    assert_int_equal(rmdir(folder.text), 0);
    expect(&news, file);
    forget(&news);
    put(*state, "data/a", "2"); // makes the folder
    expect(&news, file);
    forget(&news);
    assert_int_equal(rename(folder.text, away.text), 0);
    expect(&news, file);
    forget(&news);
    put(*state, "away/a", "of no interest any more");
    assert_int_equal(rename(away.text, folder.text), 0);
    expect(&news, file);
    forget(&news);
    put(*state, "data/a", "3");
    expect(&news, file);
    watch_destroy(w);
}

static void folders_above_may_be_missing_too(void **state) {
    path_text file = in(*state, "a/b/c/file");
    watch *w = open_watch(&news);
    follow(w, &file, 1);
    put(*state, "a/b/c/file", "1");
    expect(&news, file);
    forget(&news);
    put(*state, "a/b/c/file", "2");
    expect(&news, file);
    watch_destroy(w);
}

static void folder_of_a_thousand_files(void **state) {
    enum { COUNT = 1000 };
    path_text *files = mem_alloc(COUNT * sizeof *files);
    for (int i = 0; i < COUNT; i++) {
        char name[32];
        snprintf(name, sizeof name, "data/%04d.vdb", i);
        files[i] = in(*state, name);
        put(*state, "data/made", "");
        write_over(files[i], "1");
    }
    watch *w = open_watch(&news);
    follow(w, files, COUNT);
    for (int i = 0; i < COUNT; i++) write_over(files[i], "2");
    for (int i = 0; i < COUNT; i++) expect(&news, files[i]);
    watch_destroy(w);
    mem_free(files);
}

static void catching_up_reports_at_once(void **state) {
    path_text file = in(*state, "a");
    watch *w = open_watch(&news);
    follow(w, &file, 1);
    for (size_t i = 1; i <= 100; i++) {
        put(*state, "a", "1");
        watch_catch_up(w);
        assert_int_equal(count_seen(&news), i);
    }
    watch_destroy(w);
}

typedef struct reply { // calls watch_set from `changed`
    seen *news;
    watch *watch;
    const char *other;
} reply;

static void on_changed_follow(void *user, const char *path, double when) {
    reply *r = user;
    on_changed(r->news, path, when);
    watch_set(r->watch, &r->other, 1);
}

static void on_settled_reply(void *user) {
    on_settled(((reply *)user)->news);
}

static void list_may_be_set_by_the_callback(void **state) {
    path_text first = in(*state, "first"), second = in(*state, "second");
    news = (seen){.mutex = PTHREAD_MUTEX_INITIALIZER, .changed = PTHREAD_COND_INITIALIZER};
    reply r = {.news = &news, .other = second.text};
    r.watch = watch_create(&(watch_desc){on_changed_follow, on_settled_reply, &r});
    follow(r.watch, &first, 1);
    put(*state, "first", "1");
    expect(&news, first);
    put(*state, "second", "1");
    expect(&news, second);
    watch_destroy(r.watch);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        SCRATCH_TEST(change_is_seen_however_it_is_written),
        SCRATCH_TEST(truncated_file_is_seen_when_it_is_closed),
        SCRATCH_TEST(file_that_is_created_is_seen_when_it_is_closed),
        SCRATCH_TEST(files_beside_it_are_not_reported),
        SCRATCH_TEST(target_of_a_link_is_watched_too),
        SCRATCH_TEST(pattern_is_watched),
        SCRATCH_TEST(list_is_replaced),
        SCRATCH_TEST(folder_is_found_again),
        SCRATCH_TEST(folders_above_may_be_missing_too),
        SCRATCH_TEST(folder_of_a_thousand_files),
        SCRATCH_TEST(catching_up_reports_at_once),
        SCRATCH_TEST(list_may_be_set_by_the_callback),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
