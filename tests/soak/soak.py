#!/usr/bin/env python3
"""Many scans through one launched chain: does a node grow, keep descriptors or threads, or get slower?

Usage: build/devel/env.sh python3 tests/soak/soak.py [--scans N] [--out FILE.csv]

The same few scans come again and again, each when the one before is through. After each a row: seconds from scan to deformed body, and
of each node anonymous memory (kB, /proc/PID/smaps_rollup), descriptors and threads. The verdict leaves out the first scans, while heaps
fill up, and compares medians of the first and the last rows after them. Exit: 0 all constant, 1 something grew, 2 no answer."""
import argparse
import csv
import os
import pathlib
import signal
import statistics
import subprocess
import sys
import tempfile
import threading
import time

sys.dont_write_bytecode = True  # not into the sources
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from launched import free_port, points_of, program, wait_until

NODES = ("reconstruction", "landmarks", "control_mesh", "tensegric", "tffd")
POINTS, BODIES = 9000, 4
MEMORY = 0.01  # a node may have so much more at the end
SLOWER = 0.25  # and a scan take so much longer: machines are shared


class Chain:
    """roslaunch with a master of its own, and a client that sends scans and waits for the deformed body."""

    def __init__(self, log):
        port = free_port()
        os.environ["ROS_MASTER_URI"] = f"http://127.0.0.1:{port}"
        os.environ["ROS_HOSTNAME"] = "127.0.0.1"
        self.launch = subprocess.Popen(["roslaunch", "-p", str(port), "tensegric_fit", "pipeline.launch"], stdout=log, stderr=log,
                                       start_new_session=True)
        import rospy  # after the master's address is set
        from sensor_msgs.msg import PointCloud2
        from tensegric_fit.msg import DeformedMesh
        self.rospy, self.cloud_type = rospy, PointCloud2
        wait_until(self.has_master, "the master", 30)
        rospy.init_node("soak", disable_signals=True)
        self.done, self.stamp = threading.Event(), None
        self.publisher = rospy.Publisher("scan/points", PointCloud2, queue_size=1)
        rospy.Subscriber("body/deformed", DeformedMesh, self.take)
        wait_until(lambda: self.publisher.get_num_connections() > 0 and len(self.processes()) == len(NODES), "the nodes", 60)

    @staticmethod
    def has_master():
        return subprocess.run(["rosnode", "list"], capture_output=True, check=False).returncode == 0

    def take(self, message):
        if message.header.stamp == self.stamp:
            self.done.set()

    def processes(self):
        """Node -> process."""
        found = {}
        for comm in pathlib.Path("/proc").glob("[0-9]*/cmdline"):
            try:
                words = comm.read_bytes().split(b"\0")
                session = os.getsid(int(comm.parent.name))
            except (OSError, ValueError):
                continue
            name = pathlib.Path(words[0].decode(errors="replace")).name
            if name.endswith("_node") and name[:-5] in NODES and self.is_ours(comm.parent, session):
                found[name[:-5]] = int(comm.parent.name)
        return found

    def is_ours(self, process, session):
        if session == self.launch.pid:
            return True
        try:  # roslaunch gives each node a session of its own
            return f"ROS_MASTER_URI={os.environ['ROS_MASTER_URI']}".encode() in (process / "environ").read_bytes()
        except OSError:
            return False

    def scan(self, points, seconds):
        from sensor_msgs import point_cloud2
        from std_msgs.msg import Header
        self.done.clear()
        self.stamp = self.rospy.Time.now()
        begin = time.monotonic()
        self.publisher.publish(point_cloud2.create_cloud_xyz32(Header(stamp=self.stamp, frame_id="booth"), points))
        if not self.done.wait(seconds):
            raise TimeoutError("no deformed body")
        return time.monotonic() - begin

    def stop(self):
        self.launch.send_signal(signal.SIGINT)
        try:
            self.launch.wait(20)
        except subprocess.TimeoutExpired:
            os.killpg(self.launch.pid, signal.SIGKILL)


def costs_of(process):
    folder = pathlib.Path(f"/proc/{process}")
    rollup = (folder / "smaps_rollup").read_text()
    anonymous = next(int(line.split()[1]) for line in rollup.splitlines() if line.startswith("Anonymous:"))
    return anonymous, len(list((folder / "fd").iterdir())), len(list((folder / "task").iterdir()))


def columns():
    return ["scan", "seconds"] + [f"{node}_{what}" for node in NODES for what in ("kB", "descriptors", "threads")]


def record(chain, clouds, scans, file):
    writer = csv.writer(file)
    writer.writerow(columns())
    processes = chain.processes()
    for i in range(scans):
        seconds = chain.scan(clouds[i % len(clouds)], 120)
        writer.writerow([i, f"{seconds:.3f}"] + [value for node in NODES for value in costs_of(processes[node])])
        file.flush()
    if chain.processes() != processes:
        raise RuntimeError("a node died")


def verdict(rows):
    """Prints the table; whether nothing grew."""
    settled = rows[min(100, len(rows) // 3):]
    part = max(len(clouds_of_one_round()), min(500, len(settled) // 4))
    first, last = settled[:part], settled[-part:]
    fine = True
    print(f"{len(rows)} scans; medians of {part} rows, after {len(rows) - len(settled)} and at the end")
    for column in columns()[1:]:
        before, after = (statistics.median(float(row[column]) for row in part_of) for part_of in (first, last))
        allowed = SLOWER if column == "seconds" else MEMORY if column.endswith("_kB") else 0
        grew = after > before * (1 + allowed)
        fine = fine and not grew
        print(f"| {column} | {before:g} | {after:g} | {100 * (after / before - 1):+.2f} % |{' GREW' if grew else ''}")
    return fine


def clouds_of_one_round():
    return range(BODIES)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scans", type=int, default=10000)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("soak.csv"))
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="soak_") as folder, open(arguments.out, "w", encoding="utf-8", newline="") as file:
        clouds = []
        for n in clouds_of_one_round():
            subprocess.run([program("virtual_booth"), "--seed", str(n + 1), "--points", str(POINTS), "--out", f"{folder}/{n}"],
                           check=True, stdout=subprocess.DEVNULL)
            clouds.append(points_of(pathlib.Path(folder) / f"{n}/scan.ply"))
        with open(f"{folder}/log", "w", encoding="utf-8") as log:
            chain = Chain(log)
            try:
                record(chain, clouds, arguments.scans, file)
            except (TimeoutError, RuntimeError) as error:
                print(error, file=sys.stderr)
                return 2
            finally:
                chain.stop()
    with open(arguments.out, encoding="utf-8", newline="") as file:
        return 0 if verdict(list(csv.DictReader(file))) else 1


if __name__ == "__main__":
    sys.exit(main())
