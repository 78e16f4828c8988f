"""Meshes to files as scanners write them: PLY, OBJ, STL, GLB. Vertices n x 3, faces m x 3 or m x 4, in the file's unit and axes."""
import json
import struct

import numpy as np


def ply(vertices, faces, ascii_text=False):
    sides = faces.shape[1] if len(faces) else 3
    head = (f"ply\nformat {'ascii' if ascii_text else 'binary_little_endian'} 1.0\nelement vertex {len(vertices)}\n"
            "property float x\nproperty float y\nproperty float z\n"
            f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n").encode()
    if ascii_text:
        lines = ["%.9g %.9g %.9g" % tuple(v) for v in vertices]
        lines += [f"{sides} " + " ".join(map(str, f)) for f in faces]
        return head + ("\n".join(lines) + "\n").encode()
    rows = np.zeros(len(faces), dtype=[("n", "u1"), ("v", "<i4", (sides,))])
    rows["n"], rows["v"] = sides, faces
    return head + vertices.astype("<f4").tobytes() + rows.tobytes()


def ply_ascii(vertices, faces):
    return ply(vertices, faces, ascii_text=True)


def obj(vertices, faces, head=""):
    lines = ["v %.6f %.6f %.6f" % tuple(v) for v in vertices]
    lines += ["f " + " ".join(str(i + 1) for i in f) for f in faces]
    return (head + "\n".join(lines) + "\n").encode()


def obj_textured(vertices, faces):
    """Colours at the vertices, materials and a texture that lie elsewhere, corners with normals and places on the texture."""
    lines = ["mtllib ../../not/there.mtl", "vt 0.5 0.5", "vn 0 0 1", "usemtl skin"]
    lines += ["v %.6f %.6f %.6f 0.8 0.6 0.5" % tuple(v) for v in vertices]
    lines += ["f " + " ".join(f"{i + 1}/1/1" for i in f) for f in faces]
    return ("\n".join(lines) + "\n").encode()


def stl(vertices, faces, head=b""):
    rows = np.zeros(len(faces), dtype=[("normal", "<f4", (3,)), ("corners", "<f4", (3, 3)), ("more", "<u2")])
    rows["corners"] = vertices[faces]
    return head.ljust(80, b"\0") + struct.pack("<I", len(faces)) + rows.tobytes()


def stl_that_says_ascii(vertices, faces):
    return stl(vertices, faces, b"solid body")


def stl_ascii(vertices, faces):
    facet = "facet normal 0 0 0\nouter loop\n" + 3 * "vertex %.9g %.9g %.9g\n" + "endloop\nendfacet\n"
    return ("solid body\n" + "".join(facet % tuple(t) for t in vertices[faces].reshape(-1, 9)) + "endsolid body\n").encode()


def glb(vertices, faces):
    points, indices = vertices.astype("<f4").tobytes(), faces.astype("<u4").tobytes()
    text = json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "buffers": [{"byteLength": len(points) + len(indices)}],
        "bufferViews": [{"buffer": 0, "byteLength": len(points)},
                        {"buffer": 0, "byteOffset": len(points), "byteLength": len(indices)}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(vertices), "type": "VEC3",
                       "min": vertices.min(axis=0).tolist(), "max": vertices.max(axis=0).tolist()},
                      {"bufferView": 1, "componentType": 5125, "count": faces.size, "type": "SCALAR"}]}).encode()
    text += b" " * (-len(text) % 4)
    data = points + indices
    return (struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data)) + struct.pack("<I4s", len(text), b"JSON") + text
            + struct.pack("<I4s", len(data), b"BIN\0") + data)


def xyz(vertices, _):
    return ("\n".join("%.6f %.6f %.6f" % tuple(v) for v in vertices) + "\n").encode()
