#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""How many pixels of strokes of real brushes get the direction in which they were drawn, as `footlight painting` tells.

    /usr/bin/python3 tests/bench/strokes.py FOOTLIGHT BRUSHES

BRUSHES is a folder with previews of MyPaint's brushes (Debian mypaint-brushes, CC0), 640 x 496 pixels, without their
captions. Outline and texture are the brush's; the middle lines were marked by hand, and as most previews have one shade,
brightness falls along them here; where a stroke has a gradient of its own that is kept. The direction at a pixel is computed anew from the line that the program tells, by Eq.
3 of Kang, Kim 2014.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

import cv2
import numpy

PAD = (100, 102)  # columns, rows: whole metres
PIXEL_M = 0.1

# Where each line goes, marked by hand, in the sense in which brightness falls here.
LINES = {
    "classic_kabura": [(92, 322), (92, 360), (105, 400), (135, 440), (175, 472), (245, 495)],
    "classic_marker_fat": [(95, 350), (115, 390), (145, 415), (190, 432), (240, 436), (290, 434)],
    "experimental_hard_sting": [(45, 350), (60, 410), (90, 440), (130, 465), (180, 470), (230, 455), (270, 430),
                                (315, 420), (355, 430), (385, 450), (405, 492)],
    "classic_brush": [(85, 132), (130, 92), (190, 62), (235, 66), (240, 100), (195, 170), (165, 250), (190, 320),
                      (260, 335), (350, 270), (440, 230), (500, 290), (480, 380), (450, 492)],
    "tanda_oil-06-paint": [(68, 185), (110, 145), (170, 105), (235, 78), (278, 72), (285, 90), (250, 140), (205, 195),
                           (170, 250), (157, 285), (170, 295), (210, 270), (255, 235), (310, 207), (355, 203),
                           (362, 225), (335, 270), (305, 315), (298, 342), (320, 342), (385, 305), (445, 272),
                           (495, 255), (497, 275), (470, 315), (445, 350), (447, 370), (470, 368), (495, 360),
                           (515, 380), (545, 438)],
    "ramon_Wet_Direction": [(205, 205), (165, 215), (130, 250), (110, 290), (120, 350), (150, 380), (190, 375),
                            (225, 340), (255, 290), (300, 255), (345, 250), (385, 270), (400, 310), (395, 345),
                            (400, 370), (440, 390), (480, 370), (505, 320), (525, 270), (545, 240)],
    "ramon_Round": [(115, 330), (200, 315), (300, 305), (400, 300), (500, 290), (570, 290)],
}
OWN_GRADIENT = ("ramon_Round",)

SHOW = """footlight: 1
title: Stroke
stage: {{grid: {{kind: square, columns: {columns}, rows: {rows}, pitch: 1 m}}, clearance: 0.5 m, max_speed: 1.4 m/s}}
performers: {{count: 1}}
music: {{tempo: 120, meter: 4/4}}
sections:
  - name: stroke
    from: {{painting: painting.png}}
    start: count 1
    duration: 400 counts
    planner: {{model: painted}}
    paint:
      - {{colour: "#00C800", role: shape, order: 1}}
      - {{colour: "#0000C8", role: shape, order: 2}}
      - {{colour: "#C80000", role: stroke}}
"""


def smooth(line):
    """Chaikin's corner cutting; the ends stay."""
    line = numpy.array(line, float)
    for _ in range(4):
        cut = numpy.empty((2 * len(line) - 2, 2))
        cut[0::2] = 0.75 * line[:-1] + 0.25 * line[1:]
        cut[1::2] = 0.25 * line[:-1] + 0.75 * line[1:]
        line = numpy.vstack([line[:1], cut, line[-1:]])
    return line


def stroke_of(picture, middle):
    """The dark or red piece in which the line's middle lies, and its brightness 0..1 within it."""
    grey = cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY)
    red = picture[..., 2].astype(int) - picture[..., 0] > 15
    _, pieces = cv2.connectedComponents(((grey < 128) | red).astype(numpy.uint8))
    room = ((PAD[1], PAD[1]), (PAD[0], PAD[0]))
    return numpy.pad(pieces == pieces[middle[1], middle[0]], room), numpy.pad(grey / 255.0, room)


def along(line, mask):
    """At each pixel of the mask the direction of the line's nearest piece and how far along that is, 0..1."""
    y, x = numpy.nonzero(mask)
    at = numpy.stack([x, y], 1) + 0.5
    middle = (line[1:] + line[:-1]) / 2
    steps = line[1:] - line[:-1]
    nearest = numpy.argmin(((at[:, None] - middle[None]) ** 2).sum(2), 1)
    length = numpy.cumsum(numpy.hypot(*steps.T))
    return steps[nearest], length[nearest] / length[-1]


def painting_of(line, mask, texture, share):
    """The stroke in red, bright at its tail, over a green shape at its tail and a blue one at its head."""
    out = numpy.full((*mask.shape, 3), 255, numpy.uint8)
    for end, inner, colour in ((line[0], line[6], (0, 200, 0)), (line[-1], line[-7], (200, 0, 0))):
        way = (end - inner) / numpy.hypot(*(end - inner))
        cv2.circle(out, [int(v) for v in end + 25 * way], 25, colour, -1)
    value = (0.95 - 0.6 * share) * (0.9 + 0.1 * texture[mask])
    out[mask] = numpy.stack([0.2 * 255 * value, 0.2 * 255 * value, 255 * value], 1).astype(numpy.uint8)
    return out


def told(program, painting):
    with tempfile.TemporaryDirectory() as folder:
        show = pathlib.Path(folder) / "show.yaml"
        rows, columns = painting.shape[:2]
        show.write_text(SHOW.format(columns=int(columns * PIXEL_M), rows=int(rows * PIXEL_M)))
        cv2.imwrite(str(show.with_name("painting.png")), painting)
        ran = subprocess.run([program, "painting", show, "--json"], capture_output=True, text=True)
        if ran.returncode != 0:
            return ran.stderr.split("error: ")[-1].split(" of who is in")[0].split(": ", 1)[-1].strip()
        return json.loads(ran.stdout)


def field(line, at):
    """Eq. 3 with a Gaussian radial basis. @param line x, y, width, metres"""
    steps = line[1:, :2] - line[:-1, :2]
    away = numpy.hypot(*(at[:, None] - line[None, :-1, :2]).transpose(2, 0, 1))
    return numpy.exp(-((away / (line[None, :-1, 2] / 2)) ** 2)) @ steps


def main():
    program, brushes = sys.argv[1], pathlib.Path(sys.argv[2])
    print("| brush | pixels | right within 20 degrees | mean error, degrees |\n|---|---|---|---|")
    for name, marked in LINES.items():
        mask, texture = stroke_of(cv2.imread(str(brushes / f"{name}.png")), marked[len(marked) // 2])
        line = smooth(marked) + PAD
        direction, share = along(line, mask)
        if name in OWN_GRADIENT:
            dark, bright = numpy.percentile(texture[mask], (2, 98))
            share = numpy.clip((bright - texture[mask]) / (bright - dark), 0, 1)
        answer = told(program, painting_of(line, mask, texture, share))
        if isinstance(answer, str):
            print(f"| {name} | {mask.sum()} | refused: {answer} | - |")
            continue
        stroke = answer["parties"][0]["legs"][0]["strokes"][0]
        y, x = numpy.nonzero(mask)
        rows, columns = mask.shape
        # The floor's middle is x = 0, its front y = 0; the picture fills it.
        at = numpy.stack([(x + 0.5) * PIXEL_M - int(columns * PIXEL_M) / 2, int(rows * PIXEL_M) - (y + 0.5) * PIXEL_M], 1)
        way = field(numpy.array(stroke["line"]), at)
        true = direction * (1, -1)
        error = numpy.degrees(abs(numpy.arctan2(way[:, 0] * true[:, 1] - way[:, 1] * true[:, 0], (way * true).sum(1))))
        print(f"| {name} | {len(x)} | {100 * (error <= 20).mean():.1f} % | {error.mean():.1f} |")


if __name__ == "__main__":
    main()
