#!/usr/bin/env python3
"""SIGKILL to the nodes before the chain and beside it (inputs.launch): depth_cameras, assembler, scan_player, correlation. Publishers latch, as the simulated booth does.

Usage: build/devel/env.sh python3 tests/faults/inputs.py --work DIR [--kills 40] [--soon 5] [--anew]

Each case kills one of them at a random moment while it is at a scan, or at a scan in the garment. The newest scan must then have the result that it has without faults, to the bit, at most 5 s after
the node is heard again; no result is another scan's. The last cases kill scan_player twice while it reads one file, and between two scans of one file. A line of JSON per case in DIR/inputs.jsonl; cases that are there are not done again. Exit: 0 all hold, 1 otherwise."""
import argparse
import hashlib
import json
import os
import pathlib
import random
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.dont_write_bytecode = True  # not into the sources
sys.path[:0] = [str(HERE), str(HERE.parent)]
from graph import BODIES, PATIENCE, SOON, STAGES
from launched import free_port, nodes_at, points_of, program, wait_until

KILLED = {"cameras": ("depth_cameras", "assembler"), "files": ("scan_player", "correlation")}
WHEN = {"depth_cameras": (0, 0.4), "assembler": (0, 0.8), "scan_player": (0, 0.4), "correlation": (0, 2)}  # s from what it gets, or begins to read: while it is at that
CAMERAS = 4


class Booths:
    """The launched booths, and what is sent to them and heard of them. Context manager."""

    def __init__(self, work):
        self.work, self.folder, self.port = work, work / "folder", free_port()
        self.lock = threading.Lock()
        self.found = {"cameras": [], "files": [], "worn": []}  # (digest, seconds)
        self.heard, self.errors = {}, {}  # booth/node -> seconds; its last error
        self.labelled = 0.0  # when a scan of a file was published last
        self.files = 0
        self.publishers = {}
        self.environment = dict(os.environ, ROS_MASTER_URI=f"http://localhost:{self.port}", ROS_HOSTNAME="localhost")

    def __enter__(self):
        self.log = open(self.work / "launch.log", "a", encoding="utf-8")
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir()
        shutil.copy(self.work / "0" / "cameras.yaml", self.work / "cameras.yaml")
        self.launched = subprocess.Popen(["roslaunch", "-p", str(self.port), HERE / "inputs.launch", f"work:={self.work}"], stdout=self.log,
                                         stderr=self.log, env=self.environment, start_new_session=True)
        try:
            wait_until(lambda: subprocess.run(["rosnode", "list"], capture_output=True, env=self.environment, check=False).returncode == 0,
                       "the master", PATIENCE)
            self.listen()
            nodes = {f"{booth}/{node}" for booth, killed in KILLED.items() for node in killed + STAGES}
            wait_until(lambda: nodes <= set(self.heard), "reports of all nodes", PATIENCE)
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        self.launched.send_signal(signal.SIGINT)
        try:
            self.launched.wait(20)
        except subprocess.TimeoutExpired:
            self.launched.kill()
        self.log.close()

    def listen(self):
        os.environ.update(self.environment)
        import rospy  # reads the environment
        from diagnostic_msgs.msg import DiagnosticArray
        from tensegric_fit.msg import Correlation, DeformedMesh, ScanLabel
        rospy.init_node("inputs", disable_signals=True)
        for booth in KILLED:
            rospy.Subscriber(f"/{booth}/body/deformed", DeformedMesh, lambda m, b=booth: m.status != "solving" and self.keep(b, m.vertices))
        rospy.Subscriber("/files/worn/correlation", Correlation, lambda m: self.keep("worn", m.distance))
        rospy.Subscriber("/files/scan/label", ScanLabel, self.note)
        rospy.Subscriber("/diagnostics", DiagnosticArray, self.hear)

    def keep(self, what, numbers):
        digest = hashlib.sha256(struct.pack(f"<{len(numbers)}f", *numbers)).hexdigest()[:16]
        with self.lock:
            self.found[what].append((digest, time.monotonic()))

    def note(self, _):
        self.labelled = time.monotonic()

    def hear(self, array):
        for status in array.status:
            node = status.name.split(":")[0]
            self.heard[node] = time.monotonic()
            self.errors[node] = next((pair.value for pair in status.values if pair.key == "last_error"), "")

    def newest(self, what):
        with self.lock:
            return self.found[what][-1] if self.found[what] else None

    def publish(self, topic, message):
        import rospy
        if topic not in self.publishers:
            self.publishers[topic] = rospy.Publisher(topic, type(message), queue_size=1, latch=True)
        self.publishers[topic].publish(message)

    def scan_cameras(self, body):
        import rosbag
        import rospy
        stamp = rospy.Time.now()
        with rosbag.Bag(str(self.work / str(body) / "cameras.bag")) as bag:
            messages = [(topic, message) for topic, message, _ in bag.read_messages() if topic.startswith("/cameras/")]
        for topic, message in sorted(messages, key=lambda m: m[0].endswith("/image")):
            message.header.stamp = stamp
            self.publish(topic.replace("/cameras/", "/cameras/cameras/", 1), message)

    def scan_files(self, body):
        self.files += 1
        half = self.work / "half.ply"
        shutil.copy(self.work / str(body) / "scan.ply", half)
        half.rename(self.folder / f"{self.files}.ply")

    def scan_bag(self, bodies):
        """One file with a scan of each."""
        import rosbag
        self.files += 1
        half = self.work / "half.bag"
        with rosbag.Bag(str(half), "w") as bag:
            for body in bodies:
                with rosbag.Bag(str(self.work / str(body) / "scan.bag")) as one:
                    for topic, message, stamp in one.read_messages(topics=["/scan/points"]):
                        bag.write(topic, message, stamp)
        half.rename(self.folder / f"{self.files}.bag")

    def scan_worn(self, body):
        import rospy
        from sensor_msgs import point_cloud2
        from std_msgs.msg import Header
        header = Header(stamp=rospy.Time.now(), frame_id="files/booth")
        self.publish("/files/worn/points", point_cloud2.create_cloud_xyz32(header, points_of(self.work / str(body) / "scan.ply")))

    def wait_for_reading(self, again=False):
        """Until the scan player has begun to read a file; `again`: one that its life before was at, which counts as played by now."""
        import rospy

        def reads():
            texts, played = (rospy.get_param(f"/files/scan_player/{name}_files", []) for name in ("interrupted", "played"))
            return any(not again or text in played for text in texts)
        wait_until(reads, "reading", PATIENCE, 0.001)

    def processes(self):
        return nodes_at(f"http://localhost:{self.port}", [node for nodes in KILLED.values() for node in nodes])

    def wait(self, what, since, digest=None):
        """When the result came, which is that one, if it is given; TimeoutError names what came in its place."""
        def right():
            newest = self.newest(what)
            return newest is not None and newest[1] > since and digest in (None, newest[0])
        wait_until(right, f"result of {what}, newest {self.newest(what)}", PATIENCE, 0.05)
        return self.newest(what)


def right_results(booths):
    """what -> body -> digest, without faults."""
    right = {what: [] for what in booths.found}
    for body in range(BODIES):
        for what in ("cameras", "files", "worn"):  # worn: of the body that files brought
            since = time.monotonic()
            getattr(booths, f"scan_{what}")(body)
            right[what].append(booths.wait(what, since)[0])
    if any(len(set(digests)) != BODIES for digests in right.values()):
        raise RuntimeError("bodies that look alike prove nothing")
    return right


def kill(booths, right, case, soon):
    dice = random.Random(f"inputs {case}")
    name = list(WHEN)[case % len(WHEN)]
    what = booth = next(b for b, names in KILLED.items() if name in names)
    node, body, delay = f"{booth}/{name}", dice.randrange(BODIES), dice.uniform(*WHEN[name])
    since = time.monotonic()
    getattr(booths, f"scan_{booth}")(body)
    if node == "files/correlation":
        booths.wait("files", since, right["files"][body])
        what, since = "worn", time.monotonic()
        booths.scan_worn(body)
    before = booths.processes()[node]
    if name == "scan_player":
        booths.wait_for_reading()
    time.sleep(delay)
    os.kill(before, signal.SIGKILL)
    killed = time.monotonic()
    wait_until(lambda: booths.processes().get(node, before) != before and booths.heard[node] > killed + 0.3, node, PATIENCE)
    back = time.monotonic()
    seconds = booths.wait(what, since, right[what][body])[1] - back
    time.sleep(1)  # a later one would be another
    strange = [digest for digest, at in booths.found[what] if at > since and digest != right[what][body]]
    return {"node": node, "body": body, "delay": round(delay, 2), "return": round(back - killed, 2), "seconds": round(seconds, 2), "was_through": seconds + back < killed,
            "strange": len(strange), "fine": seconds <= soon and not strange}


def kill_twice(booths, right):
    """A file that may be what ends the scan player is not read a third time, and that is said; the next file is played."""
    begin, node = time.monotonic(), "files/scan_player"
    booths.scan_files(0)
    for reading in (1, 2):
        process = booths.processes()[node]
        booths.wait_for_reading(again=reading == 2)
        os.kill(process, signal.SIGKILL)
        wait_until(lambda: booths.processes().get(node, process) != process, node, PATIENCE)
    wait_until(lambda: booths.errors.get(node) == "broken_file", "the name of the loss", PATIENCE)
    lost = booths.newest("files")[1] < begin
    booths.scan_files(1)
    booths.wait("files", begin, right["files"][1])
    return {"node": node, "twice": True, "fine": lost}


def kill_between(booths, right):
    """Of a file with several scans, some of which are out, the rest is not played, and that is said; the next file is played."""
    begin, node = time.monotonic(), "files/scan_player"
    booths.scan_bag([0, 1])
    wait_until(lambda: booths.labelled > begin, "the first scan", PATIENCE)
    time.sleep(1)  # of the ten to the next; it has noted that one is out
    process, begin = booths.processes()[node], time.monotonic()
    os.kill(process, signal.SIGKILL)
    wait_until(lambda: booths.processes().get(node, process) != process, node, PATIENCE)
    back = time.monotonic()
    wait_until(lambda: booths.heard[node] > back + 0.3 and booths.errors[node] == "broken_file", "the name of the loss", PATIENCE)
    booths.scan_files(2)
    booths.wait("files", begin, right["files"][2])
    played = any(digest == right["files"][1] for digest, at in booths.found["files"] if at > begin)
    return {"node": node, "between": True, "fine": not played}


OTHERS = (kill_twice, kill_between)


def bodies_in(work):
    for n in range(BODIES):
        if not (work / str(n)).exists():
            subprocess.run([program("virtual_booth"), "--seed", str(n + 1), "--points", "9000", "--depth-cameras", str(CAMERAS), "--out", work / str(n)],
                           check=True, stdout=subprocess.DEVNULL)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--work", type=pathlib.Path, required=True)
    parser.add_argument("--kills", type=int, default=40)
    parser.add_argument("--soon", type=float, default=SOON, help="seconds that a result may take, on a machine that is shared")
    parser.add_argument("--anew", action="store_true", help="do the cases that are there again")
    arguments = parser.parse_args()
    work = arguments.work.resolve()
    work.mkdir(parents=True, exist_ok=True)
    path = work / "inputs.jsonl"
    if arguments.anew:
        path.unlink(missing_ok=True)
    rows = [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()] if path.exists() else []
    bodies_in(work)
    with Booths(work) as booths, open(path, "a", encoding="utf-8") as file:
        right = right_results(booths)
        for case in range(len(rows), arguments.kills + len(OTHERS)):
            try:
                row = kill(booths, right, case, arguments.soon) if case < arguments.kills else OTHERS[case - arguments.kills](booths, right)
            except TimeoutError as error:
                row = {"fine": False, "error": str(error)}
            rows.append({"case": case, **row})
            file.write(json.dumps(rows[-1]) + "\n")
            file.flush()
            print(json.dumps(rows[-1]), flush=True)
    print(f"{len(rows)} cases, {sum(row['fine'] for row in rows)} fine")
    return 0 if all(row["fine"] for row in rows) else 1


if __name__ == "__main__":
    with tempfile.TemporaryDirectory(prefix="ros_") as home:
        os.environ.setdefault("ROS_HOME", home)
        sys.exit(main())
