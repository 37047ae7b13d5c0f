#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Repeats the experiments of Kang, Kim 2014 with the shows kang-theatre, kang-castle and kang-march.

    scripts/kang2014 [--build DIR] [--brushes DIR]

Writes docs/kang2014.md. footlight_painted_raw plans each show and says where everybody is every half second, as the
model leads people and as they walk; what is measured here is measured on both. With the previews of MyPaint's brushes
the table of their directions is measured anew, else the one that stands in the page is kept.
"""
import argparse
import json
import pathlib
import string
import subprocess
import sys

import numpy
from scipy.optimize import linear_sum_assignment

import paintings

ROOT = pathlib.Path(__file__).resolve().parents[2]
SHOWS = {"theatre": "exit", "castle": "castle", "march": "curve march"}
PAPER = {"theatre": (400, 3.5), "castle": (600, 5.0), "march": (1000, 6.0)}  # people, minutes of parameter generation
# From corner to corner of each opening, and which way is out of it (or in, at the castle).
THEATRE = {"front, stage right": ("front-right", (-12.5, 12.5), (-8.5, 12.5), (0, -1)),
           "front, stage left": ("front-left", (8.5, 12.5), (12.5, 12.5), (0, -1)),
           "side, stage right": ("side-right", (-23.5, 26), (-23.5, 29), (-1, 0)),
           "side, stage left": ("side-left", (23.5, 26), (23.5, 29), (1, 0))}
CASTLE = {"south": ("south", (-3, 15.75), (3, 15.75), (0, 1)), "west": ("west", (-21.25, 32), (-21.25, 38), (1, 0)),
          "north": ("north", (-3, 54.25), (3, 54.25), (0, -1)), "east": ("east", (21.25, 32), (21.25, 38), (-1, 0))}
NEAR_M = 3
BRUSHES = "| brush |"


def run(*command):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stderr)
    return done.stdout


def both(raw, walked, digits):
    return f"{walked:.{digits}f} | {raw:.{digits}f}"


def door(found, at, group, a, b, out):
    """Of a group at its door: people per metre of it who have not passed within NEAR_M, mean from the first to the last
    who pass and most; seconds that each is that near; delay beside walking straight to it; when the last has passed."""
    at = at[:, numpy.array(found["group"]) == group]
    t = numpy.array(found["at_s"])
    a, b = numpy.array(a), numpy.array(b)
    width = numpy.hypot(*(b - a))
    share = numpy.clip((at - a) @ (b - a) / width**2, 0, 1)
    away = numpy.hypot(*numpy.moveaxis(at - a - share[..., None] * (b - a), 2, 0))
    passed = numpy.argmax((at - a) @ numpy.array(out) > 0, axis=0)
    near = (away <= NEAR_M) & (numpy.arange(len(t))[:, None] < passed)
    waiting = near.sum(axis=1)[passed.min():passed.max()] / width
    each = near.sum(axis=0) * (t[1] - t[0])
    delay = t[passed] - away[0] / found["model_speed_mps"]
    return waiting.mean(), waiting.max(), each.mean(), delay.mean(), t[passed].max()


def doors(found, openings):
    rows = ["| door | waiting a metre of it, mean | raw | most | raw | s near it | raw | delay, s | raw | last through, s | raw |",
            "|---|---|---|---|---|---|---|---|---|---|---|"]
    for name, (group, a, b, out) in openings.items():
        raw, walked = (door(found, numpy.array(found[what]), group, a, b, out) for what in ("raw", "walked"))
        rows.append(f"| {name} | " + " | ".join(both(r, w, d) for r, w, d in zip(raw, walked, (2, 2, 1, 1, 0))) + " |")
    return "\n".join(rows)


def lanes(found):
    """How far people of the march are from the middle line of their stroke between the blocks, and how many in its width."""
    rows = ["| column | m from the middle of its stroke, mean | raw | within its width | raw |", "|---|---|---|---|---|"]
    groups = numpy.array(found["group"])
    for k, group in enumerate(("first", "second", "third", "fourth")):
        lane, half = (1.5 - k) * paintings.LANE_M, paintings.LANE_HALF_M
        line, rise = paintings.s_curve(26, 26, 70, lane)
        line = paintings.smooth(line + (0, 36 - rise / 2))
        values = []
        for what in ("raw", "walked"):
            at = numpy.array(found[what])[:, groups == group].reshape(-1, 2)
            at = at[(at[:, 0] > -24) & (at[:, 0] < 24)]
            away = numpy.full(len(at), numpy.inf)
            for p, q in zip(line[:-1], line[1:]):
                share = numpy.clip((at - p) @ (q - p) / max(1e-9, (q - p) @ (q - p)), 0, 1)
                away = numpy.minimum(away, numpy.hypot(*(at - p - share[:, None] * (q - p)).T))
            values.append((away.mean(), 100 * (away <= half).mean()))
        rows.append(f"| {group} | {both(values[0][0], values[1][0], 2)} | {values[1][1]:.1f} % | {values[0][1]:.1f} % |")
    return "\n".join(rows)


def apart(found):
    """Walked from raw: person by person, and as crowds of the same group, whoever is where; every 5 s."""
    raw, walked = numpy.array(found["raw"]), numpy.array(found["walked"])
    person = numpy.hypot(*numpy.moveaxis(raw - walked, 2, 0))
    groups = numpy.array(found["group"])
    crowd = []
    for k in range(0, len(raw), 10):
        for group in set(found["group"]):
            a, b = raw[k, groups == group], walked[k, groups == group]
            cost = numpy.hypot(*numpy.moveaxis(a[:, None] - b[None], 2, 0))
            crowd.append(cost[linear_sum_assignment(cost**2)])
    crowd = numpy.concatenate(crowd)
    return (f"{crowd.mean():.2f} | {numpy.percentile(crowd, 99):.2f} | {crowd.max():.2f} | {person.mean():.2f} | "
            f"{person.max():.2f}")


def distances(all_found):
    rows = ["| show | people | crowd from crowd, m: mean | 99 of 100 | most | person from person: mean | most | least clearance, m | wrong |",
            "|---|---|---|---|---|---|---|---|---|"]
    for name, found in all_found.items():
        rows.append(f"| {SHOWS[name]} | {found['people']:,} | {apart(found)} | {found['min_clearance_m']:.3f} | {found['violations']} |")
    return "\n".join(rows)


def figure3(maps):
    rows = ["| shape | map | neighbours kept | least distance of ideal | covered | inside |", "|---|---|---|---|---|---|"]
    for shape, kinds in maps.items():
        for kind, runs in kinds.items():
            mean = {key: numpy.mean([one[key] for one in runs]) for key in runs[0]}
            rows.append(f"| {shape} | {kind} | {100 * mean['kept']:.1f} % | {mean['separation']:.3f} | "
                        f"{100 * mean['coverage']:.1f} % | {100 * mean['inside']:.1f} % |")
    return "\n".join(rows)


def table1(program, shows):
    rows = ["| example | people | paper: parameters, min | here, s | paper: frames/s | steps/s | steps as long as the show, s |", "|---|---|---|---|---|---|---|"]
    for name, (people, minutes) in PAPER.items():
        one = json.loads(run(program, "--steps", shows[name]))
        rows.append(f"| {SHOWS[name]} | {people:,} | {minutes} | {one['read_cpu_s'] + one['prepared_cpu_s']:.1f} | "
                    f"{'12' if people == 1000 else '-'} | {one['steps_a_second']:.0f} | {one['steps_cpu_s']:.1f} |")
    return "\n".join(rows)


def brushes(build, folder, page):
    """The table of strokes.py, measured or as it was."""
    if folder is not None:
        return run("/usr/bin/python3", ROOT / "tests/bench/strokes.py", build / "footlight", folder).strip()
    lines = page.splitlines()
    first = next(n for n, line in enumerate(lines) if line.startswith(BRUSHES))
    return "\n".join(lines[first:next(n for n in range(first, len(lines) + 1) if n == len(lines) or not lines[n].startswith("|"))])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--build", type=pathlib.Path, required=True)
    parser.add_argument("--brushes", type=pathlib.Path)
    options = parser.parse_args()
    build = options.build.resolve()
    program = build / "tests/bench/footlight_painted_raw"
    shows = {name: ROOT / f"shows/kang-{name}/show.yaml" for name in SHOWS}
    found = {name: json.loads(run(program, show)) for name, show in shows.items()}
    trained = json.loads(run(program, "--train", 200, 1000))
    target = ROOT / "docs/kang2014.md"
    page = string.Template((ROOT / "tests/bench/kang2014.md.in").read_text())
    target.write_text(page.substitute(
        figure3=figure3(json.loads(run(program, "--maps"))), table1=table1(program, shows),
        train=f"{trained['inputs']:,} inputs to a map of {trained['people']} take {trained['cpu_s']:.2f} s",
        theatre=doors(found["theatre"], THEATRE), castle=doors(found["castle"], CASTLE), lanes=lanes(found["march"]),
        distances=distances(found), brushes=brushes(build, options.brushes, target.read_text())))


if __name__ == "__main__":
    main()
