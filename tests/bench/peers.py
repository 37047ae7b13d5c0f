# SPDX-License-Identifier: Apache-2.0
"""Peers in Python on the files that `footlight_bench --write` makes; one JSON object a line of each command.

peers.py assignment FILE squared|euclidean REPETITIONS   scipy.optimize.linear_sum_assignment (Crouse 2016)
peers.py formation FILE REPETITIONS                      numpy: sums over the frame, shares of cells, the best NUM
"""
import json
import resource
import sys
import time

import numpy


def timed(repetitions, work):
    """CPU seconds of each run, and the last result."""
    seconds = []
    for _ in range(repetitions):
        start = time.process_time()
        result = work()
        seconds.append(time.process_time() - start)
    return seconds, result


def peak_mb():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def assignment(file, cost, repetitions):
    from scipy.optimize import linear_sum_assignment
    points = numpy.loadtxt(file, skiprows=1)
    before = peak_mb()

    def work():
        difference_x = points[:, None, 0] - points[None, :, 2]
        difference_y = points[:, None, 1] - points[None, :, 3]
        costs = difference_x ** 2 + difference_y ** 2
        if cost == "euclidean":
            costs = numpy.sqrt(costs)
        rows, columns = linear_sum_assignment(costs)
        return costs[rows, columns].sum()

    seconds, total = timed(repetitions, work)
    return {"seconds": seconds, "cost": total, "mb": peak_mb() - before}


def formation(file, repetitions, people=3290):
    with open(file, encoding="ascii") as lines:
        _, _, columns, rows = (int(word) for word in next(lines).split())
        a, _, c, _, e, f = (float(word) for word in next(lines).split())
        frame = numpy.array([numpy.frombuffer(line.strip().encode(), numpy.uint8) - ord("0") for line in lines])
    before = peak_mb()

    def work():
        sums = numpy.zeros((frame.shape[0] + 1, frame.shape[1] + 1), numpy.int32)
        numpy.cumsum(numpy.cumsum(frame, axis=0, dtype=numpy.int32), axis=1, out=sums[1:, 1:])

        def at(x, y):  # between pixels the sums are bilinear
            x = numpy.clip(x, 0, frame.shape[1])
            y = numpy.clip(y, 0, frame.shape[0])
            left = numpy.minimum(x.astype(int), frame.shape[1] - 1)
            top = numpy.minimum(y.astype(int), frame.shape[0] - 1)
            u, v = (x - left)[None, :], (y - top)[:, None]
            upper = sums[numpy.ix_(top, left)] * (1 - u) + sums[numpy.ix_(top, left + 1)] * u
            lower = sums[numpy.ix_(top + 1, left)] * (1 - u) + sums[numpy.ix_(top + 1, left + 1)] * u
            return upper * (1 - v) + lower * v

        middle_x = a * (numpy.arange(columns) - (columns - 1) / 2) + c
        middle_y = e * (numpy.arange(rows) + 0.5) + f
        half = abs(a) / 2
        area = (at(middle_x + half, middle_y + half) - at(middle_x - half, middle_y + half)
                - at(middle_x + half, middle_y - half) + at(middle_x - half, middle_y - half))
        shares = (area / (4 * half * half)).ravel()
        return shares[numpy.argpartition(-shares, people)[:people]].sum()

    seconds, total = timed(repetitions, work)
    return {"seconds": seconds, "cost": total, "mb": peak_mb() - before}


if __name__ == "__main__":
    if sys.argv[1] == "assignment":
        answer = assignment(sys.argv[2], sys.argv[3], int(sys.argv[4]))
    else:
        answer = formation(sys.argv[2], int(sys.argv[3]))
    print(json.dumps({key: float(value) if key != "seconds" else value for key, value in answer.items()}))
