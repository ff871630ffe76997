#!/usr/bin/env python3
"""Draws a report's pictures from the CSV files in this script's folder, as PNG and SVG.

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
import numpy
from matplotlib.ticker import EngFormatter, FuncFormatter, LogLocator, NullLocator

FOLDER = pathlib.Path(__file__).resolve().parent
PIXELS = 2000
INK, PALE, BAND = "#333333", "#d9d9d9", "#f2f2f2"
# Distinguishable by colour-blind people (Paul Tol's palettes).
COLOURS = ["#4477aa", "#ee6677", "#228833", "#ccbb44", "#66ccee", "#aa3377", "#bbbbbb",
           "#000000", "#ee7733", "#009988", "#882255", "#999933", "#332288", "#ddcc77"]

plt.rcParams.update({
    "font.size": 9, "font.family": "DejaVu Sans", "figure.dpi": 100,
    "axes.edgecolor": INK, "axes.labelcolor": INK, "axes.linewidth": 0.7,
    "axes.spines.top": False, "axes.spines.right": False,
    "axes.titlesize": 10, "axes.titlelocation": "left", "axes.titlepad": 8,
    "xtick.color": INK, "ytick.color": INK, "text.color": INK,
    "axes.grid": True, "grid.color": PALE, "grid.linewidth": 0.5, "axes.axisbelow": True,
    "svg.fonttype": "none", "svg.hashsalt": "errbound",
})


def table(name):
    """Return the file's rows as dictionaries, with numbers as floats; none if there is no such file."""
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
    """Write the figure as PNG, at most PIXELS a side, and as SVG."""
    figure.canvas.draw()
    box, pad = figure.get_tightbbox(figure.canvas.get_renderer()), 0.15
    dpi = min(200, PIXELS / (max(box.width, box.height) + 2 * pad + 0.05))
    figure.savefig(FOLDER / f"{name}.png", bbox_inches="tight", pad_inches=pad, dpi=dpi)
    figure.savefig(FOLDER / f"{name}.svg", bbox_inches="tight", pad_inches=0.15,
                   metadata={"Date": None})
    plt.close(figure)


def in_order(values):
    """Return each value once, in the order of first appearance."""
    return list(dict.fromkeys(values))


def colours(names):
    return {name: COLOURS[i % len(COLOURS)] for i, name in enumerate(names)}


def short(number):
    """0.001, 12, 3k, 2M."""
    if math.isinf(number):  # a logarithmic knob of -inf
        return "zero"
    if number == 0:
        return "0"
    for size, letter in ((1e6, "M"), (1e3, "k")):
        if abs(number) >= size:
            return f"{number / size:.3g}{letter}"
    return f"{number:.3g}" if abs(number) >= 1e-3 else f"1e{math.log10(abs(number)):.0f}"


def power(exponent):
    """Ten to this power: 1.4, 230, 1e12."""
    if math.isnan(exponent):
        return "-"
    return f"{10 ** exponent:.2g}" if -3 < exponent < 2 else f"1e{exponent:.0f}"


NANOSECONDS = FuncFormatter(lambda ns, _: EngFormatter("s")(ns / 1e9))
SHORT = FuncFormatter(lambda number, _: short(number))


# ---- Error against run time ----

def rate_axis(axes, rates):
    """Make a logarithmic axis of rates, linear below the least positive rate to show exact zeros."""
    least = 10.0 ** math.floor(math.log10(min((r for r in rates if r > 0), default=1)))
    axes.set_yscale("symlog", linthresh=least, linscale=0.5)
    axes.set_ylim(-0.3 * least, 10.0 ** math.ceil(math.log10(max(*rates, least)) + 0.1))
    axes.yaxis.set_major_formatter(SHORT)
    axes.axhspan(-0.3 * least, 0.6 * least, color=BAND, lw=0, zorder=0)


def label_points(axes, points):
    """Write each (x, y, text, colour) next to its point, clear of points and labels."""
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
    offsets = [(8, 0), (-8, 0), (0, 11), (0, -11)]
    for distance in range(14, 140, 6):
        for angle in range(0, 360, 30):
            offsets.append((distance * math.cos(math.radians(angle)),
                            distance * math.sin(math.radians(angle))))
    at = axes.transData.transform([point[:2] for point in points])
    for x, y, text, colour in sorted(points, key=lambda point: point[:2]):
        px, py = axes.transData.transform((x, y))
        # If two points nearly coincide, the left one's label stands on the left.
        neighbour = any(0 < qx - px < 14 * pixel and abs(qy - py) < 10 * pixel for qx, qy in at)
        for dx, dy in [(-8, 0)] * neighbour + offsets:
            side = "left" if dx > 1 else "right" if dx < -1 else "center"
            line = None if math.hypot(dx, dy) < 12 else dict(
                arrowstyle="-", color=colour, lw=0.7, shrinkA=0, shrinkB=4)
            label = axes.annotate(text, (x, y), xytext=(dx, dy), textcoords="offset points",
                                  ha=side, va="center", arrowprops=line)
            label.update_positions(renderer)
            box = matplotlib.text.Text.get_window_extent(label, renderer)  # without the line
            inside = (frame.x0 <= box.x0 and box.x1 <= frame.x1 and
                      frame.y0 <= box.y0 and box.y1 <= frame.y1)
            if inside and not any(box.overlaps(other) for other in taken):
                taken.append(box)
                break
            label.remove()
        else:  # a crowd: better over another label than nowhere
            axes.annotate(text, (x, y), xytext=(8, 0), textcoords="offset points", va="center")


def totals(rows):
    """Return for each method sums over data sets and kinds, and the mean of ns weighted by queries."""
    methods = {}
    for row in rows:
        m = methods.setdefault(row["method"], dict.fromkeys(
            ("queries", "colliding", "false_positives", "false_negatives", "ns"), 0))
        for key in ("queries", "colliding", "false_positives", "false_negatives"):
            m[key] += row[key]
        m["ns"] += row["ns_min"] * row["queries"]
    for m in methods.values():
        m["ns"] /= m["queries"]
        m["separate"] = m["queries"] - m["colliding"]
    return methods


def pareto(rows, name, of_what):
    if not rows:
        return
    methods = totals(rows)
    colour = colours(methods)
    ns = {name: m["ns"] for name, m in methods.items()}
    figure, panels = plt.subplots(2, 1, figsize=(9, 8.6), sharex=True)
    panels[0].set_xscale("log")
    panels[0].set_xlim(min(ns.values()) / 1.6, max(ns.values()) * 2.6)
    panels[1].set_xlabel("time per query, one thread, mean over all")
    any_method = next(iter(methods.values()))
    judged = ((panels[0], "false_positives", "separate", "False positives", "do not collide"),
              (panels[1], "false_negatives", "colliding", "False negatives", "collide"))
    for axes, _, among, what, do in judged:
        axes.set_title(f"{what} per million, of the {any_method[among]:,.0f} {of_what} that {do}")
        axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axes.xaxis.set_major_formatter(NANOSECONDS)
        axes.xaxis.set_minor_locator(NullLocator())
        axes.tick_params(labelbottom=True)
    figure.tight_layout(h_pad=2)
    for axes, errors, among, _, _ in judged:
        rates = {name: 1e6 * m[errors] / max(m[among], 1) for name, m in methods.items()}
        rate_axis(axes, rates.values())
        points = [(ns[name], rates[name], name, colour[name]) for name in methods]
        for x, y, _, c in points:
            axes.plot(x, y, "o", ms=7, mfc=c, mec="white", mew=0.8, zorder=3, clip_on=False)
        label_points(axes, points)
    save(figure, name)


def methods(rows):
    pareto([r for r in rows if r["origin"] == "scene"], "pareto", "candidate pairs of steps")
    pareto([r for r in rows if r["origin"] != "scene"], "pareto-queries",
           "queries picked to be hard")


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


def legend(figure, handles, note):
    """Add a line of handles above the figure, and the note above it."""
    figure.legend(handles=handles, loc="lower left", bbox_to_anchor=(0.01, 1.0),
                  ncol=len(handles), frameon=False, borderaxespad=0)
    figure.text(0.012, 1 + 0.3 / figure.get_figheight(), note, va="bottom")


def rule_legend(figure, colour, note):
    legend(figure, [plt.Line2D([], [], color=c, lw=4, label=r) for r, c in colour.items()], note)


SPREAD_NOTE = "Dot: median; thick: middle half; thin: 1 % to 99 %"


def grid(rows, height):
    """Make a panel for each data set (down) and kind (across). Return the figure and (axes, rows).

    Many data sets stand in several columns, so that the figure is not taller than wide.
    """
    sets, kinds = in_order(r["data_set"] for r in rows), in_order(r["kind"] for r in rows)
    across = next(n for n in range(1, len(sets) + 1) if height * -(-len(sets) // n) <= max(9 * n, height))
    lines = -(-len(sets) // across)
    figure, panels = plt.subplots(lines, across * len(kinds), squeeze=False,
                                  figsize=(9 * across, height * lines))
    cells = []
    for axes in panels.flat:
        axes.set_axis_off()
    for i, name in enumerate(sets):
        for j, kind in enumerate(kinds):
            here = [r for r in rows if (r["data_set"], r["kind"]) == (name, kind)]
            if here:
                axes = panels[i % lines][i // lines * len(kinds) + j]
                axes.set_axis_on()
                axes.set_title(f"{name}, {kind}")
                cells.append((axes, here))
    return figure, cells


def bounds(rows):
    rules = in_order(r["rule"] for r in rows)
    colour = colours(rules)
    variables = in_order(r["variable"] for r in rows)
    # All values of a query's k may be rounding errors, so the axis is bounded.
    low, high = 1e-18, 1e3
    figure, cells = grid(rows, 2.1)
    for axes, here in cells:
        axes.set_yscale("log")
        axes.set_ylim(low, high)
        axes.set_yticks([10.0 ** e for e in range(-18, 4, 3)])
        for r in here:
            at = variables.index(r["variable"]) + \
                (rules.index(r["rule"]) - (len(rules) - 1) / 2) * 0.7 / len(rules)
            inside = {key: min(max(value, low), high) if isinstance(value, float) else value
                      for key, value in r.items()}
            spread(axes, at, inside, "relative_", colour[r["rule"]], True)
        axes.set_xticks(range(len(variables)))
        axes.set_xticklabels(variables)
        axes.grid(axis="x", visible=False)
        axes.set_ylabel("bound / largest |k|")
    figure.tight_layout()
    rule_legend(figure, colour, SPREAD_NOTE + "; cut off at 1e-18 and 1000")
    save(figure, "bounds")


def tightness(rows):
    rows = [r for r in rows if r["number"] == "double" and r["measure"] != "error/value"]
    if not rows:
        return
    for r in rows:
        r["quantity"] = f"{r['part']}: {r['quantity']}"
    rules, quantities = in_order(r["rule"] for r in rows), in_order(r["quantity"] for r in rows)
    image = numpy.full((len(quantities), len(rules)), math.nan)
    figure, axes = plt.subplots(figsize=(2.6 + 0.72 * len(rules), 1.4 + 0.24 * len(quantities)))
    for r in rows:
        at = quantities.index(r["quantity"]), rules.index(r["rule"])
        image[at] = r["median"]
        if not math.isnan(r["median"]):
            axes.text(at[1], at[0], f"{power(r['median'])} / {power(r['q99'])}", ha="center",
                      va="center", fontsize=6.5, color="white" if r["median"] > 8 else INK)
    # Most medians lie below 10^2, some far beyond.
    palette = matplotlib.colormaps["YlOrRd"].copy()
    palette.set_bad(BAND)
    palette.set_under(COLOURS[4])
    drawn = axes.imshow(image, cmap=palette, aspect="auto", interpolation="nearest",
                        norm=matplotlib.colors.PowerNorm(0.5, 0, 16))
    axes.set_xticks(range(len(rules)))
    axes.set_xticklabels(rules, rotation=45, ha="left", rotation_mode="anchor")
    axes.xaxis.tick_top()
    axes.set_yticks(range(len(quantities)))
    axes.set_yticklabels(quantities)
    axes.grid(False)
    bar = figure.colorbar(drawn, ax=axes, shrink=0.4, aspect=30, pad=0.02, extend="both",
                          ticks=[0, 1, 2, 4, 8, 16],
                          format=FuncFormatter(lambda x, _: f"$10^{{{x:.0f}}}$"))
    bar.set_label("median of bound / true error (blue: the bound fails, or an estimate is too small)")
    axes.set_xlabel("in each field: median / 99 % of bound / true error; grey: no errors, or all bounds infinite")
    save(figure, "tightness")


def times(rows):
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
        axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5) if most < 300 * least else (1,)))
        axes.xaxis.set_major_formatter(NANOSECONDS)
        axes.xaxis.set_minor_locator(NullLocator())
    figure.tight_layout()
    handles = [plt.Line2D([], [], color=COLOURS[0], marker=mark, ls="", label=label, mew=1.4,
                          mfc="white" if mark == "o" else COLOURS[0]) for _, mark, label in marks]
    legend(figure, handles, "Time of single queries")
    save(figure, "times")


# ---- First contacts ----

def contacts(rows):
    names = [f"{r['data_set']}, {r['kind']}" for r in rows]
    figure, (kinds, costs) = plt.subplots(1, 2, figsize=(9, 1.2 + 0.17 * len(rows)), sharey=True,
                                          gridspec_kw={"width_ratios": (2, 3)})
    shares = (("at_start", "at the start"), ("one_double", "at another double"),
              ("neighbours", "between two neighbours"))
    left = numpy.zeros(len(rows))
    for (key, label), colour in zip(shares, COLOURS):
        share = numpy.array([r[key] / max(r["contacts"], 1) for r in rows])
        kinds.barh(range(len(rows)), share, left=left, color=colour, height=0.7, label=label)
        left += share
    kinds.set_title("Times of contacts")
    kinds.set_xlim(0, 1)
    kinds.set_xlabel("share of contacts")
    requests = (("ns_batch_", "s", "in batches"), ("ns_", "o", "one by one"),
                ("ns_contact_", "d", "one by one, only contacts"))
    for (prefix, mark, label), colour in zip(requests, COLOURS[3:]):
        costs.plot([r[prefix + "time"] / r[prefix + "decision"] for r in rows], range(len(rows)),
                   mark, ms=5, color=colour, mec="white", mew=0.6, label=label)
    costs.axvline(1, color=INK, lw=0.7)
    costs.set_title("First times compared with yes or no")
    costs.set_xlabel("time with first times / time of yes or no")
    kinds.set_yticks(range(len(rows)))
    kinds.set_yticklabels(names, fontsize=8)
    kinds.set_ylim(len(rows) - 0.4, -0.6)
    for axes in (kinds, costs):
        axes.grid(axis="y", visible=False)
        axes.legend(loc="upper left", bbox_to_anchor=(0, -0.45 / figure.get_figheight() - 0.04),
                    frameon=False, fontsize=8)
    figure.tight_layout()
    save(figure, "contacts")


# ---- Stress heat maps ----

def stress(rows):
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
    ticks = [d * 10.0 ** e for e in range(-12, 12) for d in (1, 2, 5)]
    bar.set_ticks([tick for tick in ticks if norm.vmin <= tick <= norm.vmax])
    bar.set_label(title if is_time else f"{title} (grey: none)")
    save(figure, name)


for draw in (methods, bounds, tightness, times, contacts, stress):
    if table_rows := table(f"{draw.__name__}.csv"):
        draw(table_rows)
