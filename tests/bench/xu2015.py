#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Repeats the tables of Xu 2015 on the shows xu-* with the program as it is shipped.

    scripts/xu2015 [--out DIR] [--build DIR]

Writes DIR/xu2015.md (default: docs). Every figure is of the plan's marks as they are walked and judged, with the model's own trajectory beside
it. Plans are kept in build/xu2015.
"""
import argparse
import json
import pathlib
import re
import string
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
SHOWS = ("xu-evolution", "xu-running", "xu-martial", "xu-fighters", "xu-path", "xu-curve")
PLAIN = "planner: {model: collective}"
COSTS = ("least effort", "euclidean", "manhattan")
TABLE1 = {110: (295, 73), 306: (104, 66), 783: (40, 71), 1190: (27, 86), 1936: (17, 96)}
TABLE2 = {"least effort": (0.131, 65.347, 13.269), "euclidean": (0.297, 148.479, 108.603), "manhattan": (0.568, 120.482, 131.216)}
FIGURES = ("I_d", "sigma_min_dis", "sigma_curr_eft")


def longer(text):
    """The show with half as much time again for each transform, so that pairings whose ways are longer get there, too."""
    out, start, length = [], 1, 0
    for line in text.splitlines(keepends=True):
        if found := re.match(r"(    (start: count|duration:|hold:) )(\d+)( counts)?\n", line):
            counts = int(found[3])
            if found[2] == "start: count":
                start, length, counts = start + length, 0, start + length
            else:
                counts = counts * 3 // 2 if found[2] == "duration:" else counts
                length += counts + (found[2] == "hold:")
            line = f"{found[1]}{counts}{found[4] or ''}\n"
        out.append(line)
    return "".join(out)


class Runs:
    def __init__(self, build):
        self.footlight = build / "footlight"
        self.raw = next(path for path in (build / "tests/bench/footlight_collective_raw", build / "footlight_collective_raw") if path.exists())
        self.folder = ROOT / "build/xu2015"
        self.refused = []

    def sections(self, show, options):
        """Raw and walked figures of the show's collective sections, planned with these options; nothing when the plan is refused."""
        name = show + "".join(c if c.isalnum() else "-" for c in options)
        folder = self.folder / name
        folder.mkdir(parents=True, exist_ok=True)
        for path in (ROOT / "shows" / show).iterdir():
            if path.suffix == ".png":
                (folder / path.name).write_bytes(path.read_bytes())
        text = (ROOT / "shows" / show / "show.yaml").read_text()
        if PLAIN not in text:
            raise SystemExit(f"{show} has no section with '{PLAIN}'")
        if options:
            text = text.replace(PLAIN, f"planner: {{model: collective, collective: {{{options}}}}}")
        (folder / "show.yaml").write_text(longer(text))
        print(f"  {show} {options}", file=sys.stderr, flush=True)
        planned = subprocess.run([self.footlight, "plan", folder / "show.yaml", "-o", folder / "show.plan"], capture_output=True, text=True)
        if planned.returncode != 0:
            self.refused.append(f"{show} {{{options}}}: {planned.stderr.strip().splitlines()[-1] if planned.stderr.strip() else planned.returncode}".replace(str(folder) + "/", ""))
            return []
        found = subprocess.run([self.raw, folder / "show.plan", folder / "show.yaml"], capture_output=True, text=True, check=True)
        return json.loads(found.stdout)

    def steps(self, people):
        print(f"  steps, {people} people", file=sys.stderr, flush=True)
        return json.loads(subprocess.run([self.raw, "--steps", str(people)], capture_output=True, text=True, check=True).stdout)


def mean(values):
    values = list(values)
    return sum(values) / len(values) if values else float("nan")


def table1(runs):
    found = {people: runs.steps(people) for people in TABLE1}
    rows = ["| people | " + " | ".join(map(str, TABLE1)) + " |", "|---" * (len(TABLE1) + 1) + "|"]
    rows.append("| Xu 2015, frames/s | " + " | ".join(str(fps) for fps, _ in TABLE1.values()) + " |")
    rows.append("| Footlight, steps/s, one thread | " + " | ".join(f"{one['steps_per_s']:.0f}" for one in found.values()) + " |")
    rows.append("| Xu 2015, MB | " + " | ".join(str(mb) for _, mb in TABLE1.values()) + " |")
    rows.append("| Footlight, MB, pairing and sub-groups included | " + " | ".join(f"{one['memory_mb']:.0f}" for one in found.values()) + " |")
    rows.append("| pairing and sub-groups, processor s | " + " | ".join(f"{one['prepare_cpu_s']:.2f}" for one in found.values()) + " |")
    return "\n".join(rows)


def cells(section):
    return " | ".join(f"{section['walked'][f]:.3f} ({section['raw'][f]:.3f})" for f in FIGURES)


def comparison(runs, shows, variants):
    """@return table, and for each variant the means over all sections of (walked, raw) figures"""
    rows = ["| transform | people | variant | I_d, bits | by chance | sigma_min_dis, m | sigma_curr_eft, m | walked off the trajectory, m: mean (most) |", "|---" * 8 + "|"]
    all_of = {name: [] for name in variants}
    for show in shows:
        found = {name: runs.sections(show, options) for name, options in variants.items()}
        for k in range(max(map(len, found.values()))):
            if any(len(sections) <= k for sections in found.values()):
                continue
            for name, sections in found.items():
                one = sections[k]
                all_of[name].append(one)
                i_d, near, effort = (f"{one['walked'][f]:.3f} ({one['raw'][f]:.3f})" for f in FIGURES)
                rows.append(f"| {show}, {one['section']} | {one['people']} | {name} | {i_d} | {one['walked']['I_d_shuffled']:.3f} | {near} | {effort} | "
                            f"{one['distance_mean_m']:.2f} ({one['distance_max_m']:.1f}) |")
    means = {name: {f: (mean(one["walked"][f] for one in sections), mean(one["raw"][f] for one in sections)) for f in FIGURES} for name, sections in all_of.items()}
    for name, figures in means.items():
        rows.append(f"| **mean** | | **{name}** | " + " | ".join(
            f"{figures[f][0]:.3f} ({figures[f][1]:.3f})" + (f" | {mean(one['walked']['I_d_shuffled'] for one in all_of[name]):.3f}" if f == "I_d" else "") for f in FIGURES) +
            f" | {mean(one['distance_mean_m'] for one in all_of[name]):.2f} |")
    return "\n".join(rows), means, all_of


def orders(all_of, first, second):
    """In how many transforms `first` is lower than `second`, for each figure: walked (raw)."""
    out = []
    for f in FIGURES:
        pairs = list(zip(all_of[first], all_of[second]))
        walked = sum(a["walked"][f] < b["walked"][f] for a, b in pairs)
        raw = sum(a["raw"][f] < b["raw"][f] for a, b in pairs)
        out.append(f"{walked} ({raw}) of {len(pairs)}")
    return " | ".join(out)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "docs")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/bench")
    parser.add_argument("--shows", nargs="+", default=SHOWS, help="of xu-* (default: six of them)")
    arguments = parser.parse_args()
    runs = Runs(arguments.build.resolve())
    costs, cost_means, cost_all = comparison(runs, arguments.shows, {cost: f"pairing: {{cost: {cost}}}" for cost in COSTS})
    feedback, _, feedback_all = comparison(runs, arguments.shows, {"with feedback": "feedback: {on: true}", "without": "feedback: {on: false}"})
    groups, _, _ = comparison(runs, ("xu-crossing",), {"rigidity 0.8": "subgroups: {rigidity: 0.8}", "rigidity 0, as the paper": "subgroups: {rigidity: 0}", "no sub-groups": "subgroups: {on: false}"})
    paper = "\n".join(["| Xu 2015, table 2 | I_d | Minimum | Effort |", "|---|---|---|---|"] + [f"| {cost} | {a} | {b} | {c} |" for cost, (a, b, c) in TABLE2.items()])
    order = "\n".join(["| lower than | I_d | sigma_min_dis | sigma_curr_eft |", "|---|---|---|---|",
                       f"| least effort than Euclidean | {orders(cost_all, 'least effort', 'euclidean')} |",
                       f"| least effort than Manhattan | {orders(cost_all, 'least effort', 'manhattan')} |",
                       f"| with feedback than without | {orders(feedback_all, 'with feedback', 'without')} |"])
    template = string.Template((ROOT / "tests/bench/xu2015.md.in").read_text())
    arguments.out.mkdir(parents=True, exist_ok=True)
    (arguments.out / "xu2015.md").write_text(template.substitute(
        table1=table1(runs), paper=paper, costs=costs, feedback=feedback, groups=groups, order=order,
        refused="none." if not runs.refused else "\n\n" + "\n".join(f"- {one}" for one in runs.refused), build=arguments.build.name))


if __name__ == "__main__":
    main()
