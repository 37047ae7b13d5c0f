"""Edits, absences and covers while a show runs, with the program and `footlight sim`. Part of run.py."""
import json
import os
import time

from rehearse import Desk
from stage import SHOW, wait_for


def make_cases(Stage, program):
    """The test cases, over stage.py's."""

    class Editing(Stage):
        def desk(self, *options):
            self.make_show()
            self.serve()
            return self.start_desk(*options)

        def start_desk(self, *options):
            desk = Desk(self, program(), "--count-in", "0", *options)
            desk.until("roll call", ready=True)
            return desk

        def notes(self, desk, text):
            return [line["note"] for line in list(desk.lines) if text in line.get("note", "")]

        def rewrite(self, name, text):
            """As editors do: another file, renamed."""
            with open(self.path("s", name + "~"), "w") as f:
                f.write(text)
            os.rename(self.path("s", name + "~"), self.path("s", name))

        def cells(self, name):
            with open(self.path("s", name)) as f:
                return f.read().splitlines()

        def swap_rows(self, name, a, b):
            """Two people change places in a formation."""
            lines = self.cells(name)
            first, second = (lines[i].split(",", 1) for i in (a, b))
            lines[a], lines[b] = f"{first[0]},{second[1]}", f"{second[0]},{first[1]}"
            self.rewrite(name, "\n".join(lines) + "\n")

        def edit(self, desk):
            return desk.state.get("edit", {})

        def wait_for_edit(self, desk, state):
            wait_for(lambda: self.edit(desk).get("state") == state, f"{state}, not {self.edit(desk)}", 90)

        def play_to_the_end(self, desk, people=12):
            for _ in range(4):
                if desk.state["phase"] == "finished":
                    break
                time.sleep(0.3)
                desk.say("go")
                wait_for(lambda: desk.state["phase"] in ("runs", "resets", "finished"), "it goes")
                wait_for(lambda: desk.state["phase"] in ("stands", "finished"), "it stands", 60)
            self.assertEqual(desk.state["phase"], "finished")
            wait_for(lambda: all(bus["unconfirmed"] == 0 for bus in desk.state["buses"]), "all nodes right")
            desk.say("quit")
            report = desk.report()
            self.assertEqual(desk.process.wait(20), 0)
            self.assertEqual(report["unconfirmed"], 0)
            self.assertEqual(report["deaf"], 0)
            self.assert_floor(report, people)
            return report

        def test_an_edit_is_told_waits_and_is_taken_where_the_show_stands(self):
            desk = self.desk()
            desk.say("go")
            desk.until("the end of cue 1", phase="stands", standby="2")
            before = desk.state["switch"]
            self.swap_rows("arrow.csv", 2, 3)
            self.wait_for_edit(desk, "waits")
            self.assertEqual((self.edit(desk)["transitions"], self.edit(desk)["people"]), (1, 2))
            self.assertIn("changed: 1 transition, 2 people", self.notes(desk, "changed:")[0])
            self.assertEqual(desk.state["switch"], before, "nothing changes by itself")
            desk.say("take")
            self.wait_for_edit(desk, "none")
            self.assertEqual(self.edit(desk)["untold"], 2)
            self.assertEqual(desk.state["standby"], "2")
            self.assertEqual(desk.state["position_s"], 0.5)
            desk.say("changed", "told 1", "changed")
            wait_for(lambda: self.edit(desk)["untold"] == 1, "one of them told")
            self.assertLessEqual({"2 to be told: 1, 2", "1, 1 to be told", "1 to be told: 2"}, set(desk.answers()))
            self.play_to_the_end(desk)
            with open(self.path("state", "footlight", "untold.json")) as f:
                self.assertEqual(json.load(f)["untold"], ["2"], "it survives the run")

        def test_an_edit_that_moves_people_who_stand_begins_with_a_reset_move(self):
            desk = self.desk()
            desk.say("go")
            desk.until("the end of cue 1", phase="stands", standby="2")
            self.swap_rows("line.csv", 2, 3)
            self.wait_for_edit(desk, "waits")
            desk.say("take")
            wait_for(lambda: desk.state["reset"]["state"] == "ready", "the way to the new plan", 60)
            self.assertTrue(any("2 people walk, at most" in line.get("reset", "") for line in desk.lines), desk.lines)
            desk.say("jump cue 1")
            wait_for(lambda: any("go to their places of the new plan first" in text for text in desk.answers()), "a refusal")
            time.sleep(0.3)
            desk.say("go")
            desk.until("the reset move", phase="resets")
            desk.until("the place where it was taken", phase="stands", reset={"state": "none"}, standby="2")
            self.play_to_the_end(desk)

        def test_an_edit_that_is_wrong_shows_its_errors_and_changes_nothing(self):
            desk = self.desk()
            with open(self.show) as f:
                good = f.read()
            wrong = good.replace("max_speed: 4 m/s", "max_sped: 4 m/s")
            with open(self.show, "w") as f:  # as others do: in pieces
                f.write(wrong[:100])
                f.flush()
                time.sleep(0.1)
                f.write(wrong[100:])
            self.wait_for_edit(desk, "wrong")
            self.assertRegex(self.edit(desk)["text"], r"show\.yaml:6:3: error: stage\.max_sped: ")
            self.assertEqual(len(self.notes(desk, "nothing is changed by it")), 1, "half a file is nobody's business")
            desk.say("take")
            wait_for(lambda: "take: what has changed is wrong, and nothing is changed by it" in desk.answers(), "a refusal")
            # People who meet: a plan that is refused.
            self.rewrite("show.yaml", good.replace("max_speed: 4 m/s", "max_speed: 0.1 m/s"))
            wait_for(lambda: len(self.notes(desk, "nothing is changed by it")) == 2, "a refused plan", 60)
            wait_for(lambda: "0.1" in self.edit(desk)["text"], "why it is refused")
            self.rewrite("show.yaml", good)
            self.wait_for_edit(desk, "waits")
            self.assertEqual(self.edit(desk)["people"], 0, "it is what plays")
            desk.say("discard")
            self.wait_for_edit(desk, "none")
            self.play_to_the_end(desk)

        def test_who_is_absent_is_covered_by_her_understudy_and_nobody_else_changes(self):
            self.make_show()
            with open(self.show) as f:
                text = f.read()
            with open(self.show, "w") as f:
                f.write(text.replace("  groups:\n", "  understudies: [{id: zoe, name: Zoe, covers: [7]}]\n  groups:\n"))
            self.serve()
            desk = self.start_desk()
            desk.say("absent 7")
            wait_for(lambda: self.edit(desk).get("absent") == [{"id": "7", "cover": None}], "an absence")
            self.assertEqual(self.edit(desk)["state"], "none", "nobody has to do anything yet")
            self.assertIn("or cover 7 by zoe", " ".join(desk.answers()))
            desk.say("cover 7")
            self.wait_for_edit(desk, "waits")
            self.assertEqual((self.edit(desk)["transitions"], self.edit(desk)["people"]), (0, 1))
            desk.say("take")
            wait_for(lambda: self.edit(desk)["absent"] == [{"id": "7", "cover": "zoe"}], "the cover")
            self.assertEqual(desk.state["reset"]["state"], "none", "her place is known")
            desk.say("changed")
            wait_for(lambda: "1 to be told: zoe" in desk.answers(), "who has to be told")
            desk.say("present 7")
            self.wait_for_edit(desk, "waits")
            desk.say("take")
            wait_for(lambda: self.edit(desk)["absent"] == [] and self.edit(desk)["state"] == "none", "she is back")
            self.play_to_the_end(desk)

        def test_a_performer_covers_another_one_and_walks_to_her_place_first(self):
            desk = self.desk()
            desk.say("cover 3 by 8", "cover 4 by 8", "cover 99 by 1")
            self.wait_for_edit(desk, "waits")
            self.assertLessEqual({"cover: 8 covers 3 already", 'there is no performer "99" (did you mean "9"?)'}, set(desk.answers()))
            self.assertEqual(self.edit(desk)["people"], 1)
            desk.say("take")
            wait_for(lambda: desk.state["reset"]["state"] == "ready", "the way to her place", 60)
            self.assertTrue(any("1 person walks, at most" in line.get("reset", "") for line in desk.lines), desk.lines)
            desk.say("go")
            desk.until("the reset move", phase="resets")
            desk.until("the top", phase="stands", reset={"state": "none"})
            report = self.play_to_the_end(desk, people=11)
            self.assertEqual(sum(look not in (0, 255) for node in report["floor"] for look in node["looks"]), 11, "eleven people on eleven lamps")

        def test_a_repair_leaves_the_place_empty_where_nobody_is_free(self):
            desk = self.desk()
            desk.say("repair 5")
            self.wait_for_edit(desk, "waits")
            self.assertEqual(self.edit(desk)["people"], 0)
            desk.say("take")
            wait_for(lambda: self.edit(desk)["absent"] == [{"id": "5", "cover": "repaired"}], "the repair")
            report = self.play_to_the_end(desk, people=11)
            self.assertEqual(sum(look not in (0, 255) for node in report["floor"] for look in node["looks"]), 11)

        def test_a_repair_gives_the_way_to_who_is_on_stage_least_and_nobody_else_changes(self):
            self.make_show(show=SHOW.replace("  clearance:", "  reserve: [A8]\n  clearance:"))
            for name in ("line.csv", "ring.csv", "arrow.csv"):
                self.rewrite(name, "\n".join([*self.cells(name)[:-1], "12,0,7"]) + "\n")  # she waits in the wings
            self.serve()
            desk = self.start_desk()
            desk.say("repair 5")
            self.wait_for_edit(desk, "waits")
            self.assertEqual(self.edit(desk)["people"], 1)
            desk.say("take")
            wait_for(lambda: desk.state["reset"]["state"] == "ready", "the way to her place", 60)
            self.assertTrue(any("1 person walks, at most" in line.get("reset", "") for line in desk.lines), desk.lines)
            desk.say("go")
            desk.until("the reset move", phase="resets")
            desk.until("the top", phase="stands", reset={"state": "none"})
            self.assertEqual(self.edit(desk)["absent"], [{"id": "5", "cover": "repaired"}])
            desk.say("changed")
            wait_for(lambda: "1 to be told: 12" in desk.answers(), "who changes")
            report = self.play_to_the_end(desk, people=11)
            self.assertEqual(sum(look not in (0, 255) for node in report["floor"] for look in node["looks"]), 11, "eleven of twelve, and the one from the wings is among them")

    return Editing
