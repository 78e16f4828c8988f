#!/usr/bin/python3
"""Bags of earlier versions are still good: rosbag fix makes today's messages of theirs, by the rules of launch/migration."""
import pathlib
import subprocess
import tempfile
import unittest

import rosbag
from tensegric_fit.msg import BodyModel, FitWarning, FitWarnings

ROOT = pathlib.Path(__file__).resolve().parent.parent
DATA, RULES = ROOT / "tests" / "data", sorted((ROOT / "launch" / "migration").glob("*.bmr"))


def fixed(bag, folder):
    """(topic, message) of a bag, by rosbag fix, as its user runs it."""
    new = pathlib.Path(folder, "new.bag")
    ran = subprocess.run(["rosbag", "fix", str(bag), str(new), *map(str, RULES)], capture_output=True, text=True, check=False)
    assert ran.returncode == 0 and new.is_file(), ran.stdout + ran.stderr
    with rosbag.Bag(str(new)) as messages:
        return [(topic, message) for topic, message, _ in messages.read_messages()]


class Migration(unittest.TestCase):
    def test_constants_hold_no_comments(self):
        for name, value in vars(FitWarning).items():
            if name.isupper():
                self.assertEqual(value, name.lower())

    def test_warnings_with_commented_constants(self):
        with tempfile.TemporaryDirectory() as folder:
            messages = fixed(DATA / "warnings_of_2026-11-24.bag", folder)
        self.assertEqual([topic for topic, _ in messages], ["body/warnings", "booth_1/body/warnings"])
        for _, message in messages:
            self.assertEqual(message._md5sum, FitWarnings._md5sum)
            self.assertEqual((message.scan_id, message.garment), ("1000000007.000000000-5dd72cc5", "B1"))
            self.assertEqual(message.header.frame_id, "booth")
            [warning], [notice] = message.warnings, message.notices
            self.assertEqual((warning.code, warning.line, warning.vertices), (FitWarning.SHELF, "chest", (3, 5, 8)))
            self.assertEqual((warning.place, warning.place_worn), ((0.1, 0.09, 1.1), (0.11, 0.08, 1.12)))
            self.assertEqual((warning.area, warning.shelf_area, warning.value), (0.0004, 0.0002, 1.1))
            self.assertEqual((notice.code, notice.lack), (FitWarning.UNDER_CONSTRICTED, "slack"))
            self.assertEqual(notice.message, "The line chest is slack.")

    def test_body_models_without_the_grounds_deviation(self):
        with tempfile.TemporaryDirectory() as folder:
            messages = fixed(DATA / "body_model_of_2026-11-25.bag", folder)
        self.assertEqual([topic for topic, _ in messages], ["body/model"])
        [(_, model)] = messages
        self.assertEqual(model._md5sum, BodyModel._md5sum)
        self.assertEqual((model.scan_id, model.header.frame_id, model.header.stamp.secs), ("1000000007.000000000-5dd72cc5", "booth", 1000000007))
        self.assertEqual((model.ground, model.ground_deviation, model.scale, model.scanned), (0.003, 0, 1.02, True))
        self.assertEqual((model.turns, model.off, model.mesh_parts, model.parts), ((0.1, 0.2, 0.3), (0.25, 0.5), b"\x00\xff", ["head"]))


if __name__ == "__main__":
    unittest.main()
