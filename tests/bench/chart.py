# SPDX-License-Identifier: Apache-2.0
"""A plot of time against people, both logarithmic, as SVG text."""
import math

WIDTH, HEIGHT = 760, 480
LEFT, RIGHT, TOP, BOTTOM = 70, 210, 30, 60
COLOURS = ("#0b5fa5", "#c2410c", "#15803d", "#7c3aed", "#64748b", "#a16207", "#be185d")


def growth(own, peers, command):
    """@param own, peers  {name: {people: seconds}}; peers are dashed."""
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
