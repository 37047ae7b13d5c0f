#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Paints the paintings of shows/kang-* (CC0), after the experiments of Kang, Kim 2014.

    /usr/bin/python3 tests/bench/paintings.py [FOLDER of the shows, default: shows]

The same bytes every time. Each picture has four pixels a metre; shapes and strokes are painted as a person with a soft
brush would: round ends, a gradient from tail to head, edges that blend into what is below.
"""
import pathlib
import sys

import cv2
import numpy

PIXELS = 4  # a metre
LANE_M = 8.6  # of the march, from middle to middle
LANE_HALF_M = 3.2
GREY = (128, 128, 128)
WHITE = (255, 255, 255)


def smooth(points, times=4):
    """Corner cutting (Chaikin): a line of a hand through a few points; its ends stay."""
    line = numpy.array(points, float)
    for _ in range(times):
        cut = numpy.empty((2 * len(line) - 2, 2))
        cut[0::2] = 0.75 * line[:-1] + 0.25 * line[1:]
        cut[1::2] = 0.25 * line[:-1] + 0.75 * line[1:]
        line = numpy.vstack([line[:1], cut, line[-1:]])
    return line


def lighter(colour, share):
    return tuple(round(c + share * (255 - c)) for c in colour)


def darker(colour, share):
    return tuple(round(c * (1 - share)) for c in colour)


class Painting:
    """Metres as on the stage: x from the middle to stage left, y upstage."""

    def __init__(self, width_m, depth_m):
        self.width_m, self.depth_m = width_m, depth_m
        self.pixels = numpy.full((round(depth_m * PIXELS), round(width_m * PIXELS), 3), 255.0)
        height, width = self.pixels.shape[:2]
        x, y = numpy.meshgrid(numpy.arange(width) + 0.5, numpy.arange(height) + 0.5)
        self.x = x / PIXELS - width_m / 2
        self.y = depth_m - y / PIXELS

    def blend(self, cover, colour):
        self.pixels += cover[..., None] * (numpy.asarray(colour, float) - self.pixels)

    def soft(self, inside_m):
        """How much of a pixel is covered whose middle is so far inside."""
        return numpy.clip(inside_m * PIXELS + 0.5, 0, 1)

    def box(self, x0, y0, x1, y1, colour):
        self.blend(self.soft(numpy.minimum.reduce([self.x - x0, x1 - self.x, self.y - y0, y1 - self.y])), colour)

    def disc(self, x, y, radius, colour):
        self.blend(self.soft(radius - numpy.hypot(self.x - x, self.y - y)), colour)

    def sector(self, x, y, inner, outer, first_deg, last_deg, colour):
        r = numpy.hypot(self.x - x, self.y - y)
        angle = numpy.degrees(numpy.arctan2(self.y - y, self.x - x)) % 360
        cover = self.soft(numpy.minimum(r - inner, outer - r))
        cover[(angle < first_deg) | (angle > last_deg)] = 0
        self.blend(cover, colour)

    def near(self, line):
        """Of each pixel: distance to a line, and how far along it that is, 0..1."""
        steps = numpy.diff(line, axis=0)
        sizes = numpy.hypot(steps[:, 0], steps[:, 1])
        at = numpy.concatenate([[0], numpy.cumsum(sizes)])
        least = numpy.full(self.x.shape, numpy.inf)
        along = numpy.zeros(self.x.shape)
        for (px, py), (sx, sy), size, begun in zip(line[:-1], steps, sizes, at[:-1]):
            if size == 0:
                continue
            share = numpy.clip(((self.x - px) * sx + (self.y - py) * sy) / size**2, 0, 1)
            away = numpy.hypot(self.x - px - share * sx, self.y - py - share * sy)
            better = away < least
            least[better] = away[better]
            along[better] = (begun + share * size)[better] / at[-1]
        return least, along

    def ribbon(self, points, half_m, colour):
        self.blend(self.soft(half_m - self.near(smooth(points))[0]), colour)

    def stroke(self, points, half_m, colour):
        """Bright at its tail, dark at its head."""
        away, along = self.near(smooth(points))
        tail, head = numpy.asarray(lighter(colour, 0.45), float), numpy.asarray(darker(colour, 0.45), float)
        shade = tail + along[..., None] * (head - tail)
        self.pixels += self.soft(half_m - away)[..., None] * (shade - self.pixels)

    def write(self, path):
        image = numpy.clip(numpy.round(self.pixels), 0, 255).astype(numpy.uint8)
        cv2.imwrite(str(path), image[..., ::-1], [cv2.IMWRITE_PNG_COMPRESSION, 9])


def theatre():
    """400 people in four blocks of seats leave by two front doors and two side doors (figure 7)."""
    art = Painting(64, 48)
    # House: walls of a metre, doors in the downstage wall (front) and in the side walls.
    for x0, x1 in ((-24, -12.5), (-8.5, 8.5), (12.5, 24)):
        art.box(x0, 12, x1, 13, GREY)
    art.box(-24, 44, 24, 45, GREY)
    for x0, x1 in ((-24, -23), (23, 24)):
        art.box(x0, 12, x1, 26, GREY)
        art.box(x0, 29, x1, 45, GREY)
    # Rows of seats are gone; two columns carry the balcony.
    art.disc(-12, 28, 0.8, GREY)
    art.disc(12, 28, 0.8, GREY)
    seats = {"front-left": (-10.5, 20), "front-right": (10.5, 20), "side-left": (-10.5, 36), "side-right": (10.5, 36)}
    colours = {"front-left": (230, 60, 60), "front-right": (60, 90, 230), "side-left": (240, 150, 30), "side-right": (40, 170, 90)}
    begin = {name: lighter(colour, 0.55) for name, colour in colours.items()}
    for name, (x, y) in seats.items():
        art.box(x - 7.5, y - 4.5, x + 7.5, y + 4.5, begin[name])
    art.box(-23, 1, -1.5, 7.5, darker(colours["front-left"], 0.55))
    art.box(1.5, 1, 23, 7.5, darker(colours["front-right"], 0.55))
    art.box(-31.5, 12, -26, 40, darker(colours["side-left"], 0.55))
    art.box(26, 12, 31.5, 40, darker(colours["side-right"], 0.55))
    art.stroke([(-10.5, 18), (-10.5, 14), (-10.5, 9), (-11, 6)], 1.7, (230, 40, 140))
    art.stroke([(10.5, 18), (10.5, 14), (10.5, 9), (11, 6)], 1.7, (150, 60, 230))
    art.stroke([(-12, 33), (-17, 30), (-21, 27.5), (-28, 27.5)], 1.2, (190, 190, 20))
    art.stroke([(12, 33), (17, 30), (21, 27.5), (28, 27.5)], 1.2, (20, 190, 190))
    return art


def castle():
    """600 people come from four sides and take a castle: towers in the corners, a gate in each wall (figure 2)."""
    art = Painting(84, 68)
    x0, x1, y0, y1 = -22, 22, 15, 55
    middle_y = (y0 + y1) / 2
    for y in (y0, y1 - 1.5):
        art.box(x0, y, -3, y + 1.5, GREY)
        art.box(3, y, x1, y + 1.5, GREY)
    for x in (x0, x1 - 1.5):
        art.box(x, y0, x + 1.5, middle_y - 3, GREY)
        art.box(x, middle_y + 3, x + 1.5, y1, GREY)
    for x in (x0 + 0.5, x1 - 0.5):
        for y in (y0 + 0.5, y1 - 0.5):
            art.disc(x, y, 3, GREY)
    south, west, north, east = (230, 60, 60), (60, 90, 230), (40, 170, 90), (240, 150, 30)
    art.box(-14, 0.5, 14, 8, lighter(south, 0.5))
    art.box(-41.5, middle_y - 12, -32, middle_y + 12, lighter(west, 0.5))
    art.box(-14, 61, 14, 67.5, lighter(north, 0.5))
    art.box(32, middle_y - 12, 41.5, middle_y + 12, lighter(east, 0.5))
    # In the middle of the court a keep, around it the four of them.
    for colour, first in ((east, -42), (north, 48), (west, 138), (south, 228)):
        art.sector(0, middle_y, 5, 16.5, first % 360, 360 if first < 0 else first + 84, darker(colour, 0.5))
        if first < 0:
            art.sector(0, middle_y, 5, 16.5, 0, first + 84, darker(colour, 0.5))
    art.disc(0, middle_y, 3, GREY)
    art.stroke([(0, 7), (0, 11), (0, 18), (0, 23)], 2, (230, 40, 140))
    art.stroke([(-34, middle_y), (-28, middle_y), (-20, middle_y), (-13, middle_y)], 2, (150, 60, 230))
    art.stroke([(0, 62), (0, 58), (0, 52), (0, 47)], 2, (190, 190, 20))
    art.stroke([(34, middle_y), (28, middle_y), (20, middle_y), (13, middle_y)], 2, (20, 190, 190))
    return art


def s_curve(half_m, radius_m, turn_deg, lane_m):
    """Straight ahead, to the left, to the right, straight ahead again: a line beside the one through the middle.

    The middle one goes from x = -half_m to half_m; lane_m to its left is positive."""
    turn = numpy.radians(turn_deg)
    angle = numpy.linspace(0, turn, 24)
    rise = radius_m * (1 - numpy.cos(turn))
    reach = radius_m * numpy.sin(turn)
    left = numpy.stack([-reach + (radius_m - lane_m) * numpy.sin(angle), radius_m - (radius_m - lane_m) * numpy.cos(angle)], 1)
    back = angle[::-1]
    right = numpy.stack([reach - (radius_m + lane_m) * numpy.sin(back), 2 * rise - radius_m + (radius_m + lane_m) * numpy.cos(back)], 1)
    return numpy.vstack([[(-half_m, lane_m)], left, right, [(half_m, 2 * rise + lane_m)]]), 2 * rise


def march():
    """1,000 people march along a curve in four columns side by side (figure 8)."""
    art = Painting(140, 72)
    colours = ((230, 60, 60), (60, 90, 230), (240, 150, 30), (40, 170, 90))
    strokes = ((230, 40, 140), (150, 60, 230), (190, 190, 20), (20, 190, 190))
    for k, (colour, brush) in enumerate(zip(colours, strokes)):
        lane = (1.5 - k) * LANE_M
        line, rise = s_curve(26, 26, 70, lane)
        low = 36 - rise / 2
        art.box(-69, low + lane - 3.9, -26, low + lane + 3.9, lighter(colour, 0.5))
        art.box(26, low + rise + lane - 3.9, 69, low + rise + lane + 3.9, darker(colour, 0.5))
        art.stroke([(-30, low + lane), *(line + (0, low))[1:-1], (30, low + rise + lane)], LANE_HALF_M, brush)
    return art


PAINTINGS = {"kang-theatre": theatre, "kang-castle": castle, "kang-march": march}

if __name__ == "__main__":
    shows = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parents[2] / "shows")
    for name, paint in PAINTINGS.items():
        (shows / name).mkdir(parents=True, exist_ok=True)
        paint().write(shows / name / "painting.png")
