#!/usr/bin/python3
"""In which frame rviz is started: the body's, which lies in the booth's namespace. Needs no master and no display."""
import os
import pathlib
import shlex
import unittest

from roslaunch.config import ROSLaunchConfig
from roslaunch.xmlloader import XmlLoader

LAUNCH = pathlib.Path(__file__).resolve().parent.parent / "launch"


def words_of(program, file, namespace, *arguments):
    os.environ.pop("ROS_NAMESPACE", None)
    if namespace is not None:
        os.environ["ROS_NAMESPACE"] = namespace
    config = ROSLaunchConfig()
    XmlLoader().load(str(LAUNCH / file), config, argv=list(arguments), verbose=False)
    started = [shlex.split(node.args) for node in config.nodes if node.type == program]  # as roslaunch does
    assert len(started) == 1, started
    return started[0]


def words_of_rviz(*arguments):
    return words_of("rviz", *arguments)


class InspectFrame(unittest.TestCase):
    def test_the_fixed_frame_lies_in_the_namespace(self):
        for namespace, frame in ((None, "body"), ("", "body"), ("/", "body"), ("booth_1", "booth_1/body"),
                                 ("/booth_1/", "booth_1/body"), ("shop/booth_1", "shop/booth_1/body")):
            for file, arguments in (("inspect.launch", []), ("inspect.launch", ["plain:=true"]), ("demo.launch", [])):
                with self.subTest(namespace=namespace, file=file, arguments=arguments):
                    self.assertEqual(words_of_rviz(file, namespace, *arguments)[2:], ["-f", frame])

    def test_a_configuration_of_ones_own_keeps_its_frame(self):
        self.assertEqual(words_of_rviz("inspect.launch", "booth_1", "config:=/home/shop/mine.rviz"), ["-d", "/home/shop/mine.rviz"])

    def test_paths_may_have_spaces(self):
        self.assertEqual(words_of_rviz("inspect.launch", None, "config:=/home/a shop/mine.rviz"), ["-d", "/home/a shop/mine.rviz"])
        played = words_of("play_sensors.py", "booth.launch", None, "assemble:=true", "file:=/home/a shop/Anna's.bag")
        self.assertEqual(played, ["/home/a shop/Anna's.bag"])

    def test_the_files_have_the_frame_of_no_namespace(self):
        for file in ("inspect.rviz", "plain.rviz"):
            self.assertIn("\n    Fixed Frame: body\n", (LAUNCH / "rviz" / file).read_text(encoding="utf-8"))


if __name__ == "__main__":
    unittest.main()
