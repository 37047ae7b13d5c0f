# SPDX-License-Identifier: Apache-2.0
"""Runs footlight_bench and its peers, compares their optima, prints a table. Called by scripts/bench."""
import argparse
import json
import math
import os
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

import chart

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "build/bench/tests/bench/footlight_bench"
PEERS = ROOT / "tests/bench/peers.py"
SCENES = ("disk_to_ring", "block_to_letters", "flower_turned")
PAPER = {100: 0.1, 330: 0.41, 1000: 2.75, 3290: 18.92, 5000: 64.09}  # Li 2020, table 1, seconds for a unit

# What a job should take at most, seconds, on cores that do the shared prototype's 3,290 squared in 13 ms.
LIMITS = {
    ("assignment squared", 1000): 2e-3, ("assignment squared", 3290): 8e-3, ("assignment squared", 10_000): 30e-3,
    ("assignment squared", 100_000): 0.6, ("assignment euclidean", 3290): 12e-3,
    ("formation 640x480", 3290): 20e-6, ("formation 1920x1080", 3290): 40e-6,
    ("unit flat", 100): 0.1e-3, ("unit flat", 1000): 2e-3, ("unit flat", 3290): 9e-3, ("unit flat", 5000): 15e-3,
    ("schedule over cells", 3290): 0.8e-3, ("schedule over cells", 100_000): 0.12,
    ("show ceremony", 3290): 4.0, ("show stadium", 100_000): 30.0, ("replan ceremony, image", 3290): 0.1, ("repair ceremony", 3290): 2.0, ("reset way ceremony", 3290): 2.0,
}


def limit_of(job, size):
    return next((limit for (start, people), limit in LIMITS.items() if job.startswith(start) and people == size), None)


class Measured:
    """Medians of one job of one program, and what is wrong with it."""

    def __init__(self, seconds, cpu=None, mb=None, cost=None, error=None):
        self.seconds, self.cpu, self.mb, self.cost, self.error = seconds, cpu, mb, cost, error


NAMES = {"generic": "ours, generic instructions", "lemon": "LEMON", "stream": "bound: state copied", "bound": "bound: copied, sorted, pairs"}


def note(text):
    print(f"note: {text}", file=sys.stderr)


def own_runs(quick):
    """What footlight_bench measured, by (who, job, size)."""
    command = [PROGRAM, "--benchmark_format=json", "--benchmark_min_time=" + ("0.02" if quick else "0.1")]
    output = subprocess.run(command + (["--quick"] if quick else []), capture_output=True, check=True, text=True)
    runs = {}
    for entry in json.loads(output.stdout)["benchmarks"]:
        if entry["run_type"] == "iteration":
            who, job, size = entry["run_name"].split("/")[:3]
            who = NAMES.get(who, who)
            size = round(entry.get("people", int(size)))
            runs.setdefault((who, job, size), []).append(entry)
    return {key: summary(key[1], entries) for key, entries in runs.items()}


def summary(job, entries):
    scale = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1}
    def median(field):
        return statistics.median(entry[field] * scale[entry["time_unit"]] for entry in entries)
    # Work on several cores, and on another process, is judged by the clock; all other by the processor's time.
    clock = re.match("show|replan|repair|reset|validate|measure|decode|step", job) is not None
    first = entries[0]
    error = next((entry["error_message"] for entry in entries if entry.get("error_occurred")), None)
    if error:
        return Measured(None, error=error)
    return Measured(median("real_time" if clock else "cpu_time"), median("cpu_time"),
                    max(entry.get("mb", 0) for entry in entries), first.get("cost"))


def python_peer(*words):
    """Nothing where it cannot run."""
    output = subprocess.run(["/usr/bin/python3", PEERS, *map(str, words)], capture_output=True, text=True)
    if output.returncode != 0:
        note(f"peers.py {words[0]} did not run: {(output.stderr.strip().splitlines() or ['no message'])[-1]}")
        return None
    answer = json.loads(output.stdout)
    return Measured(statistics.median(answer["seconds"]), mb=answer["mb"], cost=answer["cost"])


def compiled_prototype(folder, name, what):
    """A shared prototype; nothing where it is not there or its instructions are not."""
    source = pathlib.Path(os.environ.get("FOOTLIGHT_SHARED", ROOT.parent / "shared")) / f"prototypes/{name}.cpp"
    if not source.exists():
        note(f"the shared prototype of the {what} is not here (FOOTLIGHT_SHARED); its rows are left out")
        return None
    if "avx512f" not in pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8"):
        note(f"the shared prototype of the {what} needs AVX-512; its rows are left out")
        return None
    program = pathlib.Path(folder) / name
    command = ["g++", "-std=c++20", "-O3", "-march=native", "-w", "-o", program, source, "-pthread"]
    if subprocess.run(command, capture_output=True).returncode != 0:
        note(f"the shared prototype of the {what} does not compile; its rows are left out")
        return None
    return program


def schedule_run(program, folder, size):
    """Steps over cells by the prototype, which checks its own conflicts."""
    pairs, matching = (pathlib.Path(folder) / f"cells_{size}{ending}.txt" for ending in ("", ".match"))
    output = subprocess.run([program, pairs, matching, "4", "7", "2.0"], capture_output=True, text=True)
    found = re.search(r" ok 1 .* plan_ms min \S+ med (\S+) .*rss (\d+)", output.stdout)
    return Measured(float(found[1]) / 1e3, mb=float(found[2])) if found else None


def prototype_run(program, file, cost, size):
    """Its figure for Euclidean distances leaves out who may stay, as ours does; it then reports the same cost."""
    repetitions = 3 if size > 10_000 else 7
    if cost == "squared":
        words, settings = [2, 200, 1, 8, 4, repetitions, 0], {"MS": "1"}
    else:
        words, settings = [1, 4, 0.003, 4, 4, repetitions, 0], {"KNB": "0", "MS": "1", "STAT": "1", "C1": "0.5", "C2": "0.25"}
    output = subprocess.run([program, file, *map(str, words)], capture_output=True, text=True, env=os.environ | settings)
    found = re.search(r"med (\S+) reps \d+ primal (\S+) .*rss (\d+)", output.stdout)
    return Measured(float(found[1]), mb=float(found[3]), cost=float(found[2])) if found else None


def peer_runs(quick, folder):
    """Peers in other programs, by (who, job, size)."""
    runs = {}
    prototype = compiled_prototype(folder, "lap4", "assignment")
    schedule = compiled_prototype(folder, "sched", "schedule over cells")
    for size in (1000, 3290, 10_000) + (() if quick else (100_000,)):
        if schedule:
            runs["prototype (AVX-512)", "schedule over cells", size] = schedule_run(schedule, folder, size)
    for scene in SCENES[:1] if quick else SCENES:
        for cost in ("squared", "euclidean"):
            job = f"assignment {cost} {scene}"
            for size in (100, 330, 1000, 3290, 5000, 10_000, 100_000):
                file = pathlib.Path(folder) / f"{scene}_{size}.txt"
                if size <= 1000 or (scene == SCENES[0] and size <= (3290 if quick else 5000) and (cost == "squared" or not quick)):
                    runs["scipy", job, size] = python_peer("assignment", file, cost, 3 if size <= 1000 else 1)
                # By distances the prototype takes a minute for 100,000.
                if prototype and file.exists() and (size <= 10_000 or cost == "squared"):
                    measured = prototype_run(prototype, file, cost, size)
                    if measured:
                        runs["prototype (AVX-512)", job, size] = measured
    for size in ("640x480", "1920x1080"):
        file = pathlib.Path(folder) / f"picture_{size}.txt"
        runs["numpy", f"formation {size}", 3290] = python_peer("formation", file, 5)
    for size, seconds in PAPER.items():
        for mode in ("flat", "hierarchical"):
            runs["Li 2020, published", f"unit {mode}", size] = Measured(seconds)
    return {key: measured for key, measured in runs.items() if measured}


def mistake(peer, ours, theirs):
    """What speaks against a row, or nothing: a check of the program, or another optimum than the peer's."""
    if ours.error or (theirs and theirs.error):
        return ours.error or f"{peer}: {theirs.error}"
    if not theirs or theirs.cost is None or ours.cost is None:
        return None
    if math.isclose(ours.cost, theirs.cost, rel_tol=1e-6 if peer == "numpy" else 1e-8):
        return None
    return f"{peer} finds {theirs.cost}, we find {ours.cost}"


def make_rows(runs):
    """One row for each of our jobs and each of its peers. `checked`: by the program, and against the peer's optimum."""
    rows = []
    for (who, job, size), ours in runs.items():
        if who != "ours":
            continue
        peers = [(peer, theirs) for (peer, same_job, same_size), theirs in runs.items()
                 if peer != "ours" and same_job == job and same_size == size]
        for peer, theirs in peers or [(None, None)]:
            wrong = mistake(peer, ours, theirs)
            theirs_s = theirs.seconds if theirs else None
            row = {"job": job, "size": size, "ours_s": ours.seconds, "ours_cpu_s": ours.cpu,
                   "ours_mb": None if ours.mb is None else round(ours.mb, 1), "peer": peer, "peer_s": theirs_s,
                   "ratio": theirs_s / ours.seconds if theirs_s and ours.seconds else None,
                   "limit_s": limit_of(job, size), "checked": wrong is None}
            rows.append(row | ({"error": wrong} if wrong else {}))
    return rows


def duration(seconds):
    if seconds is None:
        return ""
    for unit, scale in (("s", 1), ("ms", 1e-3)):
        if seconds >= scale:
            return f"{seconds / scale:.3g} {unit}" if seconds < 1000 * scale else f"{seconds / scale:.0f} {unit}"
    return f"{seconds / 1e-6:.3g} µs"


def table(rows):
    """The rows as the cells of a table, peers of one job beneath each other."""
    out = [["job", "people", "ours", "memory, MB", "peer", "peer's", "ratio", "aim"]]
    last = None
    for row in rows:
        key = (row["job"], row["size"])
        ours = duration(row["ours_s"]) if row["checked"] else "wrong: " + row["error"]
        if re.match("show|replan|repair|reset|validate|measure", row["job"]) and row["checked"]:
            ours += f" (CPU {duration(row['ours_cpu_s'])})"
        memory = "" if row["ours_mb"] is None else f"{row['ours_mb']:.1f}"
        first = [row["job"], f"{row['size']:,}", ours, memory] if key != last else [""] * 4
        ratio = f"{row['ratio']:.3g}" if row["ratio"] and row["ratio"] < 1000 else f"{row['ratio']:,.0f}" if row["ratio"] else ""
        out.append(first + [row["peer"] or "", duration(row["peer_s"]), ratio,
                            duration(row["limit_s"]) if key != last else ""])
        last = key
    return out


def as_text(cells):
    widths = [max(len(line[i]) for line in cells) for i in range(len(cells[0]))]
    return "\n".join("  ".join(word.ljust(width) for word, width in zip(line, widths)).rstrip() for line in cells)


def as_markdown(cells):
    lines = ["| " + " | ".join(line) + " |" for line in cells]
    return "\n".join([lines[0], "|" + "---|" * len(cells[0]), *lines[1:]])


def machine():
    info = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8")
    model = re.search(r"model name\s*: (.*)", info)
    return f"{model[1] if model else 'unknown processor'}, {os.cpu_count()} cores"


def curves(rows):
    """Seconds by people for the plot: our own, and each peer's on the same instances."""
    own, peers = {}, {}
    for row in rows:
        if row["checked"] and row["job"] in ("assignment squared disk_to_ring", "assignment euclidean disk_to_ring", "unit hierarchical"):
            name = row["job"].replace(" disk_to_ring", "")
            own.setdefault(name, {})[row["size"]] = row["ours_s"]
            if row["peer"] and "generic" not in row["peer"] and not row["job"].startswith("assignment euclidean"):
                peer = f"{row['peer'].split(',')[0].split(' (')[0]}, {name.split()[0]}"
                peers.setdefault(peer, {})[row["size"]] = row["peer_s"]
    return own, peers


def write_docs(rows, quick):
    command = "scripts/bench --docs" + (" --quick" if quick else "")
    text = (ROOT / "tests/bench/benchmarks.md.in").read_text(encoding="utf-8")
    text = text.replace("@COMMAND@", command).replace("@MACHINE@", machine())
    text = text.replace("@LOAD@", f"{os.getloadavg()[2]:.1f}").replace("@TABLE@", as_markdown(table(rows)))
    (ROOT / "docs/benchmarks.md").write_text(text, encoding="utf-8")
    (ROOT / "docs/benchmarks.svg").write_text(chart.growth(*curves(rows), command), encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(prog="scripts/bench")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--json", metavar="FILE")
    parser.add_argument("--docs", action="store_true")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([PROGRAM, "--write", folder], check=True)
        runs = own_runs(arguments.quick)
        runs |= peer_runs(arguments.quick, folder)
    rows = make_rows(runs)
    print(as_text(table(rows)))
    if arguments.json:
        pathlib.Path(arguments.json).write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")
    if arguments.docs:
        write_docs(rows, arguments.quick)
    wrong = [row for row in rows if not row["checked"]]
    for row in wrong:
        print(f"error: {row['job']}, {row['size']}: {row['error']}", file=sys.stderr)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
