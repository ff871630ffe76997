#!/usr/bin/env python3
"""Draws a report's pictures from the CSV files beside this script, as PNG and SVG.

    python3 plot.py

`ccd report` puts this script into its folder and runs it there. Needs matplotlib; exit status 3
where it is missing.
"""

import csv
import math
import pathlib
import sys

try:
    import matplotlib
except ImportError:
    print("no pictures: Python finds no matplotlib (Debian, Ubuntu: apt-get install "
          "python3-matplotlib)", file=sys.stderr)
    sys.exit(3)

matplotlib.use("Agg")
import matplotlib.colors
import matplotlib.pyplot as plt
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

FOLDER = pathlib.Path(__file__).resolve().parent
INK, PALE, BAND = "#333333", "#d9d9d9", "#f2f2f2"
# Told apart by people who see few colours, too (Paul Tol's palettes).
COLOURS = ["#4477aa", "#ee6677", "#228833", "#ccbb44", "#66ccee", "#aa3377", "#bbbbbb",
           "#000000", "#ee7733", "#009988", "#882255", "#999933", "#332288", "#ddcc77"]

plt.rcParams.update({
    "font.size": 9, "font.family": "DejaVu Sans", "figure.dpi": 100, "savefig.dpi": 200,
    "axes.edgecolor": INK, "axes.labelcolor": INK, "axes.linewidth": 0.7,
    "axes.spines.top": False, "axes.spines.right": False,
    "axes.titlesize": 10, "axes.titlelocation": "left", "axes.titlepad": 8,
    "xtick.color": INK, "ytick.color": INK, "text.color": INK,
    "axes.grid": True, "grid.color": PALE, "grid.linewidth": 0.5, "axes.axisbelow": True,
    "svg.fonttype": "none", "svg.hashsalt": "errbound",
})


def table(name):
    """The file's rows as dictionaries, numbers as numbers; none where there is no such file."""
    path = FOLDER / name
    if not path.exists():
        return []

    def value(text):
        try:
            return float(text)
        except ValueError:
            return text if text else math.nan

    with path.open(newline="") as file:
        return [{key: value(text) for key, text in row.items()} for row in csv.DictReader(file)]


def save(figure, name):
    figure.savefig(FOLDER / f"{name}.png", bbox_inches="tight", pad_inches=0.15)
    figure.savefig(FOLDER / f"{name}.svg", bbox_inches="tight", pad_inches=0.15,
                   metadata={"Date": None})
    plt.close(figure)


def in_order(values):
    """Each value once, in the order of first appearance."""
    return list(dict.fromkeys(values))


def colours(names):
    return {name: COLOURS[i % len(COLOURS)] for i, name in enumerate(names)}


def short(number):
    """0.001, 12, 3k, 2M."""
    if number == 0:
        return "0"
    for size, letter in ((1e6, "M"), (1e3, "k")):
        if abs(number) >= size:
            return f"{number / size:.3g}{letter}"
    return f"{number:.3g}" if abs(number) >= 1e-3 else f"1e{math.log10(abs(number)):.0f}"


def nanoseconds(ns):
    for size, unit in ((1e9, "s"), (1e6, "ms"), (1e3, "µs")):
        if ns >= size:
            return f"{ns / size:.3g} {unit}"
    return f"{ns:.3g} ns"


NANOSECONDS = FuncFormatter(lambda ns, _: nanoseconds(ns))
SHORT = FuncFormatter(lambda number, _: short(number))


# ---- Labels beside points, without overlap ----

def label_points(axes, points):
    """Writes each (x, y, text, colour) beside its point, where it meets neither point nor label."""
    figure = axes.figure
    figure.canvas.draw()
    renderer = figure.canvas.get_renderer()
    pixel = figure.dpi / 72
    frame = axes.get_window_extent(renderer)
    taken = []
    for x, y, _, _ in points:
        px, py = axes.transData.transform((x, y))
        taken.append(matplotlib.transforms.Bbox.from_extents(px - 5 * pixel, py - 5 * pixel,
                                                             px + 5 * pixel, py + 5 * pixel))
    # Right, left, above and below the point, then further and further off.
    offsets = [(8, 0), (-8, 0), (0, 10), (0, -10)]
    for distance in range(14, 140, 6):
        for angle in range(0, 360, 30):
            offsets.append((distance * math.cos(math.radians(angle)),
                            distance * math.sin(math.radians(angle))))
    for i, (x, y, text, colour) in sorted(enumerate(points), key=lambda p: (p[1][1], p[1][0])):
        for dx, dy in offsets:
            side = "left" if dx > 1 else "right" if dx < -1 else "center"
            near = math.hypot(dx, dy) < 12
            label = axes.annotate(
                text, (x, y), xytext=(dx, dy), textcoords="offset points", ha=side, va="center",
                color=INK, fontsize=9,
                arrowprops=None if near else dict(arrowstyle="-", color=colour, lw=0.7,
                                                  shrinkA=0, shrinkB=4))
            box = label.get_window_extent(renderer).expanded(1.04, 1.1)
            text_box = matplotlib.text.Text.get_window_extent(label, renderer)
            inside = (frame.x0 <= text_box.x0 and text_box.x1 <= frame.x1 + 30 * pixel and
                      frame.y0 <= text_box.y0 and text_box.y1 <= frame.y1)
            if inside and not any(text_box.overlaps(other) for other in taken):
                taken.append(text_box)
                break
            label.remove()
        else:
            axes.annotate(text, (x, y), xytext=(8, 0), textcoords="offset points", fontsize=9)


# ---- Error against run time ----

def rate_axis(axes, rates):
    """A logarithmic axis of rates with a band below it for exact zero; returns where zero is."""
    positive = [rate for rate in rates if rate > 0]
    low = 10.0 ** math.floor(math.log10(min(positive))) if positive else 1.0
    high = 10.0 ** math.ceil(math.log10(max(positive)) + 0.15) if positive else 10.0
    decades = max(math.log10(high / low), 1)
    share = 0.35 if any(rate == 0 for rate in rates) else 0.1
    bottom = low / 10 ** (decades * share / (1 - share))
    axes.set_yscale("log")
    axes.set_ylim(bottom, high)
    axes.axhspan(bottom, low, color=BAND, lw=0, zorder=0)
    axes.axhline(low, color=INK, lw=0.7)
    zero = math.sqrt(bottom * low)
    step = max(1, round(decades / 6))
    ticks = [10.0 ** e for e in range(round(math.log10(low)), round(math.log10(high)) + 1, step)]
    axes.set_yticks([zero] + ticks)
    axes.set_yticklabels(["exactly 0"] + [short(tick) for tick in ticks])
    axes.yaxis.set_minor_locator(NullLocator())
    return zero


def pareto():
    methods = totals(table("methods.csv"))
    if not methods:
        return
    colour = colours(methods)
    figure, panels = plt.subplots(2, 1, figsize=(9, 8.6), sharex=True)
    for axes, of, title in (
            (panels[0], ("false_positives", "separate"),
             "False positives per million queries that do not collide"),
            (panels[1], ("false_negatives", "colliding"),
             "False negatives per million queries that collide")):
        rates = {name: 1e6 * m[of[0]] / m[of[1]] if m[of[1]] else 0 for name, m in methods.items()}
        axes.set_xscale("log")
        zero = rate_axis(axes, rates.values())
        axes.set_title(title)
        points = [(m["ns"], rates[name] or zero, name, colour[name])
                  for name, m in methods.items()]
        for x, y, _, c in points:
            axes.plot(x, y, "o", ms=7, mfc=c, mec="white", mew=0.8, zorder=3)
        axes.xaxis.set_major_formatter(NANOSECONDS)
        axes.tick_params(labelbottom=True)
        axes.xaxis.set_minor_locator(LogLocator(subs=range(2, 10)))
        axes.xaxis.set_minor_formatter(matplotlib.ticker.NullFormatter())
        all_ns = [m["ns"] for m in methods.values()]
        axes.set_xlim(min(all_ns) / 1.6, max(all_ns) * 2.2)
        axes.points = points
    panels[1].set_xlabel("time per query, one thread (mean over all queries of all data sets)")
    figure.tight_layout(h_pad=2)
    for axes in panels:
        label_points(axes, axes.points)
    save(figure, "pareto")


def totals(rows):
    """Per method: sums over data sets and kinds, and the mean of ns weighted by queries."""
    methods = {}
    for row in rows:
        m = methods.setdefault(str(row["method"]), dict.fromkeys(
            ("queries", "colliding", "false_positives", "false_negatives", "ns"), 0))
        for key in ("queries", "colliding", "false_positives", "false_negatives"):
            m[key] += row[key]
        m["ns"] += row["ns_min"] * row["queries"]
    for m in methods.values():
        m["ns"] /= m["queries"]
        m["separate"] = m["queries"] - m["colliding"]
    return methods


# ---- Distributions: a line from 1 % to 99 %, thick over the middle half, a dot at the median ----

def spread(axes, at, row, prefix, colour, vertical):
    values = [row.get(f"{prefix}q{p}", math.nan) for p in (1, 25, 50, 75, 99)]
    if any(not isinstance(v, float) or math.isnan(v) for v in values):
        return
    draw = axes.vlines if vertical else axes.hlines
    draw(at, values[0], values[4], color=colour, lw=1)
    draw(at, values[1], values[3], color=colour, lw=4)
    axes.plot(*((at, values[2]) if vertical else (values[2], at)), "o", ms=4, mfc="white",
              mec=colour, mew=1.2)


def rule_legend(figure, colour, note):
    handles = [plt.Line2D([], [], color=c, lw=4, label=rule) for rule, c in colour.items()]
    figure.legend(handles=handles, loc="lower left", bbox_to_anchor=(0.01, 1.0),
                  ncol=len(handles), frameon=False, borderaxespad=0)
    figure.text(0.99, 1.005, note, ha="right", va="bottom", fontsize=8)


SPREAD_NOTE = "dot: median; thick: middle half; thin: 1 % to 99 %"


def grid(rows, height):
    """A panel for each data set (down) and kind (across): yields (axes, rows of the panel)."""
    sets, kinds = in_order(r["data_set"] for r in rows), in_order(r["kind"] for r in rows)
    figure, panels = plt.subplots(len(sets), len(kinds), figsize=(9, height * len(sets)),
                                  squeeze=False)
    cells = []
    for i, name in enumerate(sets):
        for j, kind in enumerate(kinds):
            here = [r for r in rows if (r["data_set"], r["kind"]) == (name, kind)]
            panels[i][j].set_title(f"{name}, {kind}")
            if here:
                cells.append((panels[i][j], here))
            else:
                panels[i][j].set_axis_off()
                panels[i][j].set_title("")
    return figure, cells


def bounds():
    rows = table("bounds.csv")
    if not rows:
        return
    rules = in_order(r["rule"] for r in rows)
    colour = colours(rules)
    variables = in_order(r["variable"] for r in rows)
    figure, cells = grid(rows, 2.5)
    for axes, here in cells:
        axes.set_yscale("log")
        for r in here:
            at = variables.index(r["variable"]) + \
                (rules.index(r["rule"]) - (len(rules) - 1) / 2) * 0.7 / len(rules)
            spread(axes, at, {k: v if v != 0 else math.nan for k, v in r.items()}, "relative_",
                   colour[r["rule"]], True)
        axes.set_xticks(range(len(variables)))
        axes.set_xticklabels(variables)
        axes.grid(axis="x", visible=False)
        axes.set_ylabel("bound / largest |k|")
    figure.tight_layout()
    rule_legend(figure, colour, SPREAD_NOTE)
    save(figure, "bounds")


def tightness():
    rows = table("tightness.csv")
    if not rows:
        return
    rules, quantities = in_order(r["rule"] for r in rows), in_order(r["quantity"] for r in rows)
    colour = colours(rules)
    figure, axes = plt.subplots(figsize=(9, 0.9 + len(quantities) * (0.2 + 0.12 * len(rules))))
    for r in rows:
        at = quantities.index(r["quantity"]) + \
            (rules.index(r["rule"]) - (len(rules) - 1) / 2) * 0.75 / len(rules)
        spread(axes, at, r, "", colour[r["rule"]], False)
    axes.set_yticks(range(len(quantities)))
    axes.set_yticklabels(quantities)
    axes.set_ylim(len(quantities) - 0.4, -0.6)
    axes.grid(axis="y", visible=False)
    axes.xaxis.set_major_formatter(FuncFormatter(lambda x, _: short(10.0 ** x) if abs(x) < 9
                                                 else f"1e{x:.0f}"))
    axes.set_xlim(left=min(0, axes.get_xlim()[0]))
    axes.axvline(0, color=INK, lw=0.7)
    axes.set_xlabel("bound / true error (1: as tight as can be; left of it the bound fails)")
    figure.tight_layout()
    rule_legend(figure, colour, SPREAD_NOTE)
    save(figure, "tightness")


def times():
    rows = table("times.csv")
    if not rows:
        return
    methods = in_order(r["method"] for r in rows)
    marks = (("ns_median", "o", "median"), ("ns_99", "|", "99 %"), ("ns_99_9", "d", "99.9 %"),
             ("ns_worst", "x", "worst"))
    figure, cells = grid(rows, 0.8 + 0.2 * len(methods))
    least = min(max(r["ns_median"], 1) for r in rows)
    most = max(r["ns_worst"] for r in rows)
    for axes, here in cells:
        axes.set_xscale("log")
        for r in here:
            at = methods.index(r["method"])
            axes.hlines(at, max(r["ns_median"], 1), r["ns_worst"], color=PALE, lw=3)
            for key, mark, _ in marks:
                axes.plot(max(r[key], 1), at, mark, ms=5, color=COLOURS[0], mew=1.4,
                          mfc="white" if mark == "o" else COLOURS[0])
        axes.set_yticks(range(len(methods)))
        axes.set_yticklabels(methods)
        axes.set_ylim(len(methods) - 0.5, -0.5)
        axes.set_xlim(least / 1.5, most * 1.5)
        axes.grid(axis="y", visible=False)
        axes.xaxis.set_major_formatter(NANOSECONDS)
        axes.xaxis.set_minor_locator(NullLocator())
    figure.tight_layout()
    handles = [plt.Line2D([], [], color=COLOURS[0], marker=mark, ls="", label=label, mew=1.4,
                          mfc="white" if mark == "o" else COLOURS[0]) for _, mark, label in marks]
    figure.legend(handles=handles, loc="lower left", bbox_to_anchor=(0.01, 1.0),
                  ncol=len(handles), frameon=False, borderaxespad=0)
    figure.text(0.99, 1.005, "time of single queries", ha="right", va="bottom", fontsize=8)
    save(figure, "times")


# ---- Stress heat maps ----

def stress():
    rows = table("stress.csv")
    if not rows:
        return
    families, methods = in_order(r["family"] for r in rows), in_order(r["method"] for r in rows)
    cells = {}  # (family, knob, method): sums over kinds
    for r in rows:
        c = cells.setdefault((r["family"], r["knob"], r["method"]), dict.fromkeys(
            ("queries", "false_negatives", "false_positives", "ns"), 0))
        for key in ("queries", "false_negatives", "false_positives"):
            c[key] += r[key]
        c["ns"] += r["ns_per_query"] * r["queries"]
    names = {r["family"]: r["knob_name"] for r in rows}
    for quantity, name, title in (
            ("false_negatives", "stress-false-negatives", "false negatives, share of queries"),
            ("false_positives", "stress-false-positives", "false positives, share of queries"),
            ("ns", "stress-ns", "ns per query")):
        value = {at: c[quantity] / c["queries"] for at, c in cells.items() if c["queries"]}
        heat_map(value, families, methods, names, name, title, quantity == "ns")


def heat_map(value, families, methods, knob_names, name, title, is_time):
    positive = [v for v in value.values() if v > 0]
    low, high = (min(positive), max(positive)) if positive else (1e-3, 1)
    norm = matplotlib.colors.LogNorm(low, max(high, low * 1.01))
    palette = matplotlib.colormaps["viridis" if is_time else "YlOrRd"].copy()
    palette.set_bad(BAND)  # exactly 0
    columns = 3
    lines = -(-len(families) // columns)
    figure, panels = plt.subplots(lines, columns, squeeze=False,
                                  figsize=(12, lines * (1.0 + 0.17 * len(methods))))
    for i, axes in enumerate(panels.flat):
        if i >= len(families):
            axes.set_axis_off()
            continue
        family = families[i]
        knobs = in_order(knob for f, knob, _ in value if f == family)
        image = [[value.get((family, knob, method), math.nan) or math.nan for knob in knobs]
                 for method in methods]
        axes.imshow(image, norm=norm, cmap=palette, aspect="auto", interpolation="nearest")
        axes.set_title(family, fontsize=9)
        axes.set_yticks(range(len(methods)))
        axes.set_yticklabels(methods if i % columns == 0 else [], fontsize=8)
        step = max(1, -(-len(knobs) // 6))
        axes.set_xticks(range(0, len(knobs), step))
        axes.set_xticklabels([short(k) if isinstance(k, float) else k for k in knobs[::step]],
                             fontsize=7)
        axes.set_xlabel(knob_names[family], fontsize=8)
        axes.grid(False)
    figure.tight_layout()
    bar = figure.colorbar(matplotlib.cm.ScalarMappable(norm, palette), ax=panels, shrink=0.5,
                          aspect=30, pad=0.02, format=NANOSECONDS if is_time else SHORT)
    bar.set_label(title if is_time else f"{title} (grey: none)")
    save(figure, name)


for draw in (pareto, bounds, tightness, times, stress):
    draw()
