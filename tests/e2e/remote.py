"""A run that is led from afar: OSC over real UDP, MIDI Show Control through a FIFO. Part of run.py."""
import json
import os
import socket
import struct
import threading
import time

from stage import wait_for


def padded(data):
    return data + b"\0" * (4 - len(data) % 4)


def osc(address, *values):
    """An OSC message."""
    types, data = ",", b""
    for value in values:
        if isinstance(value, str):
            types, data = types + "s", data + padded(value.encode())
        elif isinstance(value, float):
            types, data = types + "f", data + struct.pack(">f", value)
        else:
            types, data = types + "i", data + struct.pack(">i", value)
    return padded(address.encode()) + padded(types.encode()) + data


def text_of(data):
    return data[:data.index(b"\0")].decode()


class Surface:
    """A control surface: sends, and keeps what is answered."""

    def __init__(self, case, port):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.socket.settimeout(0.05)
        self.port, self.heard, self.over = port, [], False
        self.reader = threading.Thread(target=self.read)
        self.reader.start()
        case.addCleanup(self.end)

    def end(self):
        self.over = True
        self.reader.join()
        self.socket.close()

    def read(self):
        while not self.over:
            try:
                data = self.socket.recv(65536)
            except (TimeoutError, ConnectionError):
                continue
            strings = [part.decode(errors="replace") for part in data.split(b"\0") if part]
            self.heard.append(tuple(strings))

    def send(self, *message):
        self.socket.sendto(osc(*message), ("127.0.0.1", self.port))

    def answers(self, address):
        return [h[2:] for h in list(self.heard) if h[0] == "/reply" + address]


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def make_cases(Stage, footlight, program, Desk, SHOW):
    """The test cases, over stage.py's and rehearse.py's."""

    class Remote(Stage):
        def write(self, name, text):
            with open(self.path(name), "w") as f:
                f.write(text)
            return self.path(name)

        def led_by_osc(self, more="", show=SHOW):
            self.make_show(show=show)
            self.serve()
            port = free_port()
            remote = self.write("remote.yaml", f"remote: 1\nosc: {{port: {port}}}\n{more}")
            desk = Desk(self, program(), "--count-in", "0", "--remote", remote)
            desk.until("roll call", ready=True)
            return desk, Surface(self, port)

        def test_a_show_is_led_by_osc(self):
            desk, surface = self.led_by_osc()
            surface.send("/cue/2/start")
            wait_for(lambda: surface.answers("/cue/2/start"), "the refusal")
            self.assertEqual(surface.answers("/cue/2/start")[0][0], "refused")
            surface.send("/go", 1.0)
            surface.send("/go", 0.0)
            desk.until("cue 1 is over", phase="stands", standby="2")
            self.assertEqual(surface.answers("/go"), [("ok", "the cue starts")])
            time.sleep(0.3)
            surface.send("/cue/2/start")
            desk.until("cue 2", phase="runs", cue="2")
            surface.send("/panic")
            desk.until("the hold", phase="stands", cue="2")
            time.sleep(0.3)
            surface.send("/resume")
            desk.until("the end", phase="finished")
            desk.say("quit")
            report = desk.report()
            self.assertEqual(desk.process.wait(20), 0)
            self.assertEqual(report["unconfirmed"], 0)
            self.assert_floor(report)

        def test_a_flood_by_udp_loses_commands_and_no_cue(self):
            desk, surface = self.led_by_osc()
            desk.say("go")
            desk.until("the end of cue 1", phase="stands", standby="2")
            time.sleep(0.3)
            desk.say("go")
            desk.until("cue 2", phase="runs", cue="2")
            sent, over = [0], threading.Event()

            def flood():
                messages = [osc("/go"), osc("/footlight/order", "tempo 99999"), osc("/cue/9/start"), b"\xff" * 100, osc("/footlight/order", "placed"), osc("/resume")]
                with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as out:
                    while not over.is_set():
                        for message in messages:
                            out.sendto(message, ("127.0.0.1", surface.port))
                        sent[0] += len(messages)
                        time.sleep(0.0005)

            flooding = threading.Thread(target=flood)
            flooding.start()
            try:
                desk.until("the end", phase="finished")
            finally:
                over.set()
                flooding.join()
            desk.say("quit")
            report = desk.report()
            self.assertEqual(desk.process.wait(20), 0)
            self.assertGreater(sent[0], 2000)
            self.assertEqual(report["unconfirmed"], 0)
            self.assertEqual(report["deaf"], 0)
            self.assertTrue(any("messages were lost" in line.get("note", "") for line in desk.lines))
            self.assertTrue(any("has pressed GO for more than 5 s" in line.get("alarm", "") for line in desk.lines) or "too soon after the last GO" in desk.answers() or "the cue runs" in desk.answers())
            self.assert_floor(report)

        def test_a_flood_swallows_neither_a_hold_nor_a_gates_sign_of_life(self):
            show = SHOW.replace("announce:", "gates: [trap closed]\nannounce:").replace("name: Ring,", "name: Ring, gates: [trap closed],")
            desk, surface = self.led_by_osc("gates: [{gate: trap closed, osc: true, lost_after: 1 s}]\nbuttons: [{name: spotter, does: hold, osc: true}]\n", show)
            over, pressed, is_loud = threading.Event(), [0], [False]

            def flood():
                loud = [osc("/go"), osc("/footlight/order", "tempo 50"), osc("/cue/9/start"), b"\xff" * 100, osc("/resume")]
                said_at = 0
                with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as out:
                    while not over.is_set():
                        for message in loud if is_loud[0] else ():
                            out.sendto(message, ("127.0.0.1", surface.port))
                        if time.monotonic() - said_at > 0.2:
                            said_at = time.monotonic()
                            out.sendto(osc("/footlight/gate", "trap closed", 1), ("127.0.0.1", surface.port))
                            out.sendto(osc("/footlight/button", "spotter", pressed[0]), ("127.0.0.1", surface.port))
                        time.sleep(0.0005)

            flooding = threading.Thread(target=flood)
            flooding.start()
            try:
                desk.until("the gate", gates=[{"name": "trap closed", "state": "closed"}])
                desk.say("go")
                desk.until("the end of cue 1", phase="stands", standby="2")
                time.sleep(0.3)
                desk.say("go")
                desk.until("cue 2", phase="runs", cue="2")
                is_loud[0] = True
                time.sleep(0.3)
                pressed[0] = 1
                desk.until("the spotter's hold", phase="stands", cue="2")
                time.sleep(1.5)
                self.assertEqual((desk.state["phase"], desk.state["cue"]), ("stands", "2"), "the flood's GO and resume are refused")
                self.assertTrue(any(line.get("alarm", "").startswith("HOLD by button spotter") for line in desk.lines))
                pressed[0], is_loud[0] = 0, False
                wait_for(lambda: not desk.state["against"], "the spotter to let go")
                time.sleep(0.3)
                desk.say("go")
                desk.until("the end", phase="finished")
            finally:
                over.set()
                flooding.join()
            self.assertFalse([line["alarm"] for line in desk.lines if "trap closed: lost" in line.get("alarm", "")])
            self.assertTrue(any("messages were lost" in line.get("note", "") for line in desk.lines))
            desk.say("quit")
            report = desk.report()
            self.assertEqual(desk.process.wait(20), 0)
            self.assert_floor(report)

        def test_a_gate_that_is_lost_holds_the_cue_and_go_is_refused(self):
            show = SHOW.replace("announce:", "gates: [trap closed]\nannounce:").replace("name: Ring,", "name: Ring, gates: [trap closed],")
            desk, surface = self.led_by_osc("gates: [{gate: trap closed, osc: true, lost_after: 0.5 s}]\nbuttons: [{name: spotter, does: hold, osc: true}]\n", show)
            closed = threading.Event()
            over = threading.Event()

            def keep():
                while not over.wait(0.1):
                    if closed.is_set():
                        surface.send("/footlight/gate", "trap closed", 1)

            keeper = threading.Thread(target=keep)
            keeper.start()
            try:
                desk.say("go")
                desk.until("cue 1 is over", phase="stands", standby="2")
                time.sleep(0.3)
                desk.say("go")
                wait_for(lambda: any("a gate that it needs is open" in text for text in desk.answers()), "the refusal")
                self.assertIn("trap closed: lost, nobody knows", desk.state["against"])
                closed.set()
                desk.until("the gate", gates=[{"name": "trap closed", "state": "closed"}])
                time.sleep(0.3)
                desk.say("go")
                desk.until("cue 2", phase="runs", cue="2")
                closed.clear()
                desk.until("the hold", phase="stands", cue="2", gates=[{"name": "trap closed", "state": "lost"}])
                self.assertTrue(any(line.get("alarm", "").startswith("trap closed: lost") for line in desk.lines))
                surface.send("/footlight/button", "spotter", 1)
                desk.say("gate trap closed by word")
                desk.until("the spotter's hold", against=["button spotter is pressed"])
                surface.send("/footlight/button", "spotter", 0)
                desk.until("the spotter lets go", against=[])
                time.sleep(0.3)
                desk.say("go")
                desk.until("the end", phase="finished")
            finally:
                over.set()
                keeper.join()
            desk.say("quit")
            report = desk.report()
            self.assertEqual(desk.process.wait(20), 0)
            self.assert_floor(report)

        def test_a_show_is_led_by_midi_show_control(self):
            self.make_show()
            self.serve()
            os.mkfifo(self.path("midi"))
            remote = self.write("remote.yaml", f"remote: 1\nmidi: {{port: {self.path('midi')}, macros: [{{number: 7, order: hold end}}]}}\n")
            desk = Desk(self, program(), "--count-in", "0", "--remote", remote)
            desk.until("roll call", ready=True)
            with open(self.path("midi"), "wb", buffering=0) as midi:
                midi.write(bytes([0x90, 0x3C, 0xF0, 0x7F, 0x7F, 0x02]))
                midi.write(bytes([0x01, 0xF8, 0x01, 0x31, 0xF7, 0xFE]))
                desk.until("cue 1 is over", phase="stands", standby="2")
                time.sleep(0.3)
                midi.write(bytes.fromhex("F07F7F02010132F7"))
                desk.until("cue 2", phase="runs", cue="2")
                midi.write(bytes.fromhex("F07F7F020108F7"))
                desk.until("all off holds", phase="stands", cue="2")
                midi.write(bytes.fromhex("F07F7F02010133F7"))
                wait_for(lambda: any("cue 3 is not standby" in text or "does not wait" in text for text in desk.answers()), "the refusal")
            desk.say("quit")
            self.assertEqual(desk.process.wait(20), 0)

        def test_a_show_with_gates_does_not_run_without_inputs(self):
            show = SHOW.replace("announce:", "gates: [trap closed]\nannounce:").replace("name: Ring,", "name: Ring, gates: [trap closed],")
            self.make_show(show=show)
            self.serve()
            desk = Desk(self, program())
            self.assertEqual(desk.process.wait(60), 2)
            self.play("--gates-by-people")

        def wait_for_stage(self, desk, name, state):
            """@return what it says then"""
            stage = lambda: next(s for s in desk.state["readiness"]["stages"] if s["name"] == name)
            wait_for(lambda: stage()["state"] == state, f"{name} to be {state}, not {stage()}")
            return stage()["text"]

        def test_a_live_run_asks_for_three_lamps_and_refuses_go_until_it_is_armed(self):
            self.make_show()
            self.serve()
            desk = Desk(self, program(), "--count-in", "0", "--scope", "live")
            desk.say("", "yes", "yes", "yes")
            desk.until("roll call", ready=True)
            self.wait_for_stage(desk, "plan-on-nodes", "SUCCESS")
            desk.say("go")
            wait_for(lambda: any("the show is not ready: nobody has said arm" in text for text in desk.answers()), "the refusal")
            stages = {s["name"]: s["state"] for s in desk.state["readiness"]["stages"]}
            self.assertEqual(stages, {"show": "SUCCESS", "plan": "SUCCESS", "buses": "SUCCESS", "roll-call": "SUCCESS", "plan-on-nodes": "SUCCESS", "probes": "SUCCESS", "looks": "SUCCESS", "time": "SKIPPED"})
            self.assertFalse(desk.state["readiness"]["armed"])
            desk.say("arm")
            wait_for(lambda: desk.state["readiness"]["armed"], "arm")
            time.sleep(0.3)
            desk.say("go")
            desk.until("cue 1 is over", phase="stands", standby="2")
            desk.say("quit")
            self.assertEqual(desk.report()["unconfirmed"], 0)
            self.assertEqual(desk.process.wait(20), 0)

        def test_a_lamp_that_is_elsewhere_is_an_error_that_somebody_answers_for(self):
            self.make_show()
            self.serve()
            desk = Desk(self, program(), "--count-in", "0", "--scope", "live")
            desk.say("yes", "no")
            desk.until("roll call", ready=True)
            self.wait_for_stage(desk, "plan-on-nodes", "SUCCESS")
            desk.say("arm")
            wait_for(lambda: any("arm: probes ERROR" in text for text in desk.answers()), "the refusal")
            desk.say("override probes", "arm", "go")
            desk.until("cue 1 is over", phase="stands", standby="2")
            desk.say("quit")
            self.assertEqual(desk.process.wait(20), 0)

        def test_nodes_of_another_patch_lock_go_until_they_are_given_the_rigs(self):
            self.make_show()
            self.serve()
            rig = self.path("s", "rig.yaml")
            with open(rig) as f:
                text = f.read()
            with open(rig, "w") as f:  # the rig of another day: the columns of the floor go to the buses in another order
                f.write(text.replace("floor: {buses: [left, middle, right]", "floor: {buses: [right, middle, left]"))
            desk = Desk(self, program(), "--count-in", "0", "--scope", "live")
            desk.say("yes", "yes", "yes")
            desk.until("roll call", ready=True)
            text = self.wait_for_stage(desk, "plan-on-nodes", "ERROR")
            self.assertIn("the patch of another rig or node is on: ", text)
            self.assertIn("left-1", text)
            desk.say("arm", "go")
            wait_for(lambda: any("arm: plan-on-nodes ERROR" in text for text in desk.answers()), "the refusal")
            wait_for(lambda: any("the show is not ready" in text for text in desk.answers()), "the refused GO")
            desk.say("quit")
            desk.process.wait(20)
            for bus in ("left", "middle", "right"):
                on = ["devices", "patch", bus, "--show", self.show, "--transport-map", self.map, "--json"]
                told, _ = footlight(*on, status=4)
                self.assertEqual({n["is"] for n in json.loads(told)["nodes"]}, {"other"})
                told, _ = footlight(*on, "--write")
                self.assertEqual({(n["is"], n["patch"] == n["rig"]) for n in json.loads(told)["nodes"]}, {("same", True)})
            desk = Desk(self, program(), "--count-in", "0", "--scope", "live")
            desk.say("yes", "yes", "yes")
            desk.until("roll call", ready=True)
            self.assertIn("keep this plan and patch", self.wait_for_stage(desk, "plan-on-nodes", "SUCCESS"))
            desk.say("arm", "quit")
            wait_for(lambda: "GO is armed" in desk.answers(), "arm")
            desk.process.wait(20)

        def test_scope_none_opens_nothing(self):
            self.make_show()
            self.serve()
            self.end_of_sim()
            out = json.loads(footlight("run", self.show, "--transport-map", self.map, "--scope", "none", "--json")[0])
            self.assertEqual([s["state"] for s in out["stages"]][:3], ["SUCCESS", "SUCCESS", "OFF"])
            self.assertFalse(out["armed"])

    return Remote
