"""What was typed wrongly is said, with status 2; help is not an error."""
from lib.program import PUFF, SMALL, Case, main


class Usage(Case):
    def setUp(self):
        super().setUp()
        self.write("puff.lua", PUFF)

    def test_no_command_shows_the_usage(self):
        done = self.run_program()
        self.assertEqual(done.returncode, 2)
        self.assertIn("usage: roil", done.stderr)
        self.assertIn("Effects here: puff.lua. Begin with `roil live puff.lua`.", done.stderr)

    def test_help_and_version_are_no_errors(self):
        for word in ("--help", "-h", "help"):
            self.assertIn("render", self.succeeds(word))
        self.assertRegex(self.succeeds("--version"), r"^roil \d+\.\d+\.\d+\n$")
        for command in ("render", "check", "info", "bench", "compare"):
            self.assertIn("Usage:", self.succeeds(command, "--help"))
            self.assertIn("Usage:", self.succeeds(command, "-h"))

    def test_what_is_no_effect_is_named_as_what_it_is(self):
        self.write("shot.png", b"")
        self.write("sweep.lua", 'return sweep { effect = "puff.lua" }\n')
        for command in ("render", "check", "live"):
            self.fails(1, "pufff.lua: No such file or directory; did you mean 'puff.lua'?", command, "pufff.lua")
            self.fails(1, "none/x.lua: No such file or directory", command, "none/x.lua")
            self.fails(1, ". is a folder; an effect is a .lua file", command, ".")
            self.fails(1, ["shot.png is a picture", "--from"], command, "shot.png")
        self.fails(1, ["sweep.lua:1: unknown name 'sweep'", "`roil bench`"], "render", "sweep.lua")
        self.fails(1, ["unknown name 'effect'", "`roil render`"], "bench", "puff.lua")

    def test_info_alone_is_an_index(self):
        text = self.succeeds("info")
        for line in ("roil info passes [NAME]", "roil info params EFFECT.lua", "roil info FILE.vdb"):
            self.assertIn(line, text)

    def test_unknown_command_gets_a_suggestion(self):
        self.fails(2, ["unknown command 'rendr'", "did you mean 'render'?"], "rendr")
        self.fails(2, ["'puff.lua' is no command; `roil live puff.lua` shows an effect"], "puff.lua")
        self.fails(2, ["unknown command 'bake'",
                       "accepted: render, live, new, bundle, check, info, export, bench, tune, repro, compare"], "bake")

    def test_unknown_option_is_named(self):
        self.fails(2, "--sise", "render", "puff.lua", "--sise", "96x54")
        self.fails(2, "--quick", "check", "--quick", "puff.lua")
        self.fails(2, "--all", "info", "--all")

    def test_unknown_option_gets_a_suggestion(self):
        self.fails(2, "render: unknown option '--frams'; did you mean '--frames'?", "render", "puff.lua",
                   "--frams", "30")
        self.fails(2, "unknown option '--sise=96x54'; did you mean '--size'?", "render", "puff.lua",
                   "--sise=96x54")
        self.fails(2, "did you mean '--validate'?", "render", "puff.lua", "--validat") # of the device
        self.fails(2, "did you mean '--help'?", "check", "--hepl")
        self.fails(2, "did you mean '--preset'?", "info", "--presets", "params")
        self.fails(2, "did you mean '--max-flip'?", "compare", "--max_flip", "1")
        self.fails(2, "did you mean '--grid'?", "export", "--gird", "density")
        self.fails(2, "did you mean '--fields'?", "export", "vdb", "--field", "density")
        self.fails(2, "did you mean '--shard'?", "bench", "--shart", "1/2")
        self.fails(2, "did you mean '--max-error'?", "tune", "--max-eror", "1")
        self.fails(2, ["unknown option '--quick'", "accepted: --preset, --json, --assets, --memory, --time-limit, --help, --usage"], "check",
                   "--quick", "puff.lua")
        self.fails(2, ["unknown option '-x'", "accepted: --output, "], "compare", "-x")

    def test_option_without_its_value_is_named(self):
        self.fails(2, "--frames", "render", "puff.lua", "--frames")
        self.fails(2, "NAME FILE", "render", "puff.lua", "--dump-pass", "march")

    def test_effect_is_missing_or_one_too_many(self):
        self.fails(2, "which effect?", "render")
        self.fails(2, "which effect?", "check")
        self.fails(2, "of which effect?", "info", "params")
        self.fails(2, "one effect at a time", "render", "puff.lua", "other.lua")

    def test_bad_frames(self):
        for frames in ("", "x", "-1", "5-", "9-3", "1,,2", "1,", "0-9:0", "0-9:-1", "1e999", "nan",
                       "0-1e300", "0-1e9", "3 4", "1-2-3"):
            with self.subTest(frames):
                self.fails(2, [f"frames '{frames}'", "accepted: 30, or 10,30,50"], "render",
                           "puff.lua", "--frames", frames)

    def test_bad_size(self):
        for size in ("", "x", "96", "96x", "x54", "0x54", "96x0", "-96x54", "96x-54", "96x54x3",
                     "16385x1", "1x99999", "99999999999x1", "9.5x4", "96 54"):
            with self.subTest(size):
                self.fails(2, [f"size '{size}'", "accepted: WIDTHxHEIGHT"], "render", "puff.lua",
                           "--size", size)

    def test_bad_output(self):
        self.fails(2, "accepted: .png, .exr, .mp4, .webm", "render", "puff.lua", "-o", "out.jpg")
        self.fails(2, "accepted: .png, .exr, .mp4, .webm", "render", "puff.lua", "-o", "out")
        for pattern in ("%s.png", "%d%d.png", "%n.png", "%04x.png", "%.png", "%99999d.png", "%*d.png",
                        "%-4d.png"):
            with self.subTest(pattern):
                self.fails(2, "accepted: one number in it", "render", "puff.lua", "-o", pattern)

    def test_several_frames_need_a_pattern(self):
        self.fails(2, ["would be overwritten", "out/%04d.png"], "render", "puff.lua", "--frames",
                   "1-3", "-o", "out.png", *SMALL)

    def test_bad_setting(self):
        for text in ("thickness", "=5", ""):
            with self.subTest(text):
                self.fails(2, "accepted: NAME=VALUE", "render", "puff.lua", "--set", text)

    def test_bad_fps(self):
        self.fails(2, "many: invalid", "render", "puff.lua", "--fps", "many")

    def test_unknown_topic_of_info(self):
        self.fails(2, "did you mean 'passes'?", "info", "pases")
        self.fails(2, "accepted: device, passes [NAME]", "info", "everything")


if __name__ == "__main__":
    main()
