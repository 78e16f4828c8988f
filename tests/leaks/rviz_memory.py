#!/usr/bin/python3
"""Does rviz with display and panel grow with the bodies that it shows?

Usage: build/devel/env.sh /usr/bin/python3 tests/leaks/rviz_memory.py OUT_DIR [--bodies 1000]

A chain makes two fits, whose messages are then sent to rviz in turn, as new scans each time. Prints anonymous memory of rviz after each
tenth of the bodies, and bytes per body over the last half. Exit: 0, 77 where there is no rviz or display."""
import argparse
import copy
import os
import pathlib
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.dont_write_bytecode = True  # not into the sources
sys.path[:0] = [str(HERE.parent / "rviz"), str(HERE.parent)]
from launched import points_of, program
from session import LAUNCH, Session, run_test, wait_for

TOPICS = ("body/mesh", "body/landmarks", "control/mesh", "control/deformed", "control/bands", "body/deformed")
SHOWN = 0.3  # seconds for one body: what software GL takes for a frame or two


def types():
    from tensegric_fit.msg import BandShapes, ControlMesh, DeformedMesh, FitState, Landmarks, TriangleMesh
    return dict(zip(TOPICS, (TriangleMesh, Landmarks, ControlMesh, FitState, BandShapes, DeformedMesh)))


def fits(session, out):
    """topic -> message of two bodies."""
    import rospy
    from sensor_msgs import point_cloud2
    from sensor_msgs.msg import PointCloud2
    from std_msgs.msg import Header
    chain = session.start_chain("tensegric_fit", "pipeline.launch")
    newest = {}
    listeners = [rospy.Subscriber(topic, kind, lambda message, topic=topic: newest.__setitem__(topic, message)) for topic, kind in types().items()]
    publisher = rospy.Publisher("scan/points", PointCloud2, queue_size=1, latch=True)
    found = []
    for seed in (1, 2):
        folder = out / str(seed)
        subprocess.run([program("virtual_booth"), "--seed", str(seed), "--out", folder], check=True, stdout=subprocess.DEVNULL)
        newest.clear()
        publisher.publish(point_cloud2.create_cloud_xyz32(Header(stamp=rospy.Time.now(), frame_id="booth"), points_of(folder / "scan.ply")))
        wait_for("fit", lambda: len(newest) == len(TOPICS) and newest["body/deformed"].status == "converged")
        time.sleep(2)  # its bands
        found.append(copy.deepcopy(newest))
    for listener in listeners:
        listener.unregister()
    session.end(chain)
    return found


def memory_of(process):
    rollup = pathlib.Path(f"/proc/{process}/smaps_rollup").read_text()
    return next(int(line.split()[1]) for line in rollup.splitlines() if line.startswith("Anonymous:"))


def drive(session, out, bodies):
    import rospy
    both = fits(session, out)
    publishers = {topic: rospy.Publisher(topic, kind, queue_size=2, latch=True) for topic, kind in types().items()}
    rviz = session.start_rviz(os.path.join(LAUNCH, "rviz", "inspect.rviz"), shows_a_body=False)
    rows = []
    for body in range(bodies):
        for topic, message in both[body % 2].items():
            message.scan_id = f"{body}"
            publishers[topic].publish(message)
        time.sleep(SHOWN)
        if (body + 1) % max(1, bodies // 10) == 0:
            rows.append((body + 1, memory_of(rviz.pid)))
            print("%d bodies: %d kB" % rows[-1], flush=True)
    (early, before), (late, after) = rows[len(rows) // 2 - 1], rows[-1]
    print("%.0f bytes per body, over the last %d" % (1024 * (after - before) / (late - early), late - early))
    session.picture(os.path.join(session.out, "last.png"))
    session.quit_rviz(rviz)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--bodies", type=int, default=1000)
    arguments = parser.parse_args()
    out = arguments.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    return run_test(lambda: Session(str(out)), lambda session: drive(session, out, arguments.bodies))


if __name__ == "__main__":
    sys.exit(main())
