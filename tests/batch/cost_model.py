#!/usr/bin/env python3
"""What a scan costs, by stage, and how that grows with the points of the scan, the triangles of the body and those of the control mesh:
`fit_batch` with one worker on one core, so that a stage's clock is its core-seconds. Exponents are slopes of a straight line through the
logarithms, over two decades. Writes a JSON file and prints the tables of launch/pages/many_scans.md. Resumable.

Usage: cost_model.py FOLDER_OF_THE_PROGRAMS --work DIR [--bodies N] [--out FILE.json]"""
import argparse
import csv
import datetime
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys

STAGES = ("reconstruction", "body_model", "landmarks", "control_mesh", "tensegric", "tffd")
POINTS = (9000, 28000, 90000, 280000, 900000)
BODY = (5000, 16000, 50000, 160000, 500000)
CONTROL = (120, 480, 1920, 7680)  # what splitting the template in four gives
USUAL = {"points": 180000, "body_triangles": 62000, "control_triangles": 120}


def row_of(series, size, body):
    settings = dict(USUAL, **{series: size})
    return {"name": f"{series} {size} {body}", "scan": f"{settings['points']}_{body}/scan.ply", "garment": "B1", "ratio": "0.95",
            "body_triangles": settings["body_triangles"], "control_triangles": settings["control_triangles"]}


def measure(arguments):
    """The lines of fit_batch, by row name."""
    rows = [row_of(series, size, body) for body in range(1, arguments.bodies + 1)
            for series, sizes in (("points", POINTS), ("body_triangles", BODY), ("control_triangles", CONTROL)) for size in sizes]
    for points in (*POINTS, USUAL["points"]):
        for body in range(1, arguments.bodies + 1):
            out = arguments.work / f"{points}_{body}"
            if not (out / "scan.ply").exists():
                subprocess.run([arguments.programs / "virtual_booth", "--seed", str(body), "--points", str(points), "--out", out],
                               check=True, stdout=subprocess.DEVNULL)
    manifest = arguments.work / "manifest.csv"
    with open(manifest, "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)
    core = max(os.sched_getaffinity(0))
    subprocess.run(["taskset", "-c", str(core), arguments.programs / "fit_batch", manifest, "--out", arguments.work / "costs", "--jobs",
                    "1", "--quiet"], check=True)
    lines = [json.loads(text) for text in (arguments.work / "costs/shard-1-of-1.jsonl").read_text(encoding="utf-8").splitlines()]
    return {line["name"]: line for line in lines}


def costs_of(line):
    """Core-seconds by stage; `rest` is what a scan takes besides: reading, the garment, the report."""
    stages = {stage: line["cost"]["stages"][stage] / 1000 for stage in STAGES}
    return dict(stages, rest=line["cost"]["cpu_seconds"] - sum(stages.values()), all=line["cost"]["cpu_seconds"],
                MB=line["cost"]["peak_MB"])


def exponent(sizes, seconds):
    x, y = [math.log(size) for size in sizes], [math.log(max(second, 1e-6)) for second in seconds]
    mean_x, mean_y = statistics.mean(x), statistics.mean(y)
    return sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) / sum((a - mean_x) ** 2 for a in x)


def series_of(lines, series, sizes, bodies):
    """Per size the median over the bodies of every cost; a size that a body is refused at is left out, and said."""
    table = {}
    for size in sizes:
        here = [lines[f"{series} {size} {body}"] for body in range(1, bodies + 1)]
        done = [costs_of(line) for line in here if line["status"] == "ok"]
        if done:
            table[size] = {name: statistics.median(costs[name] for costs in done) for name in done[0]}
        for line in here:
            if line["status"] != "ok":
                print(f"{line['name']}: {line['status']} {line['reason']}", file=sys.stderr)
    return table


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("--work", type=pathlib.Path, required=True)
    parser.add_argument("--bodies", type=int, default=3)
    parser.add_argument("--out", type=pathlib.Path)
    arguments = parser.parse_args()
    arguments.work.mkdir(parents=True, exist_ok=True)
    lines = measure(arguments)
    usual = [costs_of(lines[f"control_triangles {USUAL['control_triangles']} {body}"]) for body in range(1, arguments.bodies + 1)]
    names = (*STAGES, "rest", "all", "MB")
    result = {"date": datetime.date.today().isoformat(), "bodies": arguments.bodies, "usual": USUAL,
              "usual_costs": {name: round(statistics.median(costs[name] for costs in usual), 4) for name in names}, "series": {}}
    print("| | " + " | ".join(names) + " |\n| --- |" + " --- |" * len(names))
    print("| usual | " + " | ".join(f"{result['usual_costs'][name]:.3g}" for name in names) + " |")
    for series, sizes in (("points", POINTS), ("body_triangles", BODY), ("control_triangles", CONTROL)):
        table = series_of(lines, series, sizes, arguments.bodies)
        exponents = {name: round(exponent(list(table), [costs[name] for costs in table.values()]), 2) for name in names}
        for size, costs in table.items():
            print(f"| {size} {series} | " + " | ".join(f"{costs[name]:.3g}" for name in names) + " |")
        print(f"| exponent, {series} | " + " | ".join(f"{exponents[name]:.2f}" for name in names) + " |")
        result["series"][series] = {"costs": {str(size): {name: round(value, 4) for name, value in costs.items()}
                                              for size, costs in table.items()}, "exponents": exponents}
    every = result["usual_costs"]["all"]
    print(f"a million scans: {every * 1e6 / 3600:.0f} core-hours")
    if arguments.out:
        arguments.out.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
