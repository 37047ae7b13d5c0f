#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Repeats table 1 and figures 18-20 of Son, Sung 2024 with the shows son-birds and son-circle-rectangle.

    scripts/son2024 [--build DIR]

Writes docs/son2024.md and docs/son2024-*.svg. Each show is planned as it is, without formation (Weiss et al. 2017), and by
the collective model (Xu et al. 2015); footlight_srd_raw follows people and their short range destinations.
"""
import argparse
import json
import os
import pathlib
import re
import string
import subprocess

import chart

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAPER = {100: 89, 200: 72, 400: 55, 800: 35, 1600: 16}
SIZES = (*PAPER, 10_000, 100_000)
MODELS = {"formation": None, "without formation": "{model: srd, srd: {formation: false}}", "collective": "{model: collective}"}
LONGER = (1, 1.5, 2)
SHOWS = {"son-birds": "two birds of 585", "son-circle-rectangle": "a circle and a rectangle of 375 each"}


def run(*command):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    return done.stdout if done.returncode == 0 else None, done.stderr


def variant(show, planner):
    """The show with another planner in the section that has a model of motion."""
    if planner is None:
        return show
    if "collective" not in planner and "orientation" in show:
        planner = planner.replace("formation: false", "formation: false, orientation: path, corner: 12 m")
    return re.sub(r"planner:(?: \{model: srd\}|\n +model: srd\n +srd: .*)", f"planner: {planner}", show)


def longer(show, times):
    """The show with so many times as long a crossing."""
    return re.sub(r"(duration: )(\d+)( counts)", lambda found: f"{found[1]}{int(times * int(found[2]))}{found[3]}", show)


def followed(build, name):
    """{model: what footlight_srd_raw says of the crossing, or why there is nothing}; who cannot be there in time is given
    longer, for a plan that is refused cannot be compared with anything"""
    out = {}
    text = (ROOT / "shows" / name / "show.yaml").read_text()
    for model, planner in MODELS.items():
        show = ROOT / "shows" / name / f".{os.getpid()}.yaml"  # beside its media
        for times in LONGER:
            show.write_text(longer(variant(text, planner), times))
            try:
                raw, why = run(build / "tests/bench/footlight_srd_raw", show)
            finally:
                show.unlink()
            told = model if times == 1 else f"{model}, {times:g} times as long"
            if raw is not None:
                out[told] = json.loads(raw)[-1]
                break
        else:
            out[told] = why.strip().splitlines()[0].split("error: ")[-1]
    return out


def mean(values):
    return sum(values) / len(values)


def row(name, model, found):
    if isinstance(found, str):
        return f"| {name} | {model} | not planned: {found} |" + " |" * 6
    n = len(found["at_s"])
    end = found["at_s"][-1]
    back = next((t for k, t in enumerate(found["at_s"]) if t > end / 2 and max(found["raw_m"][k:]) < 0.1), None)
    return (f"| {name} | {model} | {mean(found['raw_m']):.3f} | {max(found['raw_m']):.3f} | {found['raw_m'][-1]:.3f} | "
            f"{mean(found['walked_m']):.3f} | {max(found['walked_m']):.3f} | {found['walked_m'][n - 1]:.3f} | "
            f"{mean(found['off_m']):.3f}, at most {max(found['off_most_m']):.2f} | {'-' if back is None else f'{back:.0f} s'} |")


def plot(found, file):
    """Mean distance to the short range destination over time, raw lines and walked ones dashed."""
    series = {}
    for model, one in found.items():
        if isinstance(one, str):
            continue
        series[model + ", raw"] = (one["at_s"], one["raw_m"], "")
        series[model + ", walked"] = (one["at_s"], one["walked_m"], ' stroke-dasharray="5 4"')
    x1 = max(at[-1] for at, _, _ in series.values())
    y1 = max(max(values) for _, values, _ in series.values()) * 1.05

    def point(t, value):
        return (f"{chart.LEFT + t / x1 * (chart.WIDTH - chart.LEFT - chart.RIGHT):.1f},"
                f"{chart.HEIGHT - chart.BOTTOM - value / y1 * (chart.HEIGHT - chart.TOP - chart.BOTTOM):.1f}")

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {chart.WIDTH} {chart.HEIGHT}" font-family="sans-serif" font-size="12">',
           "<desc>made by scripts/son2024</desc>", f'<rect width="{chart.WIDTH}" height="{chart.HEIGHT}" fill="white"/>']
    for k in range(5):
        left, level = point(0, y1 * k / 4).split(",")
        out.append(f'<line x1="{left}" x2="{chart.WIDTH - chart.RIGHT}" y1="{level}" y2="{level}" stroke="#ddd"/>')
        out.append(f'<text x="{float(left) - 8}" y="{float(level) + 4}" text-anchor="end">{y1 * k / 4:.2f} m</text>')
        x, base = point(x1 * k / 4, 0).split(",")
        out.append(f'<text x="{x}" y="{float(base) + 18}" text-anchor="middle">{x1 * k / 4:.0f} s</text>')
    for n, (name, (at, values, dash)) in enumerate(series.items()):
        colour = chart.COLOURS[n // 2 % len(chart.COLOURS)]
        line = " ".join(point(t, value) for t, value in zip(at, values))
        out.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="1.5"{dash}/>')
        y = chart.TOP + 20 * n + 10
        out.append(f'<line x1="{chart.WIDTH - chart.RIGHT + 15}" x2="{chart.WIDTH - chart.RIGHT + 45}" y1="{y}" y2="{y}" stroke="{colour}" stroke-width="1.5"{dash}/>')
        out.append(f'<text x="{chart.WIDTH - chart.RIGHT + 50}" y="{y + 4}">{name}</text>')
    file.write_text("\n".join(out + ["</svg>", ""]))


def pictures(found, stage_m, file):
    """Where people walk at four instants, a dot of their group's colour each."""
    wide, deep = stage_m
    scale = 370 / wide
    height = deep * scale
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 760 {2 * height + 60:.0f}" font-family="sans-serif" font-size="12">',
           "<desc>made by scripts/son2024</desc>", f'<rect width="760" height="{2 * height + 60:.0f}" fill="white"/>']
    for n, picture in enumerate(found["pictures"]):
        left, top = n % 2 * 385 + 5, n // 2 * (height + 28) + 22
        out.append(f'<text x="{left}" y="{top - 6:.0f}">{picture["at_s"]:.0f} s</text>')
        out.append(f'<rect x="{left}" y="{top}" width="370" height="{height:.1f}" fill="none" stroke="#ddd"/>')
        for colour, people in picture["people"].items():
            dots = "".join(f"M{left + (x + wide / 2) * scale - 0.8:.1f} {top + (deep - y) * scale:.1f}h1.6" for x, y in people)
            out.append(f'<path d="{dots}" stroke="{colour}" stroke-width="1.6"/>')
    file.write_text("\n".join(out + ["</svg>", ""]))


def stage_of(text):
    columns, rows, pitch = (float(re.search(key + r": ([0-9.]+)", text)[1]) for key in ("columns", "rows", "pitch"))
    return columns * pitch, rows * pitch


def table1(build):
    rows = ["| people | Son 2024, frames/s | steps/s | without formation, steps/s | ns a person and step | without |", "|---|---|---|---|---|---|"]
    for people in SIZES:
        held, loose = (json.loads(run(build / "tests/bench/footlight_srd_raw", "--steps", people, model)[0]) for model in ("srd", "weiss"))
        ns = [1e9 * one["cpu_s"] / one["steps"] / people for one in (held, loose)]
        rows.append(f"| {people:,} | {PAPER.get(people, '-')} | {held['steps_a_second']:,.0f} | {loose['steps_a_second']:,.0f} | {ns[0]:.0f} | {ns[1]:.0f} |")
    return "\n".join(rows)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--build", type=pathlib.Path, required=True)
    build = parser.parse_args().build.resolve()
    recovered = ["| show | model | raw, mean m | most | at the end | walked, mean m | most | at the end | walked from raw, m | formed again (raw below 0.1 m) after |",
                 "|---|---|---|---|---|---|---|---|---|---|"]
    for name, told in SHOWS.items():
        found = followed(build, name)
        recovered += [row(told, model, one) for model, one in found.items()]
        plot(found, ROOT / "docs" / f"son2024-{name[4:]}.svg")
        stage_m = stage_of((ROOT / "shows" / name / "show.yaml").read_text())
        pictures(found["formation"], stage_m, ROOT / "docs" / f"{name}.svg")
    page = string.Template((ROOT / "tests/bench/son2024.md.in").read_text())
    (ROOT / "docs/son2024.md").write_text(page.substitute(table1=table1(build), recovered="\n".join(recovered)))


if __name__ == "__main__":
    main()
