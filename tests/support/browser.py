#!/usr/bin/python3
"""Opens a performer's page in Chromium as a telephone shows it, goes through it by keys, taps and buttons, and prints what was seen as one
JSON document.

    browser.py PAGE.html [PICTURE.png]

Keys of the result: "places" [count, measure, cell, way, heading] of each, "after" where each way of going leads (numbers from 1), "wide" places
that are wider than the screen, "without_map", "light" and "dark" grounds, "requests" for anything but the page itself."""
import base64
import json
import os
import sys
import tempfile

from chromium import Browser


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
