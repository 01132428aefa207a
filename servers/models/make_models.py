#!/usr/bin/env python3
"""Draws the project's own models of vehicles and writes each as a glTF file beside this script.

  make_models.py [FOLDER]

Shapes are made of a few closed parts in metres: tapered tubes, wings, boxes, wheels. Axes are glTF's: y up, z forward,
x to the left; the origin is the middle of the vehicle in the air, and the ground under its middle for what stands on
the ground. Faces are flat-shaded where edges are hard and smooth around tubes. Standard library only; the output is the
same on every run.
"""

import base64
import json
import math
import struct
import sys
from pathlib import Path


class Model:
    """Triangles by material; each vertex is (position, normal)."""

    def __init__(self):
        self.materials = {}  # (part, name) -> (rgb, [vertices])
        self.parts = {}  # what moves by itself: name -> (pivot, the part that it hangs under or None)
        self.part = None
        self.stations = {}  # where something can be attached: number of SISO-REF-010 -> place

    def colour(self, name, rgb):
        self.materials.setdefault((self.part, name), (rgb, []))
        return self.materials[self.part, name][1]

    def begin(self, part, pivot, under=None):
        """What follows belongs to that part, which turns about the pivot; end() goes back to the body."""
        self.parts[part] = (pivot, under)
        self.part = part

    def end(self):
        self.part = None

    def station(self, number, place):
        self.stations[number] = place

    def triangle(self, out, a, b, c, normals=None):
        if normals is None:
            n = normal_of(a, b, c)
            if n is None:
                return
            normals = (n, n, n)
        elif normal_of(a, b, c) is None:
            return
        out.extend(zip((a, b, c), normals))

    def quad(self, out, a, b, c, d, normals=None):
        if normals is None:
            self.triangle(out, a, b, c)
            self.triangle(out, a, c, d)
        else:
            self.triangle(out, a, b, c, (normals[0], normals[1], normals[2]))
            self.triangle(out, a, c, d, (normals[0], normals[2], normals[3]))

    def tube(self, out, stations, sides=12, axis="z"):
        """A closed body along an axis: stations are (along, centre_x, centre_y, radius_x, radius_y), in rising order."""
        rings = []
        for along, cx, cy, rx, ry in stations:
            ring = []
            for i in range(sides):
                t = 2 * math.pi * i / sides
                ring.append(place(axis, cx + rx * math.cos(t), cy + ry * math.sin(t), along))
            rings.append(ring)
        centres = [place(axis, s[1], s[2], s[0]) for s in stations]
        normals = smooth_normals(rings, centres, stations)
        for k in range(len(rings) - 1):
            for i in range(sides):
                j = (i + 1) % sides
                corners = (rings[k][i], rings[k][j], rings[k + 1][j], rings[k + 1][i])
                around = (normals[k][i], normals[k][j], normals[k + 1][j], normals[k + 1][i])
                self.quad(out, *corners, around)
        for k, turn in ((0, 1), (len(rings) - 1, 0)):
            for i in range(sides):
                j = (i + 1) % sides
                pair = (rings[k][j], rings[k][i]) if turn else (rings[k][i], rings[k][j])
                self.triangle(out, centres[k], *pair)

    def wing(self, out, root, tip, vertical=False):
        """A closed slab from a root section to a tip section: (x, y, z of the leading edge, chord, thickness)."""
        sections = []
        for x, y, z, chord, thick in (root, tip):
            points = [(0, 0), (-0.3, 0.5), (-1, 0), (-0.3, -0.5)]  # leading edge, top, trailing edge, bottom
            section = []
            for along, up in points:
                offset = (up * thick, 0) if vertical else (0, up * thick)
                section.append((x + offset[0], y + offset[1], z + along * chord))
            sections.append(section)
        self.loft(out, sections)

    def loft(self, out, sections):
        """Closes the outline of each section to the next, and both ends; turned outwards whichever way they run."""
        faces = []
        count = len(sections[0])
        for first, second in zip(sections, sections[1:]):
            for i in range(count):
                j = (i + 1) % count
                faces.append([first[i], first[j], second[j], second[i]])
        faces.append(list(reversed(sections[0])))
        faces.append(list(sections[-1]))
        if volume_of(faces) < 0:
            faces = [list(reversed(face)) for face in faces]
        for face in faces:
            for i in range(1, len(face) - 1):
                self.triangle(out, face[0], face[i], face[i + 1])

    def prism(self, out, outline, x0, x1):
        """A profile of (z, y) points, seen from the side, pulled from x0 to x1."""
        self.loft(out, [[(x, y, z) for z, y in outline] for x in (x0, x1)])

    def box(self, out, x0, x1, y0, y1, z0, z1):
        self.prism(out, [(z0, y0), (z1, y0), (z1, y1), (z0, y1)], x0, x1)

    def wheel(self, out, x, y, z, radius, width, sides=10):
        self.tube(out, [(x - width / 2, y, z, radius, radius), (x + width / 2, y, z, radius, radius)], sides, "x")


def place(axis, a, b, along):
    """(a, b) across an axis, `along` on it: across z that is x, y; across x it is y, z; across y it is z, x."""
    return {"z": (a, b, along), "x": (along, a, b), "y": (b, along, a)}[axis]


def sub(a, b):
    return tuple(p - q for p, q in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return sum(p * q for p, q in zip(a, b))


def unit(v):
    length = math.sqrt(dot(v, v))
    return tuple(p / length for p in v) if length > 1e-12 else None


def normal_of(a, b, c):
    return unit(cross(sub(b, a), sub(c, a)))


def volume_of(faces):
    return sum(dot(f[0], cross(f[i], f[i + 1])) for f in faces for i in range(1, len(f) - 1))


def smooth_normals(rings, centres, stations):
    normals = []
    for k, ring in enumerate(rings):
        before, after = max(k - 1, 0), min(k + 1, len(rings) - 1)
        out = []
        for i, point in enumerate(ring):
            j = (i + 1) % len(ring)
            h = (i - 1) % len(ring)
            around = sub(ring[j], ring[h])
            if dot(around, around) < 1e-12:  # a ring shrunk to a point: that of its wider neighbour
                near = rings[after] if k == before else rings[before]
                around = sub(near[j], near[h])
            along = sub(rings[after][i], rings[before][i])
            out.append(unit(cross(around, along)) or (0.0, 0.0, 1.0))
        normals.append(out)
    return normals


# ---- the vehicles ----------------------------------------------------------------------------------------------------

WHITE = (0.86, 0.88, 0.90)
BLUE = (0.10, 0.22, 0.50)
RED = (0.70, 0.10, 0.10)
GLASS = (0.08, 0.12, 0.16)
GREY = (0.42, 0.45, 0.48)
DARK = (0.10, 0.10, 0.11)
GREEN = (0.24, 0.29, 0.17)
ORANGE = (0.90, 0.42, 0.08)
STEEL = (0.55, 0.58, 0.60)


def both(function):
    for side in (1, -1):
        function(side)


def airliner():
    m = Model()
    body = m.colour("fuselage", WHITE)
    m.tube(body, [(-19.0, 0, 1.3, 0.15, 0.2), (-14.0, 0, 0.75, 1.1, 1.2), (-8.0, 0, 0.1, 1.9, 1.95), (12.0, 0, 0, 1.95, 2.0),
                  (15.5, 0, -0.1, 1.7, 1.75), (17.6, 0, -0.4, 1.0, 1.05), (18.8, 0, -0.6, 0.12, 0.12)], 14)
    m.tube(m.colour("windows", GLASS), [(15.7, 0, 0.9, 1.45, 0.75), (17.1, 0, 0.35, 1.1, 0.6)], 14)
    wing = m.colour("wings", STEEL)
    engine = m.colour("engines", BLUE)

    def side(s):
        m.wing(wing, (s * 1.4, -1.1, 4.6, 7.2, 0.95), (s * 6.2, -0.6, 1.4, 4.2, 0.55))
        m.wing(wing, (s * 6.2, -0.6, 1.4, 4.2, 0.55), (s * 17.2, 0.4, -4.6, 1.5, 0.2))
        m.wing(wing, (s * 17.2, 0.4, -4.6, 1.5, 0.2), (s * 17.9, 2.4, -5.8, 0.6, 0.1))
        m.wing(wing, (s * 0.6, 1.2, -14.6, 3.6, 0.4), (s * 6.4, 1.8, -18.0, 1.3, 0.15))
        m.tube(engine, [(0.6, s * 5.7, -2.1, 0.7, 0.7), (2.4, s * 5.7, -2.1, 1.1, 1.1), (4.4, s * 5.7, -2.1, 1.0, 1.0)], 10)
        m.box(engine, s * 5.7 - 0.15, s * 5.7 + 0.15, -1.3, -0.6, 0.0, 3.2)

    both(side)
    m.begin("gear", (0, -1.6, 0))
    for x, z in ((0, 13.5), (2.9, -1.5), (-2.9, -1.5)):
        m.box(m.colour("legs", GREY), x - 0.12, x + 0.12, -3.2, -1.4, z - 0.12, z + 0.12)
        for w in (-0.35, 0.35):
            m.wheel(m.colour("wheels", DARK), x + w, -3.2, z, 0.55, 0.35, 6)
    m.end()
    m.wing(m.colour("fin", BLUE), (0, 1.3, -12.6, 5.4, 0.45), (0, 7.7, -17.4, 2.2, 0.2), vertical=True)
    return m


def light_aircraft():
    m = Model()
    body = m.colour("fuselage", WHITE)
    m.tube(body, [(-4.6, 0, 0.35, 0.08, 0.15), (-1.6, 0, 0.1, 0.42, 0.5), (0.4, 0, 0.1, 0.6, 0.75), (1.9, 0, -0.05, 0.56, 0.55),
                  (3.2, 0, -0.1, 0.35, 0.35), (3.5, 0, -0.1, 0.1, 0.1)], 10)
    m.tube(m.colour("windows", GLASS), [(-0.8, 0, 0.55, 0.4, 0.2), (0.1, 0, 0.62, 0.56, 0.3), (1.1, 0, 0.55, 0.52, 0.24),
                                        (1.7, 0, 0.35, 0.4, 0.1)], 8)
    red = m.colour("trim", RED)
    wing = m.colour("wings", WHITE)

    def side(s):
        m.wing(wing, (s * 0.1, 0.95, 1.5, 1.6, 0.2), (s * 4.2, 1.02, 1.5, 1.5, 0.18))
        m.wing(red, (s * 4.2, 1.02, 1.5, 1.5, 0.18), (s * 5.5, 1.05, 1.3, 1.1, 0.1))
        m.wing(wing, (s * 0.05, 0.4, -3.4, 1.1, 0.1), (s * 1.7, 0.4, -3.6, 0.8, 0.06))
        m.wheel(m.colour("wheels", DARK), s * 1.1, -1.0, 0.4, 0.25, 0.18, 8)
        m.box(wing, s * 0.75 - 0.35, s * 0.75 + 0.35, -0.85, -0.75, 0.32, 0.5)

    both(side)
    m.wing(red, (0, 0.4, -3.1, 1.4, 0.1), (0, 1.8, -4.1, 0.8, 0.06), vertical=True)
    m.wheel(m.colour("wheels", DARK), 0, -1.0, 2.6, 0.2, 0.15, 8)
    m.box(wing, -0.05, 0.05, -0.9, -0.3, 2.55, 2.65)
    m.begin("propeller", (0, -0.1, 3.46))
    m.box(m.colour("propeller", DARK), -0.08, 0.08, -1.05, 0.85, 3.42, 3.5)
    m.end()
    return m


def helicopter():
    m = Model()
    body = m.colour("fuselage", ORANGE)
    m.tube(body, [(-7.2, 0, 0.55, 0.12, 0.14), (-2.4, 0, 0.3, 0.35, 0.4), (-1.2, 0, -0.1, 1.05, 1.0), (1.6, 0, -0.2, 1.2, 1.15),
                  (3.2, 0, -0.4, 0.9, 0.85), (4.2, 0, -0.7, 0.15, 0.2)], 12)
    m.tube(m.colour("windows", GLASS), [(1.5, 0, 0.05, 1.17, 0.97), (2.6, 0, -0.13, 1.02, 0.86), (3.5, 0, -0.28, 0.66, 0.54)], 12)
    m.tube(m.colour("engine", GREY), [(-2.4, 0, 0.9, 0.35, 0.3), (-1.4, 0, 1.0, 0.6, 0.45), (0.9, 0, 1.0, 0.55, 0.4)], 8)
    m.begin("rotor", (0, 1.8, -0.3))
    dark = m.colour("rotor", DARK)
    m.tube(dark, [(0.9, -0.3, 0, 0.14, 0.14), (1.9, -0.3, 0, 0.12, 0.12)], 6, "y")
    for blade in range(4):
        t = math.pi * (0.25 + blade / 2)
        c, s = math.cos(t), math.sin(t)
        across = (0.22 * -s, 0.22 * c)
        far = (6.6 * c, 6.6 * s)
        outline = [(across[0], across[1]), (far[0] + across[0], far[1] + across[1]), (far[0] - across[0], far[1] - across[1]),
                   (-across[0], -across[1])]
        m.loft(dark, [[(x, y, z - 0.3) for x, z in outline] for y in (1.78, 1.86)])
    m.end()
    m.wing(body, (0, 0.5, -6.2, 1.3, 0.2), (0, 2.2, -7.0, 0.7, 0.12), vertical=True)
    m.begin("tail_rotor", (0.17, 1.3, -6.95))
    dark = m.colour("rotor", DARK)
    m.box(dark, 0.14, 0.2, 0.45, 2.15, -7.05, -6.85)
    m.box(dark, 0.14, 0.2, 1.2, 1.4, -7.8, -6.1)
    m.end()

    def side(s):
        m.wing(body, (s * 0.1, 0.5, -5.2, 0.8, 0.1), (s * 1.4, 0.5, -5.3, 0.6, 0.08))
        m.tube(m.colour("skids", GREY), [(-1.9, s * 1.15, -2.0, 0.08, 0.08), (2.6, s * 1.15, -2.0, 0.08, 0.08)], 6)
        for z in (-0.8, 1.4):
            m.box(m.colour("skids", GREY), min(s * 0.5, s * 1.15), max(s * 0.5, s * 1.15), -2.0, -0.9, z - 0.06, z + 0.06)

    both(side)
    return m


def fighter():
    m = Model()
    body = m.colour("fuselage", GREY)
    m.tube(body, [(-7.3, 0, 0, 0.6, 0.6), (-5.5, 0, 0, 0.85, 0.8), (-1.0, 0, 0, 1.05, 0.9), (2.5, 0, 0.05, 0.8, 0.75),
                  (5.2, 0, 0, 0.5, 0.5), (7.0, 0, -0.1, 0.2, 0.2), (7.7, 0, -0.12, 0.03, 0.03)], 12)
    m.tube(m.colour("nozzle", DARK), [(-7.9, 0, 0, 0.5, 0.5), (-7.2, 0, 0, 0.62, 0.62)], 10)
    m.tube(m.colour("canopy", GLASS), [(1.4, 0, 0.6, 0.2, 0.1), (2.6, 0, 0.75, 0.42, 0.45), (3.9, 0, 0.62, 0.4, 0.38),
                                       (5.1, 0, 0.35, 0.2, 0.12)], 8)
    m.box(m.colour("intake", DARK), -0.55, 0.55, -1.15, -0.5, -0.5, 2.2)
    wing = m.colour("wings", (0.36, 0.39, 0.42))

    def side(s):
        m.wing(wing, (s * 0.7, 0.05, 2.6, 6.2, 0.32), (s * 4.7, 0.05, -2.0, 1.5, 0.08))
        m.wing(wing, (s * 0.6, 0.05, -4.7, 2.6, 0.2), (s * 2.8, -0.1, -6.4, 1.2, 0.06))
        m.tube(m.colour("missiles", WHITE), [(-3.8, s * 4.8, 0.05, 0.06, 0.06), (-1.2, s * 4.8, 0.05, 0.07, 0.07),
                                             (-0.9, s * 4.8, 0.05, 0.01, 0.01)], 6)

    both(side)
    # Pylons: two under each wing, one under the fuselage. x is to the left.
    pylons = m.colour("pylons", GREY)
    for i, (x, z) in enumerate(((2.1, -0.6), (3.3, -1.5))):
        for wing_station, s in ((640, 1), (768, -1)):
            m.box(pylons, s * x - 0.05, s * x + 0.05, -0.3, 0.05, z - 0.8, z + 0.8)
            m.station(wing_station + i, (s * x, -0.41, z))
    m.station(512, (0, -1.27, 0.4))
    m.begin("gear", (0, -0.8, 0))
    for x, z in ((0, 3.8), (1.1, -1.6), (-1.1, -1.6)):
        m.box(m.colour("legs", WHITE), x - 0.06, x + 0.06, -1.7, -0.7, z - 0.06, z + 0.06)
        m.wheel(m.colour("wheels", DARK), x, -1.7, z, 0.32, 0.2, 8)
    m.end()
    m.wing(wing, (0, 0.6, -3.6, 3.2, 0.2), (0, 3.6, -6.4, 1.2, 0.08), vertical=True)
    return m


def wheels(m, positions, radius, width):
    dark = m.colour("wheels", DARK)
    for x, z in positions:
        m.wheel(dark, x, radius, z, radius, width)


def truck():
    m = Model()
    wheels(m, [(s * 1.0, z) for s in (1, -1) for z in (3.3, -1.6, -2.8)], 0.5, 0.35)
    m.box(m.colour("chassis", DARK), -0.9, 0.9, 0.55, 0.85, -4.1, 4.2)
    cab = m.colour("cab", BLUE)
    m.prism(cab, [(2.3, 0.85), (4.3, 0.85), (4.35, 1.7), (4.0, 2.9), (2.3, 3.0)], -1.2, 1.2)
    glass = m.colour("windows", GLASS)
    m.prism(glass, [(4.37, 1.75), (4.4, 1.8), (4.06, 2.75), (4.03, 2.7)], -1.05, 1.05)
    m.box(glass, -1.22, 1.22, 1.8, 2.6, 2.7, 3.7)
    m.box(m.colour("cargo", WHITE), -1.25, 1.25, 0.9, 3.5, -4.3, 2.0)
    m.box(m.colour("lights", RED), -1.1, 1.1, 0.7, 0.85, -4.35, -4.25)
    return m


def car():
    m = Model()
    wheels(m, [(s * 0.75, z) for s in (1, -1) for z in (1.4, -1.35)], 0.32, 0.22)
    body = m.colour("body", RED)
    m.prism(body, [(-2.2, 0.3), (2.2, 0.3), (2.25, 0.6), (2.1, 0.78), (1.0, 0.92), (-1.6, 0.95), (-2.2, 0.88)], -0.88, 0.88)
    m.prism(m.colour("windows", GLASS), [(1.1, 0.9), (0.3, 1.36), (-1.0, 1.38), (-1.75, 0.92)], -0.74, 0.74)
    m.prism(body, [(0.3, 1.34), (0.22, 1.42), (-0.95, 1.44), (-1.05, 1.36)], -0.72, 0.72)
    m.box(m.colour("lights", WHITE), -0.8, 0.8, 0.58, 0.7, 2.1, 2.26)
    return m


def tank():
    m = Model()
    hull = m.colour("hull", GREEN)
    m.prism(hull, [(-3.9, 0.75), (-3.7, 0.5), (3.0, 0.5), (3.95, 1.0), (3.4, 1.35), (1.2, 1.65), (-3.9, 1.65)], -1.75, 1.75)
    tracks = m.colour("tracks", DARK)

    def side(s):
        x0, x1 = sorted((s * 1.2, s * 1.82))
        m.prism(tracks, [(-3.3, 0.0), (2.7, 0.0), (3.7, 0.6), (3.6, 1.0), (-3.8, 1.0), (-3.95, 0.6)], x0, x1)
        m.box(hull, *sorted((s * 1.3, s * 1.86)), 1.0, 1.35, -3.6, 3.2)

    both(side)
    m.begin("turret", (0, 1.65, -0.4))
    turret = m.colour("turret", (0.28, 0.33, 0.20))
    m.prism(turret, [(-2.6, 1.65), (1.6, 1.65), (1.9, 1.95), (1.2, 2.4), (-2.2, 2.45), (-2.7, 2.1)], -1.35, 1.35)
    m.begin("hatch", (0.6, 2.45, -0.85), "turret")
    m.tube(m.colour("hatch", (0.25, 0.29, 0.18)), [(2.44, -0.5, 0.6, 0.3, 0.3), (2.6, -0.5, 0.6, 0.26, 0.26)], 8, "y")
    m.begin("gun", (0, 2.02, 1.5), "turret")
    m.tube(m.colour("gun", DARK), [(1.6, 0, 2.02, 0.14, 0.14), (3.4, 0, 2.06, 0.1, 0.1), (5.8, 0, 2.1, 0.08, 0.08)], 8)
    m.end()
    return m


def ship():
    m = Model()
    hull = m.colour("hull", BLUE)
    deck = m.colour("deck", (0.45, 0.30, 0.24))
    sections = []
    for z, half, keel in ((-60, 8.5, -3.0), (-40, 10.0, -6.0), (30, 10.0, -6.0), (50, 6.0, -6.0), (63, 0.4, -3.0)):
        rise = 2.5 if z > 40 else 0.0
        sections.append([(-half, 5.0 + rise, z), (-half * 0.9, 0.0, z), (-half * 0.45, keel, z), (half * 0.45, keel, z),
                         (half * 0.9, 0.0, z), (half, 5.0 + rise, z)])
    m.loft(hull, sections)
    m.box(deck, -8.6, 8.6, 5.0, 5.4, -58, 34)
    white = m.colour("bridge", WHITE)
    m.box(white, -8.0, 8.0, 5.4, 12.0, -54, -36)
    m.box(white, -6.5, 6.5, 12.0, 16.0, -52, -39)
    m.box(m.colour("windows", GLASS), -8.6, 8.6, 13.6, 15.2, -43, -38.4)
    m.tube(m.colour("funnel", RED), [(16.0, -49, 0, 2.4, 1.8), (21.0, -49.8, 0, 2.0, 1.5)], 10, "y")
    for k, rgb in enumerate((ORANGE, GREY, RED, BLUE, GREEN)):
        z = -32 + 13 * k
        m.box(m.colour("cargo%d" % k, rgb), -7.8, 7.8, 5.4, 10.2 if k % 2 else 12.6, z, z + 12)
    m.box(white, -0.4, 0.4, 7.0, 15.0, 52.0, 52.8)
    return m


def missile():
    m = Model()
    m.tube(m.colour("body", WHITE), [(-1.8, 0, 0, 0.11, 0.11), (1.35, 0, 0, 0.11, 0.11), (1.65, 0, 0, 0.08, 0.08),
                                     (1.85, 0, 0, 0.01, 0.01)], 10)
    m.tube(m.colour("nozzle", DARK), [(-1.86, 0, 0, 0.07, 0.07), (-1.78, 0, 0, 0.09, 0.09)], 8)
    m.tube(m.colour("band", RED), [(0.7, 0, 0, 0.115, 0.115), (0.85, 0, 0, 0.115, 0.115)], 10)
    fin = m.colour("fins", GREY)

    def side(s):
        for z, chord, span in ((-1.2, 0.55, 0.34), (0.5, 0.4, 0.24)):
            m.wing(fin, (s * 0.1, 0, z, chord, 0.02), (s * span, 0, z - 0.25, chord * 0.5, 0.01))
            m.wing(fin, (0, s * 0.1, z, chord, 0.02), (0, s * span, z - 0.25, chord * 0.5, 0.01), vertical=True)

    both(side)
    return m


def soldier():
    m = Model()
    uniform = m.colour("uniform", (0.33, 0.36, 0.24))
    boots = m.colour("boots", DARK)
    skin = m.colour("skin", (0.72, 0.53, 0.42))

    def side(s):
        m.tube(uniform, [(0.12, 0.02, s * 0.11, 0.08, 0.08), (0.88, 0, s * 0.1, 0.1, 0.1)], 6, "y")
        m.box(boots, s * 0.11 - 0.06, s * 0.11 + 0.06, 0, 0.13, -0.1, 0.18)
        m.tube(uniform, [(0.98, 0.14, s * 0.26, 0.05, 0.05), (1.42, -0.02, s * 0.25, 0.07, 0.07)], 6, "y")

    both(side)
    m.tube(uniform, [(0.85, 0, 0, 0.13, 0.2), (1.2, 0, 0, 0.13, 0.2), (1.47, 0, 0, 0.11, 0.22)], 8, "y")
    m.tube(skin, [(1.47, 0, 0, 0.06, 0.06), (1.58, 0.02, 0, 0.09, 0.08), (1.68, 0.01, 0, 0.1, 0.09)], 8, "y")
    m.tube(m.colour("helmet", GREEN), [(1.64, 0, 0, 0.14, 0.13), (1.74, 0, 0, 0.13, 0.12), (1.82, 0, 0, 0.05, 0.05)], 8, "y")
    m.box(m.colour("pack", GREEN), -0.17, 0.17, 1.0, 1.45, -0.3, -0.12)
    m.box(m.colour("rifle", DARK), -0.03, 0.03, 1.08, 1.16, 0.05, 0.78)
    return m


# ---- glTF ------------------------------------------------------------------------------------------------------------

FLOAT, UNSIGNED_SHORT = 5126, 5123
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963


def indexed(vertices):
    """Shares equal vertices. Rounded first, so that the file is the same on every machine."""
    numbers, unique, indices = {}, [], []
    for position, normal in vertices:
        key = tuple(round(v, 4) + 0.0 for v in position + tuple(normal))
        if key not in numbers:
            numbers[key] = len(unique)
            unique.append(key)
        indices.append(numbers[key])
    return unique, indices


def write_gltf(model, name, path):
    blob = bytearray()
    views, accessors, materials = [], [], []

    def add(data, target, component, count, kind, bounds=None):
        while len(blob) % 4:
            blob.append(0)
        views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": len(data), "target": target})
        blob.extend(data)
        accessor = {"bufferView": len(views) - 1, "componentType": component, "count": count, "type": kind}
        if bounds:
            accessor["min"], accessor["max"] = bounds
        accessors.append(accessor)
        return len(accessors) - 1

    meshes = {part: [] for part in [None, *model.parts]}
    for part, material in sorted(model.materials, key=lambda key: (key[0] or "", key[1])):
        rgb, vertices = model.materials[part, material]
        pivot = model.parts[part][0] if part else (0, 0, 0)
        unique, indices = indexed([(sub(position, pivot), normal) for position, normal in vertices])
        linear = [round(c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4, 5) for c in rgb]
        materials.append({"name": material, "pbrMetallicRoughness": {"baseColorFactor": linear + [1.0], "metallicFactor": 0.0,
                                                                      "roughnessFactor": 0.8}})
        bounds = ([min(v[i] for v in unique) for i in range(3)], [max(v[i] for v in unique) for i in range(3)])
        bounds = tuple([struct.unpack("<f", struct.pack("<f", v))[0] for v in side] for side in bounds)
        position = add(b"".join(struct.pack("<3f", *v[:3]) for v in unique), ARRAY_BUFFER, FLOAT, len(unique), "VEC3", bounds)
        normal = add(b"".join(struct.pack("<3f", *v[3:]) for v in unique), ARRAY_BUFFER, FLOAT, len(unique), "VEC3")
        index = add(struct.pack("<%dH" % len(indices), *indices), ELEMENT_ARRAY_BUFFER, UNSIGNED_SHORT, len(indices), "SCALAR")
        meshes[part].append({"attributes": {"POSITION": position, "NORMAL": normal}, "indices": index,
                             "material": len(materials) - 1})
    names = [None, *model.parts]
    nodes = []
    for number, part in enumerate(names):
        node = {"mesh": number, "name": part or name}
        if part:
            pivot, under = model.parts[part]
            node["translation"] = [round(v, 4) for v in sub(pivot, model.parts[under][0] if under else (0, 0, 0))]
        children = [i for i, other in enumerate(names) if other and model.parts[other][1] == part]
        if children:
            node["children"] = children
        nodes.append(node)
    for number, place in model.stations.items():
        nodes[0].setdefault("children", []).append(len(nodes))
        nodes.append({"name": "station_%d" % number, "translation": [round(v, 4) for v in place]})

    uri = "data:application/octet-stream;base64," + base64.b64encode(bytes(blob)).decode("ascii")
    document = {
        "asset": {"version": "2.0", "generator": "make_models.py"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": nodes,
        "meshes": [{"name": part or name, "primitives": meshes[part]} for part in names],
        "materials": materials,
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(blob), "uri": uri}],
    }
    path.write_text(json.dumps(document, indent=1) + "\n", encoding="ascii")


MODELS = (airliner, light_aircraft, helicopter, fighter, truck, car, tank, ship, missile, soldier)


def main():
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent
    for make in MODELS:
        model = make()
        write_gltf(model, make.__name__, folder / (make.__name__ + ".gltf"))
        points = [p for _, vertices in model.materials.values() for p, _ in vertices]
        length = max(p[2] for p in points) - min(p[2] for p in points)
        print("%-15s %5d triangles, %6.2f m long" % (make.__name__, len(points) // 3, length))


if __name__ == "__main__":
    main()
