#!/usr/bin/python3
"""Real rviz: both plugins load, B1 is picked, the chest slider goes to 90 %, the picture changes at the bust and nowhere else.

rviz_test.py SCAN_BAG OUT_DIR. Exit: 0 passed, 1 failed, 77 skipped. OUT_DIR gets before.png, after.png and the logs.
"""
import math
import os
import sys

import numpy as np

sys.dont_write_bytecode = True  # not into the sources
from session import BACKGROUND, HERE, LAUNCH, PANEL, Session, pixels_of, run_test, wait_for

EYE = {"distance": 1.1, "yaw": 0.45, "pitch": 0.1, "focus": (0.05, 0.0, 1.18), "field": math.pi / 4}  # of launch/rviz/inspect.rviz
KEY_STEP, START, GOAL = 0.005, 0.95, 0.90  # ratio: of an arrow key, of B1.yaml, wanted
RADIUS = 25  # pixels round a landmark that are looked at


def view_of(picture):
    """left, top, right, bottom of the 3D view: what its background fills."""
    rows, columns = np.nonzero(np.abs(picture - BACKGROUND).max(axis=2) <= 1)
    assert len(rows) > 1000, "no 3D view on the screen"
    return columns.min(), rows.min(), columns.max(), rows.max()


def pixel_of(place, view):
    """Where rviz's orbit camera shows a place of the body frame."""
    yaw, pitch = EYE["yaw"], EYE["pitch"]
    back = np.array([math.cos(yaw) * math.cos(pitch), math.sin(yaw) * math.cos(pitch), math.sin(pitch)])
    right = np.array([-math.sin(yaw), math.cos(yaw), 0])
    way = np.asarray(place) - EYE["focus"] - EYE["distance"] * back
    left, top, end, bottom = view
    scale = (bottom - top) / 2 / math.tan(EYE["field"] / 2) / -way.dot(back)
    return (left + end) / 2 + scale * way.dot(right), (top + bottom) / 2 - scale * way.dot(np.cross(back, right))


def change_around(change, pixel):
    column, row = (int(value) for value in pixel)
    return change[max(0, row - RADIUS):row + RADIUS, max(0, column - RADIUS):column + RADIUS].mean()


def drive(session, scan):
    session.start_chain(os.path.join(HERE, "rviz_test.launch"), "scan:=" + scan)
    wait_for("first fit", lambda: "body/deformed" in session.message)
    first, panel, before, after = (os.path.join(session.out, name + ".png") for name in ("first", "panel", "before", "after"))
    rviz = session.start_rviz(os.path.join(LAUNCH, "rviz", "inspect.rviz"))
    session.still_picture(first)
    session.put_on("B1")
    wait_for("body under B1", lambda: session.wears("B1", START))
    session.still_picture(before, unlike=first)  # H1 is on no more
    session.still_picture(panel, PANEL)  # with the lines of B1
    session.press("alt+1")  # the slider of the first line
    session.press(*["Left"] * round((START - GOAL) / KEY_STEP))
    wait_for("body at %g" % GOAL, lambda: session.wears("B1", GOAL))
    session.still_picture(after, unlike=before)
    assert rviz.poll() is None, "rviz has ended"
    with open(os.path.join(session.out, "rviz.log")) as log:
        assert "failed to load" not in log.read(), "a plugin did not load: see rviz.log"
    session.quit_rviz(rviz)


def compare(landmarks, before, after):
    to_body = np.array(landmarks.body_from_scan).reshape(4, 4)
    places = {point.name: to_body[:3, :3] @ point.position + to_body[:3, 3] for point in landmarks.points}
    view = view_of(before)
    change = np.abs(after - before).max(axis=2)
    bust = [change_around(change, pixel_of(places[name], view)) for name in ("bust_point_L", "bust_point_R")]
    still = change_around(change, pixel_of(places["navel"], view))
    print("mean change of colour: bust points %.1f and %.1f, navel %.1f" % (*bust, still))
    assert min(bust) > 8, "the picture did not change at the bust points"
    assert still < 2, "the picture changed at the navel"


def main(scan, out):
    def drive_and_compare(session):
        drive(session, scan)
        compare(session.message["body/landmarks"], *(pixels_of(os.path.join(out, name + ".png"))
                                                     for name in ("before", "after")))

    return run_test(lambda: Session(out), drive_and_compare)


if __name__ == "__main__":
    sys.exit(main(os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])))
