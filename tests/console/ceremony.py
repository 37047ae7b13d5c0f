"""shows/ceremony as a stage manager rehearses it in one sitting, with a picture of everything: 3,290 people, 12,960 lamps on eighteen buses. Part of run.py.

The real program, `footlight sim` as markers on real ports, Chromium. Its CAN buses are others here, so that every machine can run it.
Real time on real ports wants a machine that does little else: FOOTLIGHT_CEREMONY=quarter rehearses with a quarter of the people and lamps on six buses and ends in the finale,
FOOTLIGHT_CEREMONY=whole with all of them, to the end of the show."""
import glob
import json
import os
import shutil
import socket
import subprocess
import threading
import time
import unittest

from page import Page
from rehearsal import Run
from stage import wait_for

HERE = os.path.dirname(os.path.abspath(__file__))
CEREMONY = os.path.join(os.path.dirname(os.path.dirname(HERE)), "shows", "ceremony")
PATIENCE_S = 120  # of a machine that does other things, too

CHOSEN = os.environ.get("FOOTLIGHT_CEREMONY")
FULL = CHOSEN == "whole"
KINDS = {"tcp": ("modbus-tcp", "tcp://192.0.2.{}:502"), "rtu": ("modbus-rtu", "rtu:///dev/nowhere-{}"), "serial": ("serial", "serial:///dev/nowhere-{}")}
# Buses, nodes, three corners.
WHOLE = {"buses": {"tcp": 3, "rtu": 4, "serial": 11}, "nodes": 405, "corners": ("A1", "EN1", "EN90")}
QUARTER = {"buses": {"tcp": 2, "rtu": 2, "serial": 2}, "nodes": 102, "corners": ("A1", "BT1", "BT45")}
SIZE = WHOLE if FULL else QUARTER
TO_A_QUARTER = {"columns: 144, rows: 90, pitch: 1 m": "columns: 72, rows: 45, pitch: 2 m", "[A1:N90, EA1:EN90]": "[A1:G45, BN1:BT45]", "count: 3290": "count: 822",
                "members: 1-1100,": "members: 1-275,", "members: 1101-2200": "members: 276-550", "members: 2201-3290": "members: 551-822"}


def rig():
    buses = [(f"{kind}-{i}", *KINDS[kind], i) for kind, many in SIZE["buses"].items() for i in range(1, many + 1)]
    text = "rig: 1\nbuses:\n"
    for name, kind, url, i in buses:
        text += f"  - {{name: {name}, kind: {kind}, url: '{url.format(i)}'" + ("}\n" if kind == "modbus-tcp" else ", bits_per_second: 115200}\n")
    return text + f"floor: {{buses: [{', '.join(bus[0] for bus in buses)}], channels_per_node: 32}}\n"


class Gateway:
    """A Modbus TCP gateway's cable. Nodes whose unit is in `dead` get nothing and say nothing."""

    def __init__(self, target):
        self.target, self.dead = target, set()
        self.server = socket.create_server(("127.0.0.1", 0))
        self.port = self.server.getsockname()[1]
        threading.Thread(target=self.serve, daemon=True).start()

    def serve(self):
        while True:
            try:
                client = self.server.accept()[0]
                markers = socket.create_connection(self.target)
            except OSError:
                return
            for one, other, asks in ((client, markers, True), (markers, client, False)):
                threading.Thread(target=self.carry, args=(one, other, asks), daemon=True).start()

    def carry(self, source, sink, asks):
        """Frame by frame: seven bytes of head, of which the fifth and sixth say how many follow the sixth."""
        held = b""
        try:
            while more := source.recv(65536):
                held += more
                while len(held) >= 7 and len(held) >= (size := 6 + int.from_bytes(held[4:6], "big")):
                    frame, held = held[:size], held[size:]
                    if frame[6] not in self.dead:
                        sink.sendall(frame)
        except OSError:
            pass
        for end in (source, sink):
            end.close()

    def close(self):
        self.server.close()


def make_cases(Stage, footlight, program, pictures, figures):
    @unittest.skipUnless(CHOSEN, "minutes in real time: FOOTLIGHT_CEREMONY=quarter or whole")
    class Ceremony(Stage):
        def setUp(self):
            super().setUp()
            self.began, self.told = time.monotonic(), []

        def shot(self, name):
            """A picture, numbered in the order of the rehearsal."""
            self.told.append((round(time.monotonic() - self.began, 1), name))
            self.page.picture(f"ceremony-{len(self.told):02d}-{name}")

        def make_show(self):
            """The show as it is, with somebody who knows the way of 3, on a rig with real ports."""
            shutil.copytree(CEREMONY, self.path("s"))
            self.show = self.path("s", "show.yaml")
            with open(self.path("s", "rig.yaml"), "w") as f:
                f.write(rig())
            if not FULL:
                for whole, quarter in TO_A_QUARTER.items():
                    self.edit(whole, quarter)
            self.edit("\n  groups:\n", "\n  understudies: [{id: zoe, name: Zoe, covers: [3]}]\n  groups:\n")
            self.edit("name: Heartbeat,", "name: Heartbeat, notes: \"Dawn leaves first. Smile.\",")
            footlight("plan", self.show)

        def edit(self, old, new):
            with open(self.show) as f:
                text = f.read()
            self.assertEqual(text.count(old), 1, old)
            with open(self.show + ".new", "w") as f:
                f.write(text.replace(old, new))
            os.replace(self.show + ".new", self.show)

        def begin(self):
            """Markers, cables, program, page."""
            self.make_show()
            urls = self.serve()
            host, port = urls["tcp-2"].split("://")[1].split(":")
            self.gateway = Gateway((host, int(port)))
            self.addCleanup(self.gateway.close)
            with open(self.map) as f:
                text = f.read()
            with open(self.map, "w") as f:
                f.write(text.replace(urls["tcp-2"].split("://")[1], f"127.0.0.1:{self.gateway.port}"))
            self.plug = self.bad_line("serial-2", urls["serial-2"], 0)
            self.cable = self.plug()
            self.run_ = Run(self, program(), "--scope", "live", "--state", self.path("state-of-run"), patience_s=PATIENCE_S, until_ready=False)
            self.page = Page(self.run_.url, pictures())
            self.addCleanup(self.page.close)
            self.page.until_text("title", "Ceremony")
            self.page.until("document.querySelectorAll('#cues li').length === 6", "the cue list")

        def say(self, order, answer, seconds=PATIENCE_S):
            """An order as typed, and what the log says came of it."""
            known = len(self.run_.answers())
            self.page.order(order)
            wait_for(lambda: any(one[0] == order for one in self.run_.answers()[known:]), f"an answer to {order}", seconds)
            told = [line["answer"] for line in self.run_.lines if "answer" in line][known:]
            text = next(one for one in told if one["order"] == order)
            self.assertRegex(text["text"], answer)
            return text

        def until(self, told, **wanted):
            wait_for(lambda: all(self.run_.state.get(key) == value for key, value in wanted.items()), f"{told}: {wanted}, not {self.run_.state}", PATIENCE_S)

        def until_count(self, count):
            wait_for(lambda: self.run_.state.get("count", 0) >= count, f"count {count}", PATIENCE_S)

        def go(self, phase="Runs"):
            time.sleep(0.5)  # the GO guard
            self.page.key(" ")
            self.page.until_text("phase", phase, PATIENCE_S)

        def fits(self):
            """Nothing of the desk is pushed out of the window, cut off or laid over something else."""
            page = self.page
            self.assertTrue(page.value("document.documentElement.scrollWidth <= innerWidth && document.documentElement.scrollHeight <= innerHeight"), "the page scrolls")
            cut = page.value("""['phase','standby_number','standby_name','countdown','notice','go','hold','floor_words','count','timecode','tempo','title','freeze']
                .filter(id => { const e = document.getElementById(id); return e.offsetParent && e.scrollWidth > e.clientWidth + 1 && e.clientWidth > 0; })""")
            self.assertEqual(cut, [], "texts that are cut off")

        def test_the_ceremony_is_rehearsed(self):
            self.begin()
            for step in (self.readiness, self.from_standby_to_go, self.hold_at_once_and_go_on, self.hold_at_the_end, self.tempo, self.loop, self.jump_back,
                         self.somebody_is_absent, self.notes, self.edits, self.a_bus_is_unplugged, self.a_node_dies, self.looking_around, self.the_end):
                with self.subTest(step.__name__):
                    step()
            print("the rehearsal of the ceremony: " + ", ".join(f"{name} {at} s" for at, name in self.told))
            figures["ceremony_s"] = round(time.monotonic() - self.began, 1)

        def readiness(self):
            page = self.page
            page.until_text("stages", "roll-call: WAITING")
            self.shot("roll-call")
            page.click("take_seat")
            page.until_text("seat", "You lead")
            for probe, cell in enumerate(SIZE["corners"], 1):
                page.until_text("question_text", f"probe {probe} of 3: {cell} ", PATIENCE_S)
                if probe == 1:
                    page.key(" ")
                    page.until_text("refusal", "go refused: the show is not ready: nobody has confirmed the probe lamp at A1")
                if probe < 3:
                    self.shot(f"probe-{cell}")
                page.click("probe_yes")
            page.until_text("floor_words", f"All {SIZE['nodes']} nodes are confirmed right", PATIENCE_S)
            stages = page.text("stages")
            for stage in ("show", "plan", "buses", "roll-call", "plan-on-nodes", "probes", "looks", "time"):
                self.assertIn(stage, stages)
            page.until_text("scope", "GO is not armed")
            self.shot("ready-but-not-armed")
            # A node that is slow to answer on a busy machine bars GO, too.
            wait_for(lambda: (page.key(" "), time.sleep(1), "nobody has said arm" in page.text("refusal"))[-1], "the refusal", PATIENCE_S)
            self.shot("go-is-refused-until-armed")
            wait_for(lambda: (page.value("[...document.querySelectorAll('#stages button')].at(-1)?.click()"), time.sleep(1), "not armed" not in page.text("scope"))[-1], "armed", PATIENCE_S)

        def from_standby_to_go(self):
            page = self.page
            page.until_text("standby_number", "1")
            self.shot("standby")
            self.fits()
            self.go("Counts in")
            self.shot("counts-in")
            page.until_text("phase", "Runs")
            self.shot("dance")
            self.assertEqual(page.text("standby_number"), "2")

        def hold_at_once_and_go_on(self):
            page = self.page
            self.until_count(56)  # on the way to the heart
            self.shot("on-the-way")
            self.fits()
            page.key("Escape")
            page.until_text("phase", "HOLD")
            self.until("the hold", phase="stands", cue="2")
            self.shot("hold")
            self.fits()
            self.go("Counts in")
            self.shot("counts-in-again")
            page.until_text("phase", "Runs")

        def tempo(self):
            page = self.page
            page.key("-", times=4)
            page.until_text("tempo", "80 %")
            self.shot("slower")
            self.say("tempo 125", r"^at most \d+ %: ")
            most = int(page.until("/at most (\\d+) %/.exec(document.getElementById('most').textContent)?.[1]", "the cap"))
            self.assertLess(most, 125)
            page.until_text("tempo", f"{most} %")
            self.shot("as-fast-as-proved")
            self.say("tempo 100", "^")

        def hold_at_the_end(self):
            page = self.page
            page.key("e")
            page.until_text("notice", "HOLD at the end of the set")
            self.shot("will-hold-at-the-end")
            page.until_text("phase", "HOLD", PATIENCE_S)
            self.assertFalse(self.run_.state["holds_at_end"])
            self.shot("held-at-the-end")

        def loop(self):
            page = self.page
            self.say("loop section heartbeat", "^")
            page.until_text("notice", "loop ")
            self.say("loop off", "^")
            here = self.run_.state["count"]
            page.order(f"loop counts {round(here)} {round(here) + 6}")
            page.until_text("notice", "loop ")
            self.go("Runs")
            self.shot("loop")
            page.until_text("notice", "GO lights the reset move", PATIENCE_S)
            self.shot("the-loop-asks-for-the-way-back")
            self.go("Reset move")
            self.shot("way-back")
            self.until("the beginning of the loop", phase="stands")
            page.key("l")
            page.until("document.getElementById('loop').getAttribute('aria-pressed') === 'false'", "no loop")

        def jump_back(self):
            page = self.page
            self.go("Runs")
            page.key("e")
            page.until_text("phase", "HOLD", PATIENCE_S)
            self.say("jump count 105", "^")
            page.until("!document.getElementById('placed').hidden", "the jump")
            page.until_text("notice", "reset move", PATIENCE_S)
            self.shot("jump-back-waits")
            wait_for(lambda: self.run_.state["reset"]["state"] == "ready", "the way back", PATIENCE_S)
            self.go("Reset move")
            time.sleep(1)
            self.shot("jump-back-is-lit")
            self.until("the beginning of the heart", phase="stands")
            self.assertAlmostEqual(self.run_.state["count"], 105, delta=1)

        def somebody_is_absent(self):
            page = self.page
            page.key("/")
            page.type("3")
            page.key("Enter")
            page.until_text("person_name", "3")
            page.key("Escape")
            page.click("person_absent")
            page.until("document.querySelectorAll('#absent li').length === 1", "she is absent")
            page.key("0")
            self.shot("absent")
            self.say("cover 3", "^")
            self.until_edit("waits")
            page.until_text("edit_head", "Changed: ")
            self.shot("covered-by-zoe")
            page.click("take")
            page.until_text("absent", "covered by zoe", PATIENCE_S)
            self.say("absent 7", "7 is absent")
            began = time.monotonic()
            self.say("repair 7", "being planned")
            self.until_edit("waits")
            figures["repair_s"] = round(time.monotonic() - began, 2)
            self.shot("repair-waits")
            page.click("take")
            page.until("/\\b7\\s+repaired/.test(document.getElementById('absent').innerText)", "repaired", PATIENCE_S)
            self.until_stands()
            self.shot("repaired-and-to-be-told")
            page.click("person_close")

        def until_edit(self, state):
            wait_for(lambda: self.run_.state["edit"]["state"] == state, f"an edit that {state}, not {self.run_.state.get('edit')}", PATIENCE_S)

        def until_stands(self):
            """People who have to go elsewhere are led there."""
            page = self.page
            wait_for(lambda: self.run_.state["edit"]["state"] == "none", "the edit", PATIENCE_S)
            if self.run_.state["reset"]["state"] != "none" or self.run_.state["phase"] in ("resets", "reset-held"):
                self.go("Reset move")
                self.until("where they must be", phase="stands")
            page.until("document.getElementById('placed').hidden", "no reset move")

        def notes(self):
            page = self.page
            page.key("n")
            page.type("person 12 too late")
            self.shot("a-note-is-typed")
            page.key("Enter")
            page.key("n")
            page.type("group dawn smile")
            page.key("Enter")
            wait_for(lambda: [one[0] for one in self.run_.answers()].count("note group dawn smile") == 1, "the notes")
            page.click("tab_log")
            self.shot("log")
            page.click("tab_health")

        def edits(self):
            page = self.page
            self.edit("hold: 56 counts", "hold: 56 cuonts")
            page.until_text("edit_head", "THE CHANGED FILE IS WRONG", PATIENCE_S)
            self.assertRegex(page.text("edit_text"), r"show\.yaml:\d+:\d+: error: ")
            self.shot("edit-is-wrong")
            self.fits()
            self.edit("hold: 56 cuonts", "hold: 60 counts")
            page.until_text("edit_head", "Changed: ", PATIENCE_S)
            self.shot("edit-waits")
            page.click("take")
            self.until_edit("none")
            self.until_stands()
            self.shot("edit-is-taken")

        def a_bus_is_unplugged(self):
            page = self.page
            self.go("Runs")
            self.cable.terminate()
            self.cable.wait()
            page.until_text("alarms", "bus serial-2 is down", PATIENCE_S)
            page.until("document.getElementById('floor_words').classList.contains('wrong')", "the fault", PATIENCE_S)
            self.shot("bus-unplugged")
            self.fits()
            self.cable = self.plug()
            page.until_text("floor_words", f"All {SIZE['nodes']} nodes are confirmed right", PATIENCE_S)
            page.key("a")
            page.until("document.getElementById('alarms').childElementCount === 0", "all alarms are seen")
            self.shot("bus-is-back")

        def a_node_dies(self):
            page = self.page
            self.gateway.dead.add(7)
            page.until_text("alarms", "is silent: 32 markers", PATIENCE_S)
            self.shot("dead-node")
            name = page.value("document.querySelector('#wrong_nodes b').textContent")
            page.value("document.querySelector('#wrong_nodes button').click()")
            page.until_text("swap_text", "2 of 2: give the spare address 7")
            self.shot("swap-plug-in")
            self.gateway.dead.clear()  # the spare
            page.until_text("swap_text", f"swap {name}: the spare answers at address 7", PATIENCE_S)
            self.shot("swap-done")
            page.click("swap_off")
            page.until("document.getElementById('swap').hidden", "the dialog is closed")
            page.key("a")

        def looking_around(self):
            page = self.page
            page.value("(()=>{const s=document.getElementById('scrub');s.value=300;s.dispatchEvent(new Event('input'))})()")
            page.until_text("scrubbed_at", "5:00.0")
            time.sleep(1)
            self.shot("scrub")
            page.click("now")
            page.key("/")
            page.type("301")
            page.key("Enter")
            page.until_text("person_name", "301")
            page.key("Escape")
            time.sleep(1)
            self.shot("somebody")
            page.key("/")
            page.type("100-200")
            page.key("Enter")
            page.until_text("person_name", "101 people")
            page.key("Escape")
            page.key("0")
            time.sleep(1)
            self.shot("a-hundred-and-one")
            page.click("person_close")
            self.say("mute day, dusk", "not guided: day, dusk")
            page.until_text("notice", "NOT GUIDED: day, dusk")
            page.click("tab_find")
            time.sleep(1)
            self.shot("only-dawn-is-guided")
            self.say("unmute", "everybody is guided")
            page.click("tab_health")
            page.click("front")
            time.sleep(1)
            self.shot("audience")
            page.click("front")
            page.click("theme")
            self.shot("light")
            page.click("theme")
            self.shot("contrast")
            page.click("theme")
            page.click("language")
            page.until_text("go", "走")
            self.shot("chinese")
            page.click("language")
            page.size(1024, 768, mobile=True)
            time.sleep(1)
            self.shot("tablet")
            self.fits()
            page.size(1600, 900)

        def the_end(self):
            page = self.page
            page.key("Escape")
            page.until_text("phase", "HOLD", PATIENCE_S)
            if not FULL:
                self.say("jump count 940", "^")
                page.until("!document.getElementById('placed').hidden", "the jump")
                page.key("p")
                self.until("the finale", phase="stands")
            self.go("Runs")
            page.until_text("phase", "The show is over", 600)
            self.shot("over")
            self.assertEqual(page.problems(), [])
            page.order("quit")
            self.run_.process.wait(60)
            page.until("!document.getElementById('lost').hidden", "the run has ended")
            self.shot("the-run-has-ended")
            self.judge_report()

        def judge_report(self):
            """What is left behind: the rehearsal's report and the journal."""
            folder = self.path("state-of-run")
            text = open(glob.glob(folder + "/rehearsal-*.txt")[0]).read()
            report = json.load(open(glob.glob(folder + "/rehearsal-*.json")[0]))
            journal = footlight("journal", os.path.join(folder, "journal.sqlite"))[0]
            for name, what in (("report.txt", text), ("journal.txt", journal)):
                with open(os.path.join(pictures(), f"ceremony-{name}"), "w") as f:
                    f.write(what)
            shutil.copy(glob.glob(folder + "/rehearsal-*.html")[0], os.path.join(pictures(), "ceremony-report.html"))
            cues = {cue["cue"]: cue for cue in report["cues"]}
            self.assertEqual(cues["1"]["starts"], 1)
            self.assertGreaterEqual(len(cues["2"]["holds_at_count"]), 2)
            self.assertGreaterEqual(cues["2"]["resets"], 2)
            self.assertEqual(sorted(report["absent"]), ["3", "7"])
            self.assertIn("bus serial-2 is down", text)
            self.assertIn("too late", text)
            for what in ("go, by", "bus serial-2 is down", "is silent", "answers again", "is absent", "taken: "):
                self.assertIn(what, journal)

    return Ceremony
