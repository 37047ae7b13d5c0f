# SPDX-License-Identifier: Apache-2.0
"""Shows for the experiments of Li 2020 on real films, and what the program says about them. Every run is kept."""
import csv
import hashlib
import json
import math
import os
import pathlib
import re
import subprocess
import time

import cv2
import numpy

ROOT = pathlib.Path(__file__).resolve().parents[2]
SHARED = pathlib.Path(os.environ.get("FOOTLIGHT_SHARED", ROOT / ".." / "shared")).resolve()
PROGRAM = ROOT / "build/release/footlight"
THRESHOLD = 127
FPS = 25  # the paper counts c in frames of the show
FILMS = {
    "vine": ROOT / "shows/vine/vine_flower_growing.mp4",
    "animals": SHARED / "media/derived-morphs/flubber_fish_crow_frog_hippo_640x480_25fps.mp4",
    "things": SHARED / "media/derived-morphs/flubber_tree_umbrella_guitar_plane_640x480_25fps.mp4",
    "scripts": SHARED / "media/derived-morphs/he_three_scripts_morph_640x480_25fps.mp4",
    "eagle": SHARED / "media/fluent-emoji-anim/eagle_512_24fps.mp4",
    "parade": SHARED / "media/fluent-emoji-anim/parade_hardcut_640x480_24fps.mp4",
}
PIECE = ("vine", "animals", "things", "scripts", "eagle", "parade")  # one after the other
MODELS = {"flat": "{model: flat, cost: euclidean}",
          "two layers": "{model: hierarchical, layers: 2, cost: euclidean}",
          "three layers": "{model: hierarchical, layers: 3, cost: euclidean}"}
WALKING, FREE = 1.4, 20  # m/s: a brisk walk; more than anybody here has to walk, as in the paper, which has no limit


def frames_of(path):
    """The pictures of a film, each an array of 0 and 1."""
    film = cv2.VideoCapture(str(path))
    while True:
        good, image = film.read()
        if not good:
            return
        yield (cv2.cvtColor(image, cv2.COLOR_BGR2GRAY) > THRESHOLD).astype(numpy.uint8)


class Runs:
    """Runs the program once for each different question; answers are kept in a folder beside the build."""

    def __init__(self, folder):
        self.folder = folder
        self.folder.mkdir(parents=True, exist_ok=True)
        self.program = hashlib.sha256(PROGRAM.read_bytes()).hexdigest()[:16]

    def kept(self, question, answer):
        """@param answer  a function that finds what is to be kept as JSON"""
        path = self.folder / (hashlib.sha256(question.encode()).hexdigest()[:24] + ".json")
        if not path.exists():
            found = json.dumps(answer())
            path.with_suffix(".new").write_text(found)
            path.with_suffix(".new").rename(path)
        return json.loads(path.read_text())

    def shape(self, name):
        """Extent of a film's picture, pixels, and the picture area of its fullest and emptiest frame."""
        def look():
            areas, box = [], [1 << 30, 1 << 30, 0, 0]
            for frame in frames_of(FILMS[name]):
                areas.append(int(frame.sum()))
                ys, xs = frame.nonzero()
                if len(xs):
                    box = [min(box[0], int(xs.min())), min(box[1], int(ys.min())), max(box[2], int(xs.max()) + 1), max(box[3], int(ys.max()) + 1)]
            return {"width": box[2] - box[0], "height": box[3] - box[1], "most": max(areas), "least": min(areas), "frames": len(areas)}
        return self.kept(f"shape {name} {FILMS[name].stat().st_size}", look)

    def show(self, names, people, seconds, planner, *, interval=80, hash_share=0.1, speed=WALKING):
        """A show of films one after the other, each with the same share of the seconds.

        The floor holds the pictures so large that the fullest frame gives everybody a cell; who has no room in an
        emptier one waits in the wings. @param interval  c, frames of the show
        """
        width = height = 0
        waiting = 0
        for name in names:
            shape = self.shape(name)
            pixels_a_metre = math.sqrt(shape["most"] / people)
            width = max(width, math.ceil(shape["width"] / pixels_a_metre) + 3)
            height = max(height, math.ceil(shape["height"] / pixels_a_metre) + 3)
            waiting = max(waiting, people * (1 - shape["least"] / shape["most"]))
        wing = math.ceil(1.1 * waiting / 2 / height) + 1
        lines = ["footlight: 1", "title: Li 2020", "stage:",
                 f"  grid: {{kind: square, columns: {width + 2 * wing}, rows: {height}, pitch: 1 m}}",
                 f"  reserve: [A1:{column(wing - 1)}{height}, {column(wing + width)}1:{column(2 * wing + width - 1)}{height}]",
                 f"  clearance: 0.5 m\n  max_speed: {speed} m/s", f"performers: {{count: {people}}}",
                 "music: {tempo: 120, meter: 4/4}", "sections:"]
        start = 1
        for name in names:
            counts = 2 * seconds / len(names)
            lines.append(f"  - {{name: {name}, from: {{video: {FILMS[name]}, threshold: {THRESHOLD}}}, start: count {start:g}, duration: {counts:g} counts,\n"
                         f"     sampling: {{interval: {interval / FPS:g} s, hash: {hash_share:g}, snap: none}}, planner: {planner}}}")
            start += counts + (8 if speed == FREE else 2 * math.ceil(2 * (width + 2 * wing) / speed))
        return "\n".join(lines) + "\n"

    def call(self, text, command, *arguments):
        """Runs the program on a show. @return (stdout, seconds of processor time of it and of its decoder, its own peak memory in kB)"""
        show = self.folder / f"{os.getpid()}.yaml"
        show.write_text(text)
        with (self.folder / f"{os.getpid()}.out").open("w+") as out, (self.folder / f"{os.getpid()}.err").open("w+") as err:
            child = subprocess.Popen(["nice", "-n", "5", PROGRAM, command, show, *arguments], stdout=out, stderr=err)
            peak_kb = 0
            while True:
                pid, status, usage = os.wait4(child.pid, os.WNOHANG)
                if pid:
                    break
                # wait4's peak is the larger one of program and decoder.
                found = re.search(r"VmHWM:\s+(\d+)", pathlib.Path(f"/proc/{child.pid}/status").read_text())
                peak_kb = int(found[1]) if found else peak_kb
                time.sleep(0.01)
            child.returncode = os.waitstatus_to_exitcode(status)
            out.seek(0), err.seek(0)
            if child.returncode != 0:
                raise SystemExit(f"footlight {command}: exit {child.returncode}\n{err.read()}\n{text}")
            return out.read(), usage.ru_utime + usage.ru_stime, peak_kb

    def measure(self, text):
        def ask():
            out, _, _ = self.call(text, "measure", "--json")
            return json.loads(out)
        return self.kept(f"measure {self.program} {text}", ask)

    def cost(self, text):
        """Processor time, s, of planning on one thread, and the number of formations."""
        def ask():
            plan = str(self.folder / f"{os.getpid()}-cost.plan")
            out, cpu_s, _ = self.call(text, "plan", "--json", "--threads", "1", "-o", plan)
            return {"cpu_s": cpu_s, "formations": json.loads(out)["formations"]}
        return self.kept(f"cost {self.program} {text}", ask)

    def memory(self, text):
        """Peak memory of planning, kB, the decoder's left out."""
        plan = str(self.folder / f"{os.getpid()}-cost.plan")
        return self.kept(f"memory {self.program} {text}", lambda: self.call(text, "plan", "--quiet", "--threads", "1", "-o", plan)[2])

    def export(self, text):
        """Folder with stage.json and marks.csv of the show's plan."""
        folder = self.folder / ("export-" + hashlib.sha256(f"{self.program} {text}".encode()).hexdigest()[:24])
        if not (folder / "stage.json").exists():
            self.call(text, "export", "--csv", str(folder))
        return folder

    def frames(self, text):
        """theta_dev of each frame of each section, [[seconds since the show's begin, theta_dev], ...], by Eq. 8 anew: the
        program itself tells means only."""
        return self.kept(f"frames {self.program} {text}", lambda: theta_frames(self.export(text)))

    def outside(self, text, name):
        """What the independent judge says about one section; nothing where it is not here."""
        judge = SHARED / "check/theta_dev.py"
        if not judge.exists():
            return None
        def ask():
            done = subprocess.run(["/usr/bin/python3", judge, self.export(text), FILMS[name], "--section", name, "--json"],
                                  capture_output=True, text=True, check=True)
            return json.loads(done.stdout)
        return self.kept(f"outside {self.program} {name} {text}", ask)


def column(number):
    """The letters of a column, as in a spreadsheet."""
    letters = ""
    number += 1
    while number:
        number, rest = divmod(number - 1, 26)
        letters = chr(65 + rest) + letters
    return letters


class Marks:
    """Where everybody is when, from an export."""

    def __init__(self, folder):
        self.stage = json.loads((folder / "stage.json").read_text())
        tracks = {}
        with (folder / "marks.csv").open(newline="") as file:
            for row in csv.DictReader(file):
                tracks.setdefault(row["performer"], []).append(
                    (float(row["time_s"]), float(row["x_m"]), float(row["y_m"]), int(row["col"]), int(row["row"])))
        self.tracks = [numpy.array(track) for track in tracks.values()]

    def places(self, section, time_s):
        """Metres, of those who are not waiting: not on a reserve cell at both ends of the stretch."""
        reserve = {tuple(cell) for cell in section.get("reserve", [])}
        out = []
        for track in self.tracks:
            k = int(numpy.clip(numpy.searchsorted(track[:, 0], time_s, "right") - 1, 0, len(track) - 1))
            here, there = track[k], track[min(k + 1, len(track) - 1)]
            if (int(here[3]), int(here[4])) in reserve and (int(there[3]), int(there[4])) in reserve:
                continue
            part = 0 if there[0] <= here[0] else min(1.0, max(0.0, (time_s - here[0]) / (there[0] - here[0])))
            out.append(here[1:3] + part * (there[1:3] - here[1:3]))
        return numpy.array(out).reshape(-1, 2)


def shares(picture, section, cell_area_m2, places):
    """rho_fit of people at some places: the share of picture in a square of one cell's area around each."""
    to_frame = numpy.array(section["stage_to_frame"], float)
    side = math.sqrt(cell_area_m2 * abs(numpy.linalg.det(to_frame[:, :2])))
    middle = places @ to_frame[:, :2].T + to_frame[:, 2]
    height, width = picture.shape
    sums = cv2.integral(picture, sdepth=cv2.CV_64F)

    def sum_to(x, y):
        x, y = x.clip(0, width), y.clip(0, height)
        i, j = numpy.minimum(x.astype(int), width - 1), numpy.minimum(y.astype(int), height - 1)
        u, v = x - i, y - j
        return sums[j, i] * (1 - u) * (1 - v) + sums[j, i + 1] * u * (1 - v) + sums[j + 1, i] * (1 - u) * v + sums[j + 1, i + 1] * u * v

    low, high = middle - side / 2, middle + side / 2
    area = sum_to(high[:, 0], high[:, 1]) - sum_to(low[:, 0], high[:, 1]) - sum_to(high[:, 0], low[:, 1]) + sum_to(low[:, 0], low[:, 1])
    return (area / side ** 2).clip(0, 1)


def theta_frames(folder):
    marks = Marks(folder)
    cell_area_m2 = float(marks.stage["grid"]["cell_area_m2"])
    out = []
    for section in marks.stage["sections"]:
        for number, image in enumerate(frames_of(FILMS[section["name"]])):
            time_s = section["start_s"] + (number - section["frame0"]) / section["fps"]
            places = marks.places(section, time_s)
            if len(places) and time_s <= section["end_s"] + 1e-9:
                out.append([time_s, float(1 - shares(image, section, cell_area_m2, places).mean())])
    return out
