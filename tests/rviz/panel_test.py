#!/usr/bin/python3
"""Real rviz, and what a shop does to it: nonsense typed, a garment file spoilt while it is worn, messages that are no good, a
folder that cannot be written, two panels at once, the pipeline gone and back. Each is answered in words, rviz lives on, and
the last good state stays.

panel_test.py SCAN_BAG OUT_DIR. Exit: 0 passed, 1 failed, 77 skipped. OUT_DIR gets pictures and the logs.
"""
import copy
import json
import os
import shutil
import signal
import subprocess
import sys
import time

import numpy as np

sys.dont_write_bytecode = True  # not into the sources
from rviz_test import view_of
from session import BACKGROUND, HERE, LAUNCH, Session, pixels_of, run_test, wait_for

LEAST, MOST = 0.5, 1.2  # ratios that the panel's sliders end at


class Shop(Session):
    """The chain on a coarse body, and rviz."""

    def open(self, scan):
        self.scan, self.exports = scan, os.path.join(self.out, "exports")
        shutil.rmtree(self.exports, ignore_errors=True)
        self.chain_command = [os.path.join(HERE, "rviz_test.launch"), "scan:=" + scan]
        self.chain = self.start_chain(*self.chain_command)
        wait_for("first fit", lambda: "body/deformed" in self.message)
        self.rviz = self.start_rviz(self.config(self.exports))

    def config(self, exports):
        with open(os.path.join(LAUNCH, "rviz", "inspect.rviz")) as file:
            text = file.read()
        panel = "Name: Fit\n"
        assert panel in text
        path = os.path.join(self.out, "panel.rviz")
        with open(path, "w") as file:
            file.write(text.replace(panel, "%s    Export folder: %s\n" % (panel, exports)))
        return path

    def wear(self, garment, name="B1"):
        self.message.pop("body/deformed", None)
        self.put_on(garment)
        wait_for("body under " + garment, lambda: "body/deformed" in self.message)
        assert self.message["body/deformed"].garment == name, "another garment was put on"
        time.sleep(1)  # its lines are on the panel

    def ratio(self):
        fit = self.message["control/deformed"]
        return fit.lines[0].request if fit.status != "solving" else None

    def comes_to(self, ratio):
        wait_for("line at %g" % ratio, lambda: self.ratio() is not None and abs(self.ratio() - ratio) < 1e-4)

    def hears(self, words):
        """Waits for words of the panel, and forgets what was said so far."""
        wait_for("'%s' on the panel" % words, lambda: any("fit panel" in line and words in line for line in list(self.said)), 30)
        self.said.clear()
        time.sleep(1)  # the panel is as it says

    def process_of(self, node):
        return int(subprocess.check_output(["pgrep", "-P", str(self.chain.pid), "-f", "__name:=%s " % node], text=True))

    def exported(self):
        return sorted(os.listdir(self.exports)) if os.path.isdir(self.exports) else []


def sliders_at_their_ends_and_nonsense_typed(shop):
    shop.press("alt+1", "End")
    shop.comes_to(MOST)
    shop.press("Home")
    shop.comes_to(LEAST)
    shop.still_picture(os.path.join(shop.out, "tightest.png"))
    shop.picture(os.path.join(shop.out, "tightest.png"))
    shop.press("Tab")  # to the per cent
    for typed in ("nonsense", "-40", "1e999", "99999", "0"):
        shop.press("ctrl+a")
        shop.write(typed)
        shop.press("Return")
    shop.press("ctrl+a")
    shop.write("93")
    shop.press("Return")
    shop.comes_to(0.93)
    shop.press("Tab", "ctrl+a")  # to the centimetres
    shop.write("inf")
    shop.press("Return")
    time.sleep(1)
    assert LEAST <= shop.ratio() <= MOST, "the line went to %g" % shop.ratio()


def the_wheel_turns_what_was_chosen_only(shop):
    def wheel(x, y, button, times=1):
        subprocess.check_call(["xdotool", "mousemove", str(x), str(y), "click", "--repeat", str(times), button])
        time.sleep(1)

    shop.comes_to(0.95)
    for chosen, x, y in (("alt+g", 1100, 406), ("alt+g", 1005, 383), ("alt+1", 1040, 192)):  # slider, per cent, garment
        shop.press(chosen)
        wheel(x, y, "5")
        assert shop.ratio() == 0.95, "the wheel over the panel changed a line"
        assert shop.message["body/deformed"].garment == "B1", "the wheel over the panel changed the garment"
        wheel(950, 110, "4", 10)  # the panel scrolled: up again
    shop.press("alt+1")  # the slider is chosen
    wheel(1100, 406, "5")
    wait_for("line that the wheel changed", lambda: shop.ratio() not in (None, 0.95), 20)


def a_garment_file_spoilt_while_it_is_worn(shop):
    path = os.path.join(shop.out, "mine.yaml")
    shutil.copy(os.path.join(LAUNCH, "garments", "B1.yaml"), path)
    shop.wear(path)
    with open(path, "w") as file:
        file.write("lines: [{name: chest, ratio: tight}, \0")
    shop.said.clear()
    body = shop.message["body/deformed"]
    shop.put_on(path)
    shop.hears("Not put on: ")
    shop.put_on("B17")
    shop.hears("Not put on: ")
    assert shop.message["body/deformed"] is body, "the garment that was refused changed the body"
    shop.press("alt+1", "Left")  # the panel goes on with what is worn
    shop.comes_to(0.945)
    shutil.copy(os.path.join(LAUNCH, "garments", "B1.yaml"), path)
    shop.wear(path)
    shop.comes_to(0.95)
    with open(path) as file:
        text = file.read().replace("ratio: 0.95", "ratio: 0.95\n    width: 0.02")
    for name in ("chest", "upper"):  # the garment's name stays; then the line has another
        with open(path, "w") as file:
            file.write(text.replace("name: chest", "name: " + name))
        shop.wear(path)
        shop.press("alt+1", "Left")
        shop.comes_to(0.945)
        line = shop.message["garment"].lines[0]
        assert (line.name, line.width) == (name, 0.02), "the slider put on an older version: %s" % line
    shop.wear("B1")


def the_scan_over_beside_and_wiped_against_the_garment(shop):
    """The list of Compare, from the keyboard; each picture is another, and the first comes back."""
    shown, last = {}, None
    shop.press("alt+c", "Home")
    for way in ("alone", "ghost", "beside", "wipe", "fade"):
        path = os.path.join(shop.out, way + ".png")
        shop.still_picture(path, unlike=last)
        shown[way], last = pixels_of(path), path
        shop.press("Down")
    shop.press("Home")
    shop.still_picture(os.path.join(shop.out, "alone_again.png"), unlike=last)

    def differs(one, other, part=slice(None)):
        return (np.abs(one[:, part] - other[:, part]).max(axis=2) > 8).mean()

    left, _, right, _ = view_of(shown["alone"])
    half = (left + right + 1) // 2
    assert differs(shown["alone"], shown["ghost"]) > 0.003, "no ghost"
    assert differs(shown["alone"], shown["beside"]) > 0.1, "nothing stands beside"
    assert differs(shown["alone"], shown["wipe"], slice(0, half - 20)) > 0.003, "left of the wipe is not the scan"
    garment = shown["wipe"][:600, half + 20:], shown["alone"][:600, half + 20:]  # above the scale of colours
    assert differs(*garment) < 0.002, "right of the wipe is not the garment"
    # Coupled and of one size: where nothing moved (above the bust) both parts are the same picture but for landmarks and tapes.
    top = shown["beside"][40:200]
    width = half - left - 4
    same = differs(top[:, left + 2:left + 2 + width], top[:, half + 2:half + 2 + width])
    assert same < 0.05, "the two bodies are not of one size and view: %g" % same
    again = pixels_of(os.path.join(shop.out, "alone_again.png"))
    assert differs(shown["alone"], again) < 0.001, "the view did not come back"


def messages_that_are_no_good(shop):
    import rospy
    from tensegric_fit.msg import DeformedMesh, FitState

    good = shop.message["body/deformed"]
    before, after = (os.path.join(shop.out, name + ".png") for name in ("good", "still_good"))
    shop.still_picture(before, "840x600+0+62")
    publisher = rospy.Publisher("body/deformed", DeformedMesh, queue_size=9)
    wait_for("rviz and this as subscribers", lambda: publisher.get_num_connections() >= 2)
    for spoil in (lambda m: setattr(m, "vertices", [float("nan")] * len(m.vertices)),
                  lambda m: setattr(m, "distortion", [float("inf")] * len(m.distortion)),
                  lambda m: setattr(m, "vertices", m.vertices[:-3]),
                  lambda m: setattr(m, "vertices", m.vertices[:-1]),
                  lambda m: setattr(m, "distortion", []),
                  lambda m: (setattr(m, "vertices", []), setattr(m, "distortion", []))):
        bad = copy.copy(good)
        spoil(bad)
        shop.said.clear()
        publisher.publish(bad)
        time.sleep(1)
        assert shop.rviz.poll() is None, "rviz has ended"
    fits = rospy.Publisher("control/deformed", FitState, queue_size=9)
    wait_for("rviz, the chain and this as subscribers", lambda: fits.get_num_connections() >= 3)
    fit = shop.message["control/deformed"]
    for course in ([0.1] * 5, [float("nan")] * 6):
        bad = copy.deepcopy(fit)
        bad.lines[0].course = course
        fits.publish(bad)
        time.sleep(1)
        assert shop.rviz.poll() is None, "rviz has ended"
    fits.unregister()
    shop.message["control/deformed"] = fit
    shop.picture(after, "840x600+0+62")
    publisher.unregister()
    shop.message["body/deformed"] = good
    assert subprocess.run(["cmp", before, after], check=False).returncode == 0, "the picture changed"


def exports_are_of_the_scan_that_is_shown(shop):
    import rosbag
    import rospy
    from sensor_msgs.msg import PointCloud2

    shop.press("alt+x")
    shop.hears("Wrote # files")  # logs hold no figures
    export = os.path.join(shop.exports, shop.exported()[0])
    assert len(os.listdir(export)) == 18, os.listdir(export)
    with open(os.path.join(export, "fit.json")) as file:
        assert json.load(file)["scan"]["scan_id"] == shop.message["body/mesh"].scan_id

    # the next customer is on the screen, and no garment was fitted to her so far
    last = shop.message["body/mesh"].scan_id
    with rosbag.Bag(shop.scan) as bag:
        _, scan, _ = next(bag.read_messages(topics=["/scan/points"]))
    scan.header.stamp = rospy.Time.now()
    publisher = rospy.Publisher("scan/points", PointCloud2, queue_size=1)
    wait_for("chain", lambda: publisher.get_num_connections() > 0)
    held = shop.process_of("control_mesh")
    os.kill(held, signal.SIGSTOP)
    try:
        publisher.publish(scan)
        wait_for("next body", lambda: shop.message["body/mesh"].scan_id != last)
        time.sleep(2)
        shop.press("alt+x")
        shop.hears("Nothing was exported: no body under a garment is shown so far.")
        assert len(shop.exported()) == 1, "the last customer's fit was exported under the next one's name"
    finally:
        os.kill(held, signal.SIGCONT)
        publisher.unregister()
    wait_for("fit of the next customer", lambda: shop.message["body/deformed"].scan_id != last)


def exports_that_cannot_be_written(shop):
    for folder in ("/proc/fits", "here/fits", shop.scan):
        shop.press("alt+f", "ctrl+a")
        shop.write(folder)
        shop.said.clear()
        shop.press("alt+x")
        shop.hears("Nothing was exported: ")
    shop.picture(os.path.join(shop.out, "not_exported.png"))
    shop.press("alt+f", "ctrl+a")
    shop.write(shop.exports)
    assert len(shop.exported()) == 1, "something was written"


def a_body_that_is_not_the_newest(shop):
    """After a scan that was refused no page of the body before is written, and no name is noted for it. On the next body nothing
    goes back to what the last customer wore."""
    import rosbag
    import rospy
    from sensor_msgs.msg import PointCloud2
    from tensegric_fit.msg import ScanLabel

    labels = []
    listener = rospy.Subscriber("scan/label", ScanLabel, labels.append)
    publisher = rospy.Publisher("scan/points", PointCloud2, queue_size=2)
    wait_for("reconstruction and capture", lambda: publisher.get_num_connections() >= 2)
    with rosbag.Bag(shop.scan) as bag:
        _, scan, _ = next(bag.read_messages(topics=["/scan/points"]))
    shop.press("alt+1", "Left")  # a step back, while she is shown
    shop.comes_to(0.945)
    exported, last = shop.exported(), shop.message["body/mesh"].scan_id
    labels.clear()  # those of before, which are latched
    shop.press("alt+m")
    shop.write("47")  # and no Return so far
    scan.header.stamp = rospy.Time.now()
    publisher.publish(PointCloud2(header=scan.header, height=1, fields=scan.fields, point_step=scan.point_step))
    shop.hears("The customer was not noted: another scan has come")
    shop.press("alt+1", "alt+m")
    shop.write("4711")
    shop.press("Return", "alt+x")
    time.sleep(3)
    shop.picture(os.path.join(shop.out, "pale.png"))
    assert not labels, "the body before was given a name: %s" % labels
    assert shop.exported() == exported, "the body before was exported"

    scan.header.stamp = rospy.Time.now()
    publisher.publish(scan)
    wait_for("fit of the next customer", lambda: shop.message["body/deformed"].scan_id == shop.message["body/mesh"].scan_id != last)
    time.sleep(2)
    shop.press("alt+1", "ctrl+z")
    time.sleep(3)
    shop.comes_to(0.945)
    shop.press("alt+m")
    shop.write("4711")
    shop.press("Return")
    wait_for("name of the next customer", lambda: labels, 20)
    assert (labels[-1].scan_id, labels[-1].customer) == (shop.message["body/mesh"].scan_id, "4711"), labels
    publisher.unregister()
    listener.unregister()


def a_scan_that_is_forgotten(shop):
    """It is gone from the view, and the label that the panel latched of it; the next customer is shown as before."""
    import rosbag
    import rospy
    from sensor_msgs.msg import PointCloud2
    from tensegric_fit.msg import ScanLabel
    from tensegric_fit.srv import Forget

    shop.press("alt+m", "ctrl+a")
    shop.write("4712")
    shop.press("Return", "alt+1")
    scan_id = shop.message["body/mesh"].scan_id
    labels = []
    listener = rospy.Subscriber("scan/label", ScanLabel, labels.append)
    wait_for("latched label", lambda: any((label.scan_id, label.customer) == (scan_id, "4712") for label in list(labels)), 20)
    listener.unregister()

    def background(name):
        path = os.path.join(shop.out, name + ".png")
        shop.picture(path, "840x600+0+62")  # above the scale of colours
        return (np.abs(pixels_of(path) - BACKGROUND).max(axis=2) <= 1).mean()

    shown = background("before_forget")
    done = rospy.ServiceProxy("forget", Forget)(scan_id=scan_id)
    assert any(line.startswith("/rviz") and line.endswith(": what it showed") for line in done.removed), done
    assert not any(line.startswith("/rviz") for line in done.not_reached if "session" not in line), done
    wait_for("empty view", lambda: background("forgotten") > max(0.9, shown), 20)
    shop.picture(os.path.join(shop.out, "forgotten_panel.png"))
    del labels[:]
    listener = rospy.Subscriber("scan/label", ScanLabel, labels.append)
    time.sleep(2)
    assert not any(label.scan_id == scan_id for label in labels), "the label is latched still"
    listener.unregister()

    publisher = rospy.Publisher("scan/points", PointCloud2, queue_size=2)
    wait_for("reconstruction and capture", lambda: publisher.get_num_connections() >= 2)
    with rosbag.Bag(shop.scan) as bag:
        _, scan, _ = next(bag.read_messages(topics=["/scan/points"]))
    scan.header.stamp = rospy.Time.now()
    publisher.publish(scan)
    # The scan player has latched an earlier one, which comes again, too.
    stamp = "%d.%09d-" % (scan.header.stamp.secs, scan.header.stamp.nsecs)
    wait_for("fit of the next customer", lambda: all(shop.message[topic].scan_id.startswith(stamp)
                                                     for topic in ("body/mesh", "control/deformed", "body/deformed")))
    wait_for("her picture", lambda: background("next") < 0.9, 20)
    publisher.unregister()


def warnings_of_another_garment_are_not_said(shop):
    import rospy
    from tensegric_fit.msg import FitWarning, FitWarnings

    publisher = rospy.Publisher("body/warnings", FitWarnings, queue_size=2)
    wait_for("rviz", lambda: publisher.get_num_connections() > 0)
    for garment in ("B17", "B1"):
        publisher.publish(FitWarnings(scan_id=shop.message["control/deformed"].scan_id, garment=garment,
                                      warnings=[FitWarning(code="shelf", message="Made up for %s." % garment)]))
        time.sleep(1)
    wait_for("warning on the panel", lambda: any("Made up for B1." in line for line in list(shop.said)), 20)
    assert not any("B17" in line for line in list(shop.said)), "a warning of a garment that is not worn was said"
    publisher.unregister()


def two_panels_at_once(shop):
    import rospy
    from tensegric_fit.msg import Garment

    asked = []
    other = shop.new_display()
    with shop.at(other):
        second = shop.start_rviz(os.path.join(shop.out, "panel.rviz"), "rviz_2")
    rospy.Subscriber("garment", Garment, lambda garment: asked.append(garment.lines[0].ratio))
    shop.press("alt+1", "Left", "Left")
    shop.comes_to(0.94)
    time.sleep(3)  # the other panel has followed, on a busy machine, too
    with shop.at(other):
        shop.press("alt+1", "Left")  # from where the first one left it
        shop.comes_to(0.935)
        time.sleep(3)
        shop.picture(os.path.join(shop.out, "second_panel.png"), "430x709+850+62")
    shop.press("Right", "Right", "Right")
    shop.comes_to(0.95)

    def was_the_last():  # it may be heard after the body in it, on a busy machine
        count = len(asked)
        time.sleep(1)
        return count == len(asked) > 0 and abs(asked[-1] - 0.95) < 1e-4

    wait_for("end of what the panels ask for", was_the_last, 30)
    asked.clear()
    time.sleep(3)
    assert not asked, "the panels go on asking: %s" % asked
    shop.end(second)


def the_pipeline_gone_and_back(shop):
    shop.said.clear()
    shop.end(shop.chain)
    shop.hears("The fitting pipeline is not running.")
    shop.press("alt+1", "Left")
    shop.hears("Not put on: The fitting pipeline is not running.")
    shop.picture(os.path.join(shop.out, "gone.png"))
    shop.message.clear()
    shop.chain = shop.start_chain(*shop.chain_command)
    wait_for("fit of the new chain", lambda: "body/deformed" in shop.message)
    time.sleep(2)
    shop.wear("B1")
    shop.press("alt+1", "Left")
    shop.comes_to(0.945)
    shop.still_picture(os.path.join(shop.out, "back.png"))
    shop.picture(os.path.join(shop.out, "back.png"))


SCENES = (sliders_at_their_ends_and_nonsense_typed, the_wheel_turns_what_was_chosen_only, a_garment_file_spoilt_while_it_is_worn,
          the_scan_over_beside_and_wiped_against_the_garment, messages_that_are_no_good,
          exports_are_of_the_scan_that_is_shown, exports_that_cannot_be_written, a_body_that_is_not_the_newest, a_scan_that_is_forgotten,
          warnings_of_another_garment_are_not_said, two_panels_at_once, the_pipeline_gone_and_back)


def main(scan, out):
    def play(shop):
        shop.open(scan)
        for scene in SCENES:
            shop.wear("B1")
            shop.said.clear()
            scene(shop)
            assert shop.rviz.poll() is None, "rviz has ended in: " + scene.__name__
            print("passed: " + scene.__name__.replace("_", " "))
        shop.quit_rviz(shop.rviz)

    return run_test(lambda: Shop(out), play)


if __name__ == "__main__":
    sys.exit(main(os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])))
