"""The report of a sweep: made from fixed results, and opened in a browser as a reader would."""
import json
import os
import re
import struct
import unittest

from lib import browser
from lib.pictures import write_png
from lib.program import Case, main

HOSTILE = '<script>alert(1)</script>"><img src=http://x.invalid/y onerror=alert(2)>\'&amp;'
STEPS, SIDES, NOISES = (16, 32, 64, 128), (0.25, 0.5, 1), ("perlin", "worley_curl")


def figure(ms, spread=0.05):
    return {"median": ms, "p5": ms * (1 - spread), "p95": ms * (1 + spread), "count": 7}


def row(index, steps, side, noise):
    """Time is linear in steps, and in pixels; error falls with both."""
    march = 0.01 * steps * side**2 * (3 if noise == "worley_curl" else 1)
    return {
        "index": index, "label": f"steps {steps}, resolution {side}, {noise}",
        "axes": {"steps": str(steps), "march.resolution": str(side), "noise": noise},
        "effect": "effects/paper.lua", "width": 1920, "height": 1080, "frames": [28, 29, 30],
        "warmup": 8, "repeats": 1, "limit": 60,
        "settings": {"opacity": "20", "steps": str(steps), "noise": noise}, "state": "done", "message": "",
        "gpu_ms": {"geometry": figure(0.4), "march": figure(march), "final": figure(0.1), "all": figure(march + 0.5)},
        "cpu_ms": {"submit": figure(0.3), "frame": figure(march + 1)}, "times_ms": {},
        "counters": {"march.samples": 40000 * steps}, "memory": {"device": 3 << 26, "reserved": 1 << 28, "host": 1 << 27},
        "error": {"psnr": 20 + steps / 8, "ssim": 0.98, "flip": 0.4 / steps + 0.01 / side},
        "thumbnail": f"rows/{index:04d}.png", "published": {"GTX 1650": 7.21} if index == 0 else {}}


def grid():
    rows = []
    for steps in STEPS:
        for side in SIDES:
            for noise in NOISES:
                rows.append(row(len(rows), steps, side, noise))
    return {
        "roil": "0.1.0", "commit": "abc1234", "sweep": "grid", "title": "A grid", "file": "scripts/bench/grid.lua",
        "content": "0", "notes": ["A note."], "device": "A device", "driver": "1.2", "date": "2026-11-21T18:10:00Z",
        "machine": {"cpu": "A processor", "cores": 2, "os": "Linux"},
        "axes": [{"name": "steps", "label": "steps", "values": [str(s) for s in STEPS]},
                 {"name": "march.resolution", "label": "resolution", "values": [str(s) for s in SIDES]},
                 {"name": "noise", "label": "noise", "values": list(NOISES)}],
        "reference": {"kind": "row", "settings": {"steps": "1024"}}, "rows": rows}


class ReportCase(Case):
    def results(self, content):
        self.write("out/results.json", json.dumps(content))
        for i in range(len(content["rows"])):
            os.makedirs(self.path("out/rows"), exist_ok=True)
            write_png(self.path(f"out/rows/{i:04d}.png"), 32, 18, lambda x, y: (8 * x, 14 * y, 10 * i))

    def report(self, content):
        self.results(content)
        self.succeeds("bench", "--report", "out")
        return self.read("out/report.html").decode()


class Report(ReportCase):
    def test_a_page_by_itself(self):
        page = self.report(grid())
        self.assertNotRegex(page, r"<script|https?://|<link|@import")
        self.assertEqual(set(re.findall(r'src="([^,"]*)', page)), {"data:image/png;base64"})

    def test_growth_is_told(self):
        page = self.report(grid())
        self.assertIn("Time of march grows with steps to the power of 1.00, at most linearly.", page)
        self.assertIn("Time of march grows with pixels to the power of 1.00, at most linearly.", page)
        content = grid()
        for r in content["rows"]:
            r["gpu_ms"]["march"] = figure(1e-3 * int(r["axes"]["steps"]) ** 1.5)
        self.assertIn("to the power of 1.50, faster than linearly.", self.report(content))

    def test_growth_within_the_spread_is_not_told(self):
        content = grid()
        for r in content["rows"]:  # march grows with pixels only, and geometry is noise
            noise = 1 + 0.02 * (r["index"] % 5)
            r["gpu_ms"]["march"] = figure(4 * float(r["axes"]["march.resolution"]) ** 2)
            r["gpu_ms"]["geometry"] = figure(40 * noise)
        page = self.report(content)
        self.assertIn("Time of march grows with pixels to the power of 1.00, at most linearly.", page)
        self.assertRegex(page, r"Time of \w+ does not change with steps by more than it spreads\.")
        for name in ("march", "geometry", "final"):
            self.assertFalse(f"{name} grows with steps" in page)
        for r in content["rows"]:  # one measurement each: a tenth is no growth
            r["gpu_ms"]["march"] = {**figure(4 * (1 - 0.0005 * int(r["axes"]["steps"])), 0), "count": 1}
        self.assertFalse("march grows with steps" in self.report(content))

    def test_failures_are_told(self):
        content = grid()
        content["rows"][3].update(state="failed", message="effects/paper.lua:3: no such noise", gpu_ms={}, error=None)
        content["rows"][4].update(state="limit", message="took longer than 60 s")
        page = self.report(content)
        self.assertIn("24 rows on A device: 22 done, 1 stopped at the time limit, 1 failed.", page)
        self.assertIn("no such noise", page)
        self.assertIn("took longer than 60 s", page)

    def test_one_row_without_anything(self):
        content = grid()
        content["rows"] = [{"index": 0, "label": "alone", "axes": {}, "state": "failed", "message": "why"}]
        content["axes"], content["reference"] = [], None
        self.assertIn("alone", self.report(content))
        content["rows"] = []
        self.assertIn("0 rows", self.report(content))

    def test_pictures_are_ours_and_png(self):
        content = grid()
        self.results(content)
        self.write("out/rows/0000.png", "secret text")
        self.write("secret.png", b"\x89PNG\r\n\x1a\n" + b"secret")
        os.remove(self.path("out/rows/0001.png"))
        os.symlink(self.path("secret.png"), self.path("out/rows/0001.png"))
        self.succeeds("bench", "--report", "out")
        self.assertEqual(self.read("out/report.html").count(b"<img "), len(content["rows"]) - 2)

    def test_bad_results(self):
        self.fails(1, "results.json", "bench", "--report", "absent")
        self.write("out/results.json", "{")
        self.fails(1, "out/results.json:1", "bench", "--report", "out")
        content = grid()
        content["rows"][0]["thumbnail"] = "../secret.png"
        self.write("out/results.json", json.dumps(content))
        self.fails(1, "thumbnail", "bench", "--report", "out")
        self.assertFalse(os.path.exists(self.path("out/report.html")))


# Places of texts in plots: two of them overlap when they share more than a pixel.
OVERLAPS = """[...document.querySelectorAll('svg.plot')].flatMap(svg => {
  const texts = [...svg.querySelectorAll('text')].map(t => [t.firstChild.data, t.getBoundingClientRect()])
                  .filter(([, r]) => r.width > 0);
  return texts.flatMap(([a, r], i) => texts.slice(i + 1).filter(([, q]) =>
    Math.min(r.right, q.right) - Math.max(r.left, q.left) > 1 &&
    Math.min(r.bottom, q.bottom) - Math.max(r.top, q.top) > 1).map(([b]) => a + ' | ' + b));
})"""


@unittest.skipUnless(browser.find(), "no Chromium")
class Opened(ReportCase):
    @classmethod
    def setUpClass(cls):
        cls.browser = browser.Browser()
        cls.addClassCleanup(cls.browser.close)

    def open(self, width, dark=False):
        b = self.browser
        b.open(self.path("out/report.html"), width, dark=dark)
        self.assertEqual(b.requests, ["file://" + self.path("out/report.html")])
        self.assertEqual(b.complaints, [])
        return b

    def test_phone_and_desktop(self):
        content = grid()
        self.report(content)
        for width in (360, 390, 768, 1280):
            b = self.open(width)
            self.assertLessEqual(b.value("document.documentElement.scrollWidth"), width)
            self.assertEqual(b.value(OVERLAPS), [], f"at {width}")
            self.assertEqual(b.value("document.querySelectorAll('table.rows tbody tr').length"), len(content["rows"]))
            self.assertGreaterEqual(b.value("document.querySelectorAll('svg.plot .line').length"), 12)
            self.assertTrue(b.value("[...document.images].every(i => i.complete && i.naturalWidth == 32)"))
            size = struct.unpack(">II", b.picture()[16:24])
            self.assertGreater(size[1], 2000)
        # What is too wide for the phone scrolls by itself, and can be reached by keys.
        b = self.open(390)
        self.assertTrue(b.value("(s => s.scrollWidth > s.clientWidth && s.tabIndex == 0)"
                                "(document.querySelector('#rows .scroll'))"))

    def test_dark_and_light_differ_and_can_be_read(self):
        self.report(grid())
        contrast = """(() => {
          const light = c => { const [r, g, b] = c.match(/\\d+/g).map(v => (v / 255) <= 0.04045 ? v / 255 / 12.92
                                 : Math.pow((v / 255 + 0.055) / 1.055, 2.4)); return 0.2126 * r + 0.7152 * g + 0.0722 * b; };
          const ground = light(getComputedStyle(document.querySelector('figure')).backgroundColor);
          const ratio = c => { const l = light(c); return (Math.max(l, ground) + 0.05) / (Math.min(l, ground) + 0.05); };
          const texts = [...document.querySelectorAll('svg.plot text')].map(t => ratio(getComputedStyle(t).fill));
          return [ground, Math.min(...texts), ratio(getComputedStyle(document.body).color)]; })()"""
        light, dark = (self.open(1280, dark=dark).value(contrast) for dark in (False, True))
        self.assertGreater(light[0], 0.8)
        self.assertLess(dark[0], 0.1)
        for ground in (light, dark):
            self.assertGreater(ground[1], 4.5)
            self.assertGreater(ground[2], 10)

    def test_the_front_is_what_no_row_beats(self):
        content = grid()
        self.report(content)
        points = [(r["gpu_ms"]["all"]["median"], r["error"]["flip"], " · ".join(r["axes"].values())) for r in content["rows"]]
        front = {name for ms, flip, name in points
                 if not any((a <= ms and b <= flip) and (a < ms or b < flip) for a, b, _ in points)}
        shown = self.open(1280).value("[...document.querySelectorAll('#front tbody td:first-child')].map(t => t.textContent)")
        self.assertEqual(set(shown), front)
        self.assertEqual(len(shown), len(front))

    def test_rows_of_a_search_are_marked(self):
        content = grid()
        content["tuned"] = {"before": 4, "chosen": 9}
        self.report(content)
        b = self.open(1280)
        self.assertEqual(b.value("document.querySelectorAll('svg.plot.wide .ring').length"), 2)
        self.assertEqual(b.value("document.querySelector('#rows tr.chosen th').textContent"), "9")

    def test_paper(self):
        self.report(grid())
        pdf = self.open(1280).printed()
        self.assertTrue(pdf.startswith(b"%PDF"))
        pages = len(re.findall(rb"/Type\s*/Page\b", pdf))
        self.assertTrue(3 <= pages <= 12, f"{pages} pages")
        boxes = {tuple(round(float(v)) for v in box.split()) for box in re.findall(rb"/MediaBox\s*\[([^\]]*)\]", pdf)}
        self.assertIn((0, 0, 595, 842), boxes)  # A4; what is wide lies on its side
        self.assertIn((0, 0, 842, 595), boxes)

    def test_hostile_texts_are_texts(self):
        content = grid()
        for key in ("commit", "sweep", "title", "file", "device", "driver", "date"):
            content[key] = HOSTILE
        content["notes"], content["machine"]["cpu"] = [HOSTILE], HOSTILE
        content["reference"]["settings"] = {HOSTILE: HOSTILE}
        content["axes"].append({"name": HOSTILE, "label": HOSTILE, "values": []})
        for r in content["rows"]:
            r.update(label=HOSTILE, message=HOSTILE, effect=HOSTILE, settings={HOSTILE: HOSTILE},
                     counters={HOSTILE: 1}, published={HOSTILE: 2})
            r["axes"][HOSTILE] = HOSTILE + str(r["index"] % 2)
            r["gpu_ms"] = {HOSTILE: figure(1 + r["index"]), **r["gpu_ms"], "less": figure(-1e14)}
        content["rows"][5]["state"] = "failed"
        self.report(content)
        for width in (390, 1280):
            b = self.open(width)
            self.assertLessEqual(b.value("document.documentElement.scrollWidth"), width)
            self.assertEqual(b.value("document.querySelector('h1').textContent"), HOSTILE)
            self.assertEqual(b.value("document.title"), HOSTILE + " · roil bench")
            self.assertEqual(b.value("document.querySelectorAll('script, [onerror]').length"), 0)
            self.assertEqual(b.value("document.images.length"), len(content["rows"]))
        with open(self.path("out/report.html"), encoding="utf-8") as page:
            self.assertNotIn("<script", page.read())

    def test_extremes_are_drawn(self):
        content = grid()
        for r in content["rows"]:
            ms = {0: 1e-300, 1: 0, 2: 1e15}.get(r["index"], 10.0 ** (r["index"] - 12))
            r["gpu_ms"] = {"march": figure(ms, 0), "all": figure(ms, 0)}
            r["error"] = {"psnr": None, "ssim": 1, "flip": 0}
        self.report(content)
        b = self.open(390)
        self.assertNotIn("nan", b.value("document.body.innerHTML.match(/=\"[^\"]*(nan|inf)[^\"]*\"/i) || ''"))
        self.assertLessEqual(b.value("document.documentElement.scrollWidth"), 390)


if __name__ == "__main__":
    main()
