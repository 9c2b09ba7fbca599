// Whole files: read with a limit, written all or not at all, listed in order.
#include "base_test.h"

#include "base/memory.h"
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <sys/resource.h>
#include <sys/wait.h>

static void assert_content(const char *path, const char *expected) {
    void *data = NULL;
    size_t size = 0;
    if (!file_read(path, 1 << 20, &data, &size)) fail_msg("%s", err_get());
    assert_int_equal(size, strlen(expected));
    assert_string_equal((const char *)data, expected); // the NUL that follows is there
    mem_free(data);
}

// How many names the folder holds: no temporary file may stay behind.
static size_t names_in(const char *folder) {
    file_list all;
    assert_true(file_glob(in(folder, "*").text, &all));
    size_t count = all.count;
    file_list_free(&all);
    assert_true(file_glob(in(folder, ".roil-*").text, &all)); // drafts
    count += all.count;
    file_list_free(&all);
    return count;
}

static void refuses_to_read(const char *path, size_t max, const char *reason) {
    void *data = NULL;
    size_t size = 99;
    err_clear();
    assert_false(file_read(path, max, &data, &size));
    assert_null(data);
    assert_message(path);
    assert_message(reason);
}

static void what_is_written_is_read(void **state) {
    path_text path = in(*state, "a.txt");
    put(*state, "a.txt", "first");
    assert_content(path.text, "first");
    put(*state, "a.txt", "the second, longer");
    assert_content(path.text, "the second, longer");
    put(*state, "a.txt", "");
    assert_content(path.text, "");
    assert_int_equal(names_in(*state), 1);
}

static void new_files_obey_the_mask(void **state) {
    struct stat info;
    mode_t before = umask(027);
    put(*state, "a", "1");
    umask(before);
    assert_int_equal(stat(in(*state, "a").text, &info), 0);
    assert_int_equal(info.st_mode & 0777, 0640);
}

static void size_limit_is_exact(void **state) {
    path_text path = in(*state, "a");
    void *data;
    size_t size;
    put(*state, "a", "12345");
    assert_true(file_read(path.text, 5, &data, &size));
    assert_int_equal(size, 5);
    mem_free(data);
    refuses_to_read(path.text, 4, "5 bytes, more than the 4 accepted");
}

static void only_regular_files_are_read(void **state) {
    path_text pipe = in(*state, "pipe");
    assert_int_equal(mkfifo(pipe.text, 0600), 0);
    refuses_to_read(pipe.text, 100, "not a regular file"); // and does not wait for a writer
    refuses_to_read(*state, 100, "not a regular file");
    refuses_to_read("/dev/zero", 100, "not a regular file");
    refuses_to_read(in(*state, "none").text, 100, "No such file");
}

static void write_errors_name_the_file(void **state) {
    path_text path = in(*state, "none/a");
    assert_false(file_write(path.text, "1", 1));
    assert_message(path.text);
    assert_message("No such file");
    assert_false(file_write(*state, "1", 1));
    assert_message("is a folder");
    put(*state, "file", "1");
    assert_false(file_write(in(*state, "file/below").text, "1", 1));
    assert_message("Not a directory");
    char longest[PATH_CAP];
    memset(longest, 'a', sizeof longest - 1);
    longest[sizeof longest - 1] = '\0';
    assert_false(file_write(longest, "1", 1));
    assert_message("too long");
}

static void devices_are_written_in_place(void **state) {
    (void)state;
    assert_true(file_write("/dev/null", "1", 1));
    struct stat info;
    assert_int_equal(stat("/dev/null", &info), 0);
    assert_true(S_ISCHR(info.st_mode)); // not replaced by a file
    if (!file_exists("/dev/full")) return;
    assert_false(file_write("/dev/full", "1", 1));
    assert_message("/dev/full: No space left");
}

// A child may not write files beyond 4 KiB; what it finds is its exit status.
static int write_on_a_full_disk(const char *path) {
    static char data[16384];
    signal(SIGXFSZ, SIG_IGN);
    struct rlimit limit = {4096, 4096};
    if (setrlimit(RLIMIT_FSIZE, &limit) != 0) return 10;
    if (file_write(path, data, sizeof data)) return 11;
    return strstr(err_get(), path) && strstr(err_get(), "cannot be written: File too large") ? 0
                                                                                             : 12;
}

static void full_disk_keeps_the_old_file(void **state) {
    path_text path = in(*state, "a");
    put(*state, "a", "old");
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) _exit(write_on_a_full_disk(path.text));
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), 0);
    assert_content(path.text, "old");
    assert_int_equal(names_in(*state), 1);
}

static void a_draft_appears_when_it_is_whole(void **state) {
    path_text path = in(*state, "a");
    file_draft draft;
    put(*state, "a", "old");
    assert_true(file_draft_begin(&draft, path.text));
    file_draft_add(&draft, "....,", 5);
    file_draft_add(&draft, "world", 5);
    file_draft_patch(&draft, 0, "hell", 4);
    file_draft_add(&draft, "!", 1);
    assert_content(path.text, "old");
    assert_true(file_draft_end(&draft));
    assert_content(path.text, "hell,world!");
    assert_true(file_draft_begin(&draft, path.text));
    file_draft_add(&draft, "new", 3);
    file_draft_drop(&draft);
    assert_content(path.text, "hell,world!");
    assert_int_equal(names_in(*state), 1);
    assert_false(file_draft_begin(&draft, "/dev/null"));
    assert_message("/dev/null: is no regular file");
}

static int write_without_permission(const char *folder) {
    if (chmod(folder, 0555) != 0) return 10;
    if (geteuid() == 0 && (setgid(65534) != 0 || setuid(65534) != 0)) return 11; // root may all
    char path[PATH_CAP];
    if (!path_join(path, folder, "a")) return 12;
    if (file_write(path, "1", 1)) return 13;
    return strstr(err_get(), "cannot be written: Permission denied") ? 0 : 14;
}

static void unwritable_folder_is_an_error(void **state) {
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) _exit(write_without_permission(*state));
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(chmod(*state, 0755), 0);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), 0);
    assert_int_equal(names_in(*state), 0);
}

static void folders_are_made_on_demand(void **state) {
    path_text deep = in(*state, "a/b//c/");
    assert_true(file_make_folders(deep.text));
    assert_true(file_make_folders(deep.text)); // again
    assert_true(file_is_folder(in(*state, "a/b/c").text));
    assert_true(file_make_parent_folders(in(*state, "x/y/file").text));
    assert_true(file_is_folder(in(*state, "x/y").text));
    assert_false(file_exists(in(*state, "x/y/file").text));
    assert_true(file_make_parent_folders("file"));
    put(*state, "file", "1");
    assert_false(file_make_folders(in(*state, "file").text));
    assert_message("not a folder");
    assert_false(file_make_folders(in(*state, "file/below").text));
    assert_message("Not a directory");
    assert_false(file_make_folders(""));
    assert_message("empty");
}

static void change_of_a_file_is_seen(void **state) {
    path_text path = in(*state, "a");
    const int64_t before = file_clock_ns(), later = before + 1000000000;
    assert_int_equal(file_changed_ns(path.text), 0);
    put(*state, "a", "1");
    assert_true(file_changed_ns(path.text) >= before);
    file_stamp stamp = file_stamp_of(path.text, later);
    assert_true(file_stamp_holds(&stamp, path.text));
    struct timespec times[2] = {{1000, 7}, {1000, 7}}; // written to, and as long as before
    assert_int_equal(utimensat(AT_FDCWD, path.text, times, 0), 0);
    assert_false(file_stamp_holds(&stamp, path.text));
    stamp = file_stamp_of(path.text, before); // it changed while it was read
    assert_false(file_stamp_holds(&stamp, path.text));
    stamp = file_stamp_of(path.text, later);
    put(*state, "a", "1"); // another file of that name
    assert_false(file_stamp_holds(&stamp, path.text));
    assert_int_equal(unlink(path.text), 0);
    assert_false(file_stamp_holds(&stamp, path.text));
    stamp = file_stamp_of(path.text, later);
    assert_false(file_stamp_holds(&stamp, path.text));
}

static void assert_matches(const char *folder, const char *pattern, const char *expected) {
    file_list found;
    char names[1000] = "";
    if (!file_glob(in(folder, pattern).text, &found)) fail_msg("%s", err_get());
    for (size_t i = 0; i < found.count; i++) {
        assert_memory_equal(found.paths[i], folder, strlen(folder));
        strcat(strcat(names, found.paths[i] + strlen(folder) + 1), " ");
    }
    assert_string_equal(names, expected);
    file_list_free(&found);
    assert_int_equal(found.count, 0);
}

static void matches_come_in_order_of_their_bytes(void **state) {
    const char *const names[] = {"b10.vdb", "b2.vdb", "B1.vdb", "\xc3\xa4.vdb", "a.vdb",
                                 "a-b.vdb", "a_.vdb", ".h.vdb", "a.obj",        "sub/a.vdb"};
    for (size_t i = 0; i < COUNT_OF(names); i++) put(*state, names[i], "");
    assert_matches(*state, "*.vdb", "B1.vdb a-b.vdb a.vdb a_.vdb b10.vdb b2.vdb \xc3\xa4.vdb ");
    assert_matches(*state, "b?.vdb", "b2.vdb ");
    assert_matches(*state, "[aB]?*.vdb", "B1.vdb a-b.vdb a_.vdb ");
    assert_matches(*state, "sub/*", "sub/a.vdb ");
    assert_matches(*state, "a.vdb", "a.vdb ");
    assert_matches(*state, "*.png", "");
    assert_matches(*state, "none/*.vdb", "");
    assert_matches(*state, "a.vdb/*", "");
}

static void wildcards_work_in_the_last_component_only(void **state) {
    put(*state, "[1] *x/a.vdb", ""); // a folder that only looks like a pattern
    put(*state, "[1] *x/b[1].vdb", "");
    put(*state, "[1] *x/b1.vdb", "");
    assert_matches(*state, "[1] *x/a*", "[1] *x/a.vdb ");
    assert_matches(*state, "[1] *x/b[1].vdb", "[1] *x/b[1].vdb ");
    file_list found;
    assert_false(file_glob(in(*state, "?/a.vdb").text, &found));
    assert_message("last component only");
}

static void long_listing_is_sorted(void **state) {
    for (int i = 0; i < 500; i++) {
        char name[32];
        snprintf(name, sizeof name, "%04d.vdb", i * 7919 % 500);
        put(*state, name, "");
    }
    file_list found;
    assert_true(file_glob(in(*state, "*.vdb").text, &found));
    assert_int_equal(found.count, 500);
    for (size_t i = 1; i < found.count; i++)
        assert_true(strcmp(found.paths[i - 1], found.paths[i]) < 0);
    file_list_free(&found);
}

// ---- files that a file names -------------------------------------------------------------------

static bool reads_inside(const char *folder, const char *name) {
    void *data;
    size_t size;
    bool done = file_read_inside(in(folder, "root").text, in(folder, name).text, 99, &data, &size);
    if (done) mem_free(data);
    return done;
}

static bool writes_inside(const char *folder, const char *name) {
    return file_write_inside(in(folder, "root").text, in(folder, name).text, "new", 3);
}

static void link_to(const char *folder, const char *to, const char *name) {
    assert_int_equal(symlink(to, in(folder, name).text), 0);
}

static void make_places(const char *folder) {
    put(folder, "root/a.txt", "inside");
    put(folder, "root/sub/b.txt", "inside");
    put(folder, "out/secret.txt", "outside");
    link_to(folder, "sub/b.txt", "root/near.txt");
    link_to(folder, in(folder, "root/sub").text, "root/near");
    link_to(folder, "../out/secret.txt", "root/far.txt");
    link_to(folder, in(folder, "out").text, "root/far");
    link_to(folder, "../out/none.txt", "root/broken.txt");
    link_to(folder, "/dev/null", "root/device");
    assert_int_equal(mkfifo(in(folder, "root/pipe").text, 0600), 0);
}

static void only_what_lies_inside_is_read(void **state) {
    make_places(*state);
    assert_true(reads_inside(*state, "root/a.txt"));
    assert_true(reads_inside(*state, "root/near.txt"));
    assert_true(reads_inside(*state, "root/near/b.txt"));
    assert_true(reads_inside(*state, "root/sub/../a.txt"));
    static const char *const refused[] = {"out/secret.txt",
                                          "root/../out/secret.txt",
                                          "root/far.txt",
                                          "root/far/secret.txt",
                                          "root/broken.txt",
                                          "root/device",
                                          "root/pipe",
                                          "root/sub",
                                          "root",
                                          "root/none.txt",
                                          "root/no/../../a.txt",
                                          "root2"};
    for (size_t i = 0; i < COUNT_OF(refused); i++) {
        err_clear();
        if (reads_inside(*state, refused[i])) fail_msg("%s was read", refused[i]);
        assert_true(err_get()[0]);
    }
}

static void only_what_lies_inside_is_written(void **state) {
    make_places(*state);
    assert_true(writes_inside(*state, "root/a.txt"));
    assert_content(in(*state, "root/a.txt").text, "new");
    assert_true(writes_inside(*state, "root/near/c.txt"));
    assert_content(in(*state, "root/sub/c.txt").text, "new");
    assert_true(writes_inside(*state, "root/made/on/demand.txt"));
    assert_content(in(*state, "root/made/on/demand.txt").text, "new");
    static const char *const refused[] = {"out/new.txt",     "root/../out/new.txt",
                                          "root/far.txt",    "root/far/new.txt",
                                          "root/broken.txt", "root/near.txt",
                                          "root/device",     "root/pipe",
                                          "root/sub",        "root/no/../../out/new.txt"};
    for (size_t i = 0; i < COUNT_OF(refused); i++)
        if (writes_inside(*state, refused[i])) fail_msg("%s was written", refused[i]);
    assert_int_equal(names_in(in(*state, "out").text), 1);
    assert_content(in(*state, "out/secret.txt").text, "outside");
    assert_content(in(*state, "root/sub/b.txt").text, "inside");
}

static void no_root_is_anywhere(void **state) {
    make_places(*state);
    size_t size;
    int fd = file_open_inside(NULL, in(*state, "root/far.txt").text, 100, &size);
    assert_true(fd >= 0);
    close(fd);
    assert_int_equal(file_open_inside(NULL, in(*state, "root/pipe").text, 100, &size), -1);
}

typedef struct swapper {
    path_text place, folder, link;
    atomic_bool stop;
} swapper;

// The folder is now there, now a link that leads out.
static void *swap(void *user) {
    swapper *s = user;
    while (!atomic_load(&s->stop)) {
        rename(s->place.text, s->folder.text);
        rename(s->link.text, s->place.text);
        rename(s->place.text, s->link.text);
        rename(s->folder.text, s->place.text);
    }
    return NULL;
}

static void a_folder_that_becomes_a_link_leads_nowhere(void **state) {
    pthread_t thread;
    swapper s = {in(*state, "root/sub"), in(*state, "aside"), in(*state, "link"), false};
    path_text root = in(*state, "root"), target = in(*state, "root/sub/secret.txt");
    make_places(*state);
    put(*state, "root/sub/secret.txt", "inside");
    link_to(*state, in(*state, "out").text, "link");
    assert_int_equal(pthread_create(&thread, NULL, swap, &s), 0);
    size_t read = 0;
    for (int i = 0; i < 4000; i++) {
        void *data;
        size_t size;
        if (i % 8 == 0) file_write_inside(root.text, target.text, "inside", 6);
        if (!file_read_inside(root.text, target.text, 99, &data, &size)) continue;
        assert_string_equal((const char *)data, "inside");
        mem_free(data);
        read++;
    }
    atomic_store(&s.stop, true);
    pthread_join(thread, NULL);
    assert_true(read > 0);
    assert_content(in(*state, "out/secret.txt").text, "outside");
}

static void a_process_that_is_killed_leaves_no_draft(void **state) {
    path_text path = in(*state, "a.txt");
    pid_t child = fork();
    if (child == 0) {
        file_draft draft;
        if (file_draft_begin(&draft, path.text)) file_draft_add(&draft, "half", 4);
        raise(SIGKILL);
    }
    assert_int_equal(waitpid(child, NULL, 0), child);
    assert_int_equal(names_in(*state), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        SCRATCH_TEST(what_is_written_is_read),
        SCRATCH_TEST(new_files_obey_the_mask),
        SCRATCH_TEST(size_limit_is_exact),
        SCRATCH_TEST(only_regular_files_are_read),
        SCRATCH_TEST(write_errors_name_the_file),
        SCRATCH_TEST(devices_are_written_in_place),
        SCRATCH_TEST(full_disk_keeps_the_old_file),
        SCRATCH_TEST(a_draft_appears_when_it_is_whole),
        SCRATCH_TEST(unwritable_folder_is_an_error),
        SCRATCH_TEST(folders_are_made_on_demand),
        SCRATCH_TEST(change_of_a_file_is_seen),
        SCRATCH_TEST(matches_come_in_order_of_their_bytes),
        SCRATCH_TEST(wildcards_work_in_the_last_component_only),
        SCRATCH_TEST(long_listing_is_sorted),
        SCRATCH_TEST(only_what_lies_inside_is_read),
        SCRATCH_TEST(only_what_lies_inside_is_written),
        SCRATCH_TEST(no_root_is_anywhere),
        SCRATCH_TEST(a_folder_that_becomes_a_link_leads_nowhere),
        SCRATCH_TEST(a_process_that_is_killed_leaves_no_draft),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
