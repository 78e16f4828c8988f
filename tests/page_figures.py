#!/usr/bin/python3
"""The figures of the stages' pages (nodes/*/README.md): launch/pictures/<stage>.png, from a body of the virtual booth.

  page_figures.py [--programs build/devel/lib/tensegric_fit] [--work build/page_figures] [STAGE...]

Scans, fits and the comparison are made in --work by the built programs and kept there; delete it to make them anew.
"""
import argparse
import csv
import json
import pathlib
import re
import subprocess
import sys

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection

from meshes import read_ply, section
from page_figure_parts import (ROOT, draw_body, draw_section, level_axes, read_arrays, report_of, save, to_body,
                               write_points)

NOISE = 0.001  # m, of the second scan that the correlation's figure makes


class Runs:
    """What the programs make, each once."""

    def __init__(self, programs, work):
        self.programs, self.work = programs, work

    def run(self, folder, program, *arguments):
        out = self.work / folder
        if not out.is_dir():
            command = [self.programs / program, *arguments, "--out", out]
            print(" ".join(map(str, command)), file=sys.stderr)
            subprocess.run([str(word) for word in command], check=True, stdout=subprocess.DEVNULL)
        return out

    def booth(self):
        return self.run("booth", "virtual_booth", "--seed", 7)

    def fit(self, ratio):
        """Of the body that the first fit reconstructed."""
        if ratio == 0.90:
            scan = self.booth() / "scan.ply"
            return self.run("fit_0.90", "fit", "--scan", scan, "--garment", "B1", "--ratio", ratio, "--quiet")
        body = self.fit(0.90) / "body.ply"
        return self.run(f"fit_{ratio:.2f}", "fit", "--mesh", body, "--garment", "B1", "--ratio", ratio, "--quiet")

    def correlation(self):
        """Simulated at 0.95; worn at 0.92, scanned again after she turned by 5 degrees and stepped aside."""
        scan = self.work / "worn.ply"
        vertices, triangles = read_ply(self.fit(0.92) / "deformed.ply")
        random = np.random.default_rng(7)
        sides = vertices[triangles]
        areas = np.linalg.norm(np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0]), axis=1)
        chosen = sides[random.choice(len(sides), 120000, p=areas / areas.sum())]
        points = np.einsum("nk,nkd->nd", random.dirichlet([1, 1, 1], len(chosen)), chosen)
        points += random.normal(0, NOISE, points.shape)
        turn = np.radians(5)
        points = points @ [[np.cos(turn), np.sin(turn), 0], [-np.sin(turn), np.cos(turn), 0], [0, 0, 1]]
        write_points(scan, points + [0.03, -0.02, 0])
        return self.run("correlation", "correlate", "--fit", self.fit(0.95), "--worn", scan, "--quiet")


def reconstruction(runs):
    fit = runs.fit(0.90)
    report = report_of(fit)
    points, _ = read_ply(runs.booth() / "scan.ply")
    vertices, triangles = read_ply(fit / "body.ply")
    truth = json.loads((runs.booth() / "truth.json").read_text())
    true, true_triangles = read_ply(runs.booth() / "body.ply")
    frame = np.array(truth["scan_from_body"])
    true = true @ frame[:3, :3].T + frame[:3, 3]
    figure, axes = plt.subplots(1, 3, figsize=(11, 4.6), gridspec_kw={"width_ratios": [1, 1, 1.5]})
    some = points[::6]
    axes[0].scatter(some[:, 1], some[:, 2], s=0.15, c="0.3", linewidths=0)
    axes[0].set_aspect("equal")
    axes[0].set_axis_off()
    axes[0].set_title(f"scan: {len(points):,} points", fontsize=9)
    draw_body(axes[1], vertices, triangles)
    for hole in report["body"]["holes"]:
        axes[1].plot(hole["centre"][1], hole["centre"][2], "o", markerfacecolor="none", markeredgecolor="tab:orange",
                     markersize=4 + 0.4 * np.sqrt(1e6 * hole["area"] / np.pi))
    axes[1].set_title(f"mesh; orange: {len(report['body']['holes'])} closed holes", fontsize=9)
    level = report["landmarks"]["bust_point_L"]["position"][2]
    near = points[np.abs(points[:, 2] - level) < 0.001] * 1000
    axes[2].scatter(near[:, 0], near[:, 1], s=4, c="0.6", linewidths=0, label="points within 1 mm of the plane")
    draw_section(axes[2], 1000 * section(true, true_triangles, 2, level), colors="tab:blue", linewidths=1,
                 label="true skin")
    draw_section(axes[2], 1000 * section(vertices, triangles, 2, level), colors="tab:red", linewidths=1,
                 label="mesh")
    tip = 1000 * np.array(report["landmarks"]["bust_point_L"]["position"])
    axes[2].set_xlim(tip[0] - 45, tip[0] + 8)
    axes[2].set_ylim(tip[1] - 35, tip[1] + 35)
    axes[2].set_aspect("equal")
    axes[2].legend(fontsize=7, loc="lower left")
    level_axes(axes[2], "level section through the left bust point")
    save(figure, "reconstruction")


def body_model(_):
    header, arrays = read_arrays(ROOT / "launch/body_model/women.tfb")
    mean, quads, parts = arrays["mean"].astype(float), arrays["quads"], arrays["parts"]
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    view = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]])  # the file's women face -y
    palette = np.array([plt.get_cmap("tab20")(i % 20)[:3] for i in range(len(header["parts"]))])
    figure, axes = plt.subplots(1, 4, figsize=(11, 3.9))
    draw_body(axes[0], mean @ view.T, triangles, 0.5 + 0.5 * palette[parts[triangles[:, 0]]])
    axes[0].set_title(f"the mean, {len(header['parts'])} parts", fontsize=9)
    for component in range(3):
        panel = axes[component + 1]
        for deviations, colour in ((-2, "tab:blue"), (2, "tab:red")):
            shape = mean + deviations * arrays["step"][component] * arrays["basis"][component].astype(float)
            some = shape[arrays["quads"]] @ view.T
            sides = np.stack([some, np.roll(some, -1, 1)], 2).reshape(-1, 2, 3)[:, :, 1:]
            panel.add_collection(LineCollection(sides, colors=colour, linewidths=0.15, alpha=0.5, rasterized=True))
        panel.set_aspect("equal")
        panel.autoscale_view()
        panel.set_axis_off()
        panel.set_title(f"component {component + 1}: -2 (blue), +2 (red)", fontsize=9)
    save(figure, "body_model")


def landmarks(runs):
    fit = runs.fit(0.90)
    report = report_of(fit)
    vertices, triangles = read_ply(fit / "body.ply")
    vertices = to_body(report, vertices)
    points = {name: to_body(report, np.array(entry["position"])) for name, entry in report["landmarks"].items()}
    figure, axes = plt.subplots(1, 3, figsize=(11, 5), gridspec_kw={"width_ratios": [1.05, 0.8, 1.1]})
    for panel, view in ((axes[0], "front"), (axes[1], "side")):
        right = draw_body(panel, vertices, triangles, view=view)
        low, high = (vertices @ right).min(), (vertices @ right).max()
        if view == "front":
            low, high = -0.5, 0.5
        for name, height in report["heights"].items():
            panel.plot([low, high], [height, height], color="tab:blue", linewidth=0.7)
            if view == "front":
                panel.text(high, height, f" {name} {1000 * height:.0f} mm", fontsize=6.5, va="center",
                           color="tab:blue")
        for name, point in points.items():
            if view == "side" and (name.endswith("_R") or name == "axilla_L"):
                continue
            panel.plot(point @ right, point[2], "o", color="tab:red", markersize=2.5)
        panel.set_ylim(0, None)
    axes[0].set_title("landmarks (red) and heights above the ground", fontsize=9)
    tip, fold = points["bust_point_L"], points["underbust_L"]
    profile = 1000 * section(vertices, triangles, 1, tip[1])
    draw_section(axes[2], profile, colors="0.3", linewidths=1.2)
    for point, name in ((tip, "bust point"), (fold, "underbust, in the fold")):
        axes[2].plot(1000 * point[0], 1000 * point[2], "o", color="tab:red", markersize=4)
        axes[2].annotate(name, (1000 * point[0], 1000 * point[2]), (6, -14), textcoords="offset points", fontsize=7.5,
                         ha="left")
    axes[2].set_xlim(1000 * tip[0] - 120, 1000 * tip[0] + 60)
    axes[2].set_ylim(1000 * fold[2] - 60, 1000 * tip[2] + 110)
    axes[2].set_aspect("equal")
    level_axes(axes[2], "sagittal profile through the left bust point", up="height, mm")
    save(figure, "landmarks")


def template_of(name):
    """The template's rows of `fixed` for the whole grid, and the places of its named nodes."""
    text = (ROOT / f"launch/templates/{name}.yaml").read_text()
    drawn = re.search(r"^fixed:.*\n((?:\s+- '[#.o]+'\n)+)", text, re.M).group(1)
    half = re.findall(r"'([#.o]+)'", drawn)
    names = {}
    for row, column, node in re.findall(r"\{row: (\d+), column: (\d+), name: (\w+)", text):
        names[int(row), int(column)] = node
    return [row + row[-2::-1] for row in half], names


def control_mesh(runs):
    fit = runs.fit(0.90)
    report = report_of(fit)
    outer, triangles = read_ply(fit / "control.ply")
    body, body_triangles = read_ply(fit / "body.ply")
    fixed, names = template_of("bust")
    flags = "".join(fixed)
    colours = {"#": "tab:red", ".": "tab:blue", "o": "tab:purple"}
    words = {"#": "held", ".": "free", "o": "free, over bone"}
    columns = len(fixed[0])
    places = np.array([[columns - 1 - i % columns, -(i // columns)] for i in range(len(flags))], float)
    figure, axes = plt.subplots(1, 3, figsize=(12, 4.2), gridspec_kw={"width_ratios": [1.1, 1.1, 1]})
    for panel, at in ((axes[0], places), (axes[1], outer[:, 1:])):
        if panel is axes[1]:
            draw_body(panel, body, body_triangles)
        sides = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
        panel.add_collection(LineCollection(at[sides], colors="0.25", linewidths=0.6))
        for flag, colour in colours.items():
            chosen = [i for i, f in enumerate(flags) if f == flag]
            panel.plot(at[chosen, 0], at[chosen, 1], "o", color=colour, markersize=3.5, label=words[flag])
        panel.set_axis_off()
    for (row, column), name in names.items():
        at = places[row * columns + column]
        axes[0].annotate(name, at, (2, 3), textcoords="offset points", fontsize=6, rotation=30)
    axes[0].margins(0.08)
    axes[0].legend(fontsize=7, loc="lower center", ncol=3, bbox_to_anchor=(0.5, -0.1))
    axes[0].set_title("the template's grid, named nodes of her left half", fontsize=9, pad=12)
    middle, size = outer[:, 1:].mean(0), np.ptp(outer[:, 1:], axis=0)
    axes[1].set_xlim(middle[0] - 0.62 * size[0], middle[0] + 0.62 * size[0])
    axes[1].set_ylim(middle[1] - 0.6 * size[1], middle[1] + 0.6 * size[1])
    axes[1].invert_xaxis() if axes[1].get_xlim()[0] > axes[1].get_xlim()[1] else None
    axes[1].set_title(f"on a body: {report['control']['nodes']} nodes, {report['control']['triangles']} triangles",
                      fontsize=9)
    level = report["landmarks"]["bust_point_L"]["position"][2]
    draw_section(axes[2], 1000 * section(body, body_triangles, 2, level), colors="0.6", linewidths=1, label="skin")
    draw_section(axes[2], 1000 * section(outer, triangles, 2, level), colors="tab:blue", linewidths=1.3,
                 label="control mesh")
    axes[2].set_xlim(0, 1000 * body[np.abs(body[:, 2] - level) < 0.01][:, 0].max() + 15)
    axes[2].set_ylim(-190, 190)
    axes[2].set_aspect("equal")
    axes[2].legend(fontsize=7)
    level_axes(axes[2], "level section at the bust points")
    save(figure, "control_mesh")


def default_of(text, name):
    return float(re.search(rf"\bdouble {name} =\s*([0-9.e-]+);", text).group(1))


def draw_unit(panel, base, height, shade, diagonals=(0, 1, 2)):
    """A prism of three struts and nine tensile parts on a triangle; strut k: outer k to inner k + 1."""
    base = np.asarray(base, float)
    outer, inner = np.c_[base, np.full(3, height)], np.c_[base, np.zeros(3)]
    for k in range(3):
        for ends in ((outer[k], outer[(k + 1) % 3]), (inner[k], inner[(k + 1) % 3]), (outer[k], inner[k])):
            panel.plot(*np.array(ends).T, color=shade, linewidth=1.3)
    for k in diagonals:
        panel.plot(*np.array((outer[k], inner[(k + 1) % 3])).T, color="tab:blue", linewidth=3)
    for layer, colour in ((outer, "tab:red"), (inner, "0.2")):
        panel.scatter(*layer.T, color=colour, s=16, depthshade=False)


def tensegric(runs):
    text = (ROOT / "nodes/tensegric/model.hpp").read_text()
    prestress, stiffening = default_of(text, "prestress"), default_of(text, "stiffening")
    barrier = (ROOT / "nodes/tensegric/fold_barrier.cpp").read_text()
    begins = float(re.search(r"kBegins = ([0-9.]+)", barrier).group(1))
    figure = plt.figure(figsize=(12, 6.4))
    corners = [np.array([np.cos(a), np.sin(a)]) for a in np.radians([90, 210, 330])]
    panel = figure.add_subplot(2, 3, 1, projection="3d")
    draw_unit(panel, corners, 1.1, "tab:orange")
    panel.set_title("a unit: 3 struts (blue),\n9 tensile parts; outer nodes red", fontsize=9)
    pair = figure.add_subplot(2, 3, 2, projection="3d")
    draw_unit(pair, corners, 1.1, "tab:orange")
    draw_unit(pair, [corners[2], corners[1], corners[1] + corners[2] - corners[0]], 1.1, "tab:orange")
    shared = np.array([[*corners[1], 0], [*corners[1], 1.1], [*corners[2], 1.1], [*corners[2], 0], [*corners[1], 0]])
    pair.plot(*shared.T, color="tab:green", linewidth=2.2)
    pair.set_title("two units share four tensile parts (green);\nin that face two struts cross", fontsize=9)
    for axes in (panel, pair):
        axes.view_init(22, -50)
        axes.set_axis_off()
        axes.set_box_aspect((1.73, 1.5, 1.1) if axes is panel else (1.73, 2.5, 1.1), zoom=1.2)

    law = figure.add_subplot(2, 3, 3)
    strain = np.linspace(-0.2, 0.15, 400)
    cube = stiffening * strain**3
    law.plot(strain, np.where(strain + prestress > 0, strain + prestress + np.where(strain > 0, cube, 0), 0),
             color="tab:orange", label="tensile part: pulls only")
    law.plot(strain, strain - prestress + cube, color="tab:blue", label="strut: two-way")
    law.axhline(0, color="0.7", linewidth=0.6)
    law.axvline(0, color="0.7", linewidth=0.6)
    law.set_ylim(-0.9, 0.9)
    law.legend(fontsize=7)
    level_axes(law, f"force of a member at a prestress of {prestress:g} k", "strain from rest", "pull / k")

    with open(runs.fit(0.90) / "history.csv", newline="") as file:
        history = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
    steps = [row["iteration"] for row in history[1:]]
    way = figure.add_subplot(2, 3, 4)
    way.semilogy(steps, [row["residual"] for row in history[1:]], "o-", label="residual")
    way.semilogy(steps, [max(abs(row["ratio_chest"] / 0.9 - 1), 1e-16) for row in history[1:]], "s-",
                 label="length error of the line")
    way.semilogy(steps, [max(abs(row["volume_error_bust"]), 1e-16) for row in history[1:]], "^-", label="volume error")
    way.legend(fontsize=7)
    level_axes(way, "equilibrium: B1 at 0.90 from rest", "iteration", "relative")

    fold = figure.add_subplot(2, 3, 5)
    share = np.linspace(0.005, 1.1, 400)
    fold.plot(share, np.where(share < begins, -(share - begins)**2 * np.log(share / begins), 0), color="tab:green")
    fold.axvline(begins, color="0.7", linewidth=0.6)
    level_axes(fold, "fold barrier: none above 0.7 of the volume at rest", "unit's volume / at rest",
               "energy / stiffness")

    outer, triangles = read_ply(runs.fit(0.90) / "control.ply")
    worn, _ = read_ply(runs.fit(0.90) / "control_deformed.ply")
    level = report_of(runs.fit(0.90))["landmarks"]["bust_point_L"]["position"][2]
    cut = figure.add_subplot(2, 3, 6)
    draw_section(cut, 1000 * section(outer, triangles, 2, level), colors="0.5", linewidths=1.2, label="at rest")
    draw_section(cut, 1000 * section(worn, triangles, 2, level), colors="tab:red", linewidths=1.2, label="B1 at 0.90")
    cut.autoscale_view()
    cut.set_aspect("equal")
    cut.legend(fontsize=7, loc="lower left")
    level_axes(cut, "control mesh, level section at the bust points")
    figure.tight_layout()
    save(figure, "tensegric")


def tffd(runs):
    fit = runs.fit(0.90)
    report = report_of(fit)
    body, triangles = read_ply(fit / "body.ply")
    worn, _ = read_ply(fit / "deformed.ply")
    outer, control = read_ply(fit / "control.ply")
    outer_worn, _ = read_ply(fit / "control_deformed.ply")
    source = (ROOT / "nodes/tffd/binding.cpp").read_text()
    paper, standard = map(float, re.search(r"Setting::paper \? ([0-9.]+) : ([0-9.]+)", source).groups())
    figure, axes = plt.subplots(1, 3, figsize=(12, 4.2), gridspec_kw={"width_ratios": [1, 1.1, 1.2]})
    distance = np.linspace(0, 3, 400)
    z = np.minimum(distance / standard, 1)
    axes[0].plot(distance, (1 - z)**4 * (4 * z + 1), label=f"standard, beta {standard:g} (from the triangle)")
    axes[0].plot(distance, np.maximum(0, 1 - distance / paper), label=f"paper, beta {paper:g} (from the centroid)")
    axes[0].legend(fontsize=7)
    level_axes(axes[0], "kernels", "distance / mean radius of the triangle", "weight before normalisation")
    side = report["landmarks"]["bust_point_L"]["position"][1]
    for mesh, faces, colour, width, name in ((body, triangles, "0.6", 1.2, "skin at rest"),
                                             (worn, triangles, "tab:red", 1.2, "skin under B1 at 0.90"),
                                             (outer, control, "0.4", 0.7, "control mesh at rest"),
                                             (outer_worn, control, "tab:blue", 0.7, "deformed")):
        draw_section(axes[1], 1000 * section(mesh, faces, 1, side), colors=colour, linewidths=width, label=name)
    tip = 1000 * np.array(report["landmarks"]["bust_point_L"]["position"])
    axes[1].set_xlim(tip[0] - 105, tip[0] + 75)
    axes[1].set_ylim(tip[2] - 90, tip[2] + 100)
    axes[1].set_aspect("equal")
    axes[1].legend(fontsize=6.5, loc="upper right")
    level_axes(axes[1], "sagittal section, left breast", up="height, mm")
    ring = lambda at: np.bincount(triangles.ravel(), np.repeat(np.linalg.norm(np.cross(
        at[triangles[:, 1]] - at[triangles[:, 0]], at[triangles[:, 2]] - at[triangles[:, 0]]), axis=1) / 2, 3))
    ratio = (ring(worn) / ring(body))[triangles].mean(1)
    colours = plt.get_cmap("RdBu")(np.clip((ratio - 0.6) / 0.8, 0, 1))[:, :3]
    draw_body(axes[2], worn, triangles, colours)
    axes[2].set_xlim(-0.24, 0.24)
    axes[2].set_ylim(1.0, 1.36)
    bar = figure.colorbar(plt.cm.ScalarMappable(plt.Normalize(0.6, 1.4), "RdBu"), ax=axes[2], shrink=0.7)
    bar.set_label("skin area after / before, each triangle's corners", fontsize=7)
    bar.ax.tick_params(labelsize=7)
    axes[2].set_title("area of the skin under B1 at 0.90", fontsize=9)
    save(figure, "tffd")


def correlation(runs):
    out = runs.correlation()
    fit = runs.fit(0.95)
    worn, triangles = read_ply(runs.fit(0.92) / "deformed.ply")
    simulated, _ = read_ply(fit / "deformed.ply")
    with open(out / "distance.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    distances = np.array([float(row["distance_mm"]) if row["compared"] == "1" else np.nan for row in rows])
    covered = np.array([row["part"] == "covered" for row in rows])
    corners = simulated[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    at_vertex = np.stack([np.bincount(triangles.ravel(), np.repeat(normals[:, k], 3)) for k in range(3)], 1)
    at_vertex /= np.linalg.norm(at_vertex, axis=1, keepdims=True)
    truth = 1000 * np.einsum("nd,nd->n", worn - simulated, at_vertex)
    figure, axes = plt.subplots(1, 2, figsize=(9.5, 4.4))
    value = distances[triangles].mean(1)
    colours = plt.get_cmap("coolwarm_r")(np.clip(value / 8 + 0.5, 0, 1))[:, :3]
    colours[np.isnan(value)] = [0.6, 0.65, 0.7]
    draw_body(axes[0], simulated, triangles, colours)
    axes[0].set_ylim(0.75, 1.45)
    bar = figure.colorbar(plt.cm.ScalarMappable(plt.Normalize(-4, 4), "coolwarm_r"), ax=axes[0], shrink=0.7)
    bar.set_label("worn skin outside (+) or inside (-), mm", fontsize=7)
    bar.ax.tick_params(labelsize=7)
    axes[0].set_title("distance map: simulated at 0.95, worn at 0.92", fontsize=9)
    known = ~np.isnan(distances)
    for chosen, colour, name in ((known & ~covered, "0.6", "other skin"), (known & covered, "tab:red", "covered skin")):
        axes[1].plot(truth[chosen], distances[chosen], ".", color=colour, markersize=1, label=name, rasterized=True)
    axes[1].plot([-6, 6], [-6, 6], color="0.2", linewidth=0.7)
    axes[1].set_aspect("equal")
    axes[1].legend(fontsize=7, markerscale=8)
    level_axes(axes[1], "found against true (from vertex to vertex, along the normal)", "true, mm", "found, mm")
    save(figure, "correlation")


STAGES = {stage.__name__: stage
          for stage in (reconstruction, body_model, landmarks, control_mesh, tensegric, tffd, correlation)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("stages", nargs="*", metavar="STAGE", help=", ".join(STAGES) + "; none: all")
    parser.add_argument("--programs", type=pathlib.Path, default=ROOT / "build/devel/lib/tensegric_fit")
    parser.add_argument("--work", type=pathlib.Path, default=ROOT / "build/page_figures")
    options = parser.parse_args()
    unknown = set(options.stages) - set(STAGES)
    if unknown:
        parser.error(f"no such stage: {', '.join(sorted(unknown))}")
    options.work.mkdir(parents=True, exist_ok=True)
    for name in options.stages or STAGES:
        STAGES[name](Runs(options.programs, options.work))


if __name__ == "__main__":
    main()
