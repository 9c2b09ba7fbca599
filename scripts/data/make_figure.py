#!/usr/bin/env python3
"""Write effects/data/figure.obj: a runner in mid-stride, of 1.8 m, who runs towards +X.

  /usr/bin/python3 scripts/data/make_figure.py effects/data

Debian: apt-get install python3-numpy. Limbs are cones with round ends between the joints of a
skeleton, muscles are ellipsoids on them, and all of it is joined with fillets.
"""
import sys

import numpy as np

from shapes import brick, cut, ellipsoid, join, limb, turned
from surface import build, write_obj

TRIANGLES = 14000


def point(start, direction, length):
    d = np.array(direction, float)
    return np.array(start, float) + length * d / np.sqrt(d @ d)


def between(a, b, t, offset=(0, 0, 0)):
    return np.array(a) * (1 - t) + np.array(b) * t + np.array(offset)


def basis(forward, side):
    """A turn that brings X along `forward`, and Y near `side`."""
    x = np.array(forward, float) / np.sqrt(np.dot(forward, forward))
    y = np.array(side, float) - x * np.dot(side, x)
    y /= np.sqrt(y @ y)
    return np.column_stack((x, y, np.cross(x, y)))


def leg(side, hip, thigh, shin, foot):
    """Thigh, calf and foot from the hip down; directions of each."""
    knee = point(hip, thigh, 0.445)
    ankle = point(knee, shin, 0.425)
    sole = basis(foot, (0, 1, 0))
    ahead = np.array(thigh, float) / np.sqrt(np.dot(thigh, thigh))
    front = basis(ahead, (0, 1, 0))[:, 2] * -1       # where the knee looks
    behind = basis(shin, (0, 1, 0))[:, 2]            # where the calf is
    foot_at = lambda x, y, z: tuple(ankle + sole @ np.array((x, y, z)))
    return [
        limb((*hip, 0.102), (*between(hip, knee, 0.35), 0.092), (*between(hip, knee, 0.75), 0.068), (*knee, 0.058)),
        ellipsoid(between(hip, knee, 0.45, 0.026 * front), (0.20, 0.070, 0.066), front_turn(hip, knee)),
        ellipsoid(between(hip, knee, 0.82, 0.018 * front + (0, -0.018 * side, 0)), (0.065, 0.03, 0.034), front_turn(hip, knee)),
        ellipsoid(between(hip, knee, 0.50, -0.032 * front), (0.17, 0.062, 0.056), front_turn(hip, knee)),
        ellipsoid(between(hip, knee, 0.995, 0.018 * front), (0.036, 0.034, 0.034)),
        limb((*knee, 0.055), (*between(knee, ankle, 0.3), 0.053), (*between(knee, ankle, 0.7), 0.042), (*ankle, 0.038)),
        ellipsoid(between(knee, ankle, 0.28, 0.026 * behind + (0, 0.012 * side, 0)), (0.120, 0.047, 0.051), front_turn(knee, ankle)),
        ellipsoid(between(knee, ankle, 0.26, 0.026 * behind + (0, -0.014 * side, 0)), (0.130, 0.047, 0.051), front_turn(knee, ankle)),
        limb((*between(knee, ankle, 0.8, 0.024 * behind), 0.020), (*foot_at(-0.054, 0, -0.03), 0.027)),
        limb((*foot_at(-0.050, 0, -0.045), 0.037), (*foot_at(0.03, 0, -0.03), 0.044), (*foot_at(0.120, -0.012 * side, -0.053), 0.032)),
        brick(foot_at(0.115, -0.008 * side, -0.064), (0.060, 0.047, 0.022), 0.020, sole),
        limb((*foot_at(0.14, 0.022 * side, -0.064), 0.018), (*foot_at(0.186, 0.026 * side, -0.068), 0.016)),
        limb((*foot_at(0.14, -0.030 * side, -0.060), 0.022), (*foot_at(0.206, -0.026 * side, -0.064), 0.020)),
        limb((*foot_at(0.14, 0.0, -0.062), 0.020), (*foot_at(0.202, 0.002 * side, -0.066), 0.017)),
    ]


def front_turn(a, b):
    return basis(np.array(b) - np.array(a), (0, 1, 0))


def arm(side, shoulder, upper, fore, hand):
    """Upper arm, forearm, and a hand with straight fingers, as sprinters hold it. They are stout: smoke has no finer ones."""
    elbow = point(shoulder, upper, 0.295)
    wrist = point(elbow, fore, 0.255)
    palm = point(wrist, hand, 0.055)
    turn = basis(hand, (0, 1, 0))
    at = lambda x, y, z: tuple(wrist + turn @ np.array((x, y, z)))
    along = front_turn(shoulder, elbow)
    bend = np.array(fore, float) / np.sqrt(np.dot(fore, fore))
    parts = [
        limb((*shoulder, 0.062), (*between(shoulder, elbow, 0.5), 0.052), (*elbow, 0.044)),
        ellipsoid(between(shoulder, elbow, 0.12), (0.095, 0.070, 0.072), along),
        ellipsoid(between(shoulder, elbow, 0.58, 0.020 * bend), (0.088, 0.044, 0.044), along),
        ellipsoid(between(shoulder, elbow, 0.50, -0.020 * bend), (0.098, 0.043, 0.042), along),
        ellipsoid(elbow - 0.012 * bend, (0.034, 0.032, 0.032)),
        limb((*elbow, 0.043), (*between(elbow, wrist, 0.25), 0.049), (*wrist, 0.034)),
        ellipsoid(between(elbow, wrist, 0.26, (0, 0.008 * side, 0)), (0.088, 0.052, 0.050), front_turn(elbow, wrist)),
        brick(palm, (0.050, 0.024, 0.046), 0.022, turn),
        limb((*at(0.02, -0.012 * side, 0.036), 0.022), (*at(0.065, -0.018 * side, 0.064), 0.018), (*at(0.105, -0.018 * side, 0.074), 0.014)),
    ]
    for k in range(4):
        z = 0.036 - 0.024 * k
        reach = (0.150, 0.166, 0.158, 0.136)[k]
        parts.append(limb((*at(0.085, 0.002 * side, z), 0.0165), (*at(0.6 * reach + 0.04, -0.004 * side, 1.08 * z), 0.0155),
                          (*at(reach + 0.03, -0.022 * side, 1.12 * z), 0.0125)))
    return parts


def head(neck, turn):
    """Skull, face, ears and hair that lies close; in its own axes X looks ahead."""
    at = lambda x, y, z: tuple(np.array(neck) + turn @ np.array((x, y, z)))
    skull = [
        ellipsoid(at(0.008, 0, 0.175), (0.102, 0.077, 0.092), turn),
        ellipsoid(at(0.052, 0, 0.120), (0.052, 0.056, 0.080), turn),          # the face
        limb((*at(0.02, 0.048, 0.095), 0.020), (*at(0.080, 0.016, 0.058), 0.018), (*at(0.086, 0, 0.055), 0.018)),
        limb((*at(0.02, -0.048, 0.095), 0.020), (*at(0.080, -0.016, 0.058), 0.018), (*at(0.086, 0, 0.055), 0.018)),
        limb((*at(0.094, 0, 0.148), 0.011), (*at(0.116, 0, 0.115), 0.0135)),  # nose
        ellipsoid(at(0.098, 0, 0.082), (0.016, 0.026, 0.015), turn),          # mouth
        ellipsoid(at(0.091, 0, 0.163), (0.018, 0.050, 0.014), turn),          # brow
    ]
    eyes = [ellipsoid(at(0.104, s * 0.033, 0.142), (0.016, 0.017, 0.012), turn) for s in (-1, 1)]
    ears = [ellipsoid(at(-0.004, s * 0.077, 0.128), (0.020, 0.010, 0.032), turn @ turned(s * 18, "z")) for s in (-1, 1)]
    hair = [ellipsoid(at(-0.010, 0, 0.188), (0.100, 0.080, 0.092), turn),
            limb((*at(-0.105, 0, 0.190), 0.024), (*at(-0.150, 0.01, 0.180), 0.040), (*at(-0.225, 0.020, 0.150), 0.036),
                 (*at(-0.30, 0.010, 0.140), 0.010))]
    return join(0.012, cut(0.014, join(0.022, *skull), *eyes), join(0.03, *hair), *ears)


def trunk():
    """Pelvis, belly, chest and shoulders, leaning forward; the shoulders turn against the hips."""
    lean = turned(14, "y")
    at = lambda x, y, z: tuple(np.array((0, 0, 1.05)) + lean @ np.array((x, y, z)))
    twist = lean @ turned(-16, "z")
    chest = lambda x, y, z: tuple(np.array(at(0, 0, 0.33)) + twist @ np.array((x, y, z)))
    soft = join(
        0.07,
        ellipsoid(at(0, 0, 0.00), (0.105, 0.150, 0.105), lean),                                   # pelvis
        limb((*at(0.0, 0, 0.02), 0.105), (*at(0.012, 0, 0.15), 0.098), (*at(0.0, 0, 0.25), 0.108)),
        ellipsoid(at(0.01, 0.055, 0.12), (0.085, 0.075, 0.12), lean), ellipsoid(at(0.01, -0.055, 0.12), (0.085, 0.075, 0.12), lean),
        ellipsoid(chest(0, 0, 0.015), (0.128, 0.166, 0.182), twist),                               # ribs
        limb((*chest(-0.015, -0.145, 0.145), 0.058), (*chest(-0.03, 0, 0.165), 0.065), (*chest(-0.015, 0.145, 0.145), 0.058)),
        limb((*chest(-0.02, 0, 0.14), 0.072), (*chest(0.045, 0, 0.29), 0.062)),                     # neck
    )
    parts = [soft]
    for s in (-1, 1):
        parts += [
            ellipsoid(chest(0.078, s * 0.072, 0.065), (0.056, 0.086, 0.068), twist @ turned(s * 12, "z")),  # breast
            ellipsoid(chest(-0.070, s * 0.082, 0.055), (0.052, 0.062, 0.110), twist),              # shoulder blade
            ellipsoid(chest(-0.02, s * 0.125, -0.02), (0.065, 0.045, 0.125), twist),               # flank
            limb((*chest(-0.025, s * 0.02, 0.24), 0.030), (*chest(-0.03, s * 0.10, 0.175), 0.036)),
            ellipsoid(at(-0.070, s * 0.068, -0.045), (0.088, 0.082, 0.094), lean),                 # seat
            limb((*at(0.074, s * 0.030, 0.24), 0.027), (*at(0.082, s * 0.030, 0.14), 0.026), (*at(0.072, s * 0.026, 0.04), 0.022)),
        ]
    return join(0.030, *parts), chest


def figure():
    body, chest = trunk()
    shoulder = {s: chest(-0.012, s * 0.185, 0.135) for s in (-1, 1)}
    neck = chest(0.035, 0, 0.210)
    legs = [
        join(0.028, *leg(-1, (0.03, -0.092, 1.035), (0.92, -0.03, -0.26), (-0.06, 0.0, -1), (0.96, -0.02, 0.06))),
        join(0.028, *leg(1, (-0.03, 0.092, 1.02), (-0.58, 0.03, -0.80), (-0.93, -0.02, -0.24), (-0.05, 0.0, -1))),
    ]
    arms = [
        join(0.022, *arm(-1, shoulder[-1], (-0.88, -0.30, -0.26), (0.16, -0.10, -0.97), (0.30, 0.0, -0.95))),
        join(0.022, *arm(1, shoulder[1], (0.70, 0.16, -0.64), (0.62, -0.20, 0.78), (0.58, -0.12, 0.80))),
    ]
    return join(0.014, join(0.045, body, *legs), join(0.04, *arms), head(neck, turned(4, "y")))


mesh = build(join(0.03, figure()), (-1.0, -0.55, 0.1), (1.0, 0.55, 2.0), float(sys.argv[2]) if len(sys.argv) > 2 else 0.0125, TRIANGLES)
write_obj(sys.argv[1], "figure", "make_figure.py", mesh, {"body": (0.55, 0.53, 0.50)})
