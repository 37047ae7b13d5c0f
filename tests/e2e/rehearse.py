"""A rehearsal with the program: orders by lines and by the keys of a terminal, against `footlight sim`. Part of run.py."""
import array
import json
import os
import pty
import select
import signal
import subprocess
import termios
import threading
import time
import wave

from stage import wait_for


class Desk:
    """`footlight run --status-lines`: says orders, follows what it says."""

    def __init__(self, case, program, *options):
        self.process = subprocess.Popen([program, "run", case.show, "--transport-map", case.map, "--status-lines", "--go-guard", "0.2", *options],
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.lines, self.state = [], {}
        self.reader = threading.Thread(target=self.read)
        self.reader.start()
        case.addCleanup(self.end)

    def end(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        self.reader.join()
        self.process.stdin.close()
        self.process.stdout.close()

    def read(self):
        for line in self.process.stdout:
            document = json.loads(line)
            self.lines.append(document)
            self.state = document.get("state", self.state)

    def say(self, *orders):
        for order in orders:
            self.process.stdin.write(order + "\n")
        self.process.stdin.flush()

    def until(self, told, **wanted):
        return wait_for(lambda: all(self.state.get(key) == value for key, value in wanted.items()), f"{told}: {wanted}, not {self.state}", 60)

    def answers(self):
        return [line["answer"]["text"] for line in list(self.lines) if "answer" in line]

    def report(self):
        self.reader.join(60)
        return self.lines[-1]["report"]


def make_cases(Stage, program):
    """The test cases, over stage.py's."""

    class Rehearse(Stage):
        def desk_in_cue_2(self, *options):
            self.make_show()
            self.serve()
            desk = Desk(self, program(), *options)
            desk.until("roll call", ready=True)
            desk.say("go")
            desk.until("the end of cue 1", phase="stands", standby="2")
            time.sleep(0.3)
            desk.say("go")
            desk.until("cue 2", phase="runs", cue="2")
            return desk

        def test_hold_back_and_the_reset_move_leave_every_marker_right(self):
            desk = self.desk_in_cue_2("--count-in", "1")
            desk.say("hold")
            desk.until("the hold", phase="stands", cue="2")
            desk.say("jump cue 1")
            wait_for(lambda: desk.state["reset"]["state"] == "ready", "the way back", 60)
            self.assertTrue(any("people walk, at most" in line.get("reset", "") for line in desk.lines), desk.lines)
            position = desk.state["position_s"]
            time.sleep(0.5)
            self.assertEqual(desk.state["position_s"], position, "nothing moves before somebody confirms")
            desk.say("go")
            desk.until("people walk on to the end of the set", phase="stands", position_s=3.0)
            time.sleep(0.3)
            desk.say("go")
            desk.until("the reset move", phase="resets")
            desk.until("the top", phase="stands", position_s=0.0)
            wait_for(lambda: all(bus["unconfirmed"] == 0 for bus in desk.state["buses"]), "all nodes right")
            desk.say("quit")
            report = desk.report()
            self.assertEqual(desk.process.wait(20), 0)
            self.assertEqual(report["unconfirmed"], 0)
            self.assertEqual([a for a in desk.answers() if a != "done"],
                             ["the cue starts", "the cue starts", "people walk on to the end of the set; then press GO for the reset move", "the reset move starts"])
            self.assert_floor(report)

        def test_refused_orders_say_why_and_a_flood_stops_no_cue(self):
            desk = self.desk_in_cue_2("--count-in", "0")
            time.sleep(0.3)  # a step passes the guard of the GO before
            desk.say(*["step", "placed", "go", "jump cue 99", "cancel"] * 400)
            desk.until("the end", phase="finished")
            wait_for(lambda: all(bus["unconfirmed"] == 0 for bus in desk.state["buses"]), "all nodes right")
            desk.say("quit")
            report = desk.report()
            self.assertEqual(desk.process.wait(20), 0)
            self.assertEqual(report["unconfirmed"], 0)
            self.assertEqual(report["deaf"], 0)
            self.assertLessEqual({"the cue runs", 'jump: no cue "99" (there are 1, 2, 3)', "no reset move is asked for"}, set(desk.answers()))
            self.assert_floor(report)

        def test_a_loop_comes_back_and_a_tempo_is_held_at_what_is_proved(self):
            self.make_show()
            self.serve()
            desk = Desk(self, program(), "--count-in", "1")
            desk.until("roll call", ready=True)
            desk.say("tempo 200", "loop cue 2")
            for _ in range(2):
                wait_for(lambda: desk.state["reset"]["state"] == "ready", "the way to the loop", 60)
                time.sleep(0.3)
                desk.say("go")
                desk.until("the beginning of the loop", phase="stands", position_s=0.5, reset={"state": "none"})
                self.assertEqual(desk.state["tempo_percent"], 164, "performer 8 walks at 2.43 of 4 m/s")
                time.sleep(0.3)
                desk.say("go")
                desk.until("the end of the loop", phase="stands", position_s=3.5)
            desk.say("quit")
            self.assertEqual(desk.process.wait(20), 0)

        def test_notes_and_mutes_are_told_kept_through_a_kill_and_reported(self):
            self.make_show()
            self.serve()
            desk = Desk(self, program(), "--count-in", "0")
            desk.until("roll call", ready=True)
            wait_for(lambda: desk.state["freeze"] is not None, "the freezes to be judged")
            desk.say("solo left", "note left too slow", "note all smile", "mute nobody")
            desk.until("the solo", muted="right")
            quiet = lambda: {line["cell"] for line in self.changes() if (line["colour"], line["brightness"], line["effect"]) == ("#0000FF", 40, "steady")}
            wait_for(lambda: len(quiet()) == 11, "six places of muted people, and five that they are announced for, to be quiet")
            wait_for(lambda: all(bus["unconfirmed"] == 0 for bus in desk.state["buses"]), "all nodes right")
            self.assertIn('mute: no group "nobody" (there are left, right; "no group")', desk.answers())
            desk.process.kill()
            desk.process.wait()
            desk = Desk(self, program(), "--count-in", "0", "--rehearsal-report", self.path("report.html"))
            desk.until("roll call", ready=True)
            desk.say("go")
            desk.until("the end of cue 1", phase="stands", standby="2")
            desk.say("note <i>ring</i> late", "notes", "quit")
            report = desk.report()
            self.assertEqual(desk.process.wait(20), 0)
            self.assertEqual(report["unconfirmed"], 0)
            self.assertEqual(desk.answers()[-1], "count 1, cue 1, left: too slow\ncount 1, cue 1, all: smile\ncount 3, cue 2, all: <i>ring</i> late")
            folder = self.path("state", "footlight")
            self.assertFalse(os.path.exists(os.path.join(folder, "rehearsal.jsonl")))
            name, = [name for name in os.listdir(folder) if name.startswith("rehearsal-") and name.endswith(".json")]
            with open(os.path.join(folder, name)) as f:
                rehearsal = json.load(f)
            self.assertEqual(rehearsal["programs"], 2)
            self.assertEqual([(cue["cue"], cue["starts"], cue["ends"], len(cue["notes"])) for cue in rehearsal["cues"]], [("1", 1, 1, 2), ("2", 0, 0, 1), ("3", 0, 0, 0)])
            self.assertEqual(rehearsal["refused"], 1)
            with open(self.path("report.html")) as f:
                self.assertIn("&lt;i&gt;ring&lt;/i&gt; late", f.read())

        def test_the_count_in_is_heard_in_a_file_and_a_missing_device_costs_a_note(self):
            self.make_show()
            self.serve()
            desk = Desk(self, program(), "--count-in", "4", "--sound", self.path("count.wav"), "--sound-language", "none")
            desk.until("roll call", ready=True)
            desk.say("go")
            desk.until("the end of cue 1", phase="stands", standby="2")
            desk.say("quit")
            self.assertEqual(desk.process.wait(20), 0)
            with wave.open(self.path("count.wav")) as sound:
                self.assertEqual((sound.getframerate(), sound.getnchannels(), sound.getsampwidth()), (48000, 1, 2))
                samples = array.array("h", sound.readframes(sound.getnframes()))
            loud = [i for i, sample in enumerate(samples) if abs(sample) > 3000]
            clicks = [i for k, i in enumerate(loud) if k == 0 or i - loud[k - 1] > 4800]
            self.assertEqual(len(clicks), 5, "four counts and the GO")
            for one, next in zip(clicks, clicks[1:]):
                self.assertAlmostEqual(next - one, 12000, delta=40, msg="240 counts a minute; accents are louder sooner")
            desk = Desk(self, program(), "--count-in", "1", "--sound", "no-such-device")
            desk.until("roll call", ready=True)
            desk.say("quit")
            self.assertEqual(desk.process.wait(20), 0)

        def test_timecode_from_a_midi_device_brings_the_cues(self):
            self.make_show()
            self.serve()
            device = self.map + ".midi"
            os.mkfifo(device)
            writer = os.open(device, os.O_RDWR)
            self.addCleanup(os.close, writer)
            desk = Desk(self, program(), "--time", "mtc:" + device)
            desk.until("roll call", ready=True)
            self.assertEqual(desk.state["time"], {"source": "mtc " + device, "lock": "none"})
            desk.say("time here")
            wait_for(lambda: any("no source of time is followed" in a for a in desk.answers()), "nothing to join yet")
            stop = threading.Event()
            tape = threading.Thread(target=self.play_mtc, args=(writer, 24 * 3600 - 2, stop))
            tape.start()
            self.addCleanup(tape.join)
            self.addCleanup(stop.set)
            desk.until("counted in by the source", phase="counts-in")
            desk.until("cue 1", phase="runs", cue="1")
            desk.until("cue 2 without GO", phase="runs", cue="2")
            self.assertTrue(desk.state["time"]["follows"])
            self.assertLess(abs(desk.state["time"]["off_s"]), 0.08, desk.state)
            stop.set()
            wait_for(lambda: any("the show goes on at its last speed" in line.get("alarm", "") for line in desk.lines), "the alarm")
            desk.until("where everybody next stands", phase="stands")
            self.assertTrue(any("lost: the show holds where everybody next stands" in line.get("alarm", "") for line in desk.lines), desk.lines)
            desk.say("quit")
            self.assertEqual(desk.process.wait(20), 0)
            self.assert_floor(desk.report())

        @staticmethod
        def play_mtc(writer, begins_s, stop):
            """Quarter frames of 25 frames a second, in real time."""
            began = time.monotonic()
            for quarter in range(100 * 60):
                wait = began + quarter / 100 - time.monotonic()
                if stop.wait(max(0.0, wait)):
                    return
                frame = (begins_s * 25 + quarter // 8 * 2) % (24 * 3600 * 25)
                hours, minutes, seconds, frames = frame // 90000, frame // 1500 % 60, frame // 25 % 60, frame % 25
                number = [frames, seconds, minutes, 1 << 5 | hours][quarter % 8 // 2]
                piece = number >> 4 if quarter % 2 else number & 15
                os.write(writer, bytes([0xF1, quarter % 8 << 4 | piece]))

        def test_a_source_of_time_that_is_none_is_one_clear_error(self):
            self.make_show()
            self.serve()
            for name, error in (("smpte", '"smpte" is no source of time'), ("ltc:none.wav", "none.wav: "), ("ltc:alsa:hw:31", 'no sound input "hw:31"'), ("mtc:/none", "/none")):
                run = subprocess.run([program(), "run", self.show, "--transport-map", self.map, "--time", name], capture_output=True, text=True, timeout=60)
                self.assertIn("error: --time: ", run.stderr)
                self.assertIn(error, run.stderr)
                self.assertIn(run.returncode, (2, 4), run.stderr)

        def terminal(self, *options):
            """`footlight run` at a terminal: (process, our end, its end)."""
            ours, its = pty.openpty()
            self.addCleanup(os.close, ours)
            self.addCleanup(os.close, its)
            process = self.start_at(its, *options)
            wait_for(lambda: not termios.tcgetattr(its)[3] & termios.ICANON, "keys one by one")
            self.assertFalse(termios.tcgetattr(its)[0] & termios.IXON, "Ctrl-S would stop what the show says")
            return process, ours, its

        def start_at(self, its, *options):
            process = subprocess.Popen([program(), "run", self.show, "--transport-map", self.map, *options], stdin=its, stdout=its, stderr=its, start_new_session=True)
            self.addCleanup(lambda: (process.poll() is None and process.kill(), process.wait()))
            return process

        def read_until(self, ours, text):
            said = ""
            end = time.monotonic() + 60
            while text not in said:
                self.assertLess(time.monotonic(), end, f"{text!r} in {said[-2000:]!r}")
                if select.select([ours], [], [], 0.1)[0]:
                    said += os.read(ours, 65536).decode(errors="replace")
            return said

        def test_the_keys_of_a_terminal_are_go_hold_and_the_others(self):
            self.make_show()
            self.serve()
            process, ours, its = self.terminal("--count-in", "1")
            self.assertIn("HOLD is no emergency stop", self.read_until(ours, "GO for cue 1 Opening line"))
            self.read_until(ours, "all 12 nodes right")
            os.write(ours, b" ")
            self.read_until(ours, "GO for cue 2 Ring")
            os.write(ours, b"    ")
            self.assertIn("go refused: the key has not been up since the last GO", self.read_until(ours, "refused"))
            os.write(ours, b"jcue 9\n")
            self.read_until(ours, 'jump: no cue "9" (there are 1, 2, 3)')
            os.write(ours, b"q")
            self.read_until(ours, "q again ends the run")
            os.write(ours, b"q")
            self.read_until(ours, "0 not right at the end")
            self.assertEqual(process.wait(20), 0)
            self.assertTrue(termios.tcgetattr(its)[3] & termios.ICANON)

        def test_whatever_ends_it_the_terminal_is_as_it_was(self):
            self.make_show()
            self.serve()
            for ends in (signal.SIGINT, signal.SIGTERM, signal.SIGABRT, signal.SIGHUP, signal.SIGSEGV):
                process, ours, its = self.terminal()
                self.assertFalse(termios.tcgetattr(its)[3] & termios.ECHO)
                process.send_signal(ends)
                wait_for(lambda: select.select([ours], [], [], 0)[0] and os.read(ours, 65536) and process.poll() is not None or process.poll() is not None, "the end")
                flags = termios.tcgetattr(its)[3]
                self.assertTrue(flags & termios.ICANON and flags & termios.ECHO, ends)

    return Rehearse
