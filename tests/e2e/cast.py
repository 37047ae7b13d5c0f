"""The cast's phones beside a run: followed, lost, killed, stopped, and in thousands. Part of run.py."""
import asyncio
import base64
import json
import os
import resource
import signal
import struct
import subprocess
import sys
import time
import urllib.error
import urllib.request

from console import Page, free_port, make_stage
from stage import wait_for


class Phone(Page):
    """A phone of the cast (docs/cast.md), as it comes over the wire."""

    def __init__(self, port, token):
        super().__init__(port, None, hello={"token": token})


def processor_s(pid):
    """User and system time of a process."""
    with open(f"/proc/{pid}/stat") as stat:
        fields = stat.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


async def read_frame(reader, writer):
    """The payload of the next text frame; answers pings. None: the connection has ended."""
    while True:
        try:
            kind, length = await reader.readexactly(2)
            if length == 126:
                length = struct.unpack(">H", await reader.readexactly(2))[0]
            elif length == 127:
                length = struct.unpack(">Q", await reader.readexactly(8))[0]
            payload = await reader.readexactly(length)
        except (asyncio.IncompleteReadError, ConnectionError):
            return None
        if kind & 15 == 1:
            return payload
        if kind & 15 == 8:
            return None
        if kind & 15 == 9:
            writer.write(bytes([0x8a, 0x80 | length]) + bytes(4) + payload)


def frame(text):
    """Masked with zeros (RFC 6455, 5.3)."""
    data = text.encode()
    assert len(data) < 65536
    head = bytes([0x81, 0x80 | len(data)]) if len(data) < 126 else bytes([0x81, 0xfe]) + struct.pack(">H", len(data))
    return head + bytes(4) + data


class Crowd:
    """Many phones on one loop; remembers when each was told of each state."""

    def __init__(self, port, token):
        self.port, self.token = port, token
        self.came, self.here, self.ended = {}, 0, 0

    async def phone(self):
        reader, writer = await asyncio.open_connection("127.0.0.1", self.port)
        writer.write(f"GET /ws HTTP/1.1\r\nHost: 127.0.0.1:{self.port}\r\nOrigin: http://127.0.0.1:{self.port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                     f"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: {base64.b64encode(os.urandom(16)).decode()}\r\n\r\n".encode())
        await reader.readuntil(b"\r\n\r\n")
        writer.write(frame(json.dumps({"hello": {"token": self.token}})))
        first = True
        while True:
            payload = await read_frame(reader, writer)
            if payload is None:
                break
            now = time.monotonic()
            self.here += first
            first = False
            state = json.loads(payload).get("state", {})
            self.came.setdefault((state.get("phase"), state.get("position_s")), []).append(now)
        self.ended += 1
        writer.close()


def make_cases(Stage, program, full):
    """The test cases, over stage.py's."""

    class Cast(make_stage(Stage, program)):
        def start_cast(self, *options, follow=None):
            self.cast_out = self.path("cast.txt")
            self.cast = self.start(program(), "cast", self.show, "--follow", follow or f"http://127.0.0.1:{self.port}", *options,
                                   stdout=open(self.cast_out, "w"), stderr=open(self.path("cast.err"), "w"))
            link = wait_for(lambda: (self.assertIsNone(self.cast.poll(), open(self.path("cast.err")).read()), open(self.cast_out).read())[1].strip(), "the link")
            place, self.code = link.split("/#")
            self.cast_port = int(place.rsplit(":", 1)[1])
            self.token = self.join(self.code)

        def join(self, code):
            request = urllib.request.Request(f"http://127.0.0.1:{self.cast_port}/api/pair", data=json.dumps({"code": code}).encode(), headers={
                "Content-Type": "application/json", "X-Footlight": "1", "Origin": f"http://127.0.0.1:{self.cast_port}"})
            with urllib.request.urlopen(request, timeout=20) as answer:
                return json.loads(answer.read())["token"]

        def phone(self):
            phone = Phone(self.cast_port, self.token)
            self.addCleanup(phone.socket.close)
            return phone

        def go(self, page):
            wait_for(lambda: (page.say(order="go"), time.sleep(0.3), page.state.get("phase") != "stands")[2], "GO", 20)

        def test_phones_follow_the_desk_and_get_their_parts_in_the_sheets_words(self):
            self.run_with_console()
            page = Page(self.port, "Ana")
            page.until("roll call", ready=True)
            self.start_cast()
            phone = self.phone()
            phone.until("the desk is heard", heard=True, same_plan=True, phase="stands", standby="1")
            with self.assertRaises(urllib.error.HTTPError) as no_token:
                urllib.request.urlopen(f"http://127.0.0.1:{self.cast_port}/api/show", timeout=20)
            self.assertEqual(no_token.exception.code, 401)
            no_token.exception.close()
            request = urllib.request.Request(f"http://127.0.0.1:{self.cast_port}/api/show", headers={"Authorization": "Bearer " + self.token})
            with urllib.request.urlopen(request, timeout=20) as answer:
                show = json.loads(answer.read())
            self.assertEqual((show["title"], len(show["performers"])), ("Twelve", 12))
            phone.say(part={"who": 4, "language": "en"})
            wait_for(lambda: phone.heard("part"), "her part")
            part = phone.heard("part")[0]
            self.assertEqual(part["who"], 4)
            self.assertRegex(part["places"][0]["way"], "stage (left|right).* foot first, there at 13")
            self.go(page)
            phone.until("the walk", phase="runs", cue="1")
            page.until("the end of the cue", phase="stands", standby="2")
            phone.until("the end of the cue", phase="stands", standby="2")
            phone.say(where={"who": 4, "cell": 0, "language": "en"})
            wait_for(lambda: phone.heard("where"), "where to go")
            self.assertIn(phone.heard("where")[0]["kind"], ("join", "wait"))
            # The view that the cast has is one that gives no orders, and it gives none.
            self.assertEqual([p["role"] for p in page.heard("people")[-1] if p["name"] == "cast"], ["view"])
            with open(os.path.join(os.environ["XDG_STATE_HOME"], "footlight", "console.log")) as log:
                said = [json.loads(line)["what"] for line in log if json.loads(line)["who"] == "cast"]
            self.assertEqual(said, ["hello"])
            page.say(order="quit")
            self.assertEqual(self.report()["unconfirmed"], 0)
            phone.until("the desk is gone", heard=False)
            self.cast.send_signal(signal.SIGINT)
            self.assertEqual(self.cast.wait(20), 0)

        def test_a_desk_that_is_away_is_told_plainly_and_found_again(self):
            self.make_show()
            port = free_port()
            self.port = port
            self.start_cast()
            phone = self.phone()
            phone.until("nobody is there", heard=False)
            self.start(program(), "console", self.show, "--console", str(port), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            phone.until("the desk", heard=True, same_plan=True)

        def test_another_version_of_the_show_is_told_until_it_is_read(self):
            self.run_with_console()
            Page(self.port, "Ana").until("roll call", ready=True)
            text = open(self.show).read()
            with open(self.show, "w") as f:
                f.write(text.replace("title: Twelve", "title: Other"))
            self.start_cast()
            phone = self.phone()
            phone.until("another version", heard=True, same_plan=False)
            with open(self.show, "w") as f:
                f.write(text)
            phone.until("the same version", same_plan=True)

        def test_killing_or_stopping_the_cast_does_nothing_to_the_show(self):
            self.run_with_console()
            page = Page(self.port, "Ana")
            page.until("roll call", ready=True)
            self.start_cast()
            self.phone().until("the desk is heard", heard=True)
            self.cast.send_signal(signal.SIGSTOP)
            self.go(page)
            page.until("the end of the cue", phase="stands", standby="2")
            self.cast.kill()
            self.go(page)
            page.until("the end", phase="finished")
            page.say(order="quit")
            report = self.report()
            self.assertEqual((report["unconfirmed"], report["refused"] if "refused" in report else 0), (0, 0))
            self.assert_floor(report)

        def play_a_cue_alone(self):
            """What a run reports that nobody follows."""
            page = Page(self.port, "Ana")
            page.until("roll call", ready=True)
            time.sleep(10)
            self.go(page)
            page.until("the end of the cue", phase="stands", standby="2")
            page.say(order="quit")
            return self.report()

        def crowd_of(self, phones):
            """Five changes and a cue for so many phones. Returns how long after the first one each was told of each change, s."""
            most = resource.getrlimit(resource.RLIMIT_NOFILE)[1]
            resource.setrlimit(resource.RLIMIT_NOFILE, (most, most))
            if most < phones + 500:
                self.skipTest(f"only {most} open files")
            self.run_with_console()
            alone = self.play_a_cue_alone()
            self.start_run()
            page = Page(self.port, "Ana")
            page.until("roll call", ready=True)
            page.say(seat="take")
            p99 = {}

            def measure(what):
                """By a process of its own: this one is busy being five thousand phones."""
                done = subprocess.run([sys.executable, os.path.abspath(__file__), str(self.port)], capture_output=True, text=True, check=True)
                p99[what] = float(done.stdout)
            measure("alone")
            self.start_cast("--phones", str(phones + 100))
            crowd = Crowd(self.cast_port, self.token)

            def play():
                self.assertEqual(crowd.ended, 0, "nobody was sent away")
                self.go(page)
                page.until("the end of the cue", phase="stands", standby="2")

            async def come():
                gate = asyncio.Semaphore(100)

                async def one():
                    async with gate:
                        task = asyncio.ensure_future(crowd.phone())
                        await asyncio.sleep(0.02)
                    await task
                tasks = [asyncio.ensure_future(one()) for _ in range(phones)]
                while crowd.here < phones:
                    await asyncio.sleep(0.1)
                    self.assertEqual(crowd.ended, 0)
                for tempo in (60, 50, 40, 30, 25):
                    crowd.came.clear()
                    used, begun = processor_s(self.cast.pid), time.monotonic()
                    page.say(order=f"tempo {tempo}")
                    while not any(len(times) >= phones for times in crowd.came.values()) and time.monotonic() < begun + 60:
                        await asyncio.sleep(0.05)
                    letters = sum(map(len, crowd.came.values()))
                    cost.append((processor_s(self.cast.pid) - used) / letters)
                    first = min(min(times) for times in crowd.came.values())
                    took.extend(when - first for times in crowd.came.values() for when in times[:phones])
                await asyncio.get_running_loop().run_in_executor(None, measure, "with phones")
                await asyncio.get_running_loop().run_in_executor(None, play)
                for task in tasks:
                    task.cancel()
                await asyncio.gather(*tasks, return_exceptions=True)
            took, cost = [], []
            asyncio.run(come())
            page.say(order="quit")
            report = self.report()
            self.assertEqual(report["unconfirmed"], 0)
            took.sort()
            print(f"\n{phones} phones: a state reaches them in p50 {1e3 * took[len(took) // 2]:.0f} ms, p99 {1e3 * took[int(0.99 * len(took))]:.0f} ms "
                  f"of the first one, for {1e6 * sorted(cost)[len(cost) // 2]:.0f} us of the cast's processor time each; the console answers in p99 {1e3 * p99['alone']:.1f} ms alone, {1e3 * p99['with phones']:.1f} ms with them; "
                  f"the show's threads wake late by p99 {alone['wake_lateness']['p99_ms']:.2f} ms (a bare timer: {alone['bare_timer']['p99_ms']:.2f}) alone, "
                  f"{report['wake_lateness']['p99_ms']:.2f} ms ({report['bare_timer']['p99_ms']:.2f}) with them")
            return took

        def test_five_hundred_phones_are_told_of_every_change(self):
            self.assertGreaterEqual(len(self.crowd_of(500)), 5 * 500)

        if full:
            def test_five_thousand_phones_are_told_of_every_change(self):
                self.assertGreaterEqual(len(self.crowd_of(5000)), 5 * 5000)

    return Cast


def answers_of_the_console(port):
    """p99 of a hundred answers, s: a ping while the show stands."""
    page = Page(port, "Clock")
    times = []
    for number in range(100):
        begun = time.monotonic()
        page.say(ping=number)
        while number not in page.heard("pong"):
            time.sleep(0.0005)
        times.append(time.monotonic() - begun)
        page.told.clear()
        time.sleep(0.02)
    return sorted(times)[98]


if __name__ == "__main__":
    print(answers_of_the_console(int(sys.argv[1])))
