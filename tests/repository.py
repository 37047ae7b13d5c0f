#!/usr/bin/python3
"""House rules that a compiler does not see: the dependency rule between folders, sources that no target builds, files without a licence
line, clocks read outside of core/clock.cpp, libraries used outside of their one place, tests that docs/faults.md and docs/console.md name and that are not there,
keys that mean one thing here and another there. One line for each finding; exit status 1 if any."""
import os
import re
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
FOLDERS = ["core", "config", "planner", "drivers", "sim", "controller", "app"]
MAY_INCLUDE = {
    "core": {"core"},
    "config": {"core", "config"},
    "planner": {"core", "planner"},
    "drivers": {"core", "drivers"},
    "sim": {"core", "sim"},
    "controller": {"core", "controller"},
    "app": set(FOLDERS),
}
# The seam between controller or sim and the drivers is these two headers and nothing else.
SEAM = {"drivers/driver.hpp", "drivers/transport.hpp"}
ONLY_IN = {  # library header -> the only places that may include it
    r"yaml-cpp/": r"^config/",
    r"libserialport\.h": r"^drivers/transports/",
    r"modbus(/modbus)?\.h": r"^drivers/transports/",
    r"gpiod\.h": r"^drivers/transports/",
    r"linux/can": r"^drivers/transports/|^sim/endpoints/",
    r"netlink/": r"^drivers/transports/",
    r"sqlite3\.h": r"^config/",
    r"opencv2/": r"^config/media/|^config/decode|^planner/",
    r"cairo": r"^app/paper/|^config/decode_(text|svg)",
    r"pango": r"^app/paper/|^config/decode_text",
    r"librsvg/": r"^config/decode_svg",
    r"boost/polygon": r"^planner/formation/delaunay",
    r"qrencode": r"^app/paper/qr_code\.cpp",
    r"RtMidi\.h": r"^app/midi/",
    r"lo/": r"^app/remote/|^app/time/",
    r"CLI/": r"^app/",
    r"boost/(asio|beast)": r"^app/(console/|cast/follower)",
}


def tracked(*patterns):
    out = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard", *patterns], cwd=ROOT, capture_output=True, text=True, check=True).stdout.split("\n")
    return [f for f in out if f and os.path.exists(os.path.join(ROOT, f))]


def faults_without_test():
    """docs/faults.md and docs/console.md promise with the names of tests: each of them is there."""
    tests = ""
    for path in tracked("tests/*.cpp", "tests/e2e/*.py"):
        with open(os.path.join(ROOT, path)) as f:
            tests += f.read()
    names = {f"{suite}.{name}" for suite, name in re.findall(r"^TEST(?:_F|_P)?\((\w+),\s*(\w+)\)", tests, re.M)}
    names |= {f"{suite}.{name}" for suite in ("Console", "Devices", "Live", "Survive") for name in re.findall(r"def (test_\w+)", tests)}
    named = []
    for page in ("faults.md", "console.md"):
        with open(os.path.join(ROOT, "docs", page)) as f:
            named += re.findall(r"`([A-Z]\w+\.\w+\*?|[A-Z]\w+\.\*)`", f.read())
    suites = {name.split(".")[0] for name in names}
    return [f"docs/faults.md, docs/console.md: there is no test {name}" for name in sorted(set(named))
            if name not in names and not (name.endswith("*") and (any(n.startswith(name[:-1]) for n in names) or name[:-2] in suites))]


def keys_that_differ():
    """A letter means the same in the terminal, on the console's page and in the table of docs/live.md."""
    def text(path):
        with open(os.path.join(ROOT, path)) as f:
            return f.read()

    terminal, page, table = {}, {}, {}
    for letters, block in re.findall(r"((?:    case '[^'\\\\]':\n)+)((?:      .*\n)+)", text("app/surfaces/prompt_desk.cpp")):
        order = re.search(r'"(\w+)', block)
        for letter in re.findall(r"'(.)'", letters) if order else []:
            terminal[letter.lower()] = order[1]
    keys = text("app/console/web/src/keys.ts")
    page.update(re.findall(r'"?(\w|\.)"?: "(\w+)"', re.search(r"kOrders.*?= \{(.*?)\}", keys)[1]))
    page.update(re.findall(r'case "(\w)":\n\s*return once\(\(\) => desk\.(?:ask\(")?([a-z]+)', keys))
    for letters, orders in re.findall(r"^\| ([a-z.](?:, [a-z.])*) \| (`[^|]*) \|", text("docs/live.md"), re.M):
        for letter, order in zip(letters.split(", "), re.findall(r"`(\w+)", orders)):
            table[letter] = order
    said = {"hold": {"hold", "run"}}  # e: "hold end" and "run on"
    return [f"docs/live.md: {letter} is {name} \"{other}\", not \"{table[letter]}\"" for letter in sorted(table)
            for name, other in (("in the terminal", terminal.get(letter)), ("on the page", page.get(letter)))
            if other not in said.get(table[letter], {table[letter]}) and (other or name == "in the terminal")]


def main():
    findings = []
    product = [f for d in FOLDERS for f in tracked(f"{d}/*.cpp", f"{d}/*.hpp")]
    cmake = "".join(open(os.path.join(ROOT, f)).read() for f in tracked("*CMakeLists.txt"))
    for path in product + tracked("tests/*.cpp", "tests/*.hpp"):
        with open(os.path.join(ROOT, path)) as f:
            text = f.read()
        if not text.startswith("// SPDX-License-Identifier: Apache-2.0\n"):
            findings.append(f"{path}:1: the first line names the licence (// SPDX-License-Identifier: Apache-2.0)")
        if path.endswith(".cpp") and os.path.basename(path) not in cmake:
            findings.append(f"{path}: no target builds it")
        folder = path.split("/")[0]
        for number, line in enumerate(text.split("\n"), 1):
            quoted = re.match(r'\s*#\s*include\s+"([^"]+)"', line)
            if quoted and folder in MAY_INCLUDE:
                other = quoted[1].split("/")[0]
                seam = folder in ("sim", "controller") and quoted[1] in SEAM
                if other in FOLDERS and other not in MAY_INCLUDE[folder] and not seam:
                    findings.append(f"{path}:{number}: {folder} may not include {quoted[1]}")
            angled = re.match(r"\s*#\s*include\s+<([^>]+)>", line)
            if angled and folder in MAY_INCLUDE:
                for library, place in ONLY_IN.items():
                    if re.match(library, angled[1]) and not re.match(place, path):
                        findings.append(f"{path}:{number}: <{angled[1]}> is included only in {place}")
            if folder in MAY_INCLUDE and path not in ("core/clock.cpp", "core/clock.hpp") and \
                    re.search(r"(steady_clock|system_clock|high_resolution_clock)::now|clock_gettime|gettimeofday", line):
                findings.append(f"{path}:{number}: the time is read from a core/clock.hpp Clock")
    findings += faults_without_test() + keys_that_differ()
    for finding in findings:
        print(finding)
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
