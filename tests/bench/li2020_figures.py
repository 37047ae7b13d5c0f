# SPDX-License-Identifier: Apache-2.0
"""The figures of Li 2020 as SVG text: deviation over time, and people on the floor."""
COLOURS = ("#c2410c", "#0b5fa5", "#15803d", "#7c3aed", "#64748b")
COMMAND = "scripts/li2020"


def begin(width, height):
    return [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="12">',
            f"<desc>made by {COMMAND}</desc>", f'<rect width="{width}" height="{height}" fill="white"/>']


def over_time(series):
    """theta_dev over the frames of the show. @param series  {name: [[seconds, theta_dev], ...]}"""
    width, height, left, right, top, bottom = 900, 360, 60, 150, 20, 50
    last_s = max(time_s for line in series.values() for time_s, _ in line)
    most = max(0.1, max(theta for line in series.values() for _, theta in line))
    x = lambda time_s: left + time_s / last_s * (width - left - right)
    y = lambda theta: height - bottom - theta / most * (height - top - bottom)
    out = begin(width, height)
    step = 0.05 if most < 0.4 else 0.1 if most < 0.7 else 0.2
    for k in range(int(most / step) + 1):
        out.append(f'<line x1="{left}" x2="{width - right}" y1="{y(k * step):.1f}" y2="{y(k * step):.1f}" stroke="#ddd"/>')
        out.append(f'<text x="{left - 8}" y="{y(k * step) + 4:.1f}" text-anchor="end">{100 * k * step:.0f} %</text>')
    for time_s in range(0, int(last_s) + 1, 20 if last_s < 300 else 60):
        out.append(f'<text x="{x(time_s):.1f}" y="{height - bottom + 18}" text-anchor="middle">{25 * time_s:,}</text>')
    out.append(f'<text x="{(left + width - right) / 2}" y="{height - 12}" text-anchor="middle">frame of the show, 25 a second</text>')
    for n, (name, line) in enumerate(series.items()):
        colour = COLOURS[n % len(COLOURS)]
        points = " ".join(f"{x(time_s):.1f},{y(theta):.1f}" for time_s, theta in line)
        out.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="1.3"/>')
        out.append(f'<line x1="{width - right + 12}" x2="{width - right + 36}" y1="{top + 20 * n + 10}" y2="{top + 20 * n + 10}" stroke="{colour}" stroke-width="2"/>')
        out.append(f'<text x="{width - right + 42}" y="{top + 20 * n + 14}">{name}</text>')
    return "\n".join(out + ["</svg>", ""])


def people(rows, stage, window):
    """People on the floor, who stands outside of the picture in red. @param rows  [(name, [(caption, places, rho), ...]), ...]
    @param window  (x0, y0, x1, y1), metres, of the floor to show"""
    x0, y0, x1, y1 = window
    cell = 210 / max(x1 - x0, y1 - y0)
    wide, high = cell * (x1 - x0), cell * (y1 - y0)
    left, top, gap = 110, 24, 12
    width = left + max(len(pictures) for _, pictures in rows) * (wide + gap)
    out = begin(f"{width:.0f}", f"{top + len(rows) * (high + gap):.0f}")
    radius = 0.4 * cell * stage["grid"]["pitch_m"]
    for r, (name, pictures) in enumerate(rows):
        at_y = top + r * (high + gap)
        out.append(f'<text x="{left - 10}" y="{at_y + high / 2:.0f}" text-anchor="end">{name}</text>')
        for c, (caption, places, rho) in enumerate(pictures):
            at_x = left + c * (wide + gap)
            if r == 0:
                out.append(f'<text x="{at_x + wide / 2:.0f}" y="{top - 8}" text-anchor="middle">{caption}</text>')
            out.append(f'<rect x="{at_x:.1f}" y="{at_y:.1f}" width="{wide:.1f}" height="{high:.1f}" fill="#f8f8f8"/>')
            for colour, chosen in (("#222", rho >= 0.5), ("#dc2626", rho < 0.5)):
                dots = "".join(f"M{at_x + cell * (x - x0):.1f} {at_y + cell * (y1 - y):.1f}h0"
                               for x, y in places[chosen] if x0 <= x <= x1 and y0 <= y <= y1)
                out.append(f'<path d="{dots}" stroke="{colour}" stroke-width="{2 * radius:.1f}" stroke-linecap="round"/>')
    return "\n".join(out + ["</svg>", ""])
