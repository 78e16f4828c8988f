#!/usr/bin/env python3
"""Many scans through one launched chain: does a node grow, keep descriptors or threads, or get slower?

Usage: build/devel/env.sh python3 tests/soak/soak.py [--scans N] [--points N] [--config FILE.yaml] [--group N] [--out FILE.csv]

The same few scans come again and again; every 33rd is of full size. In groups: within one a scan is sent when the body before has its mesh, so that
stages work side by side; the next group waits until the chain is at rest. A row is a scan: seconds from scan to deformed body. The last row of a group also has
the processor's seconds per scan that the nodes and their children took, which other work on the machine hardly changes, and of each node, at rest,
anonymous memory (kB, /proc/PID/smaps_rollup), descriptors and threads. A run that was stopped goes on after its last whole group: with the
same chain where that still runs (the chain outlives a run that is killed), else with a new one, whose rows are another part. The verdict
is by part; it leaves out the first scans of it, while heaps fill up, and compares medians of the first and the last rows after them.
Exit: 0 all constant, 1 something grew, 2 no answer."""
import argparse
import csv
import functools
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
from launched import free_port, nodes_at, points_of, program, wait_until

NODES = ("reconstruction", "landmarks", "control_mesh", "tensegric", "tffd", "vault")
POINTS, BODIES = 9000, 4
FULL_POINTS, FULL_EVERY = 180000, 33  # 303 of 10,000 scans are of full size
GROUP = 27  # scans; no factor in common with BODIES, so that the last of a group is each body in turn
REST = 1.5  # s, after a group: nodes give memory back after a second
MEMORY = 0.01  # a node may have so much more at the end
FEWEST = 100  # scans; over fewer, memory is not judged: heaps still fill up
SLOWER = {"seconds": 0.25, "processor_s": 0.1}  # and a scan take so much longer: machines are shared


class Chain:
    """roslaunch with a master of its own, and a client that sends scans and waits for their meshes and deformed bodies."""

    def __init__(self, out, config):
        self.note, self.is_new = out.with_suffix(".chain"), False  # where it runs
        port, self.pid = self.running() or self.launch(out.with_suffix(".log"), config)
        self.address(port)
        import rospy  # after the master's address is set
        from sensor_msgs.msg import PointCloud2
        from tensegric_fit.msg import DeformedMesh, TriangleMesh
        self.rospy, self.cloud_type = rospy, PointCloud2
        wait_until(self.has_master, "the master", 30)
        rospy.init_node("soak", anonymous=True, disable_signals=True)
        self.changed = threading.Condition()
        self.seen = {"mesh": {}, "deformed": {}}  # stamp -> when the message came
        self.publisher = rospy.Publisher("scan/points", PointCloud2, queue_size=1)
        rospy.Subscriber("body/mesh", TriangleMesh, lambda message: self.take("mesh", message))
        rospy.Subscriber("body/deformed", DeformedMesh, lambda message: message.status != "solving" and self.take("deformed", message))
        wait_until(lambda: self.publisher.get_num_connections() > 0 and len(self.processes()) == len(NODES), "the nodes", 60)

    @staticmethod
    def address(port):
        os.environ["ROS_MASTER_URI"] = f"http://127.0.0.1:{port}"
        os.environ["ROS_HOSTNAME"] = "127.0.0.1"

    def running(self):
        """Port and process of the chain of an earlier run, where all its nodes live."""
        try:
            port, process = map(int, self.note.read_text().split())
            self.address(port)
            return (port, process) if "roslaunch" in pathlib.Path(f"/proc/{process}/cmdline").read_text() and len(self.processes()) == len(NODES) else None
        except (OSError, ValueError):
            return None

    def launch(self, log_path, config):
        port = free_port()
        self.address(port)
        with open(log_path, "a", encoding="utf-8") as log:
            process = subprocess.Popen(["roslaunch", "-p", str(port), "tensegric_fit", "pipeline.launch", *config], stdout=log, stderr=log, start_new_session=True)
        self.note.write_text(f"{port} {process.pid}")
        self.is_new = True
        return port, process.pid

    @staticmethod
    def has_master():
        return subprocess.run(["rosnode", "list"], capture_output=True, check=False).returncode == 0

    def take(self, what, message):
        with self.changed:
            self.seen[what][message.header.stamp] = time.monotonic()
            self.changed.notify()

    @staticmethod
    def processes():
        """Node -> process."""
        return {name.strip("/"): process for name, process in nodes_at(os.environ["ROS_MASTER_URI"], NODES).items()}

    def send(self, cloud):
        """Stamp of the scan, and when it was sent."""
        cloud.header.stamp = self.rospy.Time.now()
        begin = time.monotonic()
        self.publisher.publish(cloud)
        return cloud.header.stamp, begin

    def wait(self, what, stamp, seconds):
        """When that scan's message came."""
        with self.changed:
            for patience in (seconds, 5):  # this process may have been stopped (SIGSTOP): 5 s for what came meanwhile
                if self.changed.wait_for(lambda: stamp in self.seen[what], patience):
                    return self.seen[what].pop(stamp)
        raise TimeoutError(f"no {what} body")

    def stop(self):
        os.kill(self.pid, signal.SIGINT)
        try:
            wait_until(lambda: not self.processes(), "the end of the nodes", 30)
        except TimeoutError:
            os.killpg(self.pid, signal.SIGKILL)
        self.note.unlink()


def costs_of(process):
    folder = pathlib.Path(f"/proc/{process}")
    rollup = (folder / "smaps_rollup").read_text()
    anonymous = next(int(line.split()[1]) for line in rollup.splitlines() if line.startswith("Anonymous:"))
    return anonymous, len(list((folder / "fd").iterdir())), len(list((folder / "task").iterdir()))


def processor_seconds(processes):
    """That the nodes have taken since they started, with their children that have ended."""
    ticks = 0
    for process in processes:
        after_name = pathlib.Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
        ticks += sum(map(int, after_name[11:15]))  # utime, stime, cutime, cstime
    return ticks / os.sysconf("SC_CLK_TCK")


def columns():
    return ["part", "scan", *SLOWER] + [f"{node}_{what}" for node in NODES for what in ("kB", "descriptors", "threads")]


def rows_of(path):
    """What was done so far, without a last group that was cut off. A file of an earlier version may lack a column."""
    if not path.exists():
        return []
    with open(path, encoding="utf-8", newline="") as file:
        reader = csv.DictReader(file)
        rows = list(reader)
        whole = [i for i, row in enumerate(rows) if all(row[column] for column in reader.fieldnames)]
        return rows[:whole[-1] + 1] if whole else []


@functools.lru_cache(maxsize=None)
def cloud_of(points, body):
    """A scan of so many points of that body; made when it is first asked for."""
    from sensor_msgs import point_cloud2
    from std_msgs.msg import Header
    with tempfile.TemporaryDirectory(prefix="soak_") as folder:
        subprocess.run([program("virtual_booth"), "--seed", str(body + 1), "--points", str(points), "--out", folder], check=True,
                       stdout=subprocess.DEVNULL)
        return point_cloud2.create_cloud_xyz32(Header(frame_id="booth"), points_of(pathlib.Path(folder) / "scan.ply"))


def record(chain, points, scans, group, path):
    rows = rows_of(path)
    if rows and list(rows[0]) != columns():
        raise RuntimeError(f"{path} has other columns: begin another file, or this one with --anew")
    part = int(rows[-1]["part"]) + chain.is_new if rows else 1
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, columns())
        writer.writeheader()
        writer.writerows(rows)
        processes = chain.processes()
        for start in range(len(rows), scans, group):
            these = range(start, min(start + group, scans))
            try:
                done = rows_of_group(chain, points, these, processes, 30)
            except TimeoutError as error:
                # A scan whose later stages take longer than the next one's mesh gives way to it, as it should in a shop.
                print(f"scans {start} to {these[-1]}: {error}; again, one after the other", file=sys.stderr)
                done = rows_of_group(chain, points, these, processes, 120, side_by_side=False)
            writer.writerows({"part": part, **row} for row in done)
            file.flush()
        if chain.processes() != processes:
            raise RuntimeError("a node died")


def rows_of_group(chain, points, scans, processes, seconds, side_by_side=True):
    sent, came = [], []
    before = processor_seconds(processes.values())
    for i in scans:
        sent.append(chain.send(cloud_of(FULL_POINTS if i % FULL_EVERY == FULL_EVERY - 1 else points, i % BODIES)))
        chain.wait("mesh", sent[-1][0], seconds)
        if not side_by_side:
            came.append(chain.wait("deformed", sent[-1][0], seconds))
    came += [chain.wait("deformed", stamp, seconds) for stamp, _ in sent[len(came):]]
    rows = [{"scan": i, "seconds": f"{end - begin:.3f}"} for i, (_, begin), end in zip(scans, sent, came)]
    rows[-1]["processor_s"] = f"{(processor_seconds(processes.values()) - before) / len(scans):.2f}"
    time.sleep(REST)
    for node in NODES:
        rows[-1].update(zip((f"{node}_kB", f"{node}_descriptors", f"{node}_threads"), costs_of(processes[node])))
    return rows


def verdict(rows, out):
    """Prints a table per part; whether nothing grew."""
    fine = True
    for part in sorted({int(row["part"]) for row in rows}):
        fine = constant([row for row in rows if int(row["part"]) == part], part, out) and fine
    return fine


def constant(rows, part, out):
    settled = rows[min(100, len(rows) // 3):]
    count = max(1, min(500, len(settled) // 3) // BODIES) * BODIES  # each body as often as the others
    first, last = settled[:count], settled[-count:]
    fine = True
    print(f"part {part}: {len(rows)} scans; medians of {count} rows, after {len(rows) - len(settled)} and at the end", file=out)
    for column in [column for column in columns()[2:] if column in rows[0]]:
        values = [[float(row[column]) for row in part_of if row[column]] for part_of in (first, last)]
        if not all(values):  # no group ended there
            fine = fine and not column.endswith(("_descriptors", "_threads"))
            print(f"| {column} | not judged: a group is longer than {count} scans")
            continue
        before, after = map(statistics.median, values)
        judged = count >= FEWEST or column.endswith(("_descriptors", "_threads"))
        allowed = SLOWER.get(column, MEMORY if column.endswith("_kB") else 0)
        grew = judged and after > before * (1 + allowed)
        fine = fine and not grew
        print(f"| {column} | {before:g} | {after:g} | {100 * (after / before - 1):+.2f} % |{' GREW' if grew else ''}", file=out)
    return fine


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scans", type=int, default=10000, help="rows of the file in all")
    parser.add_argument("--points", type=int, default=POINTS, help="of a scan")
    parser.add_argument("--group", type=int, default=GROUP, help="so many scans between two rests of the chain")
    parser.add_argument("--config", type=pathlib.Path, help="of the chain; launch/config/pipeline.yaml without it")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("soak.csv"))
    parser.add_argument("--anew", action="store_true", help="does not go on where an earlier run was stopped")
    parser.add_argument("--verdict", action="store_true", help="of the rows that are there, and no scan")
    arguments = parser.parse_args()
    if arguments.group < 1:
        parser.error("--group: at least 1")
    if arguments.anew:
        arguments.out.unlink(missing_ok=True)
    if not arguments.verdict:
        chain = Chain(arguments.out, [f"config:={arguments.config.resolve()}"] if arguments.config else [])
        try:
            record(chain, arguments.points, arguments.scans, arguments.group, arguments.out)
        except (TimeoutError, RuntimeError) as error:
            print(error, file=sys.stderr)
            return 2
        finally:
            chain.stop()
    rows = rows_of(arguments.out)
    if not rows:
        print(f"{arguments.out} has no scans", file=sys.stderr)
        return 2
    return 0 if verdict(rows, sys.stdout) else 1


if __name__ == "__main__":
    sys.exit(main())
