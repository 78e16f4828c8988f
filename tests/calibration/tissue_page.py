#!/usr/bin/python3
"""Tissue error against time on one page: solvers, 60 to 1,920 control triangles, inner nodes free and bound.

Runs `fit` on BODY_body.ply under BODY_chest.yaml for each reference BODY_skin_rNNN.npz at 0.97 and 0.95, compares the
moved skin with the reference, and writes OUT/page.html with the finite elements' own time at the far end.
"""
import argparse
import io
import json
import pathlib
import shutil
import statistics
import subprocess

import matplotlib
import numpy as np

from reference_csv import read_ply

matplotlib.use("Agg")
from matplotlib import pyplot

RATIOS = ("0.97", "0.95")
REPEATS = 3  # of each fit; the median time counts
BENCHMARKS = pathlib.Path(__file__).resolve().parents[1] / "benchmarks"
PAPERS = BENCHMARKS / "papers.yaml"
COARSE = BENCHMARKS / "bust_60.yaml"


# Name, colour and arguments of each curve, and the numbers of control triangles.
CURVES = [("equilibrium, inner nodes bound (default)", "tab:blue", [], (60, 120, 480, 1920)),
          ("equilibrium, inner nodes free (papers)", "tab:cyan", ["--tissue", PAPERS], (60, 120, 480)),
          ("adaptive (P2)", "tab:orange", ["--solver", "adaptive"], (60, 120, 480)),
          ("relaxation (P1)", "tab:red", ["--solver", "relaxation"], (60, 120, 480))]


def measure(fit, data, out, body, ratio, arguments, triangles):
    folder = out / "fit"
    mesh = data / "open" / f"{body}_body.ply"
    command = [fit, "--mesh", mesh, "--garment", data / "fem" / f"{body}_chest.yaml", "--ratio", ratio, "--out", folder,
               "--control-triangles", str(triangles), "--quiet", *arguments]
    if triangles < 120:
        (out / "templates").mkdir(exist_ok=True)
        shutil.copy(COARSE, out / "templates/bust.yaml")
        command += ["--templates", out / "templates"]
    times = []
    for _ in range(REPEATS if triangles < 1000 else 1):
        done = subprocess.run([str(word) for word in command], stdout=subprocess.DEVNULL)
        if done.returncode != 0:
            return None
        report = json.loads((folder / "report.json").read_text())
        times.append(report["solver"]["ms"])
    field = np.load(data / "fem" / f"{body}_skin_r{round(1000 * float(ratio)):03d}.npz")
    free = field["fixed"] == 0
    vertex = field["vertex"][free]
    moved = read_ply(folder / "deformed.ply")[vertex] - read_ply(mesh)[vertex]
    error = 1e3 * np.sqrt(((moved - field["disp_m"][free]) ** 2).sum(1).mean())
    return statistics.median(times), error, report["solver"]["status"], report["lines"][0]["ratio"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("fit", help="the program")
    parser.add_argument("data", type=pathlib.Path, help="a folder with bodies in open/ and references in fem/")
    parser.add_argument("out", type=pathlib.Path)
    options = parser.parse_args()
    fit, data, out = options.fit, options.data, options.out
    out.mkdir(parents=True, exist_ok=True)
    seconds = {(e["body"], f"{e['request']:.2f}"): e["seconds"]
               for e in json.loads((data / "fem" / "summary.json").read_text()) if e["variant"] == "skin"}
    bodies = sorted({body for body, _ in seconds})
    rows, figure = [], pyplot.figure(figsize=(10, 4.5))
    for panel, ratio in enumerate(RATIOS):
        axes = figure.add_subplot(1, 2, panel + 1)
        for name, colour, arguments, sizes in CURVES:
            curve = []
            for triangles in sizes:
                found = [measure(fit, data, out, body, ratio, arguments, triangles) for body in bodies]
                if not all(found):
                    continue
                time, error = (statistics.mean(f[k] for f in found) for k in (0, 1))
                ratios = ", ".join(f"{f[3]:.3f}" for f in found)
                words = ", ".join(sorted({f[2] for f in found}))
                speed = statistics.mean(seconds[body, ratio] for body in bodies) * 1e3 / time
                rows.append((ratio, name, triangles, time, speed, [f[1] for f in found], ratios, words))
                curve.append((time, error, triangles))
            if not curve:
                continue
            axes.plot(*zip(*[c[:2] for c in curve]), "o-", color=colour, label=name)
            for time, error, triangles in curve:
                axes.annotate(triangles, (time, error), textcoords="offset points", xytext=(4, 4), fontsize=8)
        elements = statistics.mean(seconds[body, ratio] for body in bodies) * 1e3
        axes.plot([elements], [0], "k*", label="finite elements (the reference)")
        axes.set(xscale="log", xlabel="solution, ms", ylabel="rms to the reference, mm", title=f"request {ratio}")
        axes.set_ylim(bottom=0)
        axes.grid(alpha=0.3)
    figure.legend(*axes.get_legend_handles_labels(), loc="lower center", ncol=3, fontsize=8)
    figure.tight_layout(rect=(0, 0.1, 1, 1))
    drawing = io.StringIO()
    figure.savefig(drawing, format="svg")
    cells = "".join("<tr><td>" + "</td><td>".join(
        (ratio, name, str(triangles), f"{time:.1f}", f"{speed:.0f}", " / ".join(f"{e:.2f}" for e in errors), ratios, words)) +
        "</td></tr>" for ratio, name, triangles, time, speed, errors, ratios, words in rows)
    (out / "page.html").write_text(f"""<!doctype html><meta charset=utf-8><meta name=viewport content="width=device-width">
<title>Tissue error against time</title><style>body{{font:15px/1.45 system-ui,sans-serif;max-width:70rem;margin:1rem auto;
padding:0 1rem}}td,th{{padding:.15rem .6rem;border-bottom:1px solid #8884;text-align:left}}svg{{max-width:100%;height:auto}}
.wide{{overflow-x:auto}}</style><h1>Tissue error against time</h1><p>Skin under one band, moved by the model, against
finite elements of {", ".join(bodies)}: root mean square over the free skin. Numbers at the points are control triangles;
times are medians of {REPEATS}, of building and solving the model. Beyond 120 triangles the default has tissue in three layers.</p><div class=wide>
{drawing.getvalue()[drawing.getvalue().index("<svg"):]}</div><div class=wide><table>
<tr><th>request<th>solver<th>control triangles<th>ms<th>times faster than finite elements<th>rms, mm: {" / ".join(bodies)}
<th>line<th>status</tr>{cells}</table></div>""")
    for row in rows:
        print(*row[:3], f"{row[3]:.1f} ms", f"x{row[4]:.0f}", [round(e, 2) for e in row[5]], row[6], row[7])


if __name__ == "__main__":
    main()
