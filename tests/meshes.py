"""Meshes in numpy: PLY files and plane sections."""
import numpy as np


def read_ply(path):
    """(vertices n x 3, triangles m x 3) of a binary PLY as the project writes it."""
    data = path.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    kinds = {"double": "<f8", "float": "<f4", "uchar": "u1", "int": "<i4"}
    counts, fields, element = {}, {}, None
    for line in data[:end].decode().splitlines():
        words = line.split()
        if words[0] == "element":
            element = words[1]
            counts[element], fields[element] = int(words[2]), []
        elif words[0] == "property" and words[1] != "list":
            fields[element].append((words[2], kinds[words[1]]))
    vertex = np.frombuffer(data, np.dtype(fields["vertex"]), counts["vertex"], end)
    face = np.frombuffer(data, np.dtype([("count", "u1"), ("corners", "<i4", 3)]), counts["face"], end + vertex.nbytes)
    assert (face["count"] == 3).all(), path
    return np.stack([vertex[axis].astype(float) for axis in "xyz"], 1), face["corners"]


def section(vertices, triangles, axis, at):
    """Segments (n x 2 x 2, the other two axes) in which a plane across `axis` cuts a mesh."""
    corners = vertices[triangles]
    heights = corners[:, :, axis] - at
    others = [k for k in range(3) if k != axis]
    ends = []
    cut = (heights.min(1) < 0) & (heights.max(1) >= 0)
    for t, h in zip(corners[cut], heights[cut]):
        points = [t[a] + h[a] / (h[a] - h[b]) * (t[b] - t[a])
                  for a, b in ((0, 1), (1, 2), (2, 0)) if (h[a] < 0) != (h[b] < 0)]
        ends.append([points[0][others], points[1][others]])
    return np.array(ends)
