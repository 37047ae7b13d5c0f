#!/usr/bin/python3
"""A program that speaks the console's protocol (docs/console.md) and has a show of any size, to measure the page with: people in blocks walk to and
fro, every cell has a lamp, nodes confirm every switch. No planner, no bus, no guard: what the page does with a real run is tested against one.

    stand_in.py PAGE_FOLDER PEOPLE [PORT]      prints the port"""
import base64
import hashlib
import http.server
import json
import math
import os
import struct
import sys
import threading
import time

import numpy

PERIOD_S, WALK_S, MOVES = 4.0, 3.0, 40
KINDS = {".html": "text/html; charset=utf-8", ".js": "text/javascript", ".css": "text/css"}
POLICY = "default-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'; object-src 'none'"


class Made:
    """A show of `people` on every second column of a square grid; at each move all walk by one column, back at the next one."""

    def __init__(self, people):
        side = math.ceil(math.sqrt(2 * people))
        self.columns, self.rows, self.people = side + side % 2 + 2, side, people
        at = numpy.arange(people)
        half = self.columns // 2 - 1
        home = (at // half) * self.columns + 2 * (at % half)
        # A wait and a walk for each move: two marks.
        times = numpy.array([t for k in range(MOVES) for t in (k * PERIOD_S, k * PERIOD_S + PERIOD_S - WALK_S)] + [MOVES * PERIOD_S], dtype="<f4")
        step = numpy.array([k // 2 % 2 for k in range(2 * MOVES)] + [MOVES % 2])
        cells = home[:, None] + step[None, :]
        self.plan = struct.pack("<4sIIII", b"FLPM", 1, 1, people, people * len(times)) + (numpy.arange(people + 1, dtype="<u4") * len(times)).tobytes() \
            + numpy.tile(times, people).tobytes() + cells.astype("<u4").tobytes()
        self.nodes = math.ceil(self.columns * self.rows / 32)
        self.show = {
            "epoch": 1, "title": f"{people} people", "version": "", "plan": "0" * 64, "markers": self.columns * self.rows, "nodes": self.nodes, "switches": MOVES, "role": "admin",
            "stage": {"grid": "square", "columns": self.columns, "rows": self.rows, "pitch_m": 1, "clearance_m": 0.5, "blocked": [], "wings": []},
            "groups": [{"name": f"g{k}", "colour": colour, "exchange": True} for k, colour in enumerate(["#FFB000", "#64B4FF", "#DC5AA0", "#60D060"])],
            "performers": [{"id": f"P{i + 1}", "name": f"P{i + 1}", "group": int(i * 4 // people)} for i in range(people)],
            "sections": [{"name": "all", "start_s": 0, "end_s": MOVES * PERIOD_S, "start_count": 1, "max_speed_mps": 1.4, "notes": []}],
            "formations": [{"id": f"all/{k}", "section": 0, "count": 1 + 8 * k, "time_s": k * PERIOD_S, "key": True} for k in range(MOVES)],
            "cues": [{"number": str(k + 1), "name": f"Cue {k + 1}", "from_s": 40.0 * k, "to_s": 40.0 * k + 40, "gap_after_s": 0, "continue": "auto-follow"} for k in range(4)],
            "tempo": [{"count": 1, "time_s": 0, "bpm": 120}], "meter": [{"count": 1, "beats": 4}],
            "switch_at": [{"time_s": k * PERIOD_S, "cause": "", "cue": None} for k in range(MOVES)],
            "buses": [{"name": "all", "kind": "can", "url": ""}],
            "rig": [{"name": f"n{n}", "bus": 0, "address": n, "channels": [c if c < self.columns * self.rows else None for c in range(32 * n, 32 * n + 32)]} for n in range(self.nodes)],
            "looks": [{"colour": c, "effect": "steady", "brightness": b} for c, b in (("#000000", 0), ("#FFB000", 255), ("#64B4FF", 255))],
        }
        self.show_text = json.dumps(self.show).encode()
        self.home = home

    def looks(self, k):
        lamps = numpy.zeros(self.nodes * 32, dtype="u1")
        lamps[self.home + k % 2] = 1 + k % 2
        return struct.pack("<4sIIII", b"FLLK", 1, 1, k, self.nodes) + lamps.tobytes()


def message(data, kind=1):
    size = len(data)
    head = bytes([0x80 | kind]) + (bytes([size]) if size < 126 else b"\x7e" + struct.pack(">H", size) if size < 65536 else b"\x7f" + struct.pack(">Q", size))
    return head + data


def page_of(made, folder):
    class Page(http.server.BaseHTTPRequestHandler):
        protocol_version = "HTTP/1.1"

        def log_message(self, *_):
            pass

        def do_GET(self):
            path = self.path.split("?")[0]
            if path == "/ws":
                return self.talk()
            if path == "/api/show":
                return self.answer(made.show_text, "application/json")
            if path == "/api/plan.bin":
                return self.answer(made.plan, "application/octet-stream")
            if path.startswith("/api/looks/") and path[11:-4].isdigit() and int(path[11:-4]) < MOVES:
                return self.answer(made.looks(int(path[11:-4])), "application/octet-stream")
            name = "index.html" if path == "/" else path[1:]
            if "/" in name or not os.path.isfile(os.path.join(folder, name)):
                return self.answer(b"{}", "application/json", 404)
            with open(os.path.join(folder, name), "rb") as f:
                self.answer(f.read(), KINDS[os.path.splitext(name)[1]])

        def answer(self, body, kind, status=200):
            self.send_response(status)
            for name, value in (("Content-Type", kind), ("Content-Length", len(body)), ("Content-Security-Policy", POLICY), ("Cache-Control", "no-store")):
                self.send_header(name, str(value))
            self.end_headers()
            self.wfile.write(body)

        def talk(self):
            key = self.headers["Sec-WebSocket-Key"] + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11"
            self.send_response(101)
            for name, value in (("Upgrade", "websocket"), ("Connection", "Upgrade"), ("Sec-WebSocket-Accept", base64.b64encode(hashlib.sha1(key.encode()).digest()).decode())):
                self.send_header(name, value)
            self.end_headers()
            self.close_connection = True
            try:
                self.tell()
            except OSError:
                pass

        def say(self, document):
            self.wfile.write(message(json.dumps(document).encode()))

        def tell(self):
            self.say({"welcome": {"you": 1, "role": "admin", "version": "", "plan": made.show["plan"], "epoch": 1, "run": "00000000"}})
            self.say({"seat": {"holder": 1, "name": "page"}})
            begin, last = time.monotonic(), -1
            while True:
                at = min(time.monotonic() - begin, MOVES * PERIOD_S - 0.01)
                k = int(at / PERIOD_S)
                if k != last:
                    last = k
                    self.wfile.write(message(struct.pack("<BBHIIIII", 1, 1, 0, 1, 0, made.nodes, k, 1), 2))
                self.say({"state": {"phase": "runs", "position_s": at, "rate": 1, "section": "all", "measure": f"{int(at / 2) + 1}:{int(at * 2) % 4 + 1}", "count": 1 + at * 2, "cue": str(int(at / 40) + 1),
                                    "standby": str(int(at / 40) + 2), "goes_in_s": None, "ends_in_s": 40 - at % 40, "tempo_percent": 100, "most_percent": 118, "holds_at_end": False, "loop": None,
                                    "reset": {"state": "none"}, "switch": k, "ready": True, "buses": [{"name": "all", "nodes": made.nodes, "unconfirmed": 0}]}})
                time.sleep(0.1)

    return Page


def serve(folder, people, port=0):
    server = http.server.ThreadingHTTPServer(("127.0.0.1", port), page_of(Made(people), folder))
    server.daemon_threads = True
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return server


if __name__ == "__main__":
    print(serve(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]) if len(sys.argv) > 3 else 0).server_port, flush=True)
    threading.Event().wait()
