#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Repeats the experiments of Li 2020 (tables 1-3, figures 3, 7-10) on real films with the program as it is shipped.

    scripts/li2020 [--quick] [--out DIR]

Writes DIR/li2020.md and DIR/li2020-*.svg (default: docs). Needs FOOTLIGHT_SHARED, the folder with the films. Every run is
kept in build/li2020: what was measured with this very program is not measured again. --quick: 330 people and three films only, without
the table of costs (default folder: build/li2020/quick).
"""
import argparse
import pathlib
import statistics
import string
import sys

import numpy

import chart
import li2020_figures as figures
from li2020_runs import FILMS, FREE, MODELS, PIECE, ROOT, WALKING, Marks, Runs, frames_of, shares

SINGLE = ("vine", "animals", "things", "eagle")
LARGE = ("things",)  # of 5,000 people, too
SIZES = {100: ("<0.1", "<1"), 330: ("0.41", "2"), 1000: ("2.75", "4"), 3290: ("18.92", "41"), 5000: ("64.09", "97")}
SAMPLINGS = {(80, 0.1): (110, 7.039), (160, 0.1): (84, 8.240), (40, 0.1): (132, 7.095), (80, 0.2): (47, 14.26), (80, 0.05): (266, 6.377)}
PAPER = {"flat": (26.12, 0.0084, "13.26"), "two layers": (7.039, 0.00029, "29.98"), "three layers": (5.224, 0.00081, "69.65")}
PIECE_S = 150  # 3,750 frames


def percent(share):
    return f"{100 * share:.2f}"


def told_s(seconds):
    return "<0.001" if seconds < 0.001 else f"{seconds:.4f}"


def seconds_for(people):
    """Twice as wide a picture takes twice as long to cross: the same film for more people lasts longer."""
    return max(120, round(240 * (people / 1000) ** 0.5))


class Experiments:
    def __init__(self, runs, quick):
        self.runs = runs
        self.sizes = [330] if quick else list(SIZES)
        self.people = 330 if quick else 1000
        self.films = ("vine", "things") if quick else SINGLE
        self.checked = []  # (theta of the program, of the independent judge)

    def text(self, names, people, model, **options):
        names = PIECE if names == "piece" else (names,) if isinstance(names, str) else names
        seconds = options.pop("seconds", PIECE_S if len(names) > 1 else seconds_for(people))
        return self.runs.show(names, people, seconds, MODELS[model], **options)

    def theta(self, names, people, model, **options):
        print(f"  {names}, {people} people, {model} {options}", file=sys.stderr, flush=True)
        return self.runs.measure(self.text(names, people, model, **options))

    # Table 1 and the times of table 3
    def unit(self, people, model):
        """Processor seconds for each key frame more."""
        costs = []
        for interval in (160, 40):
            print(f"  cost, {people} people, {model}", file=sys.stderr, flush=True)
            costs.append(self.runs.cost(self.text("animals", people, model, seconds=120, interval=interval, speed=FREE)))
        few, many = costs
        return (many["cpu_s"] - few["cpu_s"]) / (many["formations"] - few["formations"])

    def memory(self, people):
        """MB more than for two people."""
        few, many = (self.runs.memory(self.text("animals", n, "two layers", seconds=120, interval=40, speed=FREE)) for n in (2, people))
        return max(0, many - few) / 1024

    def table1(self):
        units = {people: {model: self.unit(people, model) for model in MODELS} for people in self.sizes}
        rows = ["| people | " + " | ".join(map(str, units)) + " |", "|---|" + "---|" * len(units)]
        rows.append("| Li 2020, s a unit | " + " | ".join(SIZES[people][0] for people in units) + " |")
        for model in MODELS:
            rows.append(f"| {model}, s a unit | " + " | ".join(told_s(units[people][model]) for people in units) + " |")
        rows.append("| Li 2020, MB | " + " | ".join(SIZES[people][1] for people in units) + " |")
        rows.append("| two layers, MB | " + " | ".join(f"{self.memory(people):.0f}" for people in units) + " |")
        own = {model: {people: max(1e-3, units[people][model]) for people in units} for model in MODELS}
        paper = {"Li 2020, published": {330: 0.41, 1000: 2.75, 3290: 18.92, 5000: 64.09}}
        return "\n".join(rows), chart.growth(own, paper, "scripts/li2020"), units

    # Table 3
    def table3(self, units):
        rows = ["| | people | show frames | key frames | flat | variance | two layers | variance | three layers | variance | two of flat | three of two |",
                "|---|---|---|---|---|---|---|---|---|---|---|---|",
                "| Li 2020 | 3290 | | 110 | 26.12 | 0.0084 | 7.04 | 0.00029 | 5.22 | 0.00081 | 27 % | 74 % |"]
        cases = [(film, people, WALKING) for people in self.sizes for film in self.films if people < 5000 or film in LARGE]
        cases += [("piece", self.people, WALKING)] + [(film, self.people, FREE) for film in (*self.films, "piece")]
        count = {"far below": [], "lower": [], "wider": []}
        for film, people, speed in cases:
            found = {model: self.theta(film, people, model, speed=speed) for model in MODELS}
            flat, two, three = (found[model] for model in MODELS)
            name = film if speed == WALKING else f"{film}, no limit"
            frames = 25 * (PIECE_S if film == "piece" else seconds_for(people))
            rows.append(f"| {name} | {people} | {frames} | {two['formations']} | " + " | ".join(
                f"{percent(m['theta_dev'])} | {m['theta_dev_var']:.5f}" for m in (flat, two, three)) +
                f" | {two['theta_dev'] / flat['theta_dev']:.0%} | {three['theta_dev'] / two['theta_dev']:.0%} |")
            count["far below"].append((speed, two["theta_dev"] < 0.75 * flat["theta_dev"]))
            count["lower"].append((speed, three["theta_dev"] < two["theta_dev"]))
            count["wider"].append((speed, three["theta_dev_var"] > two["theta_dev_var"]))
        times = ""
        if units:
            people = 3290
            times = ("\n\n| calculation time of a unit, s, 3,290 people | flat | two layers | three layers |\n|---|---|---|---|\n| Li 2020 | 13.26 | 29.98 | 69.65 |\n"
                        "| Footlight | " + " | ".join(told_s(units[people][model]) for model in MODELS) + " |")
        return "\n".join(rows) + times, {key: {speed: f"{sum(good for s, good in found if s == speed)} of {sum(s == speed for s, _ in found)}"
                                               for speed in (WALKING, FREE)} for key, found in count.items()}

    def defaults(self):
        """The product's own cost, squared distance, and other sizes of region."""
        ways = {"flat": "{model: flat, cost: squared}"}
        ways |= {f"two layers, {size}": f"{{model: hierarchical, layers: 2, region: {{size: {size}, variance: {size / 2:g}}}}}" for size in (15, 30, 60, 120)}
        ways["three layers, 60"] = "{model: hierarchical, layers: 3, region: {size: 60, variance: 30}}"
        rows = ["| | " + " | ".join(ways) + " |", "|---|" + "---|" * len(ways)]
        for film in self.films:
            cells = []
            for planner in ways.values():
                m = self.runs.measure(self.runs.show((film,), self.people, seconds_for(self.people), planner))
                cells.append(f"{percent(m['theta_dev'])} ({m['total_distance_m'] / self.people:.0f} m)")
            rows.append(f"| {film} | " + " | ".join(cells) + " |")
        return "\n".join(rows)

    # Table 2 and figure 3
    def table2(self, speed):
        people = 330
        films = (*self.films, "piece")
        rows = ["| c / T_hash | " + " | ".join(f"{film}: key frames | theta_dev" for film in films) + " | Li 2020: key frames | theta_dev |", "|---" * (2 * len(films) + 3) + "|"]
        for (c, share), (keys, theta) in SAMPLINGS.items():
            cells = []
            for film in films:
                m = self.theta(film, people, "two layers", interval=c, hash_share=share, speed=speed)
                cells.append(f"{m['formations']} | {percent(m['theta_dev'])}")
            rows.append(f"| {c} / {share:g} | " + " | ".join(cells) + f" | {keys} | {theta:.2f} |")
        return "\n".join(rows)

    def figure3(self):
        people = 330
        rows = ["| film | dynamic, 80/.1 | fixed, every 80 frames | fixed, every 160 frames | hash alone, .1 | fixed, as many as dynamic |", "|---|---|---|---|---|---|"]
        told = lambda m: f"{percent(m['theta_dev'])} ({m['formations']})"
        better = {"fixed, every 80 frames": 0, "fixed, every 160 frames": 0, "hash alone": 0, "fixed, as many": 0}
        films = (*self.films, "piece")
        for film in films:
            free = {"speed": FREE}
            dynamic = self.theta(film, people, "two layers", **free)
            others = [self.theta(film, people, "two layers", hash_share=1, **free),
                      self.theta(film, people, "two layers", interval=160, hash_share=1, **free),
                      self.theta(film, people, "two layers", interval=25 * 600, **free),
                      self.as_many(film, people, dynamic["formations"])]
            for key, other in zip(better, others):
                better[key] += dynamic["theta_dev"] <= other["theta_dev"]
            rows.append(f"| {film} | " + " | ".join(told(m) for m in (dynamic, *others)) + " |")
        return "\n".join(rows), "; ".join(f"{key}: {n} of {len(films)}" for key, n in better.items())

    def as_many(self, film, people, formations):
        """Fixed sampling with as many key frames as another has, as nearly as frames allow."""
        films = len(PIECE) if film == "piece" else 1
        seconds = PIECE_S if film == "piece" else seconds_for(people)
        interval, best = 25 * seconds / (formations - films), None
        for _ in range(4):
            found = self.theta(film, people, "two layers", interval=round(interval, 1), hash_share=1, speed=FREE)
            if best is None or abs(found["formations"] - formations) < abs(best["formations"] - formations):
                best = found
            if found["formations"] == formations:
                break
            interval *= (found["formations"] - films) / (formations - films)
        return best

    # Figures
    def figure7(self):
        return figures.over_time({f"{c}/{share:g}": self.runs.frames(self.text("piece", 330, "two layers", interval=c, hash_share=share, speed=FREE))
                                  for c, share in SAMPLINGS})

    def figure9(self):
        series = {}
        for model in MODELS:
            text = self.text("things", self.people, model)
            series[model] = self.runs.frames(text)
            ours = self.theta("things", self.people, model)["theta_dev"]
            outside = self.runs.outside(text, "things")
            mean = statistics.fmean(theta for _, theta in series[model])
            if abs(mean - ours) > 5e-4:
                raise SystemExit(f"figure 9: frames have the mean {mean}, the program says {ours}")
            if outside:
                self.checked.append((f"things, {self.people} people, {model}", ours, outside["theta_dev"]))
        return figures.over_time(series)

    def crowd(self, texts, film, instants, window=None):
        """@param instants  shares of the section's time"""
        rows = []
        for name, text in texts.items():
            marks = Marks(self.runs.export(text))
            section = next(s for s in marks.stage["sections"] if s["name"] == film)
            pictures = list(frames_of(FILMS[film]))
            shown = []
            for share in instants:
                time_s = section["start_s"] + share * (section["end_s"] - section["start_s"])
                places = marks.places(section, time_s)
                picture = pictures[min(len(pictures) - 1, round((time_s - section["start_s"]) * section["fps"]) + section["frame0"])]
                shown.append((f"frame {25 * (time_s - section['start_s']):.0f}", places, shares(picture, section, marks.stage["grid"]["cell_area_m2"], places)))
            rows.append((name, shown))
        if window is None:
            all_places = numpy.concatenate([places for _, shown in rows for _, places, _ in shown])
            window = (*(all_places.min(0) - 1), *(all_places.max(0) + 1))
        return figures.people(rows, marks.stage, window)

    def figure8(self):
        texts = {f"{c}/{share:g}": self.text("animals", 100, "two layers", interval=c, hash_share=share) for c, share in SAMPLINGS}
        return self.crowd(texts, "animals", (0.10, 0.13, 0.16, 0.19, 0.22, 0.25))

    def figure10(self):
        texts = {model: self.text("vine", self.people, model) for model in MODELS}
        return self.crowd(texts, "vine", (0.45, 0.47, 0.49, 0.51, 0.53))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--out", type=pathlib.Path)
    options = parser.parse_args()
    missing = [str(path) for path in FILMS.values() if not path.exists()]
    if missing:
        raise SystemExit(f"{missing[0]} is not there; set FOOTLIGHT_SHARED to the folder with media/")
    kept = ROOT / "build/li2020"
    out = options.out or (kept / "quick" if options.quick else ROOT / "docs")
    out.mkdir(parents=True, exist_ok=True)
    do = Experiments(Runs(kept), options.quick)
    words = {"command": "scripts/li2020" + (" --quick" if options.quick else ""), "people": do.people}
    table1, growth, units = ("(left out by --quick)", None, None) if options.quick else do.table1()
    words["table1"] = table1
    words["table3"], held = do.table3(units)
    for key, name in (("far below", "far_below"), ("lower", "lower"), ("wider", "wider")):
        words[name], words[name + "_free"] = held[key][WALKING], held[key][FREE]
    words["defaults"] = do.defaults()
    words["table2"], words["table2_walking"] = do.table2(FREE), "(left out by --quick)" if options.quick else do.table2(WALKING)
    words["figure3"], words["dynamic"] = do.figure3()
    drawings = {"growth": growth, "fig7": do.figure7(), "fig8": do.figure8(), "fig9": do.figure9(), "fig10": do.figure10()}
    for name, drawing in drawings.items():
        if drawing:
            (out / f"li2020-{name}.svg").write_text(drawing)
    words["checked"] = "; ".join(f"{what}: {ours:.5f} and {theirs:.5f}" for what, ours, theirs in do.checked) or "it was not there"
    template = string.Template((pathlib.Path(__file__).parent / "li2020.md.in").read_text())
    (out / "li2020.md").write_text(template.substitute(words))
    print(f"wrote {out / 'li2020.md'}")


if __name__ == "__main__":
    main()
