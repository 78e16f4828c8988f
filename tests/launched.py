"""What campaigns on launched chains share. They run in the build's env.sh."""
import os
import pathlib
import socket
import struct
import time


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def program(name):
    """Path of a program of this package."""
    for folder in os.environ["CMAKE_PREFIX_PATH"].split(":"):
        path = pathlib.Path(folder) / "lib/tensegric_fit" / name
        if path.exists():
            return path
    raise RuntimeError(f"{name} is not built")


def nodes_at(master_uri, names):
    """namespace/node -> process, of the nodes of these names that know that master."""
    found = {}
    for command in pathlib.Path("/proc").glob("[0-9]*/cmdline"):
        try:
            words = command.read_bytes().decode(errors="replace").split("\0")
            environment = (command.parent / "environ").read_bytes().decode(errors="replace").split("\0")
        except OSError:  # ended meanwhile, or another user's
            continue
        name = next((word[8:] for word in words if word.startswith("__name:=")), None)
        uri = next((word[15:] for word in environment if word.startswith("ROS_MASTER_URI=")), "").rstrip("/")  # roslaunch may add a /
        if name in names and uri == master_uri:
            space = next((word[14:] for word in environment if word.startswith("ROS_NAMESPACE=")), "").strip("/")
            found[f"{space}/{name}"] = int(command.parent.name)
    return found


def points_of(ply):
    """x, y, z per point of a binary PLY of the virtual booth."""
    header, body = pathlib.Path(ply).read_bytes().split(b"end_header\n", 1)
    sizes = {"float": 4, "float32": 4, "double": 8, "uchar": 1, "uint8": 1, "int": 4, "ushort": 2}
    vertex = header.decode().split("element vertex ")[1].split("element")[0]
    properties = [line.split()[1:] for line in vertex.splitlines() if line.startswith("property")]
    count = int(vertex.split()[0])
    stride = sum(sizes[kind] for kind, _ in properties)
    return [struct.unpack_from("<fff", body, i * stride) for i in range(count)]


def wait_until(true, what, seconds, step=0.2):
    """Raises TimeoutError naming `what`."""
    end = time.monotonic() + seconds
    while not true():
        if time.monotonic() > end:
            raise TimeoutError(f"{what}: not within {seconds} s")
        time.sleep(step)
