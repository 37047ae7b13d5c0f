"""The console's server as browsers and others meet it, against `footlight sim`. Part of run.py."""
import base64
import json
import os
import signal
import socket
import struct
import subprocess
import threading
import time
import urllib.error
import urllib.request

from stage import wait_for


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Page:
    """A client of the console that follows what it is told (docs/console.md)."""

    def __init__(self, port, name, token=None, host=None, hello=None):
        self.socket = socket.create_connection(("127.0.0.1", port), 20)
        host = host or f"127.0.0.1:{port}"
        self.send(f"GET /ws HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                  f"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: {base64.b64encode(os.urandom(16)).decode()}\r\n\r\n".encode())
        self.got = b""
        while b"\r\n\r\n" not in self.got:
            more = self.socket.recv(4096)
            if not more:
                raise ConnectionError(self.got)
            self.got += more
        head, _, self.got = self.got.partition(b"\r\n\r\n")
        if not head.startswith(b"HTTP/1.1 101"):
            raise ConnectionError(head)
        self.state, self.told, self.frames, self.code = {}, [], [], None
        self.say(hello=hello or {"name": name, **({"token": token} if token else {})})
        self.reader = threading.Thread(target=self.read, daemon=True)
        self.reader.start()

    def send(self, data):
        self.socket.sendall(data)

    def say(self, **message):
        text = json.dumps(message).encode()
        size = bytes([0x80 | len(text)]) if len(text) < 126 else bytes([0x80 | 126]) + struct.pack(">H", len(text))
        self.send(b"\x81" + size + bytes(4) + text)

    def frame(self):
        def take(size):
            while len(self.got) < size:
                more = self.socket.recv(65536)
                if not more:
                    raise ConnectionError
                self.got += more
            out, self.got = self.got[:size], self.got[size:]
            return out
        kind, length = take(2)
        if length == 126:
            length = struct.unpack(">H", take(2))[0]
        elif length == 127:
            length = struct.unpack(">Q", take(8))[0]
        return kind & 15, take(length)

    def read(self):
        try:
            while True:
                kind, payload = self.frame()
                if kind == 8:
                    self.code = struct.unpack(">H", payload[:2])[0] if payload else 1005
                    return
                if kind == 9:
                    self.send(b"\x8a" + bytes([0x80 | len(payload)]) + bytes(4) + payload)
                elif kind == 2:
                    self.frames.append(payload)
                elif kind == 1:
                    message = json.loads(payload)
                    self.told.append(message)
                    self.state = message.get("state", self.state)
        except (OSError, ConnectionError):
            if self.code is None:
                self.code = 0

    def heard(self, key):
        return [message[key] for message in list(self.told) if key in message]

    def until(self, told, **wanted):
        return wait_for(lambda: all(self.state.get(key) == value for key, value in wanted.items()), f"{told}: {wanted}, not {self.state}", 60)

    def nodes(self):
        """By node: (switch, flags of what it shows), as a page has them."""
        known = {}
        for frame in list(self.frames):
            assert frame[0] == 1 and len(frame) == 8 + 16 * struct.unpack_from("<I", frame, 4)[0], frame
            if frame[1] & 1:
                known = {}
            for at in range(8, len(frame), 16):
                first, count, shown, flags = struct.unpack_from("<4I", frame, at)
                known.update({n: (shown, flags & 15) for n in range(first, first + count)})
        return known


def make_stage(Stage, program):
    """What test cases of a run with a console derive from, over stage.py's."""

    class Led(Stage):
        def run_with_console(self, *options, place=None):
            self.make_show()
            self.serve()
            self.start_run(*options, place=place)

        def start_run(self, *options, place=None):
            """On the markers that are served already."""
            self.port = free_port()
            self.process = subprocess.Popen([program(), "run", self.show, "--transport-map", self.map, "--status-lines", "--go-guard", "0.2", "--count-in", "1",
                                         "--console", place.format(self.port) if place else str(self.port), *options],
                                        stdin=subprocess.PIPE, stdout=open(self.path("run.jsonl"), "w"), stderr=open(self.path("run.txt"), "w"), text=True)

            def end():
                if self.process.poll() is None:
                    self.process.kill()
                self.process.wait()
                self.process.stdin.close()
            self.addCleanup(end)

            def listens():
                self.assertIsNone(self.process.poll(), open(self.path("run.txt")).read())
                with socket.socket() as probe:
                    return probe.connect_ex(("127.0.0.1", self.port)) == 0
            wait_for(listens, "the console")

        def get(self, target, **headers):
            """(status, headers, body)"""
            request = urllib.request.Request(f"http://127.0.0.1:{self.port}{target}", headers={k.replace("_", "-"): v for k, v in headers.items()})
            try:
                with urllib.request.urlopen(request, timeout=20) as answer:
                    return answer.status, answer.headers, answer.read()
            except urllib.error.HTTPError as error:
                with error:
                    return error.code, error.headers, error.read()

        def report(self):
            self.assertEqual(self.process.wait(60), 0, open(self.path("run.txt")).read())
            with open(self.path("run.jsonl")) as f:
                return json.loads(f.read().splitlines()[-1])["report"]

        def play_to_the_end(self, page):
            """GO, GO by whoever is `page`, to the end of the show."""
            for cue in ("1", "2"):
                page.until("a cue to start", phase="stands", standby=cue)
                wait_for(lambda: (page.say(order="go"), time.sleep(0.3), page.state.get("phase") != "stands")[2], "GO", 20)
            page.until("the end", phase="finished")
            wait_for(lambda: all(bus["unconfirmed"] == 0 for bus in page.state["buses"]), "every marker")

    return Led


def make_cases(Stage, footlight, program):
    """The test cases, over stage.py's."""

    class Console(make_stage(Stage, program)):
        def test_a_show_is_led_from_the_console_and_every_document_is_right(self):
            self.run_with_console()
            page = Page(self.port, "Ana")
            page.until("roll call", ready=True)
            status, headers, body = self.get("/api/show")
            self.assertEqual(status, 200)
            show = json.loads(body)
            self.assertEqual((show["title"], len(show["performers"]), show["nodes"]), ("Twelve", 12, 12))
            self.assertGreater(show["cues"][1]["most_percent"], 100)
            status, headers, plan = self.get("/api/plan.bin")
            self.assertEqual((plan[:4], struct.unpack_from("<4I", plan, 4)[:3]), (b"FLPM", (1, show["epoch"], 12)))
            self.play_to_the_end(page)
            wait_for(lambda: set(page.nodes().values()) == {(page.state["switch"], 1)}, "every node right, at the switch that is lit")
            self.assertEqual(len(page.nodes()), 12)
            status, headers, looks = self.get(f"/api/looks/{page.state['switch']}.bin")
            self.assertEqual((status, looks[:4], len(looks)), (200, b"FLLK", 20 + 32 * 12))
            self.assertEqual(self.get("/api/looks/4000000000.bin")[0], 404)
            page.say(order="quit")
            report = self.report()
            self.assertEqual(report["unconfirmed"], 0)
            for n, node in enumerate(report["floor"]):
                self.assertEqual(list(looks[20 + 32 * n:][:len(node["looks"])]), node["looks"])
            wait_for(lambda: page.code is not None, "the farewell")
            self.assertEqual(page.code, 1001)
            self.assert_floor(report)

        def test_a_flood_during_a_show_costs_orders_and_no_marker(self):
            self.run_with_console()
            page = Page(self.port, "Ana")
            page.until("roll call", ready=True)
            page.say(seat="take")
            over = threading.Event()
            closed = []

            def orders():
                """Another operator who gives orders as fast as the wire takes them."""
                while not over.is_set():
                    try:
                        other = Page(self.port, "Flood")
                        while not over.is_set() and other.code is None:
                            for order in ("go", "tempo 25", "jump cue 1", "hold end x", "quit"):
                                other.say(order=order)
                        closed.append(other.code)
                    except (OSError, ConnectionError):
                        pass

            def requests():
                while not over.is_set():
                    try:
                        self.get("/api/show")
                    except OSError:
                        pass

            def rubbish():
                while not over.is_set():
                    try:
                        with socket.create_connection(("127.0.0.1", self.port), 5) as one:
                            one.sendall(os.urandom(2000))
                    except OSError:
                        pass
            loris = [socket.create_connection(("127.0.0.1", self.port), 20) for _ in range(40)]
            for one in loris:
                one.sendall(b"GET / HTTP/1.1\r\nX: ")
            threads = [threading.Thread(target=work) for work in (orders, requests, rubbish)]
            for thread in threads:
                thread.start()
            try:
                self.play_to_the_end(page)
            finally:
                over.set()
                for thread in threads:
                    thread.join()
                for one in loris:
                    one.close()
            page.say(order="quit")
            report = self.report()
            self.assertEqual(report["unconfirmed"], 0)
            self.assertEqual(report["deaf"], 0)
            self.assertIn(4429, closed, "a flood is cut off")
            self.assertTrue(all(answer["refused"] for answer in page.heard("answer") if answer["who"] == "Flood" and not answer["order"].startswith("hold")))
            self.assert_floor(report)

        def test_every_operator_may_hold_and_the_seat_is_seen(self):
            self.run_with_console()
            ana, ben = Page(self.port, "Ana"), Page(self.port, "Ben")
            ana.until("roll call", ready=True)
            ana.say(seat="take")
            wait_for(lambda: any(seat and seat["name"] == "Ana" for seat in ben.heard("seat")), "the seat")
            ana.say(order="go")
            ben.until("cue 1", phase="runs")
            ben.say(order="go", id=1)
            wait_for(lambda: any(a.get("id") == 1 for a in ben.heard("answer")), "the refusal")
            self.assertEqual([a["text"] for a in ben.heard("answer") if a.get("id") == 1], ["somebody else has the seat: take it first"])
            ben.say(order="hold", id=2)
            ana.until("the hold", phase="stands", cue="1")
            self.assertIn({"order": "hold", "who": "Ben", "refused": False, "text": "done"}, ana.heard("answer"))
            with open(os.path.join(os.environ["XDG_STATE_HOME"], "footlight", "console.log")) as f:
                lines = [json.loads(line) for line in f]
            plan = json.loads(self.get("/api/show")[2])["plan"]
            self.assertTrue(any((line["who"], line["from"], line["what"], line["result"], line["cue"], line["plan"]) == ("Ben", "127.0.0.1", "order hold", "done", "1", plan)
                                for line in lines), lines)

        def test_another_address_asks_for_a_token_that_nobody_else_may_read(self):
            self.run_with_console(place="0.0.0.0:{}")
            self.assertEqual(self.get("/api/show")[0], 401)
            self.assertEqual(self.get("/")[0], 200)
            stranger = Page(self.port, "Eve")
            wait_for(lambda: stranger.code is not None, "the refusal")
            self.assertEqual(stranger.code, 4401)
            file = os.path.join(os.environ["XDG_STATE_HOME"], "footlight", "console.token")
            self.assertEqual(os.stat(file).st_mode & 0o777, 0o600)
            with open(file) as f:
                token = f.read().strip()
            self.assertEqual(len(token), 64)
            page = Page(self.port, "Ana", token)
            page.until("roll call", ready=True)
            self.assertEqual(self.get("/api/show", Authorization=f"Bearer {token}")[0], 200)
            self.assertEqual(self.get(f"/api/show?token={token}")[0], 404)
            self.assertEqual(self.get("/api/show", Authorization=f"Bearer {token}", Host="evil.example")[0], 421)
            self.process.kill()
            self.process.wait()
            os.chmod(file, 0o644)
            _, said = footlight("run", self.show, "--transport-map", self.map, "--console", f"0.0.0.0:{self.port}", status=2)
            self.assertIn(f"console token {file}: others may read it (mode 644); chmod 600 it, or remove it for a new one", said)

        def test_a_plan_is_looked_at_without_buses_and_nobody_gives_orders(self):
            self.make_show()
            process = self.start(program(), "console", self.show, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
            address = process.stdout.readline().strip()
            self.assertTrue(address.startswith("http://127.0.0.1:"), address)
            self.port = int(address.rsplit(":", 1)[1])
            page = Page(self.port, "Ana")
            page.until("the state", phase="stands", standby="1")
            self.assertEqual(page.heard("welcome")[0]["role"], "view")
            page.say(order="go", id=1)
            page.say(order="hold", id=2)
            wait_for(lambda: len(page.heard("answer")) == 2, "the refusals")
            self.assertEqual({answer["text"] for answer in page.heard("answer")}, {"who views gives no orders"})
            show = json.loads(self.get("/api/show")[2])
            self.assertEqual(self.get(f"/api/looks/{show['switches'] - 1}.bin")[0], 200)
            process.send_signal(signal.SIGINT)
            self.assertEqual(process.wait(20), 0)
            process.stdout.close()

        def test_a_place_that_is_none_is_refused(self):
            self.make_show()
            self.serve()
            for place in ("here", "8440x", "70000", "example.org:8440", "1.2.3:8440", ":"):
                _, said = footlight("run", self.show, "--transport-map", self.map, "--console", place, status=2)
                self.assertIn(f'"{place}" is no place for the console: a port, as 8440, or a numeric address of this machine and a port, as '
                              "192.168.1.5:8440 or [::1]:8440", said)

    return Console
