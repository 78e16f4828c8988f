"""What the figures of the stages' pages have in common: files of bodies, sections, drawn bodies."""
import json
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection, PolyCollection

ROOT = pathlib.Path(__file__).resolve().parents[1]
PICTURES = ROOT / "launch/pictures"
SKIN = np.array([0.86, 0.74, 0.68])


def write_points(path, points):
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n"
    header += "".join(f"property float {axis}\n" for axis in "xyz") + "end_header\n"
    path.write_bytes(header.encode() + points.astype("<f4").tobytes())


def read_arrays(path):
    """Header and arrays of a file of the body model (nodes/body_model/README.md, Files)."""
    data = path.read_bytes()
    first = data.index(b"\n") + 1
    second = data.index(b"\n", first) + 1
    at = second + int(data[first:second])
    header, arrays = json.loads(data[second:at]), {}
    for entry in header["arrays"]:
        kind = np.dtype(entry["type"]).newbyteorder("<")
        size = int(np.prod(entry["shape"]))
        arrays[entry["name"]] = np.frombuffer(data, kind, size, at).reshape(entry["shape"])
        at += size * kind.itemsize
    return header, arrays


def draw_section(axes, segments, **style):
    axes.add_collection(LineCollection(segments, **style))


def draw_body(axes, vertices, triangles, colours=None, view="front"):
    """Lit triangles, the far ones first. `colours`: one (r, g, b) a triangle."""
    right, depth = (np.array([0, 1, 0]), np.array([1, 0, 0])) if view == "front" else (
        np.array([1, 0, 0]), np.array([0, -1, 0]))
    corners = vertices[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    facing = np.flatnonzero(normals @ depth > 0)
    facing = facing[np.argsort(corners[facing].mean(1) @ depth)]
    light = 0.5 + 0.5 * np.clip(normals[facing] @ (depth + 0.4 * right + [0, 0, 0.5]) / 1.2, 0, 1)
    base = SKIN if colours is None else colours[facing]
    flat = np.stack([corners[facing] @ right, corners[facing][:, :, 2]], 2)
    shades = np.clip(light[:, None] * base, 0, 1)
    axes.add_collection(PolyCollection(flat, facecolors=shades, edgecolors=shades, linewidths=0.3, rasterized=True))
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.set_axis_off()
    return right


def save(figure, stage):
    path = PICTURES / f"{stage}.png"
    figure.savefig(path, dpi=85, bbox_inches="tight", pil_kwargs={"optimize": True})
    plt.close(figure)
    print(f"{path.relative_to(ROOT)}: {path.stat().st_size // 1000} kB", file=sys.stderr)


def level_axes(axes, title, across="forward, mm", up="to her left, mm"):
    axes.set_title(title, fontsize=9)
    axes.set_xlabel(across, fontsize=8)
    axes.set_ylabel(up, fontsize=8)
    axes.tick_params(labelsize=7)


def report_of(folder):
    return json.loads((folder / "report.json").read_text())


def to_body(report, points):
    frame = np.array(report["scan"]["body_from_scan"])
    return points @ frame[:3, :3].T + frame[:3, 3]
