#!/usr/bin/env python3
"""Write the flow templates of effects/templates: OpenEXR files of 64 x 64 halves, and a sheet of them.

  /usr/bin/python3 scripts/data/make_templates.py effects/templates

Debian: apt-get install python3-numpy. What the channels mean stands in effects/templates/README.md.
Velocities are mostly curls of a stream function, so that the solver has little to take away.
"""
import os
import struct
import sys
import zlib

import numpy as np

SIDE = 64
BORDER = 0.3   # standard deviation of alpha, in halves of a side: 1 in the middle, 0.004 at the border
PANEL, GAP, COLUMNS = 128, 8, 5

HALF = (np.arange(SIDE) + 0.5) / SIDE * 2 - 1
X, Y = np.meshgrid(HALF, -HALF)   # rows from the top, Y up
R2 = X**2 + Y**2


def bump(x, y, wide, high=None):
    high = wide if high is None else high
    return np.exp(-0.5 * (((X - x) / wide)**2 + ((Y - y) / high)**2))


def slopes(values):
    """d/dx and d/dy, with Y up."""
    dy, dx = np.gradient(values, 2 / SIDE)
    return dx, -dy


def curl(stream):
    """The flow along the lines of a stream function: anticlockwise round a hill."""
    dx, dy = slopes(stream)
    return -dy, dx


def down(potential):
    """The flow from where it is high to where it is low."""
    dx, dy = slopes(potential)
    return -dx, -dy


def waves(seed, least, most, count=24):
    """A sum of waves of random directions, `least` to `most` of them across a side."""
    random = np.random.default_rng(seed)
    out = np.zeros_like(X)
    for _ in range(count):
        turn, phase = random.uniform(0, 2 * np.pi, 2)
        k = np.pi * random.uniform(least, most)
        out += np.cos(k * (np.cos(turn) * X + np.sin(turn) * Y) + phase) / k
    return out


def mushroom():
    """A jet upwards that rolls up on both sides of its tip."""
    return X * bump(0, 0.1, 0.3, 0.5) + 0.25 * (bump(0.38, 0.3, 0.17) - bump(-0.38, 0.3, 0.17))


# name: velocity (right, up), pressure. All are scaled to 1 afterwards.
TEMPLATES = {
    "source": (down(bump(0, 0, 0.33)), bump(0, 0, 0.33)),
    "sink": (down(-bump(0, 0, 0.33)), -bump(0, 0, 0.33)),
    "vortex_left": (curl(-bump(0, 0, 0.33)), -bump(0, 0, 0.25)),
    "vortex_right": (curl(bump(0, 0, 0.33)), -bump(0, 0, 0.25)),
    "pump": (down((1 - R2 / 0.12) * bump(0, 0, 0.35)), (R2 / 0.12 - 1) * bump(0, 0, 0.35)),
    "jet": (curl(X * bump(0, 0, 0.25, 0.55)), bump(0, -0.32, 0.25) - bump(0, 0.32, 0.25)),
    "pair": (curl(X * bump(0, 0, 0.36)), bump(0, 0.4, 0.2) - bump(-0.36, 0, 0.22) - bump(0.36, 0, 0.22)),
    "corona": (curl(mushroom()), bump(0, -0.2, 0.22, 0.3) - 0.7 * (bump(0.42, 0.3, 0.18) + bump(-0.42, 0.3, 0.18))),
    "corrugation": (curl(np.sin(3 * np.pi * X) * bump(0, 0, 0.6, 0.35)), np.cos(3 * np.pi * X) * bump(0, 0, 0.6, 0.35)),
    "swirls": (curl(waves(3, 3, 7)), waves(5, 3, 7)),
}


def rgba(velocity, pressure):
    """Scaled so that the greatest speed, and pressure, within the border is 1."""
    alpha = np.exp(-0.5 * R2 / BORDER**2)
    seen = alpha > 0.01
    speed = np.sqrt(velocity[0]**2 + velocity[1]**2)[seen].max()
    return np.stack([velocity[0] / speed, velocity[1] / speed, pressure / np.abs(pressure[seen]).max(), alpha], 2)


# ---- files ----------------------------------------------------------------------------------------


def attribute(name, kind, data):
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data


def write_exr(path, image):
    """One part, scan lines, ZIP blocks of 16 lines, channels A B G R of halves."""
    height, width, _ = image.shape
    channels = b"".join(name + b"\0" + struct.pack("<iB3xii", 1, 0, 1, 1) for name in (b"A", b"B", b"G", b"R"))
    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = struct.pack("<ii", 20000630, 2)
    header += attribute("channels", "chlist", channels + b"\0") + attribute("compression", "compression", b"\3")
    header += attribute("dataWindow", "box2i", box) + attribute("displayWindow", "box2i", box)
    header += attribute("lineOrder", "lineOrder", b"\0") + attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
    header += attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0))
    header += attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0"
    blocks = []
    for y in range(0, height, 16):
        lines = image[y:y + 16, :, ::-1].transpose(0, 2, 1).astype("<f2").tobytes()
        parted = np.frombuffer(lines[0::2] + lines[1::2], np.uint8).astype(int)
        steps = np.concatenate([parted[:1], parted[1:] - parted[:-1] + 384]) & 255
        packed = zlib.compress(steps.astype(np.uint8).tobytes(), 9)
        if len(packed) >= len(lines):
            packed = lines
        blocks.append(struct.pack("<ii", y, len(packed)) + packed)
    at = len(header) + 8 * len(blocks)
    offsets = b""
    for block in blocks:
        offsets += struct.pack("<q", at)
        at += len(block)
    with open(path, "wb") as out:
        out.write(header + offsets + b"".join(blocks))


def write_png(path, image):
    """Bytes of red, green and blue."""
    chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"".join(b"\0" + row.tobytes() for row in image)
    with open(path, "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", image.shape[1], image.shape[0], 8, 2, 0, 0, 0))
                  + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


# ---- the sheet ------------------------------------------------------------------------------------


def sample(values, x, y):
    """Linear between pixels, coordinates in pixels."""
    x, y = np.clip(x, 0, values.shape[1] - 1.001), np.clip(y, 0, values.shape[0] - 1.001)
    i, j = x.astype(int), y.astype(int)
    u, v = x - i, y - j
    return ((values[j, i] * (1 - u) + values[j, i + 1] * u) * (1 - v)
            + (values[j + 1, i] * (1 - u) + values[j + 1, i + 1] * u) * v)


def enlarged(values):
    at = (np.arange(PANEL) + 0.5) * SIDE / PANEL - 0.5
    return sample(values, *np.meshgrid(at, at))


def pressure_panel(image):
    """Green is raised, red lowered, as published; by as much as the template is blended in."""
    p = np.clip(enlarged(image[:, :, 2] * np.sqrt(image[:, :, 3])), -1, 1)
    ground = np.full_like(p, 0.08)
    return np.stack([ground + 0.9 * np.maximum(-p, 0), ground + 0.75 * np.maximum(p, 0), ground], 2)


def hues(angle):
    """Whereto, as a colour: red is right, yellow-green up, cyan left, violet down."""
    return np.stack([0.5 + 0.5 * np.cos(angle - turn) for turn in (0, 2 * np.pi / 3, -2 * np.pi / 3)], 2)


def velocity_panel(image, noise):
    """Noise smeared along the flow (Cabral and Leedom 1993), bright where it is fast."""
    weight = np.sqrt(image[:, :, 3])
    u, v = enlarged(image[:, :, 0] * weight), -enlarged(image[:, :, 1] * weight)
    speed = np.sqrt(u**2 + v**2)
    lines = np.zeros_like(u)
    for sign in (-1, 1):
        x, y = np.meshgrid(np.arange(PANEL, dtype=float), np.arange(PANEL, dtype=float))
        for step in range(16):
            lines += sample(noise, x, y) * (1 - step / 16)
            s = np.maximum(sample(speed, x, y), 1e-3)
            x, y = x + sign * sample(u, x, y) / s * 0.7, y + sign * sample(v, x, y) / s * 0.7
    lines = np.clip((lines - lines.mean()) / lines.std() * 0.2 + 0.6, 0, 1)
    bright = np.clip(speed, 0, 1)**0.7 * lines
    return 0.08 + bright[:, :, None] * (0.25 + 0.75 * hues(np.arctan2(-v, u)))


def sheet(images):
    rows = (len(images) + COLUMNS - 1) // COLUMNS
    cell = (2 * PANEL + GAP, PANEL + 2 * GAP)
    out = np.ones((rows * cell[0] + GAP * (rows + 1), COLUMNS * PANEL + GAP * (COLUMNS + 1), 3)) * 0.2
    noise = np.random.default_rng(1).uniform(0, 1, (PANEL, PANEL))
    for k, image in enumerate(images):
        y, x = (k // COLUMNS) * (cell[0] + GAP) + GAP, (k % COLUMNS) * (PANEL + GAP) + GAP
        out[y:y + PANEL, x:x + PANEL] = pressure_panel(image)
        out[y + PANEL + 2:y + 2 * PANEL + 2, x:x + PANEL] = velocity_panel(image, noise)
    return (np.clip(out, 0, 1) * 255 + 0.5).astype(np.uint8)


def main():
    folder = sys.argv[1]
    images = []
    for name, (velocity, pressure) in TEMPLATES.items():
        images.append(rgba(velocity, pressure))
        write_exr(os.path.join(folder, name + ".exr"), images[-1])
    write_png(os.path.join(folder, "sheet.png"), sheet(images))


if __name__ == "__main__":
    main()
