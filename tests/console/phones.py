"""The cast's page on a phone: the real program, simulated markers, Chromium as small as a telephone. Part of run.py."""
import json
import signal
import subprocess

from page import Page
from rehearsal import HOSTILE, Run
from stage import SHOW, wait_for

PHONE = {"width": 390, "height": 844, "mobile": True}
SLOW = SHOW.replace("tempo: 240", "tempo: 60").replace("title: Twelve", f"title: '{HOSTILE}'")


class PhonePage(Page):
    def press(self, part):
        self.value(f"document.getElementById({json.dumps(part)}).click()")

    def fill(self, part, text):
        self.value(f"(()=>{{const e=document.getElementById({json.dumps(part)});e.value={json.dumps(text)};e.dispatchEvent(new Event('input'))}})()")


def make_cases(Stage, program, pictures):
    class Phones(Stage):
        def cast(self, *options, show=SLOW):
            self.make_show(show=show)
            self.serve()
            self.run_ = Run(self, program(), *options)
            out = self.path("cast.txt")
            self.process = self.start(program(), "cast", self.show, "--follow", self.run_.url, stdout=open(out, "w"), stderr=subprocess.DEVNULL)
            self.link = wait_for(lambda: open(out).read().strip(), "the link")

        def page(self, url, **size):
            page = PhonePage(url, pictures(), **{**PHONE, **size})
            self.addCleanup(page.close)
            return page

        def test_a_performer_picks_her_name_once_and_is_led_through_the_show(self):
            self.cast()
            page = self.page(self.link)
            page.until("!document.getElementById('pick').hidden", "the list of names")
            self.assertEqual(page.value("location.hash"), "", "the code does not stay in the address")
            self.assertEqual(page.value("document.querySelectorAll('#people button').length"), 12)
            page.fill("search", "7")
            page.until("document.querySelectorAll('#people button').length===1", "one name")
            page.picture("cast-pick")
            page.value("document.querySelector('#people button').click()")
            page.until("document.getElementById('cell').innerText.length>1", "her cell")
            page.until_text("banner", "wait for GO")
            page.picture("cast-standby")
            self.run_.say("go")
            page.until_text("left_of", "counts to GO")
            page.until("document.getElementById('banner').hidden", "the show runs")
            first = page.until("/^[0-9]+$/.test(document.getElementById('left').innerText) && document.getElementById('left').innerText", "a count-down")
            page.until(f"Number(document.getElementById('left').innerText)<{int(first)}", "it counts down by itself")
            page.picture("cast-stand")
            page.until_text("banner", "Standby 2")
            self.run_.say("go")
            page.until_text("doing", "Walk to")
            self.assertNotEqual(page.value("document.getElementById('arrow').style.transform"), "")
            page.picture("cast-walk")
            page.press("theme")
            page.picture("cast-walk-light")
            page.press("language")
            page.until_text("doing", "走到")
            page.picture("cast-walk-chinese")
            self.run_.say("hold")
            page.until_text("banner", "停住")
            page.press("language")
            page.until_text("banner", "HOLD")
            page.picture("cast-hold")
            kept = page.text("cell")
            page.open()
            page.until(f"document.getElementById('cell').innerText==={json.dumps(kept)}", "she is known when the page comes back")
            self.assertEqual(page.problems(), [])
            self.assertLessEqual(page.value("document.documentElement.scrollWidth-innerWidth"), 0, "nothing is wider than the phone")

        def test_who_is_lost_gets_a_way_and_names_are_never_html(self):
            self.cast()
            page = self.page(self.link)
            page.until("!document.getElementById('pick').hidden", "the list of names")
            page.value("document.querySelectorAll('#people button')[3].click()")
            page.until("document.getElementById('cell').innerText.length>1", "her cell")
            page.press("where")
            page.fill("lost_cell", "zz99")
            page.press("lost_ask")
            page.until_text("answer", "There is no such cell")
            page.value("document.getElementById('map').scrollIntoView()")
            x, y = page.value("(()=>{const r=document.getElementById('map').getBoundingClientRect();return [r.x+r.width*0.3,r.y+r.height*0.6]})()")
            page.click_at(x, y)
            page.until("/^[A-Z]+[0-9]+$/.test(document.getElementById('lost_cell').value)", "the cell that was tapped")
            page.press("lost_ask")
            page.until("/go now|WAIT|right|where you are/i.test(document.getElementById('answer').innerText)", "an answer")
            page.picture("cast-where-stands")
            self.run_.say("go")
            page.until("document.getElementById('banner').hidden", "the show runs")
            page.press("lost_ask")
            page.until("/at count/.test(document.getElementById('answer').innerText)", "a count")
            page.picture("cast-where-runs")
            self.assertEqual(page.value("document.querySelectorAll('img').length"), 0)
            self.assertEqual(page.problems(), [])

        def test_a_wrong_code_and_a_desk_that_is_gone_are_said_plainly(self):
            self.cast()
            page = self.page(self.link.split("#")[0])
            page.until("!document.getElementById('join').hidden", "the question for the code")
            page.fill("code", "00000-00000")
            page.press("enter")
            page.until_text("join_why", "this is not the code of this cast")
            page.picture("cast-code")
            page.fill("code", self.link.split("#")[1].lower())
            page.press("enter")
            page.until("!document.getElementById('pick').hidden", "the list of names")
            page.value("document.querySelector('#people button').click()")
            page.until_text("banner", "wait for GO")
            self.run_.process.kill()
            page.until_text("banner", "THE DESK IS NOT HEARD")
            self.assertEqual(page.text("left"), "–")
            page.picture("cast-not-heard")
            self.process.send_signal(signal.SIGKILL)
            page.until_text("banner", "NO CONNECTION")

        def test_the_page_fits_small_and_large_phones_both_ways(self):
            self.cast()
            page = self.page(self.link, width=320, height=568)
            page.until("!document.getElementById('pick').hidden", "the list of names")
            page.value("document.querySelectorAll('#people button')[5].click()")
            page.until("document.getElementById('cell').innerText.length>1", "her cell")
            for width, height in ((320, 568), (568, 320), (430, 932), (820, 1180)):
                page.size(width, height, True)
                page.picture(f"cast-{width}x{height}")
                wide, high = page.value("[document.getElementById('cell').getBoundingClientRect().height, innerHeight]")
                self.assertGreater(wide, 0.1 * min(width, height))
                self.assertLessEqual(page.value("document.getElementById('foot').getBoundingClientRect().bottom"), high)

    return Phones
