#!/usr/bin/python3
"""End to end with the program as it is shipped: shows are planned, exported, judged by programs of other hands, and played on simulated buses.

    run.py [--program build/release/footlight] [--json FILE] [NAME...]

The judge is found through FOOTLIGHT_SHARED (default ../shared beside the project); without it its tests are skipped and say so.
FOOTLIGHT_FULL=1 runs the long forms.
"""
import argparse
import csv
import glob
import hashlib
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

import cast
import console
import devices
import editing
import live
import ola
import rehearse
import remote
import stage
import survive

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SHARED = os.environ.get("FOOTLIGHT_SHARED", os.path.join(ROOT, "..", "shared"))
FULL = bool(os.environ.get("FOOTLIGHT_FULL"))
PROGRAM = os.path.join(ROOT, "build", "release", "footlight")


def footlight(*arguments, status=0, cwd=ROOT):
    """Runs the program, checks its exit status, returns (stdout, stderr)."""
    done = subprocess.run([PROGRAM, *map(str, arguments)], cwd=cwd, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    if done.returncode != status:
        raise AssertionError(f"footlight {' '.join(map(str, arguments))}: exit {done.returncode}, expected {status}\n{done.stdout[-2000:]}\n{done.stderr[-4000:]}")
    return done.stdout, done.stderr


class Case(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="footlight-e2e-")
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def path(self, *parts):
        return os.path.join(self.folder, *parts)

    def judge(self, program, *arguments):
        tool = os.path.join(SHARED, "check", program)
        if not os.path.exists(tool):
            self.skipTest(f"the independent judge is not here ({tool}); set FOOTLIGHT_SHARED")
        done = subprocess.run(["/usr/bin/python3", tool, *arguments, "--json"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout[-3000:] + done.stderr[-2000:])
        return json.loads(done.stdout)

    def assert_judged_well(self, show, performers):
        """The judge finds nothing wrong, and its figures are ours."""
        plan = self.path("show.plan")
        footlight("plan", show, "-o", plan)
        footlight("export", show, "--plan", plan, "--csv", self.path("csv"))
        measured = json.loads(footlight("measure", show, "--plan", plan, "--json")[0])
        self.assertTrue(measured["valid"])
        judged = self.judge("check_marks.py", self.path("csv"), "--performers", str(performers), "--clearance", "0.5", "--max-speed", "1.4")
        self.assertEqual(judged["wrong"], 0)
        self.assertEqual(judged["too_close"], measured["too_close"])
        self.assertAlmostEqual(judged["max_speed_m_s"], measured["max_speed_m_s"], places=4)
        if judged["min_clearance_m"] < 1.5 * judged["clearance_m"]:
            self.assertAlmostEqual(judged["min_clearance_m"], measured["min_clearance_m"], places=5)
        lag_s = measured["lag_s"]
        late = self.judge("check_marks.py", self.path("csv"), "--clearance", "0.5", "--max-speed", "1.4", "--lag", str(lag_s))
        self.assertEqual(late["too_close_lag"] == 0, measured["lag_tolerated_by"] == measured["transitions"])
        self.assertAlmostEqual(judged["mean_distance_m"], measured["total_distance_m"] / performers, places=3)
        with open(self.path("csv", "stage.json")) as f:
            stage = json.load(f)
        for section in stage["sections"]:
            if "video" not in section or section.get("fps", 0) == 0:
                continue
            video = os.path.join(os.path.dirname(os.path.abspath(show)), section["video"])
            judged = self.judge("theta_dev.py", self.path("csv"), video, "--section", section["name"])
            ours = next(s for s in measured["sections"] if s["name"] == section["name"])
            for figure in ("theta_dev", "theta_miss", "theta_iou"):
                self.assertAlmostEqual(judged[figure], ours[figure], delta=0.0005, msg=f"{section['name']} {figure}")
        return measured


# The show in real time, and a technician's work, on real endpoints.
Stage = stage.make_stage(Case, footlight, lambda: PROGRAM)
Live = live.make_cases(Stage, footlight, lambda: PROGRAM)
Devices = devices.make_cases(Stage, footlight)
Ola = ola.make_cases(Stage)
Rehearse = rehearse.make_cases(Stage, lambda: PROGRAM)
Console = console.make_cases(Stage, footlight, lambda: PROGRAM)
Cast = cast.make_cases(Stage, lambda: PROGRAM, FULL)
Survive = survive.make_cases(Stage, footlight, lambda: PROGRAM, FULL)
Remote = remote.make_cases(Stage, footlight, lambda: PROGRAM, rehearse.Desk, stage.SHOW)
Editing = editing.make_cases(Stage, lambda: PROGRAM)


class Docs(Case):
    def test_architecture_follows_a_cue_that_the_trace_of_vine_shows(self):
        """Who changes the vine show or its plan takes the cue in docs/architecture.md anew."""
        with open(os.path.join(ROOT, "docs", "architecture.md")) as f:
            promised = [line for block in f.read().split("```trace\n")[1:] for line in block.split("```")[0].splitlines()]
        self.assertGreater(len(promised), 8)
        footlight("dryrun", os.path.join(ROOT, "shows/vine/show.yaml"), "--trace", self.path("trace"))
        with open(self.path("trace")) as f:
            shown = set(f.read().splitlines())
        self.assertEqual([line for line in promised if line not in shown], [])


class Shows(Case):
    def test_vine_is_planned_and_judged_well(self):
        measured = self.assert_judged_well(os.path.join(ROOT, "shows/vine/show.yaml"), 900)
        self.assertGreaterEqual(measured["min_clearance_m"], 0.5)

    def test_scenarios_of_lin_2007_are_planned_judged_and_played(self):
        for show in sorted(glob.glob(os.path.join(ROOT, "shows/lin-*/show.yaml"))):
            with self.subTest(os.path.basename(os.path.dirname(show))):
                self.assert_judged_well(show, 40 if "corners" in show else 20)
                footlight("dryrun", show, "--plan", self.path("show.plan"))

    def test_paintings_of_kang_2014_are_planned_judged_and_played(self):
        for name, people in (("theatre", 400), ("castle", 600)):
            with self.subTest(name):
                show = os.path.join(ROOT, f"shows/kang-{name}/show.yaml")
                self.assert_judged_well(show, people)
                footlight("dryrun", show, "--plan", self.path("show.plan"))

    def test_a_crossing_of_son_2024_is_planned_judged_and_played(self):
        for name, people in (("circle-rectangle", 750), ("birds", 1170)) if FULL else (("circle-rectangle", 750),):
            with self.subTest(name):
                show = os.path.join(ROOT, f"shows/son-{name}/show.yaml")
                self.assert_judged_well(show, people)
                footlight("dryrun", show, "--plan", self.path("show.plan"))

    def test_transforms_of_xu_2015_are_planned_judged_and_played(self):
        for show in sorted(glob.glob(os.path.join(ROOT, "shows/xu-*/show.yaml"))):
            with self.subTest(os.path.basename(os.path.dirname(show))):
                with open(show) as f:
                    people = int(re.search(r"^  count: (\d+)$", f.read(), re.M)[1])
                self.assert_judged_well(show, people)
                footlight("dryrun", show, "--plan", self.path("show.plan"))

    def test_vine_over_cells_is_judged_well_and_lights_its_markers(self):
        shutil.copytree(os.path.join(ROOT, "shows/vine"), self.path("vine"), ignore=shutil.ignore_patterns("*.plan", "*.stages"))
        show = self.path("vine", "show.yaml")
        with open(show) as f:
            text = f.read()
        with open(show, "w") as f:
            f.write(text.replace("\ntitle:", "\nwalk: cells\ntitle:", 1))
        measured = self.assert_judged_well(show, 900)
        self.assertAlmostEqual(measured["min_clearance_m"], 0.5 ** 0.5, places=6)
        self.assertEqual(measured["lag_tolerated_by"], measured["transitions"])
        with open(self.path("csv", "marks.csv"), newline="") as f:
            marks = list(csv.DictReader(f))
        for before, after in zip(marks, marks[1:]):
            if before["performer"] == after["performer"]:
                steps = abs(int(before["col"]) - int(after["col"])) + abs(int(before["row"]) - int(after["row"]))
                self.assertLessEqual(steps, 1, f"{before} {after}")
                self.assertTrue(steps == 0 or float(after["count"]).is_integer(), after)
        report = json.loads(footlight("dryrun", show, "--plan", self.path("show.plan"), "--json")[0])
        self.assertEqual(report["wrong_final"], 0, report)

    def test_every_mode_is_judged_as_it_measures_itself(self):
        """One film, planned in each mode: the figures of both judges are those of `measure`, which puts the modes side by side."""
        film = os.path.join(ROOT, "shows/vine/vine_flower_growing.mp4")
        shows = []
        for model in ("flat, cost: euclidean", "flat", "hierarchical", "joint"):
            show = self.path(f"{len(shows)}.yaml")
            with open(show, "w") as f:
                f.write("footlight: 1\ntitle: Mode\nstage:\n  grid: {kind: square, columns: 40, rows: 24, pitch: 1 m}\n"
                        "  reserve: [A1:F24, AI1:AN24]\n  clearance: 0.5 m\n  max_speed: 1.4 m/s\nperformers: {count: 150}\n"
                        "music: {tempo: 120}\nsections:\n"
                        f"  - {{name: film, from: {{video: {film}}}, start: count 1, duration: 80 counts, planner: {{model: {model}}}}}\n")
            shows.append(show)
            measured = self.assert_judged_well(show, 150)
            self.assertEqual(measured["too_close"], 0, model)
        together = json.loads(footlight("measure", *shows, "--json")[0])["plans"]
        self.assertEqual([os.path.basename(p["file"]) for p in together], ["0.yaml", "1.yaml", "2.yaml", "3.yaml"])
        for plan in together:
            self.assertTrue(plan["valid"])
            self.assertGreater(plan["planning_s"], 0)

    def test_an_interrupted_planning_ends_at_once_and_writes_nothing(self):
        show = os.path.join(ROOT, "shows/ceremony/show.yaml")
        for stage in ("decoding", "formations", "pairing"):
            running = subprocess.Popen([PROGRAM, "plan", show, "-o", self.path("show.plan"), "--progress"], stdout=subprocess.PIPE,
                                       stderr=subprocess.PIPE, text=True, stdin=subprocess.DEVNULL)
            for line in running.stderr:
                if line.startswith(stage):
                    break
            running.send_signal(signal.SIGINT)
            # The promise is 0.1 s; a busy machine may take its time, a planning to its end would take longer.
            out, err = running.communicate(timeout=60)
            self.assertEqual(running.returncode, 130, err)
            self.assertEqual(out, "")
            self.assertRegex(err, r"error: interrupted(; nothing was written| while decoding '.*')\n$")
            self.assertNotIn("validate", err)
            self.assertEqual(os.listdir(self.folder), [])

    def test_ceremony_is_planned_and_judged_well(self):
        self.assert_judged_well(os.path.join(ROOT, "shows/ceremony/show.yaml"), 3290)

    def assert_dry_run(self, show, *options):
        report = json.loads(footlight("dryrun", show, "--plan", self.plan(show), "--json", *options)[0])
        self.assertEqual(report["wrong_final"], 0, report)
        self.assertGreater(report["deliveries"], 0)
        self.assertEqual({"serial", "modbus-rtu", "can"}, {b["kind"] for b in report["buses"]})
        for bus in report["buses"]:
            self.assertGreater(bus["deliveries"], 0, bus)
            self.assertLess(bus["utilisation"], 1.0, bus)
        return report

    def plan(self, show):
        plan = self.path(hashlib.sha256(show.encode()).hexdigest()[:8] + ".plan")
        if not os.path.exists(plan):
            footlight("plan", show, "-o", plan)
        return plan

    def test_ceremony_lights_every_marker_rightly_on_all_three_kinds_of_bus(self):
        show = os.path.join(ROOT, "shows/ceremony/show.yaml")
        clean = self.assert_dry_run(show)
        self.assertGreaterEqual(clean["right_share"], 0.999)
        self.assertEqual(clean["retries"], 0)
        faulty = self.assert_dry_run(show, "--faults", "loss=5%,reboot=2", "--seed", "7")
        self.assertGreater(faulty["retries"], 0)

    def test_the_same_seed_gives_the_same_trace_byte_for_byte(self):
        for show, seeds in (("shows/vine/show.yaml", (3, 3, 4)), ("shows/ceremony/show.yaml", (1, 1))):
            show = os.path.join(ROOT, show)
            digests = []
            for i, seed in enumerate(seeds):
                trace = self.path(f"trace{i}")
                footlight("dryrun", show, "--plan", self.plan(show), "--faults", "loss=5%,reboot=2", "--seed", seed, "--trace", trace)
                with open(trace, "rb") as f:
                    digests.append(hashlib.file_digest(f, "sha256").hexdigest())
                os.remove(trace)
            self.assertEqual(digests[0], digests[1])
            if len(digests) > 2:
                self.assertNotEqual(digests[0], digests[2])

    def test_a_new_show_checks_plans_and_dry_runs_as_it_is(self):
        footlight("new", "my-show", cwd=self.folder)
        show = self.path("my-show", "show.yaml")
        footlight("check", show)
        footlight("plan", show)
        report = json.loads(footlight("dryrun", show, "--json")[0])
        self.assertEqual(report["wrong_final"], 0)

    def test_a_plan_is_the_same_for_any_number_of_threads(self):
        exports = []
        for threads in (1, 2, 8):
            footlight("plan", os.path.join(ROOT, "shows/vine/show.yaml"), "--threads", threads, "-o", self.path("t.plan"))
            footlight("export", os.path.join(ROOT, "shows/vine/show.yaml"), "--plan", self.path("t.plan"), "--csv", self.path(f"csv{threads}"))
            with open(self.path(f"csv{threads}", "marks.csv"), "rb") as f:
                exports.append(f.read())
        self.assertEqual(exports[0], exports[1])
        self.assertEqual(exports[0], exports[2])


# name, people, columns, rows, wings, counts; videos that no example show uses
OTHERS = [
    ("fluent-emoji-anim/walking_512_24fps.mp4", 330, 60, 44, 8, 240),
    ("derived-morphs/he_three_scripts_morph_640x480_25fps.mp4", 1000, 110, 76, 14, 400),
    ("oneko-1bit/oneko_story_640x320_8fps.mp4", 200, 64, 34, 6, 300),
    ("fluent-emoji-anim/parade_hardcut_640x480_24fps.mp4", 330, 60, 44, 8, 600),
]
MORE = [
    ("svg-smil-anim/linemd_sun-rising-filled-loop_480_25fps.mp4", 500, 66, 48, 10, 400),
    ("svg-smil-anim/weather_fill_snow_480_25fps.mp4", 400, 60, 48, 8, 240),
    ("derived-morphs/flubber_tree_umbrella_guitar_plane_640x480_25fps.mp4", 1000, 110, 76, 12, 600),
    ("fluent-emoji-anim/bike_512_24fps.mp4", 600, 70, 58, 8, 300),
    ("fluent-emoji-anim/eagle_512_24fps.mp4", 600, 70, 58, 8, 300),
]


class Pictures(Case):
    """An image of a disc whose edges are grey, and its negative."""

    def planned(self, name, pixel, options=""):
        with open(self.path(f"{name}.pgm"), "wb") as f:
            f.write(b"P5 120 90 255\n" + bytes(pixel(x, y) for y in range(90) for x in range(120)))
        with open(self.path(f"{name}.yaml"), "w") as f:
            f.write("footlight: 1\ntitle: Disc\nstage: {grid: {kind: square, columns: 24, rows: 18, pitch: 1 m}}\n"
                    "performers: {count: 90}\nsections:\n"
                    f"  - {{name: disc, from: {{image: {name}.pgm{options}}}, start: count 1, hold: 8 counts}}\n")
        footlight("plan", self.path(f"{name}.yaml"), "-o", self.path(f"{name}.plan"))
        footlight("export", self.path(f"{name}.yaml"), "--plan", self.path(f"{name}.plan"), "--csv", self.path(name))
        with open(self.path(name, "formations.csv")) as f:
            return sorted(line.rstrip().split(",")[5:] for line in f.readlines()[1:])

    def test_a_negative_with_invert_is_planned_as_the_picture(self):
        def grey(x, y):  # from 230 to 20 over 20 pixels
            return round(min(230, max(20, 125 - 10.5 * (((x - 60) ** 2 + (y - 45) ** 2) ** 0.5 - 28))))
        drawn = self.planned("grey", grey, ", threshold: 125")
        self.assertEqual(len(drawn), 90)
        self.assertEqual(drawn, self.planned("negative", lambda x, y: 250 - grey(x, y), ", threshold: 124, invert: true"))
        self.assertEqual(drawn, self.planned("hard", lambda x, y: 255 if grey(x, y) > 125 else 0))
        # Otsu cuts grey edges somewhere between dark and bright: the same disc, hardly larger or smaller.
        otsu = self.planned("otsu", grey)
        self.assertGreater(len([cell for cell in otsu if cell in drawn]), 80)


class OtherVideos(Case):
    def judge_video(self, video, people, columns, rows, wings, counts, kind="square"):
        source = os.path.join(SHARED, "media", video)
        if not os.path.exists(source):
            self.skipTest(f"{source} is not here; set FOOTLIGHT_SHARED")
        shutil.copy(source, self.path("film.mp4"))
        name = lambda c: (chr(64 + c // 26) if c >= 26 else "") + chr(65 + c % 26)
        with open(self.path("show.yaml"), "w") as f:
            f.write(f"""footlight: 1
title: {os.path.basename(video)}
stage:
  grid: {{kind: {kind}, columns: {columns}, rows: {rows}, pitch: 1 m}}
  reserve: [A1:{name(wings - 1)}{rows}, {name(columns - wings)}1:{name(columns - 1)}{rows}]
performers: {{count: {people}}}
music: {{tempo: 120, meter: 4/4}}
sections:
  - {{name: film, from: {{video: film.mp4}}, start: count 1, duration: {counts} counts}}
cues:
  - {{number: "1", section: film}}
""")
        self.assert_judged_well(self.path("show.yaml"), people)


def add_video_tests():
    for entry in OTHERS + (MORE if FULL else []):
        stem = os.path.basename(entry[0]).split(".")[0].replace("-", "_")
        setattr(OtherVideos, f"test_{stem}_is_judged_well", lambda self, e=entry: self.judge_video(*e))
    for kind in ("hexagonal", "triangular"):
        setattr(OtherVideos, f"test_a_{kind}_floor_is_judged_well",
                lambda self, k=kind: self.judge_video("fluent-emoji-anim/heart_512_24fps.mp4", 250, 60, 40, 10, 240, k))


def main():
    global PROGRAM
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", default=PROGRAM)
    parser.add_argument("--json")
    parser.add_argument("names", nargs="*")
    arguments = parser.parse_args()
    PROGRAM = os.path.abspath(arguments.program)
    add_video_tests()
    loader = unittest.TestLoader()
    suite = loader.loadTestsFromNames(arguments.names, sys.modules["__main__"]) if arguments.names else loader.loadTestsFromModule(sys.modules["__main__"])
    result = unittest.TextTestRunner(verbosity=2).run(suite)
    failed = len(result.failures) + len(result.errors)
    if arguments.json:
        with open(arguments.json, "w") as f:
            json.dump({"passed": result.testsRun - failed - len(result.skipped), "failed": failed, "skipped": len(result.skipped),
                       "problems": [f"e2e: {t}" for t, _ in result.failures + result.errors] + [f"skipped {t}: {why}" for t, why in result.skipped]}, f)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
