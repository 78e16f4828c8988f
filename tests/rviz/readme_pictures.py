#!/usr/bin/python3
"""The README's pictures of rviz, from rviz itself: readme_pictures.py SCAN_BAG [OUT_DIR, by default launch/pictures].

Run it with the package built: build/devel/env.sh tests/rviz/readme_pictures.py SCAN_BAG
"""
import os
import sys
import tempfile
import time

sys.dont_write_bytecode = True  # not into the sources
from session import LAUNCH, Session, wait_for

RATIO = 0.90
FOLDER = ("Name: Fit\n", "Name: Fit\n    Export folder: /home/clerk/exports\n")  # not that of who makes the pictures
PART = "1280x709+0+62"  # of the screen: view and panel
# Name of the picture, garment, what the display shows other than launch/rviz/inspect.rviz.
PICTURES = [
    ("rviz", "B1", {}),
    ("rviz_side_by_side", "B1", {"Show: After": "Show: Side by side", "Distance: 1.1": "Distance: 1.9", "Yaw: 0.45": "Yaw: 0"}),
    ("rviz_model", "B1", {"Alpha: 1\n": "Alpha: 0.35\n", "Struts and tensile parts: false": "Struts and tensile parts: true",
                          "Girths: true": "Girths: false", "Distance: 1.1": "Distance: 0.7"}),
]


def main(scan, pictures):
    os.makedirs(pictures, exist_ok=True)
    with open(os.path.join(LAUNCH, "rviz", "inspect.rviz")) as file:
        config = file.read()
    with tempfile.TemporaryDirectory() as out, Session(out) as session:
        import rospy
        from tensegric_fit.srv import SetGarment

        session.start_chain("tensegric_fit", "demo.launch", "rviz:=false", "bag:=" + scan)
        wait_for("first fit", lambda: "body/deformed" in session.message)
        for name, garment, changes in PICTURES:
            changed = config.replace(*FOLDER)
            for old, new in changes.items():
                assert old in changed, "inspect.rviz has no '%s'" % old
                changed = changed.replace(old, new)
            path = os.path.join(out, name + ".rviz")
            with open(path, "w") as file:
                file.write(changed)
            rospy.ServiceProxy("set_garment", SetGarment)(name=garment, lines=[""], ratios=[RATIO])
            wait_for("body under " + garment, lambda worn=garment: session.wears(worn, RATIO))
            rviz = session.start_rviz(path)
            time.sleep(2)
            session.picture(os.path.join(pictures, name + ".png"), PART)
            session.end(rviz)


if __name__ == "__main__":
    main(os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2]) if len(sys.argv) > 2 else os.path.join(LAUNCH, "pictures"))
