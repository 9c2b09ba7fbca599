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

TRIANGLES = 9000


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
        limb((*hip, 0.098), (*between(hip, knee, 0.35), 0.086), (*between(hip, knee, 0.75), 0.062), (*knee, 0.054)),
        ellipsoid(between(hip, knee, 0.45, 0.026 * front), (0.20, 0.062, 0.058), front_turn(hip, knee)),
        ellipsoid(between(hip, knee, 0.82, 0.018 * front + (0, -0.018 * side, 0)), (0.065, 0.03, 0.034), front_turn(hip, knee)),
        ellipsoid(between(hip, knee, 0.50, -0.032 * front), (0.17, 0.056, 0.046), front_turn(hip, knee)),
        ellipsoid(between(hip, knee, 0.995, 0.018 * front), (0.036, 0.034, 0.034)),
        limb((*knee, 0.050), (*between(knee, ankle, 0.3), 0.046), (*between(knee, ankle, 0.7), 0.035), (*ankle, 0.031)),
        ellipsoid(between(knee, ankle, 0.28, 0.026 * behind + (0, 0.012 * side, 0)), (0.115, 0.040, 0.042), front_turn(knee, ankle)),
        ellipsoid(between(knee, ankle, 0.26, 0.026 * behind + (0, -0.014 * side, 0)), (0.125, 0.040, 0.042), front_turn(knee, ankle)),
        limb((*between(knee, ankle, 0.8, 0.022 * behind), 0.016), (*foot_at(-0.052, 0, -0.03), 0.022)),
        limb((*foot_at(-0.045, 0, -0.045), 0.031), (*foot_at(0.03, 0, -0.03), 0.036), (*foot_at(0.115, -0.012 * side, -0.055), 0.024)),
        brick(foot_at(0.115, -0.008 * side, -0.064), (0.055, 0.042, 0.016), 0.015, sole),
        limb((*foot_at(0.14, 0.022 * side, -0.066), 0.013), (*foot_at(0.178, 0.026 * side, -0.07), 0.011)),
        limb((*foot_at(0.14, -0.030 * side, -0.062), 0.017), (*foot_at(0.196, -0.026 * side, -0.067), 0.015)),
        limb((*foot_at(0.14, 0.0, -0.064), 0.015), (*foot_at(0.192, 0.002 * side, -0.069), 0.012)),
    ]


def front_turn(a, b):
    return basis(np.array(b) - np.array(a), (0, 1, 0))


def arm(side, shoulder, upper, fore, hand):
    """Upper arm, forearm, and a loose fist with a thumb."""
    elbow = point(shoulder, upper, 0.295)
    wrist = point(elbow, fore, 0.255)
    palm = point(wrist, hand, 0.055)
    turn = basis(hand, (0, 1, 0))
    at = lambda x, y, z: tuple(wrist + turn @ np.array((x, y, z)))
    along = front_turn(shoulder, elbow)
    bend = np.array(fore, float) / np.sqrt(np.dot(fore, fore))
    parts = [
        limb((*shoulder, 0.058), (*between(shoulder, elbow, 0.5), 0.046), (*elbow, 0.038)),
        ellipsoid(between(shoulder, elbow, 0.12), (0.085, 0.062, 0.064), along),
        ellipsoid(between(shoulder, elbow, 0.58, 0.020 * bend), (0.085, 0.037, 0.036), along),
        ellipsoid(between(shoulder, elbow, 0.50, -0.020 * bend), (0.095, 0.037, 0.034), along),
        ellipsoid(elbow - 0.012 * bend, (0.034, 0.032, 0.032)),
        limb((*elbow, 0.037), (*between(elbow, wrist, 0.25), 0.042), (*wrist, 0.026)),
        ellipsoid(between(elbow, wrist, 0.26, (0, 0.008 * side, 0)), (0.085, 0.045, 0.041), front_turn(elbow, wrist)),
        brick(palm, (0.046, 0.020, 0.040), 0.018, turn),
        limb((*at(0.03, -0.012 * side, 0.030), 0.015), (*at(0.075, -0.020 * side, 0.044), 0.012), (*at(0.10, -0.020 * side, 0.03), 0.010)),
    ]
    for k in range(4):
        z = 0.030 - 0.020 * k
        reach = (0.098, 0.105, 0.100, 0.088)[k]
        parts.append(limb((*at(0.085, 0.004 * side, z), 0.0125), (*at(reach + 0.02, -0.004 * side, z), 0.0115),
                          (*at(reach + 0.022, -0.030 * side, z), 0.0105), (*at(reach - 0.01, -0.038 * side, z), 0.0095)))
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
    lean = turned(11, "y")
    at = lambda x, y, z: tuple(np.array((0, 0, 1.05)) + lean @ np.array((x, y, z)))
    twist = lean @ turned(-16, "z")
    chest = lambda x, y, z: tuple(np.array(at(0, 0, 0.33)) + twist @ np.array((x, y, z)))
    soft = join(
        0.07,
        ellipsoid(at(0, 0, 0.00), (0.105, 0.150, 0.105), lean),                                   # pelvis
        limb((*at(0.0, 0, 0.02), 0.105), (*at(0.012, 0, 0.15), 0.098), (*at(0.0, 0, 0.25), 0.108)),
        ellipsoid(at(0.01, 0.055, 0.12), (0.085, 0.075, 0.12), lean), ellipsoid(at(0.01, -0.055, 0.12), (0.085, 0.075, 0.12), lean),
        ellipsoid(chest(0, 0, 0.015), (0.120, 0.158, 0.175), twist),                               # ribs
        limb((*chest(-0.015, -0.145, 0.145), 0.058), (*chest(-0.03, 0, 0.165), 0.065), (*chest(-0.015, 0.145, 0.145), 0.058)),
        limb((*chest(-0.02, 0, 0.14), 0.068), (*chest(0.045, 0, 0.30), 0.056)),                     # neck
    )
    parts = [soft]
    for s in (-1, 1):
        parts += [
            ellipsoid(chest(0.078, s * 0.072, 0.065), (0.050, 0.082, 0.062), twist @ turned(s * 12, "z")),  # breast
            ellipsoid(chest(-0.070, s * 0.082, 0.055), (0.052, 0.062, 0.110), twist),              # shoulder blade
            ellipsoid(chest(-0.02, s * 0.125, -0.02), (0.065, 0.045, 0.125), twist),               # flank
            limb((*chest(-0.025, s * 0.02, 0.24), 0.030), (*chest(-0.03, s * 0.10, 0.175), 0.036)),
            ellipsoid(at(-0.070, s * 0.068, -0.045), (0.078, 0.078, 0.088), lean),                 # seat
            limb((*at(0.074, s * 0.030, 0.24), 0.027), (*at(0.082, s * 0.030, 0.14), 0.026), (*at(0.072, s * 0.026, 0.04), 0.022)),
        ]
    return join(0.030, *parts), chest


def figure():
    body, chest = trunk()
    shoulder = {s: chest(-0.012, s * 0.185, 0.135) for s in (-1, 1)}
    neck = chest(0.035, 0, 0.225)
    legs = [
        join(0.028, *leg(-1, (0.03, -0.092, 1.035), (0.90, -0.03, -0.36), (-0.10, 0.0, -1), (0.95, -0.02, -0.22))),
        join(0.028, *leg(1, (-0.03, 0.092, 1.02), (-0.55, 0.03, -0.84), (-0.90, -0.02, -0.42), (0.12, 0.0, -1))),
    ]
    arms = [
        join(0.022, *arm(-1, shoulder[-1], (-0.86, -0.30, -0.38), (0.26, -0.10, -0.95), (0.45, 0.0, -0.90))),
        join(0.022, *arm(1, shoulder[1], (0.62, 0.16, -0.76), (0.80, -0.22, 0.62), (0.78, -0.15, 0.62))),
    ]
    return join(0.014, join(0.045, body, *legs), join(0.04, *arms), head(neck, turned(4, "y")))


mesh = build(join(0.03, figure()), (-1.0, -0.55, 0.1), (1.0, 0.55, 2.0), float(sys.argv[2]) if len(sys.argv) > 2 else 0.0125, TRIANGLES)
write_obj(sys.argv[1], "figure", "make_figure.py", mesh, {"body": (0.55, 0.53, 0.50)})
