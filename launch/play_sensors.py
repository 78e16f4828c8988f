#!/usr/bin/python3
"""play_sensors.py BAG - plays what the sensors of a booth recorded, once somebody hears each of them.

Of the bag, the assembler's `sensors` of this namespace and transforms are played, and nothing else: `rosbag play` waits for a
subscriber of every topic that it plays. Topics that the bag has without the namespace are played in it. Ends with 1 and a sentence
where a sensor is not in the bag.
"""
import os
import sys

import rosbag
import roslib.packages
import rosgraph
from rosgraph.names import get_ros_namespace, resolve_name

TRANSFORMS = ("/tf", "/tf_static")


def main(bag, remappings):
    node = get_ros_namespace(argv=remappings) + "sensors"
    try:
        sensors = rosgraph.Master(node).getParam(resolve_name("assembler/sensors", node))
    except (rosgraph.MasterException, OSError):
        return "play_sensors: the parameter 'sensors' of the assembler is not set, or there is no ROS master"
    try:
        with rosbag.Bag(bag) as opened:
            there = set(opened.get_type_and_topic_info()[1])
    except (rosbag.ROSBagException, OSError) as error:
        return "play_sensors: %s: %s" % (bag, error)
    asked, missing = {}, []
    for sensor in sensors:
        heard = resolve_name(sensor, node)
        names = [name for name in (heard, resolve_name(sensor, "/"), sensor) if name in there]
        if names:
            asked[names[0]] = heard
        else:
            missing.append(sensor)
    if missing:
        return "play_sensors: %s: has no %s; 'sensors' names the topics of a capture, the bag has %s" % (
            bag, ", ".join(missing), ", ".join(sorted(there)))
    play = roslib.packages.find_node("rosbag", "play")
    topics = list(asked) + [topic for topic in TRANSFORMS if topic in there]
    os.execv(play[0], [play[0], "--quiet", "--keep-alive", "--wait-for-subscribers", bag, "--topics"] + topics
             + ["%s:=%s" % names for names in asked.items() if names[0] != names[1]] + remappings)
    return None


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit("play_sensors.py BAG")
    sys.exit(main(sys.argv[1], sys.argv[2:]))
