// Paths as text, and the fence around an effect's folder.
#include "base_test.h"

#include <errno.h>

static void parts_of_a_path_are_found(void **state) {
    (void)state;
    static const struct {
        const char *path, *folder, *name, *extension;
    } cases[] = {
        {"a/b.c", "a", "b.c", "c"},
        {"b.c", ".", "b.c", "c"},
        {"/b", "/", "b", ""},
        {"a/b.tar.gz", "a", "b.tar.gz", "gz"},
        {"a.b/c", "a.b", "c", ""},
        {".hidden", ".", ".hidden", ""},
        {"a/.hidden", "a", ".hidden", ""},
        {"a.", ".", "a.", ""},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char folder[PATH_CAP];
        path_folder(folder, cases[i].path);
        assert_string_equal(folder, cases[i].folder);
        assert_string_equal(path_name(cases[i].path), cases[i].name);
        assert_string_equal(path_extension(cases[i].path), cases[i].extension);
    }
}

static void absolute_name_wins_a_join(void **state) {
    (void)state;
    char out[PATH_CAP], longest[PATH_CAP];
    assert_true(path_join(out, "a", "b"));
    assert_string_equal(out, "a/b");
    assert_true(path_join(out, "", "b"));
    assert_string_equal(out, "b");
    assert_true(path_join(out, "a", "/b"));
    assert_string_equal(out, "/b");
    memset(longest, 'a', sizeof longest - 1);
    longest[sizeof longest - 1] = '\0';
    assert_true(path_join(out, "", longest));
    assert_false(path_join(out, "a", longest));
    assert_message("too long");
}

static void stays(const char *root, const char *name, const char *expected) {
    char out[PATH_CAP];
    if (!path_confine(out, root, name)) fail_msg("%s", err_get());
    assert_string_equal(out, in(root, expected).text);
}

static void leaves(const char *root, const char *name, const char *reason) {
    char out[PATH_CAP];
    err_clear();
    if (path_confine(out, root, name)) fail_msg("%s was let through as %s", name, out);
    assert_message(reason);
}

static void names_inside_are_accepted(void **state) {
    put(*state, "data/a.vdb", "");
    stays(*state, "data/a.vdb", "data/a.vdb");
    stays(*state, "./data/.//a.vdb", "data/a.vdb");
    stays(*state, "data", "data");
    stays(*state, "data/none.vdb", "data/none.vdb");     // may be made later
    stays(*state, "none/deep/x.vdb", "none/deep/x.vdb"); // with its folders
    stays(*state, "data/*.vdb", "data/*.vdb");
    stays(*state, "..a/b..", "..a/b.."); // dots are fine inside a name
}

static void names_outside_are_refused(void **state) {
    leaves(*state, "", "empty");
    leaves(*state, "/etc/passwd", "leads out");
    leaves(*state, "..", "leads out");
    leaves(*state, "../a", "leads out");
    leaves(*state, "a/../../b", "leads out");
    leaves(*state, "a//..//../b", "leads out");
    leaves(*state, "a/..", "leads out");
    leaves(in(*state, "none").text, "a", "No such file");
}

static void links_are_followed(void **state) {
    path_text root = in(*state, "root");
    put(*state, "root/data/a.vdb", "");
    put(*state, "outside/secret", "");
    put(*state, "root2/secret", "");
    assert_int_equal(symlink("data", in(root.text, "inner").text), 0);
    assert_int_equal(symlink("../outside", in(root.text, "folder").text), 0);
    assert_int_equal(symlink(in(*state, "outside/secret").text, in(root.text, "file").text), 0);
    assert_int_equal(symlink("../root2", in(root.text, "sibling").text), 0);
    stays(root.text, "inner/a.vdb", "data/a.vdb");
    leaves(root.text, "file", "leads out");
    leaves(root.text, "folder", "leads out");
    leaves(root.text, "folder/secret", "leads out");
    leaves(root.text, "folder/none", "leads out");
    leaves(root.text, "folder/*.vdb", "leads out");
    leaves(root.text, "sibling/secret", "leads out"); // "root" is only the beginning of "root2"
}

static void existing_files_are_told_inside_from_outside(void **state) {
    path_text root = in(*state, "root");
    put(*state, "root/data/a", "");
    put(*state, "root2/a", "");
    assert_int_equal(symlink("data/a", in(root.text, "inner").text), 0);
    assert_int_equal(symlink("../root2/a", in(root.text, "outer").text), 0);
    assert_int_equal(symlink("outer", in(root.text, "twice").text), 0);
    assert_true(path_require_inside(root.text, in(root.text, "data/a").text));
    assert_true(path_require_inside(root.text, in(root.text, "data/../inner").text));
    assert_true(path_require_inside("/", in(root.text, "outer").text));
    assert_false(path_require_inside(root.text, in(root.text, "outer").text));
    assert_message("leads out");
    assert_false(path_require_inside(root.text, in(root.text, "twice").text));
    assert_false(path_require_inside(root.text, in(*state, "root2/a").text));
    assert_false(path_require_inside(root.text, in(root.text, "none").text));
    assert_message("No such file");
}

static void broken_links_are_refused(void **state) {
    put(*state, "root/a", "");
    path_text root = in(*state, "root");
    assert_int_equal(symlink("../not-yet", in(root.text, "link").text), 0);
    leaves(root.text, "link", "broken link");
    leaves(root.text, "link/a", "broken link");
}

static void loops_of_links_are_refused(void **state) {
    assert_int_equal(symlink("b", in(*state, "a").text), 0);
    assert_int_equal(symlink("a", in(*state, "b").text), 0);
    leaves(*state, "a", "symbolic links");
    leaves(*state, "a/x", "symbolic links");
}

static void root_may_be_a_link_or_the_top(void **state) {
    put(*state, "real/a", "");
    path_text link = in(*state, "link");
    char out[PATH_CAP];
    assert_int_equal(symlink("real", link.text), 0);
    assert_true(path_confine(out, link.text, "a"));
    assert_string_equal(out, in(*state, "real/a").text);
    assert_true(path_confine(out, "/", (const char *)*state + 1));
    assert_string_equal(out, *state);
}

static void overlong_names_are_refused(void **state) {
    char name[2 * PATH_CAP];
    memset(name, 'a', sizeof name - 1);
    name[sizeof name - 1] = '\0';
    leaves(*state, name, "too long");
    name[300] = '\0'; // a component beyond what file systems take
    leaves(*state, name, "too long");
}

static void cache_folder_follows_the_environment(void **state) {
    char out[PATH_CAP];
    path_text own = in(*state, "own"), xdg = in(*state, "xdg"), home = in(*state, "home");
    setenv("ROIL_CACHE_DIR", own.text, 1);
    setenv("XDG_CACHE_HOME", xdg.text, 1);
    setenv("HOME", home.text, 1);
    assert_true(path_cache_folder(out, "spirv"));
    assert_string_equal(out, in(*state, "own/spirv").text);
    assert_true(file_is_folder(out));
    unsetenv("ROIL_CACHE_DIR");
    assert_true(path_cache_folder(out, "spirv"));
    assert_string_equal(out, in(*state, "xdg/roil/spirv").text);
    setenv("XDG_CACHE_HOME", "relative", 1); // the specification says: ignore it
    assert_true(path_cache_folder(out, "spirv"));
    assert_string_equal(out, in(*state, "home/.cache/roil/spirv").text);
    unsetenv("XDG_CACHE_HOME");
    unsetenv("HOME");
    assert_false(path_cache_folder(out, "spirv"));
    assert_message("ROIL_CACHE_DIR");
}

static void program_folder_holds_the_program(void **state) {
    (void)state;
    char folder[PATH_CAP];
    assert_true(path_own_folder(folder));
    assert_true(file_exists(in(folder, program_invocation_short_name).text));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parts_of_a_path_are_found),
        cmocka_unit_test(absolute_name_wins_a_join),
        SCRATCH_TEST(names_inside_are_accepted),
        SCRATCH_TEST(names_outside_are_refused),
        SCRATCH_TEST(links_are_followed),
        SCRATCH_TEST(existing_files_are_told_inside_from_outside),
        SCRATCH_TEST(broken_links_are_refused),
        SCRATCH_TEST(loops_of_links_are_refused),
        SCRATCH_TEST(root_may_be_a_link_or_the_top),
        SCRATCH_TEST(overlong_names_are_refused),
        SCRATCH_TEST(cache_folder_follows_the_environment),
        cmocka_unit_test(program_folder_holds_the_program),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
