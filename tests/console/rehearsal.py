"""A rehearsal as a stage manager leads it from the page: the real program, simulated markers on real ports, Chromium. Part of run.py."""
import json
import os
import re
import signal
import subprocess
import threading
import time

from page import Page
from stage import SHOW, wait_for

HOSTILE = "<img src=x onerror=alert(1)>"


class Run:
    """`footlight run --console`; `lines` is what it says on stdout, as JSON."""

    def __init__(self, case, program, *options, port=0, patience_s=20, until_ready=True):
        self.notes = case.path("run.err")
        self.process = subprocess.Popen([program, "run", case.show, "--transport-map", case.map, "--status-lines", "--console", f"127.0.0.1:{port}", "--count-in", "2", "--go-guard", "0.3", *options],
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=open(self.notes, "w"), text=True)
        self.lines, self.state = [], {}
        self.reader = threading.Thread(target=self.read)
        self.reader.start()
        case.addCleanup(self.end)
        found = wait_for(lambda: self.alive() and re.search(r"console: (http://127\.0\.0\.1:(\d+))", open(self.notes).read()), "the console's address", patience_s)
        self.url, self.port = found[1], int(found[2])
        if until_ready:
            wait_for(lambda: self.state.get("ready"), "the roll call", patience_s)

    def alive(self):
        if self.process.poll() is not None:
            raise AssertionError(f"the program has ended with {self.process.returncode}:\n{open(self.notes).read()}")
        return True

    def read(self):
        for line in self.process.stdout:
            document = json.loads(line)
            self.lines.append(document)
            self.state = document.get("state", self.state)

    def say(self, order):
        self.process.stdin.write(order + "\n")
        self.process.stdin.flush()

    def answers(self):
        return [(line["answer"]["order"], line["answer"]["refused"]) for line in list(self.lines) if "answer" in line]

    def until(self, told, **wanted):
        return wait_for(lambda: all(self.state.get(key) == value for key, value in wanted.items()), f"{told}: {wanted}, not {self.state}", 60)

    def end(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        self.reader.join()
        self.process.stdin.close()
        self.process.stdout.close()


def make_cases(Stage, program, pictures, figures):
    class Rehearsal(Stage):
        def desk(self, *options, sim=(), show=SHOW, width=1600, height=900, buses=("left", "middle", "right"), between=None):
            """Show, markers, program and page; nobody leads yet."""
            self.make_show(buses, show=show)
            urls = self.serve(*sim)
            if between:
                between(urls)
            self.run_ = Run(self, program(), *options)
            return self.window(width, height)

        def window(self, width=1600, height=900, mobile=False):
            page = Page(self.run_.url, pictures(), width, height, mobile)
            self.addCleanup(page.close)
            page.until_text("title", "Twelve")
            page.until("document.querySelectorAll('#cues li').length === 3", "the cue list")
            return page

        def lead(self, page):
            page.until("document.getElementById('take_seat').textContent === 'Take the desk' && document.getElementById('link').textContent.endsWith(' ms')", "the connection")
            page.click("take_seat")
            page.until_text("seat", "You lead")

        def in_cue_2(self, page):
            """Twelve people walk into the ring."""
            page.until_text("standby_number", "1")
            page.key(" ")
            page.until_text("phase", "Counts in")
            self.run_.until("the end of cue 1", phase="stands", standby="2")
            page.until("document.getElementById('card').dataset.phase === 'stands' && document.getElementById('standby_number').textContent === '2'", "standby 2")
            time.sleep(0.5)
            page.key(" ")
            page.until_text("phase", "Runs")

        def assert_clean(self, page):
            self.assertEqual(page.problems(), [])
            self.assertEqual([url for url in page.requests() if not url.startswith(self.run_.url)], [], "nothing comes from elsewhere")

        def test_go_hold_going_on_and_the_end(self):
            page = self.desk()
            page.until_text("floor_words", "All 12 nodes are confirmed right")
            page.picture("01-standing")
            page.key(" ")
            page.until_text("refusal", "take the desk first")
            self.assertEqual(self.run_.answers(), [], "without the desk nothing is said")
            page.picture("02-refused")
            self.lead(page)
            self.in_cue_2(page)
            page.picture("03-runs")
            page.key("Escape")
            page.until_text("phase", "HOLD")
            self.run_.until("the hold", phase="stands", cue="2")
            page.until_text("cue_now", "in cue 2 Ring")
            page.picture("04-hold")
            position = self.run_.state["position_s"]
            page.key(" ", repeats=8)
            page.until_text("phase", "Counts in")
            page.picture("05-counts-in")
            page.until_text("phase", "The show is over", 90)
            self.assertGreater(self.run_.state["position_s"], position)
            page.picture("06-over")
            gos = [refused for order, refused in self.run_.answers() if order == "go"]
            self.assertEqual(gos, [False, False, False], "a press is one GO, however long it lasts")
            self.assert_clean(page)

        def test_a_refused_go_flashes_with_its_reason(self):
            page = self.desk()
            self.lead(page)
            self.in_cue_2(page)
            page.key(" ")
            page.until_text("refusal", "go refused: ")
            why = page.text("refusal")
            self.assertTrue(any(line["answer"]["refused"] and line["answer"]["text"] in why for line in self.run_.lines if "answer" in line), why)
            page.picture("07-go-refused")
            page.until("!document.getElementById('refusal').classList.contains('shown')", "the refusal goes away")

        def test_back_asks_for_the_reset_move_and_go_lights_it(self):
            page = self.desk()
            self.lead(page)
            self.in_cue_2(page)
            page.key("Escape")
            page.until_text("phase", "HOLD")
            page.order("jump cue 1")
            page.until_text("notice", "GO: people walk on to the end of the set")
            self.assertTrue(page.value("!document.getElementById('placed').hidden && !document.getElementById('cancel').hidden"))
            time.sleep(0.4)
            page.key(" ")
            page.until_text("notice", "GO lights the reset move to 0:00.0", 90)
            page.picture("08-reset-move-is-asked-for")
            time.sleep(0.4)
            page.key(" ")
            page.until_text("phase", "Reset move")
            time.sleep(1.2)
            page.picture("09-reset-move")
            self.run_.until("the top", phase="stands", position_s=0.0)
            page.until_text("standby_number", "1")
            page.key("j")
            page.type("cue 3")
            page.key("Enter")
            page.until("!document.getElementById('cancel').hidden", "the jump")
            page.key("c")
            page.until("document.getElementById('cancel').hidden", "the jump is taken back")
            self.assertEqual(self.run_.state["position_s"], 0.0)
            self.assert_clean(page)

        def test_arrows_choose_a_cue_and_enter_asks_for_the_jump(self):
            page = self.desk()
            self.lead(page)
            page.key("ArrowDown", times=2)
            page.until("document.querySelector('#cues [aria-selected=true] b').textContent === '3'", "cue 3 is chosen")
            page.key("Enter")
            page.until("!document.getElementById('placed').hidden", "the jump", 90)
            page.until_text("notice", "reset move")
            page.key("p")
            self.run_.until("cue 3", standby="3", phase="stands")
            self.assertIn(("jump cue 3", False), self.run_.answers())

        def test_loop_and_tempo_are_shown_with_their_limits(self):
            page = self.desk()
            self.lead(page)
            page.order("loop section ring")
            page.until_text("notice", "loop 0:03.0")
            page.key("-", times=4)
            page.until_text("tempo", "80 %")
            self.run_.until("the tempo", tempo_percent=80)
            page.order("tempo 200")
            most = page.until("/at most (\\d+) %/.exec(document.getElementById('most').textContent)?.[1]", "the cap")
            page.until(f"document.getElementById('tempo').textContent === '{min(200, int(most))} %'", "the capped tempo")
            page.picture("10-loop-and-tempo")
            page.key("l")
            page.until("document.getElementById('loop').getAttribute('aria-pressed') === 'false'", "no loop")

        def test_who_is_clicked_is_told_with_place_next_place_and_marker(self):
            page = self.desk()
            at = page.value("(()=>{const r=document.getElementById('floor').getBoundingClientRect();return [r.x,r.y,r.width,r.height]})()")
            found = None
            for y in range(60, int(at[3]) - 40, 20):  # somebody stands on one of the rows
                page.click_at(at[0] + at[2] * 0.46, at[1] + y)
                if page.value("!document.getElementById('person').hidden || (footlight.cost(), false)"):
                    found = y
                    break
                time.sleep(0.3)
                if page.value("!document.getElementById('person').hidden"):
                    found = y
                    break
            self.assertIsNotNone(found, "nobody was found by clicking")
            facts = page.until("(t => /Marker\\s+\\S+\\.\\d+: /.test(t) && t)(document.getElementById('person_facts').innerText)", "a marker that is confirmed")
            self.assertRegex(facts, r"Place\s+[A-L][1-8]")
            self.assertRegex(facts, r"Next place\s+[A-L][1-8], in \d+ s")
            page.picture("11-picked")
            page.key("/")
            page.type("right")
            page.until("[...document.querySelectorAll('#found button')].filter(b => b.textContent.endsWith(' · right')).length === 6", "a group")
            page.key("Escape")
            self.assertEqual(self.run_.answers(), [], "Esc in a field is no HOLD")
            page.key("Escape")
            wait_for(lambda: self.run_.answers(), "HOLD without the desk's seat")
            self.assertEqual(self.run_.answers()[0][0], "hold")

        def test_scrubbing_shows_any_time_and_sends_nothing(self):
            page = self.desk()
            self.lead(page)
            time.sleep(0.5)
            changes, state = len(self.changes()), dict(self.run_.state)
            page.value("(()=>{const s=document.getElementById('scrub');s.value=4.4;s.dispatchEvent(new Event('input'))})()")
            page.until_text("scrubbed_at", "0:04.4, count 18.6")
            self.assertEqual(page.text("count"), "1", "what stands below is now")
            page.until_text("legend", "marker as planned")
            page.picture("12-scrub")
            self.assertEqual(len(self.changes()), changes, "no lamp changed")
            self.assertEqual(self.run_.state["position_s"], state["position_s"])
            self.assertEqual(self.run_.answers(), [])
            page.click("now")
            page.until("document.getElementById('scrubbed').hidden", "now")

        def test_a_dead_node_is_told_by_name_and_number_of_markers(self):
            page = self.desk(sim=("--faults", "dead=1", "--seed", "3"))
            page.until_text("floor_words", "8 of 96 markers not right", 60)
            page.until("document.querySelectorAll('#wrong_nodes li').length === 1", "the node")
            self.assertRegex(page.text("wrong_nodes"), r"silent|quarantined")
            page.until("document.querySelectorAll('#buses tr.wrong').length >= 1", "its bus")
            page.picture("13-dead-node")

        def test_an_unplugged_bus_is_an_unmistakable_fault_and_heals(self):
            plug = []

            def cable(urls):
                plug.append(self.bad_line("left", urls["left"], 0))
                plug.append(plug[0]())

            page = self.desk(between=cable)
            page.until_text("floor_words", "All 12 nodes are confirmed right")
            plug[1].terminate()
            plug[1].wait()
            page.until("document.getElementById('floor_words').classList.contains('wrong') && document.querySelectorAll('#buses tr.wrong').length >= 1", "the fault", 60)
            page.picture("14-unplugged")
            plug[0]()
            page.until_text("floor_words", "All 12 nodes are confirmed right", 60)

        def test_a_program_that_dies_is_seen_at_once_and_found_again(self):
            page = self.desk()
            self.lead(page)
            port = self.run_.port
            self.run_.process.send_signal(signal.SIGKILL)
            page.until("!document.getElementById('lost').hidden", "NOT CONNECTED", 10)
            page.picture("15-not-connected")
            page.key(" ")
            page.until_text("refusal", "there is no connection") if page.value("document.getElementById('seat').classList.contains('mine')") else None
            self.run_ = Run(self, program(), port=port)
            page.until("document.getElementById('lost').hidden", "the connection", 30)
            page.until_text("seat", "You lead", 30)

        def test_a_take_over_is_seen_by_both(self):
            one = self.desk()
            self.lead(one)
            two = self.window(1024, 768, mobile=True)
            two.until_text("seat", "leads")
            two.key(" ")
            two.until_text("refusal", "take the desk first")
            self.lead(two)
            one.until("!document.getElementById('seat').classList.contains('mine')", "the desk is gone")
            one.key(" ")
            one.until_text("refusal", "take the desk first")
            self.assertEqual(self.run_.answers(), [])
            two.picture("16-tablet")

        def test_names_are_text_whatever_they_contain(self):
            show = SHOW.replace("name: Opening line", f"name: {json.dumps(HOSTILE)}").replace("title: Twelve", f"title: {json.dumps('Twelve ' + HOSTILE)}")
            page = self.desk(show=show)
            page.until_text("title", HOSTILE)
            page.until_text("cues", HOSTILE)
            page.until_text("standby_name", HOSTILE)
            self.assertEqual(page.value("document.images.length + document.querySelectorAll('body script').length"), 0)
            self.lead(page)
            page.order(HOSTILE)
            page.until_text("refusal", HOSTILE)
            self.assertEqual(page.value("document.images.length"), 0)
            self.assert_clean(page)

        def test_every_light_and_language_fits_and_keys_alone_are_enough(self):
            page = self.desk()
            page.click("front")
            time.sleep(0.5)
            page.picture("17-audience")
            page.click("theme")
            page.picture("18-light")
            page.click("theme")
            page.key("v")
            page.picture("19-contrast")
            page.click("language")
            page.until_text("go", "走")
            page.picture("20-chinese")
            for width, height in ((1600, 900), (1280, 720), (1024, 768)):
                page.size(width, height)
                self.assertTrue(page.value("document.documentElement.scrollWidth <= innerWidth && document.documentElement.scrollHeight <= innerHeight"), (width, height))
                sizes = page.value("['countdown','standby_number'].map(id=>parseFloat(getComputedStyle(document.getElementById(id)).fontSize))")
                self.assertGreaterEqual(min(sizes), 56, "read from two metres")
            page.size(600, 1000)
            self.assertTrue(page.value("document.documentElement.scrollWidth <= innerWidth"))
            page.size(1600, 900)
            page.key("?")
            page.until("document.getElementById('help').open", "help")
            page.picture("21-keys")
            page.key("Escape")
            page.until("!document.getElementById('help').open", "no help")
            reached = set()
            for _ in range(60):
                page.key("Tab")
                reached.add(page.value("document.activeElement.id"))
            for part in ("take_seat", "go", "hold", "order", "cues", "floor", "front", "scrub", "tab_log"):
                self.assertIn(part, reached, "reached by Tab")
            nameless = page.value("[...document.querySelectorAll('button,input,canvas,[role=tab]')].filter(e=>!e.hidden&&e.getAttribute('aria-hidden')!=='true'&&!(e.getAttribute('aria-label')||e.innerText||'').trim()).map(e=>e.id)")
            self.assertEqual(nameless, [])

        def test_what_is_said_elsewhere_reaches_the_page_within_a_tenth_of_a_second(self):
            page = self.desk()
            page.value("""(()=>{window.seen=[];const s=WebSocket.prototype;new MutationObserver(()=>window.seen.push(Date.now())).observe(document.getElementById('refusal'),{childList:true})})()""")
            delays = []
            for _ in range(10):
                page.value("window.seen.length=0")
                begin = time.time()
                self.run_.say("tempo 999")
                page.until("window.seen.length > 0", "the refusal")
                delays.append(page.value("window.seen[0]") / 1000 - begin)
                page.until("!document.getElementById('refusal').classList.contains('shown')", "it goes", 20)
            figures["refusal_on_the_page_s"] = sorted(delays)[len(delays) // 2]
            print(f"from a line on stdin to the page: median {figures['refusal_on_the_page_s'] * 1000:.0f} ms, worst {max(delays) * 1000:.0f} ms")

    return Rehearsal
