"""A small show on simulated markers with real endpoints: what the tests of live.py, devices.py and ola.py begin with."""
import json
import os
import signal
import subprocess
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))

SHOW = """footlight: 1
title: Twelve
stage:
  grid: {kind: square, columns: 12, rows: 8, pitch: 1 m}
  clearance: 0.5 m
  max_speed: 4 m/s
performers:
  count: 12
  groups:
    - {name: left, members: 1-6, colour: "#FF69B4"}
    - {name: right, members: 7-12, colour: "#00A0FF"}
music: {tempo: 240, meter: 4/4}
sections:
  - {name: line, from: {cells: line.csv}, start: count 1, hold: 2 counts}
  - {name: ring, from: {cells: ring.csv}, start: count 13, hold: 2 counts}
  - {name: arrow, from: {cells: arrow.csv}, start: count 25, hold: 2 counts}
cues:
  - {number: "1", section: line, name: Opening line}
  - {number: "2", section: ring, name: Ring, continue: auto-follow}
  - {number: "3", section: arrow, name: Arrow}
announce: 2 counts
rig: rig.yaml
"""

BUSES = {"left": "{name: left, kind: serial, url: 'serial:///dev/nowhere'}",
         "middle": "{name: middle, kind: modbus-rtu, url: 'rtu:///dev/nowhere', bits_per_second: 115200}",
         "right": "{name: right, kind: modbus-tcp, url: 'tcp://192.0.2.7:502'}"}


def wait_for(what, told, seconds=20):
    """Polls until `what` is true; a machine under load takes its time."""
    for _ in range(int(seconds * 50)):
        value = what()
        if value:
            return value
        time.sleep(0.02)
    raise AssertionError(f"waited {seconds} s for {told}")


def make_stage(Case, footlight, program):
    """What test cases derive from, over run.py's own `Case` and `footlight`; `program` gives the path of the program."""

    class Stage(Case):
        def setUp(self):
            super().setUp()
            old = os.environ.get("XDG_STATE_HOME")
            os.environ["XDG_STATE_HOME"] = self.path("state")
            self.addCleanup(lambda: os.environ.pop("XDG_STATE_HOME") if old is None else os.environ.update(XDG_STATE_HOME=old))

        def make_show(self, buses=("left", "middle", "right"), show=SHOW, profile=""):
            """The twelve people of `footlight new` on a rig of these buses, in six seconds."""
            footlight("new", self.path("s"))
            self.show = self.path("s", "show.yaml")
            with open(self.show, "w") as f:
                f.write(show)
            with open(self.path("s", "rig.yaml"), "w") as f:
                f.write("rig: 1\nbuses:\n" + "".join(f"  - {BUSES[b] if not profile else BUSES[b][:-1] + ', profile: ' + profile + '}'}\n" for b in buses) +
                        f"floor: {{buses: [{', '.join(buses)}], channels_per_node: 8}}\n")
            return self.show

        def start(self, *command, **options):
            process = subprocess.Popen(list(map(str, command)), stdin=subprocess.DEVNULL, text=True, **options)
            self.addCleanup(lambda: (process.poll() is None and process.kill(), process.wait()))
            return process

        def serve(self, *options):
            """Starts `footlight sim`; its lines go into a file. Returns the URL of each bus."""
            self.ports = self.path("ports")
            self.map = self.path("map.yaml")
            self.lines = self.path("sim.jsonl")
            self.sim = self.start(program(), "sim", self.show, "--json", "--dir", self.ports, "--write-map", self.map, *options,
                                  stdout=open(self.lines, "w"), stderr=subprocess.DEVNULL)
            wait_for(lambda: os.path.exists(self.lines) and open(self.lines).read().endswith("\n") and os.path.exists(self.map), "footlight sim")
            with open(self.lines) as f:
                return {b["bus"]: b["url"] for b in json.loads(f.readline())["serving"]}

        def end_of_sim(self):
            """What every lamp shows when the simulation is told to end: {node: {channel: look}}."""
            self.sim.send_signal(signal.SIGINT)
            self.assertEqual(self.sim.wait(20), 0)
            with open(self.lines) as f:
                last = json.loads(f.readlines()[-1])
            self.assertEqual(os.listdir(self.ports), [], "the links are gone")
            return {n["node"]: {int(c): look for c, look in n["looks"].items()} for n in last["floor"]}

        def changes(self):
            with open(self.lines) as f:
                return [line for line in map(json.loads, f.read().splitlines()) if "look" in line]

        def play(self, *options, status=0):
            return json.loads(footlight("run", self.show, "--transport-map", self.map, "--go", "--json", *options, status=status)[0])

        def assert_floor(self, report, people=12):
            """What the markers show, by their own word, is what the schedule says."""
            shown = self.end_of_sim()
            planned = {n["node"]: n["looks"] for n in report["floor"]}
            self.assertEqual(set(shown), set(planned))
            wrong = [(node, channel, look, planned[node][channel]) for node, looks in shown.items() for channel, look in looks.items() if look != planned[node][channel]]
            self.assertEqual(wrong, [])
            self.assertGreaterEqual(sum(look not in (0, 255) for looks in shown.values() for look in looks.values()), people, "so many people stand somewhere")

        def bad_line(self, bus, url, share):
            """socat between run and sim. Returns what starts it."""
            link = self.path(f"bad-{bus}")
            good = url.split("://")[1]
            with open(self.map) as f:
                text = f.read()
            with open(self.map, "w") as f:
                f.write(text.replace(good, link))

            def plug():
                process = self.start("socat", f"PTY,link={link},rawer", f"SYSTEM:{sys.executable} {HERE}/bad_line.py {good} {share}", stderr=subprocess.DEVNULL)
                wait_for(lambda: os.path.exists(link), "socat")
                return process

            return plug

    return Stage
