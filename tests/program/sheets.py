"""Sheets for engines: cells in their order, sizes in metres, motion and light as they are, files as
engines read them."""
import base64
import json
import math
import os
import shutil
import struct
import subprocess
import time
import unittest

from lib import browser
from lib.pictures import Exr, Png
from lib.program import BINARY, Case, main

FLOW = os.path.join(BINARY, "libroil-flow.so")

# A ball that goes to the right by 1 m a second. Its light is constant, so that colours are known.
ROLLING = """
local fx = effect { name = "rolling", fps = 10, frames = 16 }
fx.camera = orbit { target = {5, 0, 3}, distance = 30, yaw = 0, pitch = 0 }
fx.sky = sky { strength = 0 }
fx.sun = sun { strength = 0 }
local thick = param { "thick", 400, min = 0, max = 1000 }
local ball = sphere { position = function(t) return {t, 0, 1} end, radius = 0.5, falloff = 0.02 }
fx.output = final { march { density = ball * thick, radiance = {0.5, 0.25, 1}, steps = 256 }, tonemap = "none" }.color
return fx
"""
# What a flow carries, in front of a wall that a picture would show.
CARRIED = """
local fx = effect { name = "carried", fps = 10, frames = 16 }
fx.camera = orbit { target = {0, 0, 1}, distance = 6, yaw = 90, pitch = 0 }
local lumps = worley { frequency = 2 }:advect(vec(0.5, 1, 2), { period = 1, mean = 0.5 })
local ball = sphere { position = function(t) return {0.5 * t, t, 2 * t} end, radius = 0.5, falloff = 0.1 }
local ground = geometry { mesh { "ground.obj" } }
local smoke = march { density = ball * (0.5 + lumps) * 4, depth = ground.depth, steps = 32 }
fx.output = final { over { smoke, shade { from = ground }, from = {smoke, ground} } }.color
return fx
"""
LIT = """
local fx = effect { name = "lit", fps = 10, frames = 4 }
local glow = param { "glow", 0, min = 0, max = 1 }
fx.camera = orbit { target = {0, 0, 1}, distance = 6, yaw = 30, pitch = 20 }
fx.sun = sun { azimuth = 60, elevation = 20, strength = 3.14159265 }
fx.sky = sky { strength = 0 }
local lumps = worley { frequency = 1.3, octaves = 2, seed = 3 }
local ball = sphere { position = {0.3, 0, 1}, radius = 1.2, falloff = 0.6 } * smoothstep(0.1, 0.4, lumps)
local lit = lighting { density = ball * 6, albedo = {0.9, 0.9, 0.9}, anisotropy = 0.3, shadow_resolution = 32, glow_resolution = 16,
                       emission = vec(0.4, 0.2, 0.1) * glow }
fx.output = final { march { from = lit, steps = 48 }, tonemap = "none" }.color
return fx
"""
SHORT = ["--grid", "2x2", "--cell", "64"]


def cell(picture, columns, index, x, y, side=64):
    column, row = index % columns, index // columns
    at = (column * side + x) * picture.channels
    return list(picture.rows[row * side + y][at:at + picture.channels])


def srgb(v):
    v = min(max(v, 0), 1)
    return 255 * (12.92 * v if v <= 0.0031308 else 1.055 * v ** (1 / 2.4) - 0.055)


def psnr(a, b):
    return 10 * math.log10(255 ** 2 * len(a) / max(sum((x - y) ** 2 for x, y in zip(a, b)), 1e-9))


def middle(picture, columns, index, side=64):
    """Where a cell's alpha lies, in pixels, and how much of it there is."""
    sums = [0.0, 0.0, 0.0]
    for y in range(side):
        for x in range(side):
            alpha = cell(picture, columns, index, x, y, side)[3] / (2 ** picture.bits - 1)
            for i, v in enumerate((x + 0.5, y + 0.5, 1)):
                sums[i] += alpha * v
    return sums[0] / sums[2], sums[1] / sums[2], sums[2]


DUST = """
local fx = effect { name = "dust", fps = 24, frames = 24 }
fx.camera = orbit { target = {0, 0, 1}, distance = 6, pitch = 0 }
local chaff = particles { count = 4000, burst = 4000, lifetime = 5, seed = 3, position = {-0.5, 0, 0.6}, radius = 0.4,
                          speed = {1, 0, 0.5}, spread = 0, variation = 0 }
local dust = deposit { chaff, box = { min = {-2, -1, 0}, max = {2, 1, 2} }, resolution = 48, size = 0.05 }
fx.output = final { march { density = dust.density * 2, steps = 48 } }.color
return fx
"""
LAPSE = """
local fx = effect { name = "lapse", fps = 10, frames = 16 }
fx.camera = camera { eye = {0, -5, 0.8}, target = {0, 0, 0.8}, orthographic = 1.6 }
local air = lbm { size = {16, 16, 16}, voxel_size = 0.1, speed = 2, buoyancy_heat = 8, time_scale = %g }
air:source { shape = sphere { position = {0, 0, 0.5}, radius = 0.3 }, density = 1, temperature = 1, rate = 12 }
fx.output = final { march { density = air.density * 4, radiance = {1, 1, 1}, steps = 16 } }.color
return fx
"""
# Lumps that rise by two cells of their lattice a second, which repeats after four.
RISING = """
local fx = effect { name = "rising", fps = 12, frames = 60 }
fx.camera = orbit { target = {0, 0, 1}, distance = 6, pitch = 0 }
local lumps = %s { frequency = 2, octaves = 2, period = 4, drift = {0, 0, -1} }%s
local ball = sphere { position = {0, 0, 1}, radius = 1, falloff = 0.3 }
fx.output = final { march { density = ball * smoothstep(0.3, 0.6, lumps) * 6, radiance = {1, 1, 1}, steps = 32 } }.color
return fx
"""

# A scene of Godot 3 that draws a sheet as its preset says, saves what is seen, and ends.
GODOT = {
    "project.godot": """config_version=4
[application]
run/main_scene="res://main.tscn"
[display]
window/size/width=96
window/size/height=96
[rendering]
quality/driver/driver_name="GLES2"
environment/default_clear_color=Color( 0, 0, 0, 1 )
""",
    "main.tscn": """[gd_scene load_steps=2 format=2]
[ext_resource path="res://main.gd" type="Script" id=1]
[node name="Main" type="Node2D"]
script = ExtResource( 1 )
""",
    "main.gd": """extends Node2D
func texture(name):
    var image = Image.new()
    if image.load(ProjectSettings.globalize_path("res://" + name)) != OK:
        OS.exit_code = 1
    var made = ImageTexture.new()
    made.create_from_image(image, Texture.FLAG_FILTER)
    return made
func _ready():
    var file = File.new()
    file.open("res://fire.json", File.READ)
    var told = parse_json(file.get_as_text())
    var shader = Shader.new()
    shader.code = "shader_type canvas_item; render_mode blend_premul_alpha, unshaded;" + \
        "uniform sampler2D color; uniform sampler2D motion; uniform vec2 grid; uniform float scale; uniform float part;" + \
        "vec2 moves(vec2 cell, vec2 at) { return (texture(motion, (cell + at) / grid).rg * 2.0 - 1.0) * scale; }" + \
        "void fragment() { vec2 next = vec2(1.0, 0.0);" + \
        " vec4 one = texture(color, (UV - moves(vec2(0.0), UV) * part) / grid);" + \
        " vec4 two = texture(color, (next + UV + moves(next, UV) * (1.0 - part)) / grid); COLOR = mix(one, two, part); }"
    var material = ShaderMaterial.new()
    material.shader = shader
    for map in told["maps"]:
        if map["map"] != "color" and map["map"] != "motion": continue
        material.set_shader_param(map["map"], texture(map["file"]))
        if map["map"] == "motion": material.set_shader_param("scale", map["scale"])
    material.set_shader_param("grid", Vector2(told["grid"][0], told["grid"][1]))
    var rect = ColorRect.new()
    rect.rect_size = Vector2(48, 48)
    rect.material = material
    add_child(rect)
    for part in [0.0, 0.5]:
        material.set_shader_param("part", part)
        yield(VisualServer, "frame_post_draw")
        yield(VisualServer, "frame_post_draw")
        var seen = get_viewport().get_texture().get_data()
        seen.flip_y()
        seen.convert(Image.FORMAT_RGB8)
        seen.save_png(ProjectSettings.globalize_path("res://seen%d.png" % int(part * 10)))
    get_tree().quit()
""",
}


class Sheets(Case):
    def export(self, effect, *options, output="fire.png", looks=False):
        """Without a look at where the medium is, which is a topic of its own."""
        self.write("effect.lua", effect)
        self.succeeds("export", "sheet", "effect.lua", "-o", output, *([] if looks else ["--all"]), *options)
        return json.loads(self.read(os.path.splitext(output)[0] + ".json"))

    def picture(self, name):
        return Png(self.read(name))

    def floats(self, name):
        return Exr(self.read(name)).channels

    def map(self, told, name):
        return next(m for m in told["maps"] if m["map"] == name)

    def test_cells_are_frames_in_order_and_metres_are_pixels(self):
        told = self.export(ROLLING, "--frames", "1-13:4", *SHORT)
        self.assertEqual((told["grid"], told["frames"], told["fps"], told["cell"]), ([2, 2], 4, 2.5, [64, 64]))
        self.assertEqual((told["made"]["kind"], told["made"]["effect"]), ("sheet", "effect.lua"))
        self.assertRegex(told["made"]["inputs"], "^[0-9a-f]{32}$")
        # The ball goes from x = -0.5 to 1.7 m, so the cells show 2.2 m within their gutters.
        self.assertAlmostEqual(told["size_m"][0], 2.2 * 64 / 56, 2)
        sheet = self.picture("fire.png")
        self.assertEqual((sheet.width, sheet.height, sheet.channels), (128, 128, 4))
        for i in range(4):
            x, y, area = middle(sheet, 2, i)
            metre = 64 / told["size_m"][0]
            self.assertAlmostEqual(x, told["pivot"][0] * 64 + 0.4 * i * metre, delta=0.3)
            self.assertAlmostEqual(y, told["pivot"][1] * 64 - metre, delta=0.3)
            self.assertAlmostEqual(area, math.pi * (0.5 * metre) ** 2, delta=0.06 * area)
            edge = [(a, b) for a in range(64) for b in (0, 3, 60, 63)]  # the gutter stays empty
            self.assertEqual({tuple(cell(sheet, 2, i, *at)) for at in edge + [at[::-1] for at in edge]}, {(0, 0, 0, 0)})

    def test_alpha_and_colour_are_the_mediums(self):
        self.export(ROLLING, "--frames", "1", "--set", "thick=2", "--light", "scene", *SHORT, output="fire.exr")
        told = self.floats("fire.exr")
        at = max(range(len(told["A"])), key=lambda i: told["A"][i])
        self.assertAlmostEqual(told["A"][at], 1 - math.exp(-2), delta=0.02)  # through a metre
        for channel, light in zip("RGB", (0.5, 0.25, 1)):
            self.assertAlmostEqual(told[channel][at], light * told["A"][at], delta=0.01)

    def test_straight_colours_go_on_where_nothing_is(self):
        told = self.export(ROLLING, "--frames", "1", "--alpha", "both", *SHORT)
        self.assertEqual([m["alpha"] for m in told["maps"]], ["premultiplied", "straight"])
        plain, straight = self.picture("fire.png"), self.picture("fire-straight.png")
        self.assertEqual(cell(plain, 2, 0, 1, 1), [0, 0, 0, 0])
        beside = cell(straight, 2, 0, 1, 1)
        self.assertEqual(beside[3], 0)
        for c, light in enumerate((188, 137, 255)):  # the same as inside, sRGB
            self.assertAlmostEqual(beside[c], light, delta=2)
        self.assertEqual(cell(straight, 2, 3, 32, 32), [0, 0, 0, 0])  # a cell without any

    def test_formats_hold_the_same(self):
        self.export(ROLLING, "--frames", "1", *SHORT)
        wanted = self.picture("fire.png")
        self.export(ROLLING, "--frames", "1", "--format", "png16", *SHORT)
        fine = self.picture("fire.png")
        self.assertEqual((wanted.bits, fine.bits), (8, 16))
        self.export(ROLLING, "--frames", "1", *SHORT, output="fire.tga")
        tga = self.read("fire.tga")
        self.assertEqual(struct.unpack("<HHBB", tga[12:18]), (128, 128, 32, 0x28))
        for x, y in ((1, 1), (20, 30), (22, 36)):
            eight, sixteen = cell(wanted, 2, 0, x, y), cell(fine, 2, 0, x, y)
            b, g, r, a = tga[18 + 4 * (y * 128 + x):][:4]
            self.assertEqual(eight, [r, g, b, a])
            for c in range(4):
                self.assertAlmostEqual(eight[c], sixteen[c] / 257, delta=0.51)

    def test_cropped_cells_keep_their_pivot(self):
        told = self.export(ROLLING, "--frames", "1,2", "--camera", "--crop", *SHORT)
        left, top, right, bottom = told["crop"]
        self.assertEqual(told["cell"], [right - left, bottom - top])
        self.assertLess(right - left, 32)
        self.assertEqual((right - left) % 4, 0)
        sheet = self.picture("fire.png")
        self.assertEqual((sheet.width, sheet.height), (2 * (right - left), 2 * (bottom - top)))
        wide, high = right - left, bottom - top
        alpha = [(x, y, sheet.rows[y][4 * x + 3]) for y in range(high) for x in range(wide)]
        whole = sum(a for _, _, a in alpha)
        x, y = (sum((at[k] + 0.5) * at[2] for at in alpha) / whole for k in (0, 1))
        metre = wide / told["size_m"][0]
        self.assertAlmostEqual(x, told["pivot"][0] * wide, delta=0.3)  # of the ball, a metre above the origin
        self.assertAlmostEqual(y, told["pivot"][1] * high - metre, delta=0.3)

    def test_motion_is_that_of_the_medium(self):
        told = self.export(CARRIED, "--frames", "1,3", "--maps", "color,motion", *SHORT, output="fire.exr")
        motion = self.floats("fire-motion.exr")
        # The camera looks along -x: +y is to the right. 0.2 s from cell to cell.
        for i in (0, 50 * 128 + 20):
            self.assertAlmostEqual(motion["R"][i], 1 * 0.2 / told["size_m"][0], delta=1e-3)
            self.assertAlmostEqual(motion["G"][i], 2 * 0.2 / told["size_m"][1], delta=1e-3)
        for engine, signs in (("unity", (1, 1)), ("unreal", (1, -1)), ("godot", (1, -1)), ("labs", (-1, 1))):
            told = self.export(CARRIED, "--frames", "1,3", "--maps", "motion", "--for", engine, *SHORT)
            entry = self.map(told, "motion")
            seen = cell(self.picture("fire-motion.png"), 2, 0, 20, 50)
            for c, wanted in enumerate((1, 2)):
                value = (seen[c] / 255 * 2 - 1) * entry["scale"]
                self.assertAlmostEqual(value, signs[c] * wanted * 0.2 / told["size_m"][0], delta=0.01 * entry["scale"])
            self.assertIn("steps", told)
        self.fails(1, ["nothing says how the medium of pass 'march' moves", "add color to the maps"], "export", "sheet",
                   self.write("still.lua", ROLLING), "-o", "still.png", "--maps", "motion")

    def test_motion_of_particles_is_theirs(self):
        told = self.export(DUST, "--frames", "3,6", "--maps", "color,motion", "--grid", "2x1", "--cell", "48", output="dust.exr")
        colors, motion = self.floats("dust.exr"), self.floats("dust-motion.exr")
        weight = sum(colors["A"])
        for channel, metres in ("R", 1), ("G", 0.5):  # it is interpolated with cells that hold nothing
            seen = sum(a * v for a, v in zip(colors["A"], motion[channel])) / weight
            wanted = metres * 3 / 24 / told["size_m"][0]
            self.assertAlmostEqual(seen, wanted, delta=0.1 * wanted)

    @unittest.skipUnless(os.path.exists(FLOW), "built without OpenCV (apt-get install libopencv-video-dev)")
    def test_motion_is_estimated_where_nothing_says_it(self):
        spotted = ROLLING.replace("ball * thick, radiance = {0.5, 0.25, 1}", "ball * thick, radiance = {1, 1, 1} * "
                                  "worley { frequency = 6, drift = {-1, 0, 0} }")
        told = self.export(spotted, "--frames", "3-6", "--maps", "color,motion", *SHORT, output="fire.exr")
        self.assertEqual(self.map(told, "motion")["from"], "optical flow of the colours")
        colors, motion = self.floats("fire.exr"), self.floats("fire-motion.exr")
        weight = sum(colors["A"])
        right = sum(a * v for a, v in zip(colors["A"], motion["R"])) / weight
        up = sum(a * v for a, v in zip(colors["A"], motion["G"])) / weight
        wanted = 0.1 / told["size_m"][0]
        self.assertAlmostEqual(right, wanted, delta=0.15 * wanted)
        self.assertAlmostEqual(up, 0, delta=0.15 * wanted)

    def test_meshes_hide_nothing_of_it(self):
        told = self.export(CARRIED, "--frames", "1", *SHORT)
        x, y, area = middle(self.picture("fire.png"), 2, 0)  # half of it lies below the ground
        self.assertAlmostEqual(y, told["pivot"][1] * 64, delta=1.5)
        self.assertGreater(area, 1000)

    def test_motion_is_by_seconds_of_the_effect(self):
        """Air in time lapse, at the same of its own times."""
        most = {}
        for scale, frame in (1, "9"), (4, "3"):
            self.export(LAPSE % scale, "--frames", frame, "--grid", "1x1", "--cell", "32", "--maps", "motion", "--camera",
                        output="air.exr")
            most[scale] = max(self.floats("air-motion.exr")["G"])
        self.assertGreater(most[1], 0.01)
        self.assertAlmostEqual(most[4], 4 * most[1], delta=0.02 * most[4])

    def test_cells_are_the_means_of_a_shutter(self):
        open_ = ["--frames", "1", "--samples", "6", "--shutter"]
        blurred = {}
        for shutter in ("0", "1"):
            told = self.export(ROLLING, *open_, shutter, *SHORT)
            sheet, metre = self.picture("fire.png"), 64 / told["size_m"][0]
            x, _, area = middle(sheet, 2, 0)
            way = 0.1 * float(shutter)  # of the ball, in metres
            self.assertAlmostEqual(x, told["pivot"][0] * 64 + 0.5 * way * metre, delta=0.1)
            self.assertAlmostEqual(area, math.pi * (0.5 * metre) ** 2, delta=0.03 * area)
            blurred[shutter] = sum(9 < cell(sheet, 2, 0, x, y)[3] < 246 for x in range(64) for y in range(64))
        self.assertGreater(blurred["1"], blurred["0"] + 50)
        self.assertEqual(told["made"]["options"][-3:-1], ["--samples=6", "--shutter=1"])
        # What is the mean of a few moments, at the edges, is one of what was there.
        told = self.export(CARRIED, *open_, "1", "--maps", "motion", "--grid", "1x1", "--cell", "32", output="fire.exr")
        motion = self.floats("fire-motion.exr")
        for c, metres in ("R", 0.1), ("G", 0.2):
            self.assertLess(max(abs(v - metres / told["size_m"][0]) for v in motion[c]), 1e-3)

    def test_six_lights_are_those_of_six_pictures(self):
        told = self.export(LIT, "--frames", "1", "--grid", "1x1", "--cell", "48", "--maps", "color,six-way", output="six.exr")
        rigs = self.floats("six-right-top-back.exr"), self.floats("six-left-bottom-front.exr")
        sides = [(0, "R", "right", 1), (0, "G", "up", 1), (0, "B", "towards_camera", -1),
                 (1, "R", "right", -1), (1, "G", "up", -1), (1, "B", "towards_camera", 1)]
        for rig, channel, axis, sign in sides:
            light = [sign * (axis == name) for name in ("right", "up", "towards_camera")]
            self.export(LIT, "--frames", "1", "--grid", "1x1", "--cell", "48", "--light", "scene",
                        *self.turned(told, light), output="one.exr")
            wanted, seen = self.floats("one.exr")["R"], rigs[rig][channel]
            self.assertGreater(max(wanted), 0.1)
            self.assertLess(max(abs(a - b) for a, b in zip(wanted, seen)), 2e-3, (axis, sign))

    def test_emission_is_beside_the_six_lights(self):
        self.export(LIT, "--frames", "1", "--grid", "1x1", "--cell", "48", "--maps", "color,six-way", "--set", "glow=1",
                    "--set", "sun.strength=0", output="six.exr")
        dark, glow = self.floats("six-right-top-back.exr"), self.floats("six-emission.exr")
        front = self.floats("six-left-bottom-front.exr")
        at = max(range(len(glow["R"])), key=lambda i: glow["R"][i])
        self.assertGreater(glow["R"][at], 0.05)
        self.assertAlmostEqual(glow["R"][at] / glow["G"][at], 2, delta=0.02)
        lit = 0.2126 * glow["R"][at] + 0.7152 * glow["G"][at] + 0.0722 * glow["B"][at]
        self.assertAlmostEqual(front["A"][at], lit, delta=2e-3)
        self.assertGreater(dark["A"][at], 0.2)

    def apart(self, sheet, columns, a, b):
        """How far two cells differ, of 255."""
        seen = [[cell(sheet, columns, i, x, y, 32)[3] for y in range(32) for x in range(32)] for i in (a, b)]
        return sum(abs(p - q) for p, q in zip(*seen)) / len(seen[0])

    def test_loops_repeat_by_themselves_where_they_do(self):
        short = ["--grid", "8x1", "--cell", "32"]
        for noise, tile in ("worley", ""), ("perlin", ""), ("worley", ":tile { resolution = 32, cells = 4 }"):
            told = self.export(RISING % (noise, tile), "--loop", "2", *short)
            self.assertEqual(told["notes"], ["loop: the medium repeats by itself after 2 s"])
            self.assertEqual((told["loop_seconds"], told["fps"]), (2, 4))
        self.export(RISING % ("worley", ""), "--frames", "1,25", *short)  # 2 s later it is the same
        self.assertLess(self.apart(self.picture("fire.png"), 8, 0, 1), 0.5)
        self.export(RISING % ("worley", ""), "--frames", "1,19", *short)
        self.assertGreater(self.apart(self.picture("fire.png"), 8, 0, 1), 5)

    def test_cells_are_framed_by_what_is_seen(self):
        """Noise less itself is nothing, but not to one who only knows its range."""
        where = 'sphere { position = {0, 0, 1}, radius = 2 } * smoothstep(0.6, 0.7, sphere { position = {0.5, 0, 1}, ' \
                'radius = 1, falloff = 0.5 } + perlin { frequency = 2 } - perlin { frequency = 2 })'
        effect = f"""
local fx = effect {{ name = "still", fps = 10, frames = 4 }}
fx.camera = orbit {{ target = {{5, 0, 3}}, distance = 30, yaw = 0, pitch = 0 }}
fx.output = final {{ march {{ density = {where} * 200, radiance = {{1, 1, 1}}, steps = 64 }}, tonemap = "none" }}.color
return fx
"""
        sizes = []
        for looks in False, True:
            told = self.export(effect, *SHORT, "--frames", "1-4", looks=looks)
            self.assertEqual("--all" in told["made"]["options"], not looks)
            scale = 64 / told["size_m"][0]
            x, y, _ = middle(self.picture("fire.png"), 2, 0)
            self.assertAlmostEqual(x, 64 * told["pivot"][0] + 0.5 * scale, delta=0.5)
            self.assertAlmostEqual(y, 64 * told["pivot"][1] - scale, delta=0.5)
            sizes.append(told["size_m"][0])
        used = 2 * 1.2 * 64 / 56  # that, with the gutter
        self.assertGreater(sizes[0], 4)
        self.assertTrue(0.6 * used < sizes[1] < 1.15 * used, sizes)

    def test_what_moves_on_dissolves_into_what_was_before(self):
        told = self.export(RISING % ("worley", ""), "--loop", "1.5", "--grid", "16x1", "--cell", "32")
        self.assertIn("dissolve into what came before the first, since the drift of 'worley' repeats every 2 s",
                      told["notes"][0])
        self.assertEqual(told["dissolve"], {"cells": 4, "blend": "in place"})  # what flow does not bring together
        sheet = self.picture("fire.png")
        seam, usual = self.apart(sheet, 16, 15, 0), [self.apart(sheet, 16, i, i + 1) for i in range(11)]
        self.assertLess(seam, 1.3 * max(usual))
        plain = self.export(RISING % ("worley", ""), "--frames", "5-19", "--grid", "16x1", "--cell", "32")
        self.assertEqual(plain["frames"], 15)
        self.assertGreater(self.apart(self.picture("fire.png"), 16, 14, 0), 2 * seam)

    def test_what_has_only_moved_is_moved_back_while_it_dissolves(self):
        ball = "function(t) return {0, 0, 0.5 + 0.2 * t} end, radius = 0.5, falloff = 0.3"
        moving = RISING.replace("{0, 0, 1}, radius = 1, falloff = 0.3", ball).replace("smoothstep(0.3, 0.6, lumps)", "1")
        told = self.export(moving % ("worley", ""), "--loop", "1.5", "--grid", "16x1", "--cell", "32")
        blend = "moved along optical flow" if os.path.exists(FLOW) else "in place"
        self.assertEqual(told["dissolve"], {"cells": 4, "blend": blend})

    def turned(self, told, light):
        """Settings by which the sun shines from `light`: right, up, towards the camera."""
        axes = [told["camera"][name] for name in ("right", "up", "towards_camera")]
        x, y, z = (sum(l * axis[i] for l, axis in zip(light, axes)) for i in range(3))
        return ["--set", f"sun.azimuth={math.degrees(math.atan2(y, x))}", "--set", f"sun.elevation={math.degrees(math.asin(z))}"]

    def drawn(self, page, **state):
        """Red, green and blue of what the page draws."""
        setting = "".join(f"sheet.state.{name} = {json.dumps(value)};" for name, value in state.items())
        data = page.value(f"sheet.play(false); {setting} sheet.draw(); sheet.canvas.toDataURL('image/png')")
        picture = Png(base64.b64decode(data.split(",")[1]))
        return [picture.channel(c) for c in range(3)]

    @unittest.skipUnless(browser.find(), "no Chromium (apt-get install chromium): the page is not tested")
    def test_the_page_draws_what_the_effect_would(self):
        small = ["--grid", "2x1", "--cell", "48"]
        told = self.export(LIT, "--frames", "1,2", *small, "--maps", "color,six-way", "--set", "glow=0.1", "--page", "lit.html")
        self.export(CARRIED, "--frames", "4,8", *small, "--maps", "color,motion", "--page", "carried.html", output="moved.png")
        self.export(CARRIED, "--frames", "4,6,8", "--grid", "3x1", "--cell", "48", output="truth.png")
        page = browser.Browser()
        self.addCleanup(page.close)
        self.load(page, "lit.html")
        for light, least in (((1, 0, 0), 45), ((0, 0, -1), 45), ((0.6, 0.64, 0.48), 30)):
            seen = self.drawn(page, time=0, view="light", light=light, background=[0, 0, 0])
            self.export(LIT, "--frames", "1", "--grid", "1x1", "--cell", "48", "--light", "scene", "--set", "glow=0.1",
                        *self.turned(told, light), output="one.exr")
            for c, channel in enumerate("RGB"):
                wanted = [srgb(v) for v in self.floats("one.exr")[channel]]
                self.assertGreater(max(wanted), 80)
                self.assertGreater(psnr(wanted, seen[c]), least, (light, channel))
        self.load(page, "carried.html")
        truth = Png(self.read("truth.png"))
        wanted = [cell(truth, 3, 1, x, y, 48)[0] for y in range(48) for x in range(48)]
        found = {}
        for between in "vectors", "fade", "none":
            found[between] = psnr(wanted, self.drawn(page, time=0.2, view="color", between=between, background=[0, 0, 0])[0])
        self.assertGreater(found["vectors"], found["fade"] + 2, found)
        self.assertGreater(found["fade"], found["none"], found)
        self.assertEqual([a for a in page.requests if not a.endswith("carried.html")], [])  # it needs nothing else

    @unittest.skipUnless(shutil.which("godot3") and shutil.which("xvfb-run"),
                         "no Godot 3 (apt-get install godot3 xvfb): no scene of an engine is tested")
    def test_an_engine_plays_it(self):
        for name, text in GODOT.items():
            self.write(name, text.replace("    ", "\t") if name.endswith(".gd") else text)
        self.export(CARRIED, "--frames", "4,8", "--grid", "2x1", "--cell", "48", "--maps", "color,motion", "--for", "godot")
        self.export(CARRIED, "--frames", "4,6,8", "--grid", "3x1", "--cell", "48", output="truth.png")
        done = subprocess.run(["xvfb-run", "-a", "-s", "-screen 0 640x480x24", "godot3", "--path", self.folder, "--audio-driver", "Dummy"],
                              env={**os.environ, "HOME": self.folder}, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              stdin=subprocess.DEVNULL, timeout=100, check=False)
        self.assertEqual(done.returncode, 0, done.stdout)
        truth = Png(self.read("truth.png"))
        wanted = [[cell(truth, 3, i, x, y, 48)[0] for y in range(48) for x in range(48)] for i in range(3)]
        first, between = ([v for row in Png(self.read(f"seen{i}.png")).rows[:48] for v in row[:48 * 3:3]] for i in (0, 5))
        self.assertGreater(psnr(wanted[0], first), 40)
        fade = [(a + b) / 2 for a, b in zip(wanted[0], wanted[2])]
        self.assertGreater(psnr(wanted[1], between), psnr(wanted[1], fade) + 2)

    def load(self, page, name):
        page.open(self.path(name), 1000)
        until = time.monotonic() + 60
        while not page.value("!!window.sheet"):
            self.assertLess(time.monotonic(), until, page.complaints)

    def test_mistakes_are_told(self):
        self.write("effect.lua", ROLLING)
        for says, *options in (
                ["--grid '8'", "--grid", "8"],
                ["--shutter 2; accepted: 0 to 1 frames", "--shutter", "2"],
                ["map 'colour'; did you mean 'color'?", "--maps", "colour"],
                ["engine 'unty'; did you mean 'unity'?", "--for", "unty"],
                ["light 'dark'", "--light", "dark"],
                ["alpha 'none'", "--alpha", "none"],
                ["format 'gif'", "--format", "gif"],
                ["no pass march is called 'smoke'; there are: march", "--source", "smoke"],
                ["16 frames in 4 cells", "--frames", "1-16", "--grid", "2x2"],
                ["a gutter of 40 pixels", "--cell", "64", "--gutter", "40"],
                ["a loop of 9 s", "--loop", "9"]):
            message = self.fails(2 if options[0] in ("--grid", "--shutter", "--frames", "--loop") else 1, says, "export", "sheet",
                                 "effect.lua", "-o", "fire.png", *options)
            self.assertFalse(os.path.exists(self.path("fire.json")), message)
        self.fails(1, "a page needs a .png", "export", "sheet", "effect.lua", "-o", "fire.exr", "--page", "fire.html")
        self.fails(2, "accepted: .png, .exr, .tga", "export", "sheet", "effect.lua", "-o", "fire.jpg")
        self.fails(2, "which effect?", "export", "sheet", "-o", "fire.png")


if __name__ == "__main__":
    main()
