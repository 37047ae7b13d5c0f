# SPDX-License-Identifier: Apache-2.0
"""Walks the scenarios of Lin 2007 (shows/lin-*) with the proposed and the original swarm. Called by scripts/lin2007."""
import argparse
import csv
import json
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENARIOS = {
    "influx": "5, 12", "stream": "6, 8, 13, 15", "obstacle": "7, 9, 14, 16", "target-circle": "10, 19", "target-wave": "10, 19",
    "corners": "17, 18", "terrain-1": "11", "terrain-2": "11", "terrain-3": "11",
}
SEEDS = (1, 2, 3)
METHODS = ("original", "proposed")
SWARM_NOTE = re.compile(r"swarm has (\d+) collisions? between people and (\d+) with obstacles on its way(?:; at its end (\d+))?")
MARKS_NOTE = re.compile(r"(\d+) marks, .* are ([\d.]+) m from the model's way, at most ([\d.]+) m")


REFUSED = 3  # exit status of a plan that nobody could walk


def run(*words, statuses=(0,)):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    if done.returncode not in statuses:
        sys.exit(f"error: {' '.join(map(str, words))}: exit status {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def numbers(pattern, notes):
    found = next((match for note in notes if (match := pattern.search(note))), None)
    if not found:
        sys.exit(f"error: no note like {pattern.pattern!r} among {notes}")
    return [float(group or 0) for group in found.groups()]


def least_m(a, b):
    """Closest approach of two tracks of (time, x, y) marks, straight and even between: in closed form."""
    times = sorted({row[0] for row in a} | {row[0] for row in b})

    def places(track):
        out, at = [], 0
        for time in times:
            while at + 1 < len(track) and track[at + 1][0] <= time:
                at += 1
            (t0, x0, y0), (t1, x1, y1) = track[at], track[min(at + 1, len(track) - 1)]
            share = (time - t0) / (t1 - t0) if t1 > t0 and time > t0 else 0
            out.append((x0 + share * (x1 - x0), y0 + share * (y1 - y0)))
        return out

    gaps = [(p[0] - q[0], p[1] - q[1]) for p, q in zip(places(a), places(b))]
    least = math.inf
    for (x0, y0), (x1, y1) in zip(gaps, gaps[1:]):
        dx, dy = x1 - x0, y1 - y0
        square = dx * dx + dy * dy
        share = min(1, max(0, -(x0 * dx + y0 * dy) / square)) if square > 0 else 0
        least = min(least, math.hypot(x0 + share * dx, y0 + share * dy))
    return least


def walked(folder):
    """What people do in the end, from the exported marks: collisions, the nearest two, and the mean way, m."""
    tracks = {}
    with open(folder / "marks.csv", newline="") as file:
        for row in csv.DictReader(file):
            tracks.setdefault(row["performer"], []).append((float(row["time_s"]), float(row["x_m"]), float(row["y_m"])))
    clearance = json.loads((folder / "stage.json").read_text())["clearance_m"]
    people = list(tracks.values())
    nearest = [least_m(a, b) for i, a in enumerate(people) for b in people[:i]]
    way = sum(math.dist(p[1:], q[1:]) for track in people for p, q in zip(track, track[1:])) / len(people)
    return {"people": len(people), "walked_collisions": sum(d < clearance - 1e-6 for d in nearest), "nearest_m": min(nearest), "way_m": way}


def drawing(folder):
    """The walked ways as an SVG: circles where people begin, dots where they end, grey where nobody can stand."""
    stage = json.loads((folder / "stage.json").read_text())
    cols, rows, pitch = stage["grid"]["cols"], stage["grid"]["rows"], stage["grid"]["pitch_m"]
    tracks = {}
    with open(folder / "marks.csv", newline="") as file:
        for row in csv.DictReader(file):
            at = (10 * (float(row["x_m"]) / pitch + cols / 2), 10 * (rows - float(row["y_m"]) / pitch))
            tracks.setdefault(row["performer"], []).append(at)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {10 * cols} {10 * rows}" width="{10 * cols}">',
           f'<rect width="{10 * cols}" height="{10 * rows}" fill="#fafafa" stroke="#999"/>']
    out += [f'<rect x="{10 * column}" y="{10 * (rows - 1 - row)}" width="10" height="10" fill="#888"/>' for column, row in stage["blocked"]]
    for track in tracks.values():
        points = " ".join(f"{x:.0f},{y:.0f}" for x, y in track)
        out.append(f'<polyline points="{points}" fill="none" stroke="#2060a0" stroke-opacity="0.6" stroke-width="1.2"/>')
        out.append(f'<circle cx="{track[0][0]:.0f}" cy="{track[0][1]:.0f}" r="3" fill="none" stroke="#c04020"/>')
        out.append(f'<circle cx="{track[-1][0]:.0f}" cy="{track[-1][1]:.0f}" r="2.5" fill="#208040"/>')
    return "\n".join([*out, "</svg>", ""])


def measured(program, scenario, method, seed, folder):
    show = pathlib.Path(folder) / f"{scenario}-{method}-{seed}"
    shutil.copytree(ROOT / "shows" / f"lin-{scenario}", show)
    text = (show / "show.yaml").read_text()
    changed = text.replace("{model: swarm}", f"{{model: swarm, swarm: {{method: {method}}}}}\n    seed: {seed}")
    if changed == text:
        sys.exit(f"error: lin-{scenario}: no planner {{model: swarm}}")
    (show / "show.yaml").write_text(changed)
    plan = json.loads(run(program, "plan", show / "show.yaml", "--json", statuses=(0, REFUSED)))
    notes = [note for section in plan["sections"] for note in section["notes"]]
    raw = numbers(SWARM_NOTE, notes)
    marks = numbers(MARKS_NOTE, notes)
    people = 40 if scenario == "corners" else 20
    out = {"people": people, "people_hit": raw[0], "obstacles_hit": raw[1], "late": raw[2], "marks_m": marks[1], "marks_most_m": marks[2], "refused": bool(plan.get("refusal"))}
    if out["refused"]:
        return out
    run(program, "export", show / "show.yaml", "--csv", show / "csv")
    return out | walked(show / "csv") | {"drawing": drawing(show / "csv")}


def mean(rows, key):
    return sum(row[key] for row in rows) / len(rows)


def table(results):
    lines = ["| scenario | the thesis's figures | people | swarm | collisions between people, on its own way | with obstacles | not arrived | plans refused | collisions as walked | nearest two, m | marks from the swarm's way: mean, most, m | walked, m |",
             "|---|---|---|---|---|---|---|---|---|---|---|---|"]
    for scenario, figures in SCENARIOS.items():
        for method in METHODS:
            rows = results[scenario, method]
            first = method == METHODS[0]
            plans = [row for row in rows if not row["refused"]]
            judged = ([str(sum(row["walked_collisions"] for row in plans)), f"{min(row['nearest_m'] for row in plans):.2f}"] if plans else ["-", "-"])
            lines.append("| " + " | ".join([
                scenario if first else "", figures if first else "", str(rows[0]["people"]) if first else "", method,
                f"{mean(rows, 'people_hit'):.1f}", f"{mean(rows, 'obstacles_hit'):.1f}", f"{mean(rows, 'late'):.1f}",
                f"{len(rows) - len(plans)} of {len(rows)}", *judged,
                f"{mean(rows, 'marks_m'):.2f}, {max(row['marks_most_m'] for row in rows):.2f}", f"{mean(plans, 'way_m'):.1f}" if plans else "-"]) + " |")
    return "\n".join(lines)


def findings(results):
    """The thesis's orderings, and whether they come out."""
    def total(method, key):
        return sum(row.get(key, 0) for scenario in SCENARIOS for row in results[scenario, method])

    def say(holds, text):
        return f"- {'Comes out' if holds else '**Does not come out**'}: {text}"

    runs = len(SCENARIOS) * len(SEEDS)
    fewer = [s for s in SCENARIOS if mean(results[s, "original"], "people_hit") > mean(results[s, "proposed"], "people_hit")]
    walls = [s for s in SCENARIOS if mean(results[s, "original"], "obstacles_hit") > 0]
    return "\n".join([
        say(total("proposed", "people_hit") == 0 and total("proposed", "obstacles_hit") == 0,
            f"paths of the proposed swarm do not collide (section 3.2.2): {total('proposed', 'people_hit'):.0f} collisions between people and "
            f"{total('proposed', 'obstacles_hit'):.0f} with obstacles in {runs} runs."),
        say(len(fewer) == len(SCENARIOS), f"the original swarm has more collisions between people than the proposed one, in {len(fewer)} of {len(SCENARIOS)} scenarios "
            f"({total('original', 'people_hit'):.0f} in {runs} runs)."),
        say(bool(walls), f"the original swarm runs into obstacles (section 4.1.2): in {', '.join(walls) or 'none'}."),
        say(total("proposed", "late") == 0, f"everybody of the proposed swarm arrives: {total('proposed', 'late'):.0f} people of all runs are more than 0.5 m from a place when "
            f"the section ends (of the original one {total('original', 'late'):.0f})."),
        say(total("proposed", "refused") == 0, f"every plan of the proposed swarm can be walked; of the original one {total('original', 'refused')} of {runs} are refused, "
            "since people stand behind an obstacle to the end and cannot be on their places in time. The thesis's particles pass through obstacles there (figure 7); here nobody enters one."),
        say(total("proposed", "walked_collisions") + total("original", "walked_collisions") == 0,
            "as walked nobody collides, whichever the swarm: the schedule repairs what the original one leaves, where there is time."),
    ])


def main():
    parser = argparse.ArgumentParser(prog="scripts/lin2007")
    parser.add_argument("--out", default=str(ROOT / "docs"))
    parser.add_argument("--program", default=str(ROOT / "build/release/footlight"))
    arguments = parser.parse_args()
    results = {}
    with tempfile.TemporaryDirectory() as folder:
        for scenario in SCENARIOS:
            for method in METHODS:
                results[scenario, method] = [measured(arguments.program, scenario, method, seed, folder) for seed in SEEDS]
                first = {key: value for key, value in results[scenario, method][0].items() if key != "drawing"}
                print(f"{scenario}, {method}: {json.dumps(first)}", file=sys.stderr)
    out = pathlib.Path(arguments.out)
    for scenario in SCENARIOS:
        row = results[scenario, "proposed"][0]
        if "drawing" in row:
            (out / f"lin2007-{scenario}.svg").write_text(row["drawing"], encoding="utf-8")
    pictures = "\n".join(f"![{scenario}](lin2007-{scenario}.svg)" for scenario in SCENARIOS)
    text = (ROOT / "tests/bench/lin2007.md.in").read_text(encoding="utf-8")
    text = text.replace("@TABLE@", table(results)).replace("@FINDINGS@", findings(results)).replace("@SEEDS@", str(len(SEEDS))).replace("@PICTURES@", pictures)
    (out / "lin2007.md").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
