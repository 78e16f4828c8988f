#!/usr/bin/python3
"""P2 Fig. 11: nipple height and volume error by iteration, for the papers' conventional and adaptive ways and ours.

  plot_history.py                          three bodies of the virtual booth, three solvers, and the picture
  plot_history.py BODY.ply...              these bodies (meshes that fit --mesh takes)
  plot_history.py --plot-only              the picture alone, from RUNS/<body>/<solver>/history.csv
"""
import argparse
import csv
import pathlib
import subprocess
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

ROOT = pathlib.Path(__file__).resolve().parents[2]
SOLVERS = {"relaxation": "conventional (P1)", "adaptive": "adaptive (P2)", "equilibrium": "equilibrium (ours)"}
PAPERS = ROOT / "tests/benchmarks/papers.yaml"
BODIES = {  # arguments of virtual_booth
    "firm": [],
    "average": ["--firmness", "0.6", "--asymmetry", "0.06", "--waist", "1.1", "--hip", "1.05"],
    "full": ["--bust", "1.15", "--firmness", "0.4", "--asymmetry", "-0.08", "--waist", "1.3", "--hip", "1.15"],
}


def run(arguments):
    print(" ".join(map(str, arguments)), file=sys.stderr)
    subprocess.run([str(a) for a in arguments], check=True, stdout=subprocess.DEVNULL)


def make_runs(options):
    bodies = {path.stem: path for path in options.bodies}
    if not bodies:
        for name, shape in BODIES.items():
            folder = options.runs / name / "booth"
            run([options.programs / "virtual_booth", "--out", folder, *shape])
            bodies[name] = folder / "body.ply"
    for name, mesh in bodies.items():
        for solver in SOLVERS:
            run([options.programs / "fit", "--mesh", mesh, "--garment", options.garment, "--ratio", options.ratio,
                 "--tissue", PAPERS, "--solver", solver, "--out", options.runs / name / solver, "--quiet"])


def read_history(path):
    """Column name -> list of numbers."""
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: [float(row[name]) for row in rows] for name in rows[0]}


def plot(options):
    found = sorted({path.parents[1].name for path in options.runs.glob("*/*/history.csv")})
    bodies = sorted(found, key=lambda name: list(BODIES).index(name) if name in BODIES else len(BODIES))
    if not bodies:
        sys.exit(f"no <body>/<solver>/history.csv in {options.runs}")
    figure, axes = plt.subplots(3, len(bodies), figsize=(4.6 * len(bodies), 9), squeeze=False, sharex=True)
    colours = {"relaxation": "tab:red", "adaptive": "tab:blue", "equilibrium": "tab:green"}
    for column, body in enumerate(bodies):
        height, volume, line = axes[:, column]
        height.set_title(body)
        for solver, label in SOLVERS.items():
            path = options.runs / body / solver / "history.csv"
            if not path.exists():
                continue
            history = read_history(path)
            iterations = history["iteration"]
            style = {"color": colours[solver], "linewidth": 1.3}
            for side, dash in (("L", "-"), ("R", ":")):
                way = history["height_bust_point_" + side]
                height.plot(iterations, [1e3 * (z - way[0]) for z in way], dash, **style,
                            label=label if side == "L" else None)
            for name, values in history.items():
                if name.startswith("volume_error_"):
                    volume.plot(iterations, [100 * v for v in values], **style)
                elif name.startswith("ratio_"):
                    line.plot(iterations, [100 * v for v in values], **style)
        line.axhline(100 * float(options.ratio), color="grey", linewidth=0.8, linestyle="--")
        for axis, limit in ((height, 40), (volume, 8), (line, None)):  # a solution that blows up leaves the picture
            axis.set_xscale("symlog", linthresh=10)
            axis.set_xlim(left=0)
            axis.grid(alpha=0.3)
            low, high = axis.get_ylim()
            if limit:
                axis.set_ylim(max(low, -limit), min(high, limit))
            else:
                axis.set_ylim(max(low, 70), min(high, 120))
        line.set_xlabel("iteration")
    axes[0, 0].set_ylabel("change of nipple height, mm\n(left solid, right dotted)")
    axes[1, 0].set_ylabel("volume error, %")
    axes[2, 0].set_ylabel("line length, % of rest")
    axes[0, 0].legend(fontsize=8)
    figure.suptitle(f"{options.garment} at {options.ratio}: three solvers (P2 Fig. 11)")
    figure.tight_layout()
    figure.savefig(options.runs / "history.png", dpi=110)
    print(options.runs / "history.png")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bodies", nargs="*", type=pathlib.Path, metavar="BODY.ply")
    parser.add_argument("--programs", type=pathlib.Path, default=ROOT / "build/devel/lib/tensegric_fit")
    parser.add_argument("--runs", type=pathlib.Path, default=pathlib.Path("history_runs"))
    parser.add_argument("--garment", default="B1")
    parser.add_argument("--ratio", default="0.90")
    parser.add_argument("--plot-only", action="store_true")
    options = parser.parse_args()
    if not options.plot_only:
        make_runs(options)
    plot(options)


if __name__ == "__main__":
    main()
