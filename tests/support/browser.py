#!/usr/bin/python3
"""Opens a performer's page in Chromium as a telephone shows it, goes through it by keys, taps and buttons, and prints what was seen as one
JSON document.

    browser.py PAGE.html [PICTURE.png]

Keys of the result: "places" [count, measure, cell, way, heading] of each, "after" where each way of going leads (numbers from 1), "wide" places
that are wider than the screen, "without_map", "light" and "dark" grounds, "requests" for anything but the page itself."""
import json
import os
import subprocess
import sys
import tempfile


class Browser:
    """Chromium over its debugging pipe: JSON messages that end with a zero byte (Chrome DevTools Protocol)."""

    def __init__(self, folder):
        to_read, self.to = os.pipe()
        self.come, from_write = os.pipe()

        def wire():
            # 3 and 4 are what Chromium reads and writes; first out of the way of each other.
            a, b = os.dup2(to_read, 60), os.dup2(from_write, 61)
            os.dup2(a, 3)
            os.dup2(b, 4)

        self.child = subprocess.Popen(
            ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
             "--user-data-dir=" + folder, "--remote-debugging-pipe", "about:blank"],
            preexec_fn=wire, close_fds=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_read)
        os.close(from_write)
        self.number, self.rest, self.session, self.events = 0, b"", None, []

    def receive(self):
        while b"\0" not in self.rest:
            more = os.read(self.come, 1 << 20)
            if not more:
                raise SystemExit("chromium has ended")
            self.rest += more
        one, self.rest = self.rest.split(b"\0", 1)
        return json.loads(one)

    def ask(self, method, **parameters):
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.to, json.dumps(message).encode() + b"\0")
        while True:
            got = self.receive()
            if got.get("id") == self.number:
                if "error" in got:
                    raise SystemExit(method + ": " + str(got["error"]))
                return got["result"]
            self.events.append(got)

    def wait_for(self, method):
        while not any(event.get("method") == method for event in self.events):
            self.events.append(self.receive())

    def value(self, script):
        return self.ask("Runtime.evaluate", expression=script, returnByValue=True)["result"].get("value")

    def key(self, name):
        for kind in ("keyDown", "keyUp"):
            self.ask("Input.dispatchKeyEvent", type=kind, key=name, code=name)

    def tap(self, x, y):
        for kind in ("mousePressed", "mouseReleased"):
            self.ask("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def end(self):
        self.child.kill()
        self.child.wait()


PLACE = """(()=>{const s=[...document.querySelectorAll('section')].filter(e=>getComputedStyle(e).display!=='none');
if(s.length!==1)return null;const t=q=>{const e=s[0].querySelector(q);return e?e.innerText.trim():''};
return [t('.count b'),t('.count i'),t('.cell b'),t('.way'),t('h2')]})()"""
NUMBER = "[...document.querySelectorAll('section')].findIndex(e=>e.classList.contains('on'))+1"
WIDE = "document.documentElement.scrollWidth>innerWidth"
MAPS = "document.querySelectorAll('section.on figure svg').length"
GROUND = "getComputedStyle(document.body).backgroundColor"


def look(browser, page, picture):
    target = browser.ask("Target.createTarget", url="about:blank")["targetId"]
    browser.session = browser.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
    browser.ask("Page.enable")
    browser.ask("Network.enable")
    browser.ask("Emulation.setDeviceMetricsOverride", width=390, height=844, deviceScaleFactor=2, mobile=True)
    browser.ask("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "light"}])
    browser.ask("Page.navigate", url="file://" + os.path.abspath(page))
    browser.wait_for("Page.loadEventFired")
    out = {"places": [], "wide": [], "without_map": [], "after": {}}
    out["light"] = browser.value(GROUND)
    many = browser.value("document.querySelectorAll('section').length")
    for k in range(many):
        out["places"].append(browser.value(PLACE))
        if browser.value(WIDE):
            out["wide"].append(k + 1)
        if browser.value(MAPS) != 2:
            out["without_map"].append(k + 1)
        if picture and k == min(1, many - 1):
            import base64
            with open(picture, "wb") as file:
                file.write(base64.b64decode(browser.ask("Page.captureScreenshot")["data"]))
        browser.key("ArrowRight")
    out["after"]["the last and one more"] = browser.value(NUMBER)
    browser.key("Home")
    out["after"]["Home"] = browser.value(NUMBER)
    browser.tap(300, 300)
    out["after"]["a tap on the right"] = browser.value(NUMBER)
    browser.tap(60, 300)
    out["after"]["a tap on the left"] = browser.value(NUMBER)
    browser.value("document.getElementById('on').click()")
    out["after"]["the button"] = browser.value(NUMBER)
    browser.ask("Page.reload")
    browser.events.clear()
    browser.wait_for("Page.loadEventFired")
    out["after"]["opening it again"] = browser.value(NUMBER)
    browser.value("document.getElementById('light').click()")
    out["dark"] = browser.value(GROUND)
    out["requests"] = [event["params"]["request"]["url"] for event in browser.events
                       if event.get("method") == "Network.requestWillBeSent"
                       and not event["params"]["request"]["url"].startswith("file://" + os.path.abspath(page))]
    return out


def main():
    page, picture = sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else None
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        browser = Browser(folder)
        try:
            print(json.dumps(look(browser, page, picture)))
        finally:
            browser.end()


main()
