"""The way between the stages of proxied_booth.launch, on which messages get lost, late, and out of order.

Usage: unreliable.py SEED SHARE        SHARE of the messages are dropped, as many delayed, as many sent after the next one of their topic
       unreliable.py SEED late_states  the last state on the way to a fit is sent after the fit, all else as it comes

Each input of a stage is a way of its own, so that stages miss different messages. A line of JSON on standard output for each message
that something happens to."""
import json
import random
import sys
import threading

import rospy
from tensegric_fit.msg import BodyModel, ControlMesh, FitState, Landmarks, TriangleMesh

TYPES = {"body/mesh": TriangleMesh, "body/model": BodyModel, "body/landmarks": Landmarks, "control/mesh": ControlMesh, "control/deformed": FitState}
INPUTS = {"landmarks": ("body/mesh", "body/model"), "control_mesh": ("body/mesh", "body/model", "body/landmarks"),
          "tensegric": ("body/mesh", "control/mesh"), "tffd": ("body/mesh", "body/landmarks", "control/mesh", "control/deformed")}
LATEST = 4  # seconds that a message is delayed by
HELD = 6  # seconds that it waits for the next one


class Way:
    def __init__(self, stage, topic, dice, share):
        self.name, self.dice, self.share = f"{stage} {topic}", dice, share
        self.lock, self.held = threading.Lock(), []
        self.publisher = rospy.Publisher(f"/left/unreliable/{stage}/{topic}", TYPES[topic], queue_size=8, latch=True)
        carry = self.carry if share > 0 else self.carry_states_late if TYPES[topic] is FitState else self.give
        rospy.Subscriber(f"/left/{topic}", TYPES[topic], carry)

    def give(self, message):
        """A state on the way to a fit is not kept for those who connect later, as that of the solver is not."""
        kept = self.publisher.impl.latch
        self.publisher.publish(message)
        if getattr(message, "status", "") == FitState.SOLVING:
            self.publisher.impl.latch = kept

    def carry(self, message):
        with self.lock:
            drawn, delay = self.dice.random() / self.share, self.dice.uniform(0.2, LATEST)
            if drawn < 1:
                self.record("dropped", message)
            elif drawn < 2:
                self.record("delayed", message)
                threading.Timer(delay, self.give, [message]).start()
            elif drawn < 3:
                self.record("held", message)
                self.held.append(message)
                threading.Timer(HELD, self.let_go, [message]).start()
            else:
                self.give(message)
                while self.held:
                    self.give(self.held.pop(0))

    def carry_states_late(self, message):
        with self.lock:
            if message.status == FitState.SOLVING:
                self.held = [message]
                return
            self.give(message)
            for held in self.held:
                self.record("held", held)
                self.give(held)
            self.held = []

    def let_go(self, message):
        with self.lock:
            if any(held is message for held in self.held):
                self.held = [held for held in self.held if held is not message]
                self.give(message)

    def record(self, what, message):
        print(json.dumps({"what": what, "way": self.name, "stamp": message.header.stamp.to_nsec()}), flush=True)


def main():
    seed, share = sys.argv[1], 0 if sys.argv[2] == "late_states" else float(sys.argv[2])
    rospy.init_node("unreliable", disable_signals=True)
    ways = [Way(stage, topic, random.Random(f"{seed} {stage} {topic}"), share) for stage, topics in INPUTS.items() for topic in topics]
    print(json.dumps({"ways": len(ways)}), flush=True)
    rospy.spin()


if __name__ == "__main__":
    main()
