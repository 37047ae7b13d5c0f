"""The show in real time: `footlight sim` on one side; `footlight run`, and programs of other hands, on the other. Part of run.py."""
import json
import os
import signal
import subprocess
import sys
import threading
import time

from stage import HERE, SHOW, wait_for


def make_cases(Stage, footlight, program):
    """The test cases, over stage.py's."""

    class Live(Stage):
        def test_a_show_is_right_on_every_marker_over_ptys_and_tcp(self):
            self.make_show()
            self.serve()
            report = self.play()
            self.assertEqual(report["unconfirmed"], 0, report)
            self.assertEqual({b["kind"] for b in report["buses"]}, {"serial", "modbus-rtu", "modbus-tcp"})
            for bus in report["buses"]:
                self.assertGreater(bus["deliveries"], 0, bus)
            self.assertGreater(report["cues"][1]["go_to_last_lamp_ms"], 0, "the second cue is started by GO and lights lamps at once")
            self.assert_floor(report)

        def test_a_line_that_garbles_and_is_cut_for_a_second_is_right_in_the_end(self):
            self.make_show(("left", "middle"))
            urls = self.serve()
            plugs = [self.bad_line(bus, urls[bus], 0.05) for bus in urls]
            cables = [plug() for plug in plugs]
            said = []
            run = self.start(program(), "run", self.show, "--transport-map", self.map, "--go", "--json", stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            reader = threading.Thread(target=lambda: said.append(run.communicate()))
            reader.start()
            wait_for(lambda: any(c["look"] not in (0, 255) for c in self.changes()), "the opening")
            time.sleep(1)
            for cable in cables:
                cable.terminate()  # so that its link goes, too: a link that is left leads to whichever terminal comes next
                cable.wait()
            time.sleep(1)
            cables = [plug() for plug in plugs]
            reader.join(60)
            self.assertEqual(run.returncode, 0, said)
            report = json.loads(said[0][0])
            self.assertEqual(report["unconfirmed"], 0)
            for bus in report["buses"]:
                self.assertGreater(bus["misses"], 0, "the cable did nothing")
            self.assert_floor(report)

        def test_faults_by_name_are_overcome(self):
            self.make_show()
            self.serve("--faults", "loss=5%,corrupt=1%,reboot=2,until=60%", "--seed", "3")
            report = self.play()
            self.assertEqual(report["unconfirmed"], 0, report)
            self.assert_floor(report)

        def test_a_second_controller_after_a_killed_one_finds_the_floor_as_it_is(self):
            self.make_show()
            self.serve()
            first = self.start(program(), "run", self.show, "--transport-map", self.map, "--go", stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            wait_for(lambda: any(c["look"] not in (0, 255) for c in self.changes()), "the opening")
            first.kill()
            first.wait()
            report = self.play()
            self.assertEqual(report["unconfirmed"], 0, report)
            self.assert_floor(report)

        def test_an_interrupted_run_makes_no_lamp_dark(self):
            self.make_show()
            self.serve()
            run = self.start(program(), "run", self.show, "--transport-map", self.map, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
            while "every node shows the opening" not in run.stderr.readline():
                self.assertIsNone(run.poll())
            lit = len(self.changes())
            run.send_signal(signal.SIGINT)
            self.assertIn("interrupted: the lamps keep what they show until their lease ends", run.communicate(timeout=20)[1])
            self.assertEqual(run.returncode, 130)
            wait_for(lambda: set({(c["node"], c["channel"]): c["look"] for c in self.changes()}.values()) == {255}, "the leases to end")
            self.assertEqual({c["look"] for c in self.changes()[lit:]}, {255}, "NO-GUIDANCE, and nothing else")

        def test_a_plan_that_is_refused_never_reaches_a_marker(self):
            self.make_show(show=SHOW.replace("start: count 13", "start: count 4"))
            self.serve()
            _, said = footlight("run", self.show, "--transport-map", self.map, "--go", status=3)
            self.assertIn("performer 8 would walk 6.1 m from H2 to G8", said)
            self.assertEqual({look for looks in self.end_of_sim().values() for look in looks.values()}, {255})

        def test_a_bus_without_a_wire_and_a_port_that_is_not_there_are_told(self):
            self.make_show()
            _, said = footlight("run", self.show, "--go", status=4)
            self.assertIn('bus "left": serial port "/dev/nowhere": No such file or directory', said)
            self.assertIn('bus "middle": serial port "/dev/nowhere": No such file or directory', said)
            with open(self.path("s", "rig.yaml")) as f:
                rig = f.read()
            with open(self.path("s", "rig.yaml"), "w") as f:
                f.write(rig.replace("serial:///dev/nowhere", "sim://serial"))
            _, said = footlight("run", self.show, "--go", status=2)
            self.assertIn("no wire for these buses: left (a real URL in the rig or in --transport-map", said)

        def test_mbpoll_reads_and_writes_rtu_and_tcp_markers(self):
            self.make_show()
            urls = self.serve()
            port = urls["right"].rsplit(":", 1)[1]
            for line in (["-m", "rtu", "-b", "115200", "-P", "even", urls["middle"].split("://")[1]], ["-m", "tcp", "-p", port, "127.0.0.1"]):
                def mbpoll(*options, values=()):
                    done = subprocess.run(["mbpoll", "-1", "-q", "-0", "-a", "2", *options, *line, *values], capture_output=True, text=True, timeout=60)
                    self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                    return done.stdout
                self.assertIn("[67]: \t1", mbpoll("-r", "64", "-c", "6"), "one boot")
                self.assertIn("Written 5 references", mbpoll("-r", "0", values=map(str, (9, 0x0102, 0x0304, 0x0506, 0x0708))))
                self.assertIn("[64]: \t9", mbpoll("-r", "64", "-c", "1"), "pending")
                self.assertIn("Written 3 references", mbpoll("-r", "32", values=map(str, (9, 9 ^ 0x5A5A, 9 ^ 0xA5A5))))
                self.assertIn(f"[64]: \t{9 << 8}", mbpoll("-r", "64", "-c", "1"), "shown")
            floor = self.end_of_sim()
            for node in ("middle-2", "right-2"):
                self.assertEqual(floor[node], {i: i + 1 for i in range(8)})

        def test_pymodbus_reads_and_writes_rtu_and_tcp_markers(self):
            from pymodbus.client import ModbusSerialClient, ModbusTcpClient
            self.make_show()
            urls = self.serve()
            # No parity: pyserial asks for it anew at every change and takes it ill that a pseudo-terminal has none.
            clients = [ModbusSerialClient(urls["middle"].split("://")[1], baudrate=115200, parity="N", timeout=10),
                       ModbusTcpClient("127.0.0.1", port=int(urls["right"].rsplit(":", 1)[1]), timeout=10)]
            for client in clients:
                self.assertTrue(client.connect())
                self.assertFalse(client.write_registers(0, [7, 0x0A0B, 0x0C0D, 0x0E0F, 0x1011], slave=3).isError())
                self.assertFalse(client.write_registers(32, [7, 7 ^ 0x5A5A, 7 ^ 0xA5A5], slave=3).isError())
                status = client.read_holding_registers(64, 6, slave=3)
                self.assertEqual(status.registers[0], 7 << 8)
                self.assertEqual(status.registers[2], 1, "showing")
                self.assertEqual(client.read_holding_registers(64, 7, slave=3).exception_code, 2)
                client.close()
            floor = self.end_of_sim()
            for node in ("middle-3", "right-3"):
                self.assertEqual(floor[node], {i: i + 10 for i in range(8)})

        def test_our_driver_drives_a_pymodbus_server(self):
            """A foreign device: looks act at once, one a register, nothing can be read back."""
            profile = self.path("foreign.yaml")
            with open(profile, "w") as f:
                f.write("profile: 1\nname: foreign\nlook_register: 100\nlooks_per_register: 1\npreload_sequence: false\n")
            self.make_show(("right",), profile=profile)
            port, registers = self.path("port"), self.path("registers.json")
            self.start(sys.executable, os.path.join(HERE, "modbus_server.py"), port, registers, "12")
            with open(wait_for(lambda: os.path.exists(port) and port, "the server")) as f:
                number = f.read()
            self.map = self.path("map.yaml")
            with open(self.map, "w") as f:
                f.write(f"transports: 1\nbuses:\n  - {{name: right, url: 'tcp://127.0.0.1:{number}'}}\n")
            report = self.play()
            self.assertEqual(report["unconfirmed"], 0)
            self.assertGreater(report["buses"][0]["unverified"], 0)
            self.assertEqual(report["buses"][0]["deliveries"], 0, "nothing is taken for proved")
            with open(registers) as f:
                held = json.load(f)
            for address, node in enumerate(report["floor"], 1):
                self.assertEqual(held[str(address)], node["looks"], node["node"])

        def tshark(self, file, display="", *options):
            """Protocols of each packet that passes the filter, with CAN read as CANopen."""
            done = subprocess.run(["tshark", "-r", file, "-d", "can.subdissector,canopen", *(["-Y", display] if display else []),
                                   "-T", "fields", "-e", "frame.protocols", "-e", "_ws.col.Info", *options], capture_output=True, text=True, timeout=120)
            self.assertEqual(done.returncode, 0, done.stderr)
            return [line.split("\t") for line in done.stdout.splitlines()]

        def assert_understood(self, file, kinds):
            """tshark reads all of the file, finds nothing malformed, and knows each language for what it is."""
            packets = self.tshark(file)
            self.assertEqual(self.tshark(file, "_ws.malformed || tcp.checksum.status == 0 || _ws.expert.severity >= 0x00800000", "-o", "tcp.check_checksum:TRUE"), [])
            self.assertEqual(self.tshark(file, "tcp.analysis.flags"), [], "one connection without a gap")
            info = {protocol: [i for p, i in packets if p.split(":")[0] == protocol] for protocol in ("can", "ip", "exported_pdu", "rtacser")}
            for kind in kinds:
                self.assertGreater(len(info[kind]), 20, kind)
            if "ip" in kinds:
                self.assertTrue(all(p == "ip:tcp:mbtcp:modbus" for p, _ in packets if p.startswith("ip")))
                self.assertTrue(any("Response: Trans:" in i and "Write Multiple Registers" in i for i in info["ip"]))
            if "exported_pdu" in kinds:
                # The dissector takes no unit 0: broadcasts are shown as bytes.
                self.assertEqual({p for p, _ in packets if p.startswith("exported")}, {"exported_pdu:mbrtu:modbus", "exported_pdu:data"})
                known = [i for i in info["exported_pdu"] if "Func:" in i]
                self.assertTrue(any("Response: Unit:" in i and "Read Holding Registers" in i for i in known))
                self.assertEqual(self.tshark(file, "exported_pdu && !mbrtu && !(data.data[0:1] == 00)"), [])
                self.assertEqual(self.tshark(file, "mbrtu.crc16.status == 0", "-o", "mbrtu.crc_verification:TRUE"), [])
            if "can" in kinds:
                self.assertTrue(all(p == "can:canopen" for p, _ in packets if p.startswith("can")))
                for word in ("SYNC", "NMT Error Control", "PDO1 (rx)", "NMT: Start remote node"):
                    self.assertTrue(any(word in i for i in info["can"]), word)

        def test_tshark_understands_the_wire_log_of_a_dry_run(self):
            self.make_show()
            with open(self.path("s", "rig.yaml")) as f:
                rig = f.read()
            with open(self.path("s", "rig.yaml"), "w") as f:
                f.write(rig.replace("floor: {buses: [", "  - {name: far, kind: can, url: 'can://can0'}\nfloor: {buses: [far, "))
            for name in ("one.pcapng", "two.pcapng"):
                footlight("dryrun", self.show, "--wire-log", self.path(name))
            with open(self.path("one.pcapng"), "rb") as one, open(self.path("two.pcapng"), "rb") as two:
                self.assertEqual(one.read(), two.read(), "equal runs give equal logs")
            self.assert_understood(self.path("one.pcapng"), ("can", "ip", "exported_pdu", "rtacser"))

        def test_tshark_knows_the_sdo_transfers_of_a_technician(self):
            self.make_show(("left",))
            with open(self.path("s", "rig.yaml"), "w") as f:
                f.write("rig: 1\nbuses: [{name: far, kind: can, url: 'can://can0'}]\nfloor: {buses: [far], channels_per_node: 8}\n")
            for number, task in enumerate((["scan", "far", "--addresses", "1-14"], ["health", "far"], ["identify", "far/2"])):
                log = self.path(f"{number}.pcapng")
                footlight("devices", *task, "--sim", "--show", self.show, "--wire-log", log)
                packets = self.tshark(log)
                self.assertTrue(all(p == "can:canopen" for p, _ in packets), packets)
                self.assertEqual(self.tshark(log, "_ws.malformed || _ws.expert.severity >= 0x00800000"), [])
                for word in ("Default-SDO (rx)", "Default-SDO (tx)"):
                    self.assertTrue(any(word in i for _, i in packets), (word, packets[:20]))
            scan = self.tshark(self.path("0.pcapng"), "canopen.sdo.main_idx == 0x1018 && canopen.sdo.sub_idx == 2")
            self.assertGreaterEqual(len(scan), 2 * 12, "the product code of each node is asked and told")
            segments = self.tshark(self.path("0.pcapng"), "canopen.sdo.ccs == 3")
            self.assertGreater(len(segments), 0, "its name comes in segments")

        def test_a_run_leaves_its_wires_and_the_bundle_packs_them(self):
            self.make_show()
            self.serve()
            log = self.path("wires.pcapng")
            report = self.play("--wire-log", log)
            self.assert_understood(log, ("ip", "exported_pdu", "rtacser"))
            before = time.time()
            times = [float(t) for _, _, t in self.tshark(log, "", "-e", "frame.time_epoch")]
            self.assertTrue(all(before - 600 < t < before + 1 for t in times), "the wall clock's time")
            footlight("bundle", self.show, "-o", self.path("b.tar.gz"))
            subprocess.run(["tar", "-xzf", self.path("b.tar.gz"), "-C", self.folder], check=True)
            inside = self.path("footlight-bundle")
            found = sorted(os.path.relpath(os.path.join(folder, name), inside) for folder, _, names in os.walk(inside) for name in names)
            self.assertEqual(found, ["run/moments.txt", "run/report.json", "run/run.json", "show/rig.yaml", "show/show.yaml", "versions.txt", "wires.pcapng"])
            self.assertEqual(len(self.tshark(os.path.join(inside, "wires.pcapng"))), len(times), "the ring has what the file has")
            with open(os.path.join(inside, "run", "report.json")) as f:
                self.assertEqual(json.load(f), report)
            with open(os.path.join(inside, "run", "moments.txt")) as f:
                self.assertEqual(len(f.read().splitlines()), report["switches"] - 1)

        def test_the_ring_is_there_after_a_kill(self):
            self.make_show()
            self.serve()
            run = self.start(program(), "run", self.show, "--transport-map", self.map, "--go", stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            wait_for(lambda: any(c["look"] not in (0, 255) for c in self.changes()), "the opening")
            time.sleep(0.5)
            run.kill()
            run.wait()
            footlight("bundle", "-o", self.path("b.tar.gz"))
            subprocess.run(["tar", "-xzf", self.path("b.tar.gz"), "-C", self.folder], check=True)
            self.assertGreater(len(self.tshark(self.path("footlight-bundle", "wires.pcapng"))), 50)

    return Live
