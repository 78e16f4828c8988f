#!/usr/bin/python3
"""clock_set_back.py

Goals of the action `capture` before and after the clock was set back by 1000 s, as by a time server after a restart: actionlib drops goals that are stamped
before its last one. Nothing scans, so each goal ends `timed_out`. Exit 0 where both are answered, else 1.
"""
import os
import pathlib
import subprocess
import sys
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from launched import free_port, program, wait_until  # noqa: E402

PATIENCE = 30  # s
BEGIN, BACK = 5000, 1000  # s, of the clock


def main():
    os.environ["ROS_MASTER_URI"] = f"http://127.0.0.1:{free_port()}"
    os.environ["ROS_HOSTNAME"] = "127.0.0.1"
    import actionlib
    import rospy
    from rosgraph_msgs.msg import Clock
    from tensegric_fit.msg import CaptureAction, CaptureGoal
    core = subprocess.Popen(["rosmaster", "--core", "-p", os.environ["ROS_MASTER_URI"].rsplit(":", 1)[1]], stdout=subprocess.DEVNULL)
    node = None
    try:
        wait_until(lambda: subprocess.run(["rosparam", "set", "/use_sim_time", "true"], capture_output=True, check=False).returncode == 0, "the master", PATIENCE)
        node = subprocess.Popen([program("capture_node"), "__name:=capture"])
        rospy.init_node("clock", disable_signals=True)
        clock, origin = rospy.Publisher("/clock", Clock, queue_size=1), [BEGIN - time.monotonic()]

        def tick():
            while not rospy.is_shutdown():
                clock.publish(Clock(clock=rospy.Time(origin[0] + time.monotonic())))
                time.sleep(0.02)
        threading.Thread(target=tick, daemon=True).start()
        client = actionlib.SimpleActionClient("capture", CaptureAction)

        def code():
            """Of a goal's answer; None: there is none."""
            answered = threading.Event()
            client.send_goal(CaptureGoal(timeout=1), done_cb=lambda *_: answered.set())
            return client.get_result().code if answered.wait(PATIENCE) else None
        wait_until(client.wait_for_server, "the action", PATIENCE)
        codes = [code()]
        before = rospy.Time.now()
        origin[0] -= BACK
        wait_until(lambda: rospy.Time.now() < before, "the clock", PATIENCE)
        time.sleep(1)  # it may be made anew: until it is, goals go to what was there
        wait_until(client.wait_for_server, "the action", PATIENCE)
        codes.append(code())
        print("answers:", codes)
        return 0 if codes == ["timed_out"] * 2 else 1
    finally:
        for process in (node, core):
            if process:
                process.terminate()
                process.wait(20)


if __name__ == "__main__":
    sys.exit(main())
