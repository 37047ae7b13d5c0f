"""Dying and living on: kills, a hung program, a full disk, the journal, an understudy. Part of run.py."""
import json
import os
import signal
import socket
import subprocess
import sys
import threading
import time

from rehearse import Desk
from remote import Surface, free_port, osc
from stage import SHOW, wait_for

LED = SHOW + 'time: {start: "01:00:00:00"}\n'
SOAK = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))), "scripts", "soak")


def make_cases(Stage, footlight, program, full):
    """The test cases, over stage.py's."""

    class Survive(Stage):
        def make_show(self, *arguments, **options):
            show = super().make_show(*arguments, **options)
            footlight("plan", show, "-o", show.replace(".yaml", ".plan"))
            return show

        def soak(self, *options):
            done = subprocess.run([sys.executable, SOAK, "--footlight", program(), "--json", self.path("rows.json"), "--verbose", *options], capture_output=True, text=True, timeout=3000)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            with open(self.path("rows.json")) as f:
                return json.load(f)

        def desk(self, *options):
            desk = Desk(self, program(), "--count-in", "0", *options)
            desk.until("roll call", ready=True)
            return desk

        def notes(self, desk):
            return [line["note"] for line in list(desk.lines) if "note" in line]

        def journal(self, *options):
            return json.loads(footlight("journal", "--json", *options)[0])

        def child_of(self, process):
            return int(wait_for(lambda: open(f"/proc/{process.pid}/task/{process.pid}/children").read().split(), "the child")[0])

        def test_a_run_that_is_killed_again_and_again_leaves_no_marker_wrong(self):
            row, = self.soak("--kills", "200" if full else "5", "--seed", "3")
            self.assertEqual((row["wrong"], row["misplaced"]), (0, 0), row)

        def test_an_understudy_takes_over_from_a_lead_that_is_killed(self):
            row, = self.soak("--understudy", "--kills", "20" if full else "2", "--seed", "3")
            self.assertEqual((row["wrong"], row["misplaced"]), (0, 0), row)

        def understudy(self, make=True, lead=(), second=(), answers=()):
            """(lead, understudy's process): the second follows the first."""
            if make:
                self.make_show()
            self.serve()
            with socket.socket() as one:
                one.bind(("127.0.0.1", 0))
                port = one.getsockname()[1]
            lead = Desk(self, program(), "--count-in", "0", "--lead", str(port), "--lead-token", self.path("token"), *lead)
            lead.say(*answers)
            lead.until("roll call", ready=True)
            second = Desk(self, program(), "--count-in", "0", "--state", self.path("second"), "--understudy", f"127.0.0.1:{port}", "--lead-token", self.path("token"), *second)
            wait_for(lambda: "an understudy follows" in self.notes(lead), "the understudy", 60)
            return lead, second, port

        def test_an_understudy_leads_when_its_operator_says_so_and_the_first_stands_back(self):
            lead, second, _ = self.understudy()
            lead.say("go")
            lead.until("the end of cue 1", phase="stands", standby="2")
            time.sleep(0.3)
            second.say("lead")
            self.assertEqual(lead.process.wait(20), 3)
            second.until("its first lamp", ready=True, phase="stands", standby="2")
            second.say("go")
            second.until("the end", phase="finished")
            second.say("quit")
            report = second.report()
            self.assertEqual(second.process.wait(20), 0)
            self.assert_floor(report)

        def test_a_lead_that_comes_back_from_the_dead_is_fenced_and_stands_back(self):
            self.make_show(("right",))
            lead, second, _ = self.understudy(make=False)
            lead.until("roll call", ready=True)
            time.sleep(0.5)  # the second has heard of it
            lead.process.send_signal(signal.SIGSTOP)
            second.until("it leads", ready=True)
            lead.say("go")  # its operator does not know
            lead.process.send_signal(signal.SIGCONT)
            second.say("go")
            self.assertEqual(lead.process.wait(30), 3)
            second.until("the end of cue 1", phase="stands", standby="2")
            time.sleep(0.3)
            second.say("go")
            second.until("the end", phase="finished")
            second.say("quit")
            report = second.report()
            self.assertEqual(second.process.wait(20), 0)
            self.assert_floor(report)

        def test_another_token_is_refused_and_a_token_is_its_owners_alone(self):
            lead, _, port = self.understudy()
            self.assertEqual(os.stat(self.path("token")).st_mode & 0o777, 0o600)
            _, said = footlight("run", self.show, "--transport-map", self.map, "--understudy", f"127.0.0.1:{port}", "--lead-token", self.path("other"), status=3)
            self.assertIn("the lead refuses this understudy: another token is wanted", said)
            wait_for(lambda: any("without the right token" in line.get("alarm", "") for line in lead.lines), "the alarm")
            _, said = footlight("run", self.show, "--transport-map", self.map, "--lead", "0.0.0.0:0", status=2)
            self.assertIn("--lead 0.0.0.0:0: an address that other machines reach needs --lead-token", said)

        def test_wires_that_are_gone_are_an_alarm_each_and_come_back(self):
            with socket.socket() as one:
                one.bind(("127.0.0.1", 0))
                port = one.getsockname()[1]
            self.make_show()
            self.serve("--ports-from", str(port))
            desk = self.desk()
            stages = lambda: {s["name"]: (s["state"], s["text"]) for s in desk.state["readiness"]["stages"]}
            alarms = lambda: [line["alarm"] for line in list(desk.lines) if "alarm" in line]
            wait_for(lambda: stages()["roll-call"] == ("SUCCESS", "12 nodes answer"), "all nodes")
            self.sim.kill()
            self.sim.wait()
            wait_for(lambda: stages()["roll-call"][0] == "ERROR", "the roll call to say so")
            wait_for(lambda: all(bus["silent"] == bus["unconfirmed"] == bus["nodes"] for bus in desk.state["buses"]), f"all nodes silent, not {desk.state['buses']}")
            self.assertTrue(stages()["roll-call"][1].startswith("96 of 96 markers silent: "), stages())
            self.assertEqual((stages()["plan-on-nodes"][0], stages()["looks"][0]), ("WARNING", "WARNING"), stages())
            wait_for(lambda: stages()["buses"][0] == "ERROR", "the ports")
            self.assertEqual(sorted(alarm.split('"')[1] for alarm in alarms()), ["left", "middle", "right"], alarms())
            self.assertTrue(any(bus["trouble"] for bus in desk.state["buses"]))
            for name in os.listdir(self.ports):
                os.remove(os.path.join(self.ports, name))
            self.serve("--ports-from", str(port))
            wait_for(lambda: stages()["roll-call"][0] == "SUCCESS" and stages()["buses"][0] == "SUCCESS", "the wires", 40)
            for bus in ("left", "middle", "right"):
                wait_for(lambda: any(note.startswith(f'bus "{bus}": all ') for note in self.notes(desk)), f"the note of {bus}")
            self.assertLessEqual(len(alarms()), 6, alarms())
            desk.say("go")
            desk.until("the end of cue 1", phase="stands", standby="2")
            wait_for(lambda: all(bus["unconfirmed"] == 0 for bus in desk.state["buses"]), "all nodes right")
            desk.say("quit")
            report = desk.report()
            self.assertEqual(desk.process.wait(20), 0)
            self.assert_floor(report)
            said = self.journal()["entries"]
            self.assertEqual(len({e["text"].split(":")[0] for e in said if e["kind"] == "health" and "answers again" in e["text"]}), 3, said)
            self.assertTrue(any(e["kind"] == "alarm" and 'bus "left"' in e["text"] for e in said))

        def test_a_reader_that_stops_makes_nobody_wait_and_is_told_in_its_order(self):
            self.make_show()
            self.serve()
            process = subprocess.Popen([program(), "run", self.show, "--transport-map", self.map, "--status-lines", "--count-in", "0", "--go-guard", "0.2", "--supervised"],
                                       stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            self.addCleanup(lambda: (process.poll() is None and process.kill(), process.wait(), process.stdin.close(), process.stdout.close(), process.stderr.close()))
            for line in process.stdout:
                if json.loads(line).get("state", {}).get("ready"):
                    break

            def say(*orders):
                process.stdin.write("".join(order + "\n" for order in orders))
                process.stdin.flush()

            child = self.child_of(process)
            lit = lambda: len(self.changes())
            before = lit()
            # From here on nobody reads. Each state is more than a kilobyte: the pipe is full after some fifty.
            for i in range(300):
                say("state", f"note all {i}")
                time.sleep(0.005)
            time.sleep(2.5)
            say("go")
            time.sleep(2.5)
            say("go")
            wait_for(lambda: lit() > before, "lamps of cue 2, which GO has started")
            time.sleep(8)  # to the end of the show, which nobody can read
            self.assertEqual(self.child_of(process), child, "it is the same run: nobody has taken it for dead")
            say("quit")
            said = [json.loads(line) for line in process.stdout]
            self.assertEqual(process.wait(30), 0, process.stderr.read())
            notes = [line["answer"]["order"] for line in said if line.get("answer", {}).get("order", "").startswith("note all")]
            self.assertEqual(notes, [f"note all {i}" for i in range(300)], "every answer, in its order")
            self.assertEqual([line["answer"]["text"] for line in said if line.get("answer", {}).get("order") == "go"], ["the cue starts"] * 2)
            self.assertIn("report", said[-1])

        def test_memory_and_handles_stay_flat(self):
            row, = self.soak("--hours", "0.2" if full else "0.015")
            self.assertEqual(row["wrong"], 0, row)
            self.assertTrue(row["flat"], row)

        def test_resume_stands_where_the_show_stood_and_the_journal_tells_who_said_what(self):
            self.make_show()
            self.serve()
            desk = self.desk()
            desk.say("go")
            desk.until("the end of cue 1", phase="stands", standby="2")
            desk.say("jump cue 9")
            wait_for(lambda: any("there are 1, 2, 3" in a for a in desk.answers()), "the answer")
            time.sleep(0.3)
            desk.process.kill()
            desk.process.wait()
            said = self.journal()
            self.assertEqual(said["runs"][-1]["how"], "")
            answers = [(e["order"], e["who"], e["refused"], e["text"]) for e in said["entries"] if e["kind"] == "answer"]
            self.assertEqual(answers, [("go", "lines", False, "the cue starts"), ("jump cue 9", "lines", True, 'jump: no cue "9" (there are 1, 2, 3)')])
            self.assertFalse(said["last_place"]["runs"])
            lit = len(self.changes())
            again = self.desk("--resume")
            self.assertIn("while the show stood at 0.500 s: it stands there", self.notes(again)[0])
            self.assertEqual((again.state["phase"], again.state["standby"]), ("stands", "2"))
            self.assertLessEqual({c["look"] for c in self.changes()[lit:]}, {c["look"] for c in self.changes()[:lit]}, "no lamp shows anything new")
            again.say("go")
            again.until("cue 3", phase="finished")
            again.say("quit")
            report = again.report()
            self.assertEqual(again.process.wait(20), 0)
            self.assert_floor(report)
            self.assertEqual(self.journal()["runs"][-1]["how"], "over")
            self.assertIn("over at", footlight("journal", "--runs")[0])

        def test_a_show_that_ran_goes_on_in_time_and_later_it_stands(self):
            self.make_show()
            self.serve()
            desk = self.desk("--after-death", "go-on")
            desk.say("go")
            desk.until("the end of cue 1", phase="stands", standby="2")
            time.sleep(0.3)
            desk.say("go")
            desk.until("cue 2", phase="runs", cue="2")
            time.sleep(0.5)
            desk.process.kill()
            again = self.desk("--resume")
            self.assertIn("the show goes on in time", self.notes(again)[0])
            again.until("the end", phase="finished")
            again.say("top", "placed")
            again.until("the top", position_s=0.0)
            time.sleep(0.3)
            again.say("go")
            again.until("the end of cue 1", phase="stands", standby="2")
            time.sleep(0.3)
            again.say("go")
            again.until("cue 2", phase="runs", cue="2")
            again.process.kill()
            time.sleep(3)
            third = self.desk("--resume")
            self.assertIn("the markers have lost guidance since; see where people are before GO", self.notes(third)[0])
            self.assertEqual((third.state["phase"], third.state["cue"]), ("stands", "2"))
            third.say("go")
            third.until("the end", phase="finished")

        def lives_on(self, *options):
            """Kills the run that there is, and takes it up."""
            self.led.process.kill()
            self.led.process.wait()
            self.led = self.desk("--resume", *options)
            return self.led

        def refused(self, desk, order, why):
            time.sleep(0.3)
            desk.say(order)
            wait_for(lambda: any(why in text for text in desk.answers()), why)

        def live(self, *answers):
            self.make_show()
            self.serve()
            self.led = Desk(self, program(), "--count-in", "0", "--scope", "live")
            self.led.say(*answers)
            self.led.until("roll call", ready=True)
            return self.led

        def stages(self, desk):
            return {s["name"]: s["state"] for s in desk.state["readiness"]["stages"]}

        def test_a_floor_that_is_wrong_stays_unarmed_through_a_death_and_its_lamps_are_right(self):
            desk = self.live("yes", "no")
            self.refused(desk, "go", "probes: ")
            desk = self.lives_on("--scope", "live")
            self.assertEqual(self.stages(desk)["probes"], "ERROR")
            self.assertFalse(desk.state["readiness"]["armed"])
            self.refused(desk, "go", "the show is not ready: probes: ")
            self.assertEqual((desk.state["phase"], desk.state["position_s"]), ("stands", 0.0))
            wait_for(lambda: all(bus["unconfirmed"] == 0 for bus in desk.state["buses"]), "all nodes right")
            desk.say("override probes")
            wait_for(lambda: self.stages(desk)["probes"] == "WARNING", "the override")
            time.sleep(0.2)
            desk = self.lives_on("--scope", "live")
            self.assertEqual(self.stages(desk)["probes"], "WARNING", "the override is remembered")
            self.refused(desk, "go", "nobody has said arm")
            desk.say("arm")
            wait_for(lambda: desk.state["readiness"]["armed"], "arm")

        def test_who_was_armed_is_armed_after_a_death_and_who_was_disarmed_is_not(self):
            desk = self.live("yes", "yes", "yes")
            desk.say("arm")
            wait_for(lambda: desk.state["readiness"]["armed"], "arm")
            time.sleep(0.2)
            desk = self.lives_on("--scope", "live")
            self.assertTrue(desk.state["readiness"]["armed"])
            self.assertEqual(self.stages(desk)["probes"], "SUCCESS")
            desk.say("disarm")
            wait_for(lambda: not desk.state["readiness"]["armed"], "disarm")
            time.sleep(0.2)
            desk = self.lives_on("--scope", "live")
            self.refused(desk, "go", "nobody has said arm")
            self.assertEqual(self.stages(desk)["probes"], "SUCCESS")

        def test_an_understudy_is_armed_when_its_lead_was_and_only_then(self):
            for armed in (False, True):
                lead, second, _ = self.understudy(make=not armed, lead=("--scope", "live"), second=("--scope", "live"), answers=("yes", "yes", "yes"))
                if armed:
                    lead.say("arm")
                wait_for(lambda: lead.state["readiness"]["armed"] == armed, "arm")
                time.sleep(0.3)
                lead.process.kill()
                second.until("it leads", ready=True)
                self.assertEqual(second.state["readiness"]["armed"], armed)
                self.assertEqual(self.stages(second)["probes"], "SUCCESS")
                second.end()
                lead.end()
                self.sim.kill()
                self.sim.wait()

        def tape_is_at(self, desk):
            """Where the desk hears the source now; nothing before it is locked. A show that stands says nothing by itself."""
            desk.say("state")
            time.sleep(0.1)
            told = desk.state["time"]
            return told["position_s"] if told["lock"] == "locked" else -1e9

        def tape(self, port, begins_at_s):
            """A source of time by OSC that says it is at `begins_at_s` of the show now, and goes on."""
            over, began = threading.Event(), time.monotonic()

            def play():
                with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as out:
                    while not over.wait(0.04):
                        out.sendto(osc("/footlight/time", 3600 + begins_at_s + time.monotonic() - began), ("127.0.0.1", port))

            playing = threading.Thread(target=play)
            playing.start()

            def stop():
                over.set()
                playing.join()

            self.addCleanup(stop)
            return stop

        def test_what_was_taken_off_the_tape_stays_off_it_through_a_death(self):
            self.make_show(show=LED)
            self.serve()
            port = free_port()
            follows = ("--time", f"osc:{port}")
            self.led = desk = self.desk(*follows)
            stop = self.tape(port, -1000)
            wait_for(lambda: desk.state["time"]["lock"] == "locked", "the tape")
            desk.say("time off")
            wait_for(lambda: not desk.state["time"]["on"], "time off")
            stop()
            time.sleep(0.2)
            desk = self.lives_on(*follows)
            stop = self.tape(port, -2)
            wait_for(lambda: self.tape_is_at(desk) > 1, "the tape has passed the top")
            self.assertEqual((desk.state["phase"], desk.state["position_s"], desk.state["time"]["on"]), ("stands", 0.0, False))
            desk.say("time on")
            stop()
            time.sleep(0.3)
            self.tape(port, -2)
            desk.until("it begins with the tape", phase="runs")

        def test_a_hold_at_the_end_of_the_set_stays_one_for_the_tape_under_the_understudy(self):
            self.make_show(show=LED)
            port, other = free_port(), free_port()
            lead, second, _ = self.understudy(False, lead=("--time", f"osc:{port}"), second=("--time", f"osc:{other}"))
            stop = self.tape(port, -2)
            lead.until("with the tape", phase="runs", cue="2")
            lead.say("hold end")
            lead.until("where everybody stands", phase="stands")
            held_s = lead.state["position_s"]
            stop()
            time.sleep(0.3)
            lead.process.kill()
            second.until("it leads", ready=True)
            self.assertEqual((second.state["phase"], second.state["position_s"]), ("stands", held_s))
            self.tape(other, held_s - 2)
            wait_for(lambda: self.tape_is_at(second) > held_s + 1, "the tape has passed that place")
            self.assertEqual((second.state["phase"], second.state["position_s"]), ("stands", held_s))
            self.assertEqual((second.state["time"]["on"], second.state["time"]["armed"]), (True, False))

        def test_an_emergency_hold_that_nobody_acknowledged_is_one_in_the_next_life(self):
            self.make_show()
            self.serve()
            port = free_port()
            with open(self.path("remote.yaml"), "w") as f:
                f.write(f"remote: 1\nosc: {{port: {port}}}\nbuttons: [{{name: red, does: emergency-hold, osc: true}}]\n")
            remote = ("--remote", self.path("remote.yaml"))
            self.led = desk = self.desk(*remote)
            surface = Surface(self, port)
            surface.send("/footlight/button", "red", 1)
            wait_for(lambda: any("EMERGENCY HOLD by button red" in line.get("alarm", "") for line in list(desk.lines)), "the alarm")
            surface.send("/footlight/button", "red", 0)
            time.sleep(0.3)
            desk = self.lives_on(*remote)
            wait_for(lambda: any("EMERGENCY HOLD from before" in line.get("alarm", "") for line in list(desk.lines)), "the alarm")
            self.refused(desk, "go", "emergency hold: when people are safe and the button is out, acknowledge it (ok): emergency hold from before this program was begun again")
            time.sleep(0.3)
            desk.say("ok")
            time.sleep(0.3)
            desk.say("go")
            desk.until("the end of cue 1", phase="stands", standby="2")
            self.lives_on(*remote)
            self.assertFalse(any("EMERGENCY" in line.get("alarm", "") for line in list(self.led.lines)), "it was acknowledged")

        def test_another_plan_is_not_taken_up(self):
            self.make_show()
            self.serve()
            desk = self.desk()
            desk.process.kill()
            desk.process.wait()
            with open(self.show) as f:
                text = f.read()
            with open(self.show, "w") as f:
                f.write(text.replace("tempo: 240", "tempo: 230"))
            _, said = footlight("run", self.show, "--transport-map", self.map, "--resume", status=2)
            self.assertIn("--resume: the run that was cut off led another plan", said)

        def test_a_supervised_run_that_hangs_is_begun_again_and_sigterm_ends_both(self):
            self.make_show()
            self.serve()
            desk = self.desk("--supervised")
            child = self.child_of(desk.process)
            os.kill(child, signal.SIGSTOP)
            wait_for(lambda: any(n.startswith("cut off") for n in self.notes(desk)), "the next life", 30)
            self.assertNotEqual(self.child_of(desk.process), child)
            desk.say("go")
            desk.until("its stdin is the same", phase="stands", standby="2")
            child = self.child_of(desk.process)
            desk.process.send_signal(signal.SIGTERM)
            self.assertEqual(desk.process.wait(20), 130)
            self.assertFalse(os.path.exists(f"/proc/{child}"))

        def test_a_full_disk_is_an_alarm_and_the_show_ends_as_it_should(self):
            self.make_show()
            self.serve()
            os.mkdir(self.path("full"))
            # A disk of its own, seen by this run alone, and not a byte free on it.
            script = f"mount -t tmpfs -o size=64k none {self.path('full')} && (cat /dev/zero >{self.path('full', 'x')} 2>/dev/null; exec \"$@\")"
            inside = ["unshare", "--mount"] if os.getuid() == 0 else ["unshare", "--mount", "--user", "--map-root-user"]
            done = subprocess.run([*inside, "sh", "-c", script, "sh", program(), "run", self.show, "--transport-map", self.map, "--go", "--status-lines",
                                   "--state", self.path("full")], capture_output=True, text=True, timeout=120, stdin=subprocess.DEVNULL)
            self.assertEqual(done.returncode, 0, done.stdout[-3000:] + done.stderr)
            lines = [json.loads(line) for line in done.stdout.splitlines()]
            alarms = [line["alarm"] for line in lines if "alarm" in line]
            self.assertEqual(len(alarms), 1, alarms)
            self.assertIn("takes nothing: ", alarms[0])
            self.assertIn("the show goes on", alarms[0])
            self.assert_floor(lines[-1]["report"])

    return Survive
