#!/usr/bin/python3
"""Adds up the reports of scripts/test and prints the closing line. Exit status 1 when something failed or nothing ran."""
import glob
import json
import os
import sys


def main(folder):
    passed = failed = skipped = 0
    problems = []
    for path in sorted(glob.glob(os.path.join(folder, "*.json"))):
        with open(path) as f:
            report = json.load(f)
        if path.endswith(".gtest.json"):
            for suite in report["testsuites"]:
                for test in suite["testsuite"]:
                    name = f'{os.path.basename(path)[:-11]}: {test["classname"]}.{test["name"]}'
                    if test.get("failures"):
                        failed += 1
                        problems.append(name)
                    elif test.get("result") == "SKIPPED":
                        skipped += 1
                        problems.append(f"skipped {name}")
                    elif test.get("status") == "RUN":
                        passed += 1
        else:
            passed += report.get("passed", 0)
            failed += report.get("failed", 0)
            skipped += report.get("skipped", 0)
            problems += report.get("problems", [report.get("name", path)] if report.get("failed") else [])
    if problems:
        print("\nnot passed:")
        for line in problems[:60]:
            print("  " + line)
    print(f"{passed} passed, {failed} failed, {skipped} skipped")
    return 0 if failed == 0 and passed > 0 else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
