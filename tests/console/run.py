#!/usr/bin/python3
"""The console's page: its pure functions under node, and in Chromium against the real program and simulated markers.

    run.py [--program build/release/footlight] [--web build/release/app/console/web] [--json FILE] [--pictures FOLDER] [NAME...]

Screenshots stay in the pictures' folder (build/console-pictures)."""
import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, os.path.join(ROOT, "tests", "e2e"))
import big  # noqa: E402
import ceremony  # noqa: E402
import phones  # noqa: E402
import rehearsal  # noqa: E402
import stage  # noqa: E402

PROGRAM = os.path.join(ROOT, "build", "release", "footlight")
WEB = os.path.join(ROOT, "build", "release", "app", "console", "web")
PICTURES = os.path.join(ROOT, "build", "console-pictures")
FIGURES = {}


def footlight(*arguments, status=0):
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, stdin=subprocess.DEVNULL)
    if done.returncode != status:
        raise AssertionError(f"footlight {' '.join(map(str, arguments))}: exit {done.returncode}, expected {status}\n{done.stdout[-2000:]}\n{done.stderr[-4000:]}")
    return done.stdout, done.stderr


class Case(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="footlight-console-")
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def path(self, *parts):
        return os.path.join(self.folder, *parts)


class Functions(Case):
    def test_pure_functions_of_the_page_do_what_they_say(self):
        done = subprocess.run([os.path.join(HERE, "node_tests.sh"), self.path("bundles")], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout[-6000:] + done.stderr[-2000:])
        self.assertIn("# fail 0", done.stdout)


Stage = stage.make_stage(Case, footlight, lambda: PROGRAM)
Rehearsal = rehearsal.make_cases(Stage, lambda: PROGRAM, lambda: PICTURES, FIGURES)
Phones = phones.make_cases(Stage, lambda: PROGRAM, lambda: PICTURES)
Ceremony = ceremony.make_cases(Stage, footlight, lambda: PROGRAM, lambda: PICTURES, FIGURES)
Big = big.make_cases(Case, lambda: WEB, lambda: PICTURES, FIGURES)


def main():
    global PROGRAM, WEB, PICTURES
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", default=PROGRAM)
    parser.add_argument("--web", default=WEB)
    parser.add_argument("--pictures", default=PICTURES)
    parser.add_argument("--json")
    parser.add_argument("names", nargs="*")
    arguments = parser.parse_args()
    PROGRAM, WEB, PICTURES = map(os.path.abspath, (arguments.program, arguments.web, arguments.pictures))
    loader, module = unittest.TestLoader(), sys.modules["__main__"]
    suite = loader.loadTestsFromNames(arguments.names, module) if arguments.names else loader.loadTestsFromModule(module)
    result = unittest.TextTestRunner(verbosity=2).run(suite)
    failed = len(result.failures) + len(result.errors)
    if FIGURES:
        print(json.dumps(FIGURES))
    if arguments.json:
        with open(arguments.json, "w") as f:
            json.dump({"passed": result.testsRun - failed - len(result.skipped), "failed": failed, "skipped": len(result.skipped),
                       "problems": [f"console: {t}" for t, _ in result.failures + result.errors] + [f"skipped {t}: {why}" for t, why in result.skipped]}, f)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
