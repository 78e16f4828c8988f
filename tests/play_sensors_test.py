#!/usr/bin/python3
"""What play_sensors.py plays of a bag: topics of the sensors and transforms alone, in the namespace that it runs in."""
import importlib.util
import os
import pathlib
import sys
import tempfile
import unittest
from unittest import mock

import rosbag
import rospy
from std_msgs.msg import String

sys.dont_write_bytecode = True
LAUNCH = pathlib.Path(__file__).resolve().parent.parent / "launch"
spec = importlib.util.spec_from_file_location("play_sensors", LAUNCH / "play_sensors.py")
play_sensors = importlib.util.module_from_spec(spec)
spec.loader.exec_module(play_sensors)

SENSORS = ["sensors/0/points", "sensors/1/points"]


class PlaySensors(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.bag = os.path.join(self.folder.name, "booth.bag")
        with rosbag.Bag(self.bag, "w") as bag:
            for topic in ["/" + sensor for sensor in SENSORS] + ["/tf_static", "/scanner/status"]:
                bag.write(topic, String("what is in it does not matter"), rospy.Time(1))

    def tearDown(self):
        self.folder.cleanup()

    def played(self, namespace, sensors):
        """What it says, and the words that rosbag's player would be started with."""
        asked = {}

        def parameter(_, name):
            asked["name"] = name
            return sensors

        with mock.patch.dict(os.environ, {"ROS_NAMESPACE": namespace}), \
                mock.patch.object(play_sensors.rosgraph.Master, "getParam", parameter), \
                mock.patch.object(play_sensors.os, "execv") as execv:
            said = play_sensors.main(self.bag, ["__name:=sensors"])
        self.assertEqual(asked["name"], ("/" + namespace if namespace else "") + "/assembler/sensors")
        return said, execv.call_args.args[1] if execv.called else None

    def test_topics_of_sensors_and_transforms_alone(self):
        said, words = self.played("", SENSORS)
        self.assertIsNone(said)
        self.assertEqual(words[words.index("--topics") + 1:], ["/" + sensor for sensor in SENSORS] + ["/tf_static", "__name:=sensors"])

    def test_in_a_namespace_they_are_played_in_it(self):
        said, words = self.played("left", SENSORS)
        self.assertIsNone(said)
        for sensor in SENSORS:
            self.assertIn("/%s:=/left/%s" % (sensor, sensor), words)

    def test_a_sensor_that_the_bag_lacks_is_named(self):
        said, words = self.played("", SENSORS + ["sensors/2/points"])
        self.assertIn("has no sensors/2/points", said)
        self.assertIsNone(words)


if __name__ == "__main__":
    unittest.main()
