"""Pareto plots as SVG, to stand in a page."""
import io
import re

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt
from matplotlib import ticker

matplotlib.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "speed", "font.family": "sans-serif", "font.size": 10,
                            "axes.spines.top": False, "axes.spines.right": False})
DEFAULT = "#b3261e"
COLOURS = ("#2b5c8a", "#d1802b", "#4a8f5c", "#7a5195")


def svg_of(figure):
    text = io.StringIO()
    figure.savefig(text, format="svg", bbox_inches="tight", metadata={"Date": None})
    plt.close(figure)
    svg = text.getvalue()
    svg = svg[svg.index("<svg"):]  # without the XML head
    return re.sub(r'width="[\d.]+pt" height="[\d.]+pt" ', "", svg, count=1)  # as wide as the page lets it


def plain(value, _=None):
    return f"{value:g}"


def few_ticks(low, high):
    """1, 2 and 5 of each decade, or all where there is no more than one of those."""
    sparse = high / low > 4
    return lambda value, _: f"{value:g}" if not sparse or f"{value:e}"[0] in "125" else ""


def pareto(series, xlabel, ylabel, default=None, floor=None):
    """series: {name: [(label, (least, median, most) time, error)]}. `default` is the label of the default in each series;
    errors below `floor` are drawn on it."""
    figure, axis = plt.subplots(figsize=(5.6, 3.9))
    for (name, points), colour in zip(series.items(), COLOURS):
        points = [(label, time, max(error, floor) if floor else error) for label, time, error in points if error is not None]
        times = [time[1] for _, time, _ in points]
        errors = [error for _, _, error in points]
        spread = [[t[1] - t[0] for _, t, _ in points], [t[2] - t[1] for _, t, _ in points]]
        axis.errorbar(times, errors, xerr=spread, color=colour, marker="o", markersize=4.5, linewidth=1, elinewidth=0.8,
                      capsize=2, alpha=0.9, label=name)
        for place, (label, time, error) in enumerate(points):
            axis.annotate(label, (time[1], error), textcoords="offset points", xytext=(5, 5 if place % 2 == 0 else -11),
                          fontsize=8, color=colour)
            if label == default:
                axis.plot(time[1], error, marker="o", markersize=13, markerfacecolor="none", markeredgecolor=DEFAULT,
                          markeredgewidth=1.6)
    axis.set_xscale("log")
    axis.set_yscale("log")
    for one in (axis.xaxis, axis.yaxis):
        low, high = one.get_view_interval()
        one.set_major_formatter(ticker.FuncFormatter(plain))
        few = high / low < 30  # less than a decade and a half: more than the powers of ten
        one.set_minor_formatter(ticker.FuncFormatter(few_ticks(low, high)) if few else ticker.NullFormatter())
    axis.set_xlabel(xlabel)
    axis.set_ylabel(ylabel)
    axis.grid(alpha=0.25, which="both")
    axis.margins(0.12)
    if len(series) > 1:
        axis.legend(fontsize=8.5, frameon=False)
    return svg_of(figure)


def stacked(rows, parts, xlabel):
    """Horizontal bars: rows = [(label, {part: value})]."""
    figure, axis = plt.subplots(figsize=(7.6, 0.42 * len(rows) + 1.2))
    palette = ("#2b5c8a", "#6b9ac4", "#4a8f5c", "#d1802b", "#7a5195", "#999999")
    for place, (_, values) in enumerate(rows):
        left = 0
        for part, colour in zip(parts, palette):
            axis.barh(place, values.get(part, 0), left=left, color=colour, height=0.66, label=part if place == 0 else None)
            left += values.get(part, 0)
    axis.set_yticks(range(len(rows)), [label for label, _ in rows])
    axis.invert_yaxis()
    axis.set_xlabel(xlabel)
    axis.grid(alpha=0.25, axis="x")
    axis.legend(fontsize=8.5, frameon=False, ncol=len(parts), loc="upper center", bbox_to_anchor=(0.5, 1.14))
    return svg_of(figure)
