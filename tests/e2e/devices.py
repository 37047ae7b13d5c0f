"""A technician at work: `footlight devices` over real ports, against the markers of `footlight sim`. Part of run.py."""
import json
import os
import socket
import threading

from stage import wait_for


def make_cases(Stage, footlight):
    """The test cases, over stage.py's."""

    class Devices(Stage):
        def on(self, bus, task, *options, status=0):
            """What `devices TASK` says of a bus of the rig, which the transport map finds."""
            told, said = footlight("devices", task, bus, "--show", self.show, "--transport-map", self.map, "--json", *options, status=status)
            return said if status else json.loads(told)

        def test_a_scan_finds_the_nodes_of_the_rig_and_strangers_on_each_kind_of_wire(self):
            self.make_show()
            urls = self.serve()
            for bus, url in urls.items():
                nodes = self.on(bus, "scan", "--addresses", "1-8")["found"]
                self.assertEqual([n["address"] for n in nodes], list(range(1, len(nodes) + 1)), bus)
                self.assertGreaterEqual(len(nodes), 3, bus)
                for node in nodes:
                    self.assertEqual((node["node"], node["is"]), (f"{bus}-{node['address']}", "present"), node)
                self.assertEqual(len({n["identities"][0]["unique_id"] for n in nodes}), len(nodes))
                told, _ = footlight("devices", "scan", url, "--addresses", f"2-{len(nodes) + 1}")
                self.assertTrue(told.endswith(f"{len(nodes) - 1} found\n"), told)
                self.assertNotIn("not in the rig", told, "a URL has no rig")

        def test_health_and_the_test_of_the_cable_ask_the_nodes_of_the_rig_or_those_that_are_named(self):
            self.make_show()
            for bus, url in self.serve().items():
                for node in self.on(bus, "health")["nodes"]:
                    self.assertEqual(node["answered"], 1, node)
                    self.assertIn({"name": "battery", "value": 100, "unit": "%"}, node["values"])
                self.assertEqual([n["address"] for n in json.loads(footlight("devices", "health", url, "--addresses", "2-3", "--json")[0])["nodes"]], [2, 3])
                tested = self.on(bus, "test", "--duration", "500 ms")
                self.assertTrue(all(n["answered"] > 1 for n in tested["nodes"]), tested)
                self.assertTrue(tested["cable"])
                _, said = footlight("devices", "test", url, "--addresses", "3-20", "--duration", "100 ms", status=4)
                self.assertIn("not every node answers", said)
                _, said = footlight("devices", "health", url, status=2)
                self.assertIn("has no nodes that are known (say which by --addresses 1-32, or give the bus's name and --show SHOW)", said)

        def test_a_spare_takes_the_address_of_what_it_replaces(self):
            self.make_show()
            for bus in self.serve():
                self.assertIn("address 2 is taken already", self.on(bus, "set-address", "1", "2", status=4))
                self.assertIn("nobody answers at address 20", self.on(bus, "set-address", "20", "21", status=4))
                before = self.on(bus, "scan", "--addresses", "2-2")["found"][0]["identities"]
                self.on(bus, "set-address", "2", "9")
                moved = self.on(bus, "scan", "--addresses", "1-9")["found"]
                self.assertEqual([(n["is"], n["identities"]) for n in moved if n["address"] in (2, 9)], [("absent", []), ("present", before)], bus)
                self.on(bus, "set-address", "9", "2")
                self.assertEqual(self.on(bus, "scan", "--addresses", "2-2")["found"][0]["identities"], before)

        def test_identify_makes_one_node_blink_white_and_gives_it_back(self):
            self.make_show()
            for bus in self.serve():
                footlight("devices", "identify", f"{bus}-2", "--show", self.show, "--transport-map", self.map)
                wait_for(lambda: {c["node"] for c in self.changes() if c.get("colour") == "#FFFFFF" and c["node"].startswith(bus)} == {f"{bus}-2"}, f"{bus}-2 to blink")
                footlight("devices", "identify", f"{bus}/2", "--off", "--show", self.show, "--transport-map", self.map)
                self.assertIn("the node of address 30 does not answer to identify", footlight("devices", "identify", f"{bus}/30", "--show", self.show, "--transport-map", self.map, status=4)[1])

        def test_ports_that_are_not_there_and_maps_that_are_wrong_are_told(self):
            self.make_show()
            self.assertIn('serial port "/dev/nowhere": No such file or directory', footlight("devices", "scan", "serial:///dev/nowhere", status=4)[1])
            self.map = self.path("map.yaml")
            with open(self.map, "w") as f:
                f.write("transports: 1\nbuses:\n  - {name: lft, url: 'serial:///dev/ttyUSB0'}\n")
            self.assertIn(f'{self.map}:3:12: error: buses[0].name: ', self.on("left", "scan", status=2))

        def test_list_tells_what_the_machine_has_with_and_without_a_rig(self):
            machine = json.loads(footlight("devices", "list", "--json", cwd=self.folder)[0])
            self.assertEqual(machine["buses"], [])
            self.assertEqual(set(machine["machine"]), {"serial", "can", "gpio", "troubles"})
            kernel = [n for n in os.listdir("/sys/class/net") if open(f"/sys/class/net/{n}/type").read().strip() == "280"]
            self.assertEqual([i["name"] for i in machine["machine"]["can"]], sorted(kernel))
            text, _ = footlight("devices", "list", self.make_show())
            self.assertIn("bus left: serial at serial:///dev/nowhere, 115200 bit/s", text)
            self.assertIn("this machine has\n", text)

        def dead_host(self):
            """A host that takes connections and never says a word. Returns its port."""
            listener = socket.create_server(("127.0.0.1", 0))
            self.addCleanup(listener.close)
            kept = []

            def take():
                try:
                    while True:
                        kept.append(listener.accept()[0])
                except OSError:
                    pass  # closed

            threading.Thread(target=take, daemon=True).start()
            return listener.getsockname()[1]

        def test_a_dead_tcp_host_delays_no_other(self):
            """Of two Modbus TCP buses one leads to a host that never answers: the other's lamps are right."""
            self.make_show(("left", "right"))
            with open(self.path("s", "rig.yaml"), "w") as f:
                f.write("rig: 1\nbuses:\n  - {name: left, kind: modbus-tcp, url: 'tcp://192.0.2.7:502'}\n  - {name: right, kind: modbus-tcp, url: 'tcp://192.0.2.8:502'}\n"
                        "floor: {buses: [left, right], channels_per_node: 8}\n")
            urls = self.serve()
            live = self.play()
            self.assertEqual(live["unconfirmed"], 0)
            with open(self.map) as f:
                text = f.read()
            with open(self.map, "w") as f:
                f.write(text.replace(urls["right"], f"tcp://127.0.0.1:{self.dead_host()}"))
            report = self.play(status=4)
            left, right = report["buses"]
            self.assertEqual(left["unconfirmed"], 0, left)
            self.assertEqual(left["deliveries"], live["buses"][0]["deliveries"])
            self.assertEqual(left["misses"], 0, left)
            self.assertEqual(right["deliveries"], 0)
            self.assertEqual(right["unconfirmed"], right["nodes"])
            shown = self.end_of_sim()
            planned = {n["node"]: n["looks"] for n in report["floor"] if n["node"].startswith("left")}
            self.assertEqual({node: [look for _, look in sorted(looks.items())] for node, looks in shown.items() if node in planned}, planned)

    return Devices
