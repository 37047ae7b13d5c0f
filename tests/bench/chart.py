# SPDX-License-Identifier: Apache-2.0
"""Plots as SVG text."""
import math

WIDTH, HEIGHT = 760, 480
LEFT, RIGHT, TOP, BOTTOM = 70, 210, 30, 60
COLOURS = ("#0b5fa5", "#c2410c", "#15803d", "#7c3aed", "#64748b", "#a16207", "#be185d")


def growth(own, peers, command):
    """Time against people, both logarithmic.  @param own, peers  {name: {people: seconds}}; peers are dashed."""
    points = [point for series in (*own.values(), *peers.values()) for point in series.items()]
    x0, x1 = (f(math.log10(people) for people, _ in points) for f in (min, max))
    y0 = math.floor(min(math.log10(seconds) for _, seconds in points))
    y1 = math.ceil(max(math.log10(seconds) for _, seconds in points))

    def x(people):
        return LEFT + (math.log10(people) - x0) / (x1 - x0) * (WIDTH - LEFT - RIGHT)

    def y(seconds):
        return HEIGHT - BOTTOM - (math.log10(seconds) - y0) / (y1 - y0) * (HEIGHT - TOP - BOTTOM)

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="12">',
           f"<desc>made by {command}</desc>", f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>']
    for power in range(y0, y1 + 1):
        out.append(f'<line x1="{LEFT}" x2="{WIDTH - RIGHT}" y1="{y(10 ** power):.1f}" y2="{y(10 ** power):.1f}" stroke="#ddd"/>')
        out.append(f'<text x="{LEFT - 8}" y="{y(10 ** power) + 4:.1f}" text-anchor="end">{tick(power)}</text>')
    for people in sorted({people for people, _ in points} - {5000}):
        out.append(f'<text x="{x(people):.1f}" y="{HEIGHT - BOTTOM + 18}" text-anchor="middle">{people:,}</text>')
    out.append(f'<text x="{(LEFT + WIDTH - RIGHT) / 2}" y="{HEIGHT - 18}" text-anchor="middle">people</text>')
    names = [(name, series, "") for name, series in own.items()]
    names += [(name, series, ' stroke-dasharray="5 4"') for name, series in peers.items()]
    for n, (name, series, dash) in enumerate(names):
        colour = COLOURS[n % len(COLOURS)]
        line = " ".join(f"{x(people):.1f},{y(seconds):.1f}" for people, seconds in sorted(series.items()))
        out.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="2"{dash}/>')
        row = TOP + 20 * n + 10
        out.append(f'<line x1="{WIDTH - RIGHT + 15}" x2="{WIDTH - RIGHT + 45}" y1="{row}" y2="{row}" stroke="{colour}" stroke-width="2"{dash}/>')
        out.append(f'<text x="{WIDTH - RIGHT + 52}" y="{row + 4}">{name}</text>')
    return "\n".join(out + ["</svg>", ""])


def tick(power):
    return f"{10 ** power:g} s" if power >= 0 else f"{10 ** (power + 3):g} ms" if power >= -3 else f"{10 ** (power + 6):g} µs"


def curves(series, x_name, y_name, command):
    """Lines through points with a word at each.  @param series  {name: [(x, y in percent, word)]}"""
    x1 = max(x for points in series.values() for x, _, _ in points) * 1.05
    y0 = min(0, min(y for points in series.values() for _, y, _ in points))

    def at(x, y):
        return (LEFT + x / x1 * (WIDTH - LEFT - RIGHT), HEIGHT - BOTTOM - (y - y0) / (100 - y0) * (HEIGHT - TOP - BOTTOM))

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="12">',
           f"<desc>made by {command}</desc>", f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>']
    for percent in range(0, 101, 20):
        left, level = at(0, percent)
        out.append(f'<line x1="{left}" x2="{WIDTH - RIGHT}" y1="{level:.1f}" y2="{level:.1f}" stroke="#ddd"/>')
        out.append(f'<text x="{left - 8}" y="{level + 4:.1f}" text-anchor="end">{percent}</text>')
    for half in range(int(2 * x1) + 1):
        x, bottom = at(half / 2, y0)
        out.append(f'<text x="{x:.1f}" y="{bottom + 18:.1f}" text-anchor="middle">{half / 2:g}</text>')
    out.append(f'<text x="{(LEFT + WIDTH - RIGHT) / 2}" y="{HEIGHT - 18}" text-anchor="middle">{x_name}</text>')
    out.append(f'<text transform="translate(20 {(TOP + HEIGHT - BOTTOM) / 2}) rotate(-90)" text-anchor="middle">{y_name}</text>')
    for n, (name, points) in enumerate(series.items()):
        colour = COLOURS[n % len(COLOURS)]
        dash = "" if n < len(COLOURS) else ' stroke-dasharray="5 4"'
        line = " ".join("{:.1f},{:.1f}".format(*at(x, y)) for x, y, _ in points)
        out.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="2"{dash}/>')
        for x, y, word in points:
            px, py = at(x, y)
            out.append(f'<circle cx="{px:.1f}" cy="{py:.1f}" r="3" fill="{colour}"/>')
            out.append(f'<text x="{px + 5:.1f}" y="{py - 4:.1f}" font-size="9" fill="{colour}">{word}</text>')
        row = TOP + 20 * n + 10
        out.append(f'<line x1="{WIDTH - RIGHT + 15}" x2="{WIDTH - RIGHT + 45}" y1="{row}" y2="{row}" stroke="{colour}" stroke-width="2"{dash}/>')
        out.append(f'<text x="{WIDTH - RIGHT + 52}" y="{row + 4}">{name}</text>')
    return "\n".join(out + ["</svg>", ""])
