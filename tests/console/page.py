"""A console's page in Chromium: opens it, presses, clicks and reads what people would."""
import base64
import json
import os
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "support"))
from chromium import Browser  # noqa: E402

CODES = {" ": "Space", "Escape": "Escape", "Enter": "Enter", "ArrowDown": "ArrowDown", "ArrowUp": "ArrowUp", "/": "Slash", "?": "Slash", "+": "Equal", "-": "Minus"}


class Page:
    """One window. `pictures` is where screenshots go."""

    def __init__(self, url, pictures, width=1600, height=900, mobile=False):
        self.url, self.pictures = url, pictures
        self.folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        self.browser = Browser(self.folder.name)
        target = self.browser.ask("Target.createTarget", url="about:blank")["targetId"]
        self.browser.session = self.browser.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.browser.ask(domain + ".enable")
        self.size(width, height, mobile)
        self.open()

    def open(self):
        self.browser.ask("Page.navigate", url=self.url)
        self.until("document.readyState==='complete' && document.getElementById('title') !== null", "the page")

    def size(self, width, height, mobile=False):
        self.browser.ask("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=mobile)
        self.browser.ask("Emulation.setTouchEmulationEnabled", enabled=mobile)

    def close(self):
        self.browser.end()
        self.folder.cleanup()

    def value(self, script):
        return self.browser.value(script)

    def until(self, script, told, seconds=60):
        """Waits for a script to be true; a machine under load takes its time."""
        for _ in range(int(seconds * 20)):
            value = self.value(script)
            if value:
                return value
            time.sleep(0.05)
        raise AssertionError(f"waited {seconds} s for {told}: {script}; the page says {self.text('desk')!r}")

    def text(self, part):
        return self.value(f"document.getElementById({json.dumps(part)})?.innerText.trim()")

    def until_text(self, part, wanted, seconds=60):
        return self.until(f"document.getElementById({json.dumps(part)}).innerText.includes({json.dumps(wanted)})", f"{part} to say {wanted!r}", seconds)

    def key(self, key, times=1, repeats=0):
        """Presses and releases; `repeats` while it is down."""
        code = CODES.get(key, "Key" + key.upper() if key.isalpha() and len(key) == 1 else "Digit" + key if key.isdigit() else key)
        text = {"text": key} if len(key) == 1 else {"text": "\r"} if key == "Enter" else {}
        for _ in range(times):
            self.browser.ask("Input.dispatchKeyEvent", type="keyDown", key=key, code=code, **text)
            for _ in range(repeats):
                self.browser.ask("Input.dispatchKeyEvent", type="keyDown", key=key, code=code, autoRepeat=True, **text)
            self.browser.ask("Input.dispatchKeyEvent", type="keyUp", key=key, code=code)

    def type(self, text):
        self.browser.ask("Input.insertText", text=text)

    def click(self, part):
        """Where a hand would: in the middle of what is seen of it."""
        x, y = self.value(f"(()=>{{const e=document.getElementById({json.dumps(part)});e.scrollIntoView({{block:'nearest'}});const r=e.getBoundingClientRect();return [r.x+r.width/2,r.y+r.height/2]}})()")
        self.click_at(x, y)

    def click_at(self, x, y):
        for kind in ("mousePressed", "mouseReleased"):
            self.browser.ask("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def order(self, line):
        """As typed into the field of orders."""
        self.key(":")
        self.type(line)
        self.key("Enter")

    def picture(self, name):
        time.sleep(0.4)
        os.makedirs(self.pictures, exist_ok=True)
        with open(os.path.join(self.pictures, name + ".png"), "wb") as file:
            file.write(base64.b64decode(self.browser.ask("Page.captureScreenshot")["data"]))

    def problems(self):
        """Exceptions and what the browser refused to load or run."""
        self.value("0")
        told = []
        for event in self.browser.events:
            parameters = event.get("params", {})
            if event.get("method") == "Runtime.exceptionThrown":
                told.append(parameters["exceptionDetails"].get("exception", {}).get("description", str(parameters)))
            elif event.get("method") == "Log.entryAdded":
                entry = parameters["entry"]
                # A program that is gone is what some tests are about, and no page has an icon.
                if entry["level"] == "error" and "ERR_CONNECTION" not in entry["text"] and not entry.get("url", "").endswith(("/favicon.ico", "/ws")):
                    told.append(entry["text"] + " " + entry.get("url", ""))
        return told

    def requests(self):
        return [event["params"]["request"]["url"] for event in self.browser.events if event.get("method") == "Network.requestWillBeSent"]
