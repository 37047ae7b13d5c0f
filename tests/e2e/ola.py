"""OLA, which most lighting tools build upon, sends DMX through the simulated DMX USB Pro widget of `footlight sim`. Part of run.py.
olad refuses to run as root, so it runs as nobody there."""
import os
import re
import subprocess

from stage import wait_for

RIG = """rig: 1
buses: [{name: ttyUSB0, kind: dmx, url: 'dmx:///dev/nowhere'}]
nodes: [{bus: ttyUSB0, address: 1, channels: [A1:C1]}]
"""


def make_cases(Stage):
    """The test case, over stage.py's."""

    class Ola(Stage):
        def unprivileged(self):
            return ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"] if os.geteuid() == 0 else []

        def test_ola_lights_our_lamps(self):
            self.make_show()
            with open(self.path("s", "rig.yaml"), "w") as f:
                f.write(RIG)
            url = self.serve()["ttyUSB0"]
            self.assertTrue(url.startswith("dmx://"), url)
            port = url.split("://")[1]
            os.chmod(os.path.realpath(port), 0o666)
            for folder in (os.path.dirname(os.path.dirname(port)), os.path.dirname(port), self.path("")):
                os.chmod(folder, 0o755)
            conf = self.path("ola")
            os.mkdir(conf, 0o777)
            os.chmod(conf, 0o777)
            with open(os.path.join(conf, "ola-usbserial.conf"), "w") as f:
                f.write(f"device_dir = {os.path.dirname(port)}\ndevice_prefix = ttyUSB\nenabled = true\n")
            os.chmod(os.path.join(conf, "ola-usbserial.conf"), 0o666)
            self.start(*self.unprivileged(), "olad", "-c", conf, "--no-http", "-l", "0", stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

            def device():
                told = subprocess.run(["ola_dev_info"], capture_output=True, text=True).stdout
                found = re.search(r"Device (\d+): Enttec Usb Pro Device, Serial #: 12345678, firmware 1.4", told)
                return found and found[1]

            number = wait_for(device, "OLA to find the widget", 40)
            subprocess.run(["ola_patch", "-d", number, "-p", "0", "-u", "1"], check=True)

            def lit():
                subprocess.run(["ola_set_dmx", "-u", "1", "-d", "255,0,0,0,255,0" + 18 * ",0"], check=True, capture_output=True)
                last = {c["channel"]: c["colour"] for c in self.changes()}
                return last.get(0) == "#FF0000" and last.get(1) == "#00FF00"

            wait_for(lit, "the lamps to be red and green", 20)

    return Ola
