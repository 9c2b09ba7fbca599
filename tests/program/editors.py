"""What editors read: the reference as JSON and as annotations for lua-language-server, errors with line and
column, and luacheck's list of words. All are held against what effects really see."""
import json
import os
import re
import shutil
import subprocess

from lib.program import PUFF, SOURCE, Case, main

# What Lua itself has in the sandbox.
LUA = set("_G _VERSION assert error getmetatable ipairs math next pairs pcall print rawequal rawget rawlen rawset require "
          "select setmetatable string table tonumber tostring type utf8 warn xpcall".split())
LISTS = ("arguments", "keys", "members")
PARTS = ("inputs", "fields", "options", "uniforms", "outputs")
TYPE = r"[\w.|:,\"\[\]() ?-]+"
# The lines of an annotation that lua-language-server knows, as far as the file uses them.
GRAMMAR = re.compile(
    r"---@meta|---@alias roil\.\w+ " + TYPE + r"|---@class roil(\.\w+)+(: roil(\.\w+)+)?|"
    r"---@field (\w+\??|\[string\]) ((roil\.[\w.]+|any|boolean|\"[\w ]+\"|fun\([^)]*\): [\w.]+)\|?)+( .*)?|"
    r"---@operator \w+(\(any\))?: roil\.field|---@param keys roil(\.\w+)+|---@return roil(\.\w+)+|"
    r"---@overload fun\((\w+\?: [\w.|\"]+, )*\.\.\.: any\): roil(\.\w+)+|---@type roil\.field|"
    r"--- .*|---|-- .*|\w+ = nil|(local )?function \w+\(keys\) end|")


class Editors(Case):
    def reference(self):
        return json.loads(self.succeeds("info", "--json"))

    def words(self):
        known = self.reference()
        return ({word["name"] for word in known["words"] if word["is"] != "module"}
                | {one["name"] for one in known["passes"] if one["constructor"]})

    def test_json_has_what_effects_see(self):
        self.write("words.lua", "local n = {}\nfor k in pairs(_G) do n[#n + 1] = k end\nprint(table.concat(n, ' '))\n" + PUFF)
        done = self.run_program("check", "words.lua")
        self.assertEqual(done.returncode, 0)
        seen = set(done.stderr.split()) - {"roil:"}
        self.assertEqual(seen - LUA, self.words())

    def test_json_says_what_the_texts_say(self):
        known = self.reference()
        for word in known["words"]:
            text = " ".join(self.succeeds("info", "fields", word["name"]).split())
            for value in (value for part in LISTS for value in word[part]):
                self.assertIn(" ".join(value.get("help", "").split()), text)
                self.assertIn(value["name"], text)
        march = {one["name"]: one for one in known["passes"]}["march"]
        steps = {value["name"]: value for value in march["uniforms"]}["steps"]
        self.assertEqual((steps["type"], steps["default"], steps["min"], steps["max"]), ("whole", 128, 1, 4096))
        self.assertEqual(json.loads(self.succeeds("info", "passes", "march", "--json"))["passes"], [march])
        worley = json.loads(self.succeeds("info", "fields", "worley", "--json"))["words"]
        self.assertEqual([word["name"] for word in worley], ["worley"])

    def test_json_of_an_effect(self):
        self.write("puff.lua", PUFF)
        puff = json.loads(self.succeeds("info", "params", "puff.lua", "--json", "--set", "steps=9"))
        self.assertEqual(puff["effect"], {"name": "puff", "fps": 24, "first_frame": 1, "frames": 10})
        controls = {control["name"]: control for control in puff["controls"]}
        steps = controls["steps"]
        self.assertEqual((steps["value"], steps["initial"], steps["min"], steps["max"]), (9, 8, 2, 64))
        self.assertTrue(steps["moved"] and steps["parameter"])
        self.assertEqual(controls["look"]["words"], ["soft", "hard"])
        self.assertEqual(controls["thickness"]["unit"], "1/m")

    def test_json_of_devices(self):
        device = json.loads(self.succeeds("info", "device", "--json"))["devices"][0]
        self.assertRegex(device["uuid"], r"^[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}$")
        self.write("puff.lua", PUFF)
        self.render(PUFF, "--device", device["uuid"].upper())
        self.fails(1, "no device is called '00000000-", "render", "puff.lua", "--device",
                   "00000000-0000-0000-0000-000000000000", "--frames", "1")

    def test_errors_have_line_and_column(self):
        cases = {
            "typo.lua": ("local fx = effect { name = 'a' }\n  local m = march { densty = 1 }\n", 2, 21),
            "syntax.lua": ("local x = = 3\n", 1, 1),
            "name.lua": ("local fx = effect {}\nlocal b = spere {}\n", 2, 11),
        }
        for name, (text, _, _) in cases.items():
            self.write(name, text)
        self.write("puff.lua", PUFF)
        done = self.run_program("check", "--json", "puff.lua", *cases, "none.lua")
        self.assertEqual(done.returncode, 1)
        said = json.loads(done.stdout)
        self.assertEqual(said["good"], ["puff.lua"])
        errors = {error["file"]: error for error in said["errors"]}
        for name, (_, line, column) in cases.items():
            self.assertEqual((errors[name]["line"], errors[name]["column"]), (line, column), errors[name])
        self.assertNotIn("line", errors["none.lua"])
        self.assertIn("No such file", errors["none.lua"]["message"])

    def test_errors_in_shaders_and_names_that_are_no_text(self):
        self.write("haze.comp", "// Haze.\nuniform sampler2D input_; //= input : it\n"
                                "writeonly uniform image2D color; //= output rgba16f : it\n\nvoid main() { wurst(); }\n")
        self.write("user.lua", 'local fx = effect {}\nfx.output = shader { "haze.comp", march { density = sphere {} } }\nreturn fx\n')
        error = json.loads(self.run_program("check", "--json", "user.lua").stdout)["errors"][0]
        self.assertEqual((error["file"], error["line"], error["column"]), ("./haze.comp", 5, 15), error)
        done = self.run_program("check", "--json", os.fsdecode(b"a\xff.lua"))
        self.assertEqual(len(json.loads(done.stdout)["errors"]), 1)

    def test_failures_of_info_are_json_too(self):
        done = self.run_program("info", "--json", "passes", "marsh")
        self.assertEqual(done.returncode, 1)
        self.assertIn("did you mean 'march'?", json.loads(done.stdout)["errors"][0]["message"])
        self.write("bad.lua", "fx = = 1\n")
        done = self.run_program("info", "--json", "params", "bad.lua")
        self.assertEqual(json.loads(done.stdout)["errors"][0]["line"], 1)
        self.fails(2, "--json goes with", "info", "--json", "graph", "bad.lua")
        self.fails(2, "--lua-meta has no topic", "info", "--lua-meta", "passes")

    def meta(self):
        return self.succeeds("info", "--lua-meta")

    def test_annotations_follow_their_grammar(self):
        classes, used, fields = set(), set(), set()
        for number, line in enumerate(self.meta().splitlines(), 1):
            self.assertTrue(GRAMMAR.fullmatch(line), f"{number}: {line}")
            declared = re.match(r"---@(?:class|alias) ([\w.]+)", line)
            field = re.match(r"---@field (\w+)", line)
            if declared:
                self.assertNotIn(declared[1], classes)
                classes.add(declared[1])
                fields = set()
            if field:
                self.assertNotIn(field[1], fields, f"{number}: twice")
                fields.add(field[1])
            if line.startswith("---@"):
                used |= set(re.findall(r"\broil(?:\.[a-z_]\w*)+", line.split(" ", 2)[-1] if field else line))
        self.assertLessEqual({name for name in used if re.fullmatch(r"roil\.\w+(\.keys)?", name)}, classes)

    def test_annotations_hold_every_function_key_unit_and_word(self):
        known, text = self.reference(), self.meta()
        declared = set(re.findall(r"^function (\w+)\(|^(\w+) = nil$", text, re.M))
        self.assertEqual({a or b for a, b in declared}, self.words())
        blocks = {block.split("\n")[0].split(" ")[1].rstrip(":"): block
                  for block in re.split(r"\n\n|(?=---@class)", text) if block.startswith("---@class")}
        values = [("roil." + word["name"] + ".keys", value) for word in known["words"] if word["is"] == "object"
                  for value in word["keys"]]
        values += [("roil." + word["name"] + ".keys", value) for word in known["words"] if word["is"] == "field"
                   for part in ("arguments", "keys") for value in word[part]]
        values += [("roil.pass." + one["name"], value) for one in known["passes"] for part in PARTS[:-1] for value in one[part]]
        self.assertGreater(len(values), 800)
        for owner, value in values:
            line = re.search(rf"^---@field {value['name']}\?? .*$", blocks[owner], re.M)
            self.assertTrue(line, f"{owner} {value['name']}")
            for part in [value.get("unit", ""), *(f'"{word}"' for word in value.get("words", []))]:
                self.assertIn(part, line[0])

    def test_a_language_server_reads_them(self):
        server = shutil.which("lua-language-server")
        if not server:
            self.skipTest("lua-language-server is not installed (Debian 12 has none)")
        self.write("library/roil.lua", self.meta())
        self.write(".luarc.json", json.dumps({"runtime.version": "Lua 5.4", "workspace.library": ["library"]}))
        self.write("puff.lua", PUFF)
        subprocess.run([server, "--check", self.folder, "--logpath", self.path("log")], check=True)
        self.assertFalse(json.loads(self.read("log/check.json") or "[]"))

    def test_luacheck_knows_all_words_and_has_no_warning(self):
        with open(os.path.join(SOURCE, ".luacheckrc"), encoding="utf-8") as file:
            listed = re.search(r"local words = \{(.*?)\}", file.read(), re.S)[1]
        self.assertEqual(set(re.findall(r'"(\w+)"', listed)), self.words())
        if not shutil.which("luacheck"):
            self.skipTest("luacheck is not installed (Debian: lua-check)")
        done = subprocess.run(["luacheck", "--no-color", "--quiet", "."], cwd=SOURCE, stdout=subprocess.PIPE, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.write("meta.lua", self.meta())
        done = subprocess.run(["luacheck", "--no-color", "--only", "0", "--", "meta.lua"], cwd=self.folder,
                              stdout=subprocess.PIPE, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stdout)


if __name__ == "__main__":
    main()
