#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Measures the theatre of shows/kang-theatre on its walked schedule: how long people take through each door, and how crowded it is there.

    /usr/bin/python3 tests/bench/kang2014.py MARKS.CSV    as `footlight export shows/kang-theatre/show.yaml --csv DIR` writes it
"""
import csv
import sys

import numpy

DOORS = {"front, stage right": (0, (-10.5, 12.5)), "front, stage left": (100, (10.5, 12.5)),
         "side, stage right": (200, (-23.5, 27.5)), "side, stage left": (300, (23.5, 27.5))}
NEAR_M = 5


def walks(path):
    people = {}
    for row in csv.DictReader(open(path)):
        people.setdefault(int(row["performer"]), []).append((float(row["time_s"]), float(row["x_m"]), float(row["y_m"])))
    end = max(marks[-1][0] for marks in people.values())
    times = numpy.arange(0, end, 0.5)
    at = numpy.empty((len(people), len(times), 2))
    for k, who in enumerate(sorted(people)):
        t, x, y = numpy.array(people[who]).T
        at[k, :, 0], at[k, :, 1] = numpy.interp(times, t, x), numpy.interp(times, t, y)
    return times, at


def main():
    times, at = walks(sys.argv[1])
    print("| door | within 5 m: most | mean while anybody is | first out | half | last out |\n|---|---|---|---|---|---|")
    for name, (first, (x, y)) in DOORS.items():
        group = at[first:first + 100]
        near = (numpy.hypot(group[..., 0] - x, group[..., 1] - y) <= NEAR_M).sum(axis=0)
        outside = group[..., 1] < y if name.startswith("front") else numpy.abs(group[..., 0]) > abs(x)
        out = numpy.sort(times[outside.argmax(axis=1)])
        print(f"| {name} | {near.max()} | {near[near > 0].mean():.1f} | {out[0]:.0f} s | {out[len(out) // 2]:.0f} s | {out[-1]:.0f} s |")


if __name__ == "__main__":
    main()
