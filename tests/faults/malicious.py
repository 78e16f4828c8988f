"""What a malicious node on the graph sends to the stages of a booth: malicious.py BOOTH ATTACK [FOLDER]

Prints a line of JSON, what the services and actions that it called answered; an answer that is none, or not the right one, begins with "wrong: ".
FOLDER: of the exports of this booth."""
import json
import random
import struct
import sys
import time

import actionlib
import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import TransformStamped
from sensor_msgs.msg import PointCloud2, PointField
from std_msgs.msg import Header
from tensegric_fit.msg import (BodyModel, CaptureAction, CaptureGoal, ControlLine, ControlMesh, DeformedMesh, FitState, ForgetAnswer, ForgetOrder, Garment,
                               GarmentLine, Landmark, Landmarks, LineForces, LineResult, ScanLabel, TriangleMesh)
from tensegric_fit.srv import DeleteExport, ExportFit, Forget, SetGarment
from tf2_msgs.msg import TFMessage

TOPICS = {"scan/points": PointCloud2, "body/mesh": TriangleMesh, "body/model": BodyModel, "body/landmarks": Landmarks, "control/mesh": ControlMesh,
          "garment": Garment, "control/deformed": FitState, "control/forces": LineForces, "body/deformed": DeformedMesh, "scan/label": ScanLabel,
          "forget/order": ForgetOrder, "forget/answer": ForgetAnswer}
STRANGE = ("", "\x00\x01\x1b[2J", "]]><!--", "../../../etc/passwd", "%n%s%d", "{}{:d}", "\U0001f4a9" * 99, "x" * 1_000_000)
NONE, ENDLESS = float("nan"), float("inf")
WRONG = "wrong: "


class Raw:
    """Bytes in place of a message, of the type that subscribers ask for."""

    def __init__(self, kind):
        class Bytes(kind):
            def serialize(self, buffer):
                buffer.write(self.bytes)
        Bytes._md5sum, Bytes._type, Bytes._full_text = kind._md5sum, kind._type, kind._full_text
        self.kind = Bytes

    def __call__(self, content):
        message = self.kind()
        message.bytes = content
        return message


class Attacker:
    def __init__(self, booth, folder):
        self.booth, self.folder, self.dice = booth, folder, random.Random(7)
        self.newest = ""
        rospy.Subscriber(f"/{booth}/body/mesh", TriangleMesh, self.see)
        time.sleep(1)  # what is latched

    def see(self, message):
        self.newest = message.scan_id

    def publish(self, messages, pause=0.01):
        """topic -> messages. Queues of two drop what comes too fast."""
        publishers = {topic: rospy.Publisher(topic if topic[0] == "/" else f"/{self.booth}/{topic}", type(of[0]), queue_size=1000)
                      for topic, of in messages.items()}
        time.sleep(1)  # until they are connected
        for topic, of in messages.items():
            for message in of:
                publishers[topic].publish(message)
                time.sleep(pause)
        time.sleep(2)
        for publisher in publishers.values():
            publisher.unregister()

    def call(self, service, kind, **request):
        try:
            answer = rospy.ServiceProxy(f"/{self.booth}/{service}", kind)(**request)
            return {"done": getattr(answer, "accepted", getattr(answer, "exported", getattr(answer, "deleted", None))), "code": getattr(answer, "code", ""),
                    "removed": list(getattr(answer, "removed", []))}
        except rospy.ServiceException as error:
            return {"done": False, "code": f"{WRONG}{str(error)[:80]}"}

    def bytes(self):
        """Random bytes, and counts that lie, as messages of every topic."""
        lies = [b"", b"\xff" * 4, struct.pack("<I", 1) * 8, struct.pack("<I", 10_000_000) * 40]
        lies += [bytes(before) + struct.pack("<I", count) for before in range(12, 37, 4) for count in (10_000_000, 2 ** 30, 2 ** 32 - 1)]
        for topic, kind in TOPICS.items():
            raw = Raw(kind)
            self.publish({topic: [raw(lie) for lie in lies] + [raw(self.dice.randbytes(self.dice.randrange(400))) for _ in range(10)]}, pause=0.1)

    def empty(self):
        self.publish({topic: [kind()] for topic, kind in TOPICS.items() if not topic.startswith("forget")})

    def tags(self):
        """Strange scan ids, frames and names."""
        self.publish({topic: [kind(header=Header(frame_id=strange), scan_id=strange) for strange in STRANGE]
                      for topic, kind in TOPICS.items() if hasattr(kind(), "scan_id") and hasattr(kind(), "header")})
        self.publish({"scan/label": [ScanLabel(scan_id=self.newest, source=strange, customer=strange) for strange in STRANGE]})

    def shapes(self):
        """Meshes, control meshes and fits of the newest scan whose numbers cannot be."""
        scan = dict(scan_id=self.newest)
        wild = [NONE, ENDLESS, -ENDLESS, 1e38, 1e-45]
        meshes = [TriangleMesh(vertices=[x] * 9, triangles=[0, 1, 2], filled=b"\0\0\0", **scan) for x in wild]
        meshes += [TriangleMesh(vertices=[0, 0, 0, 1, 0, 0, 0, 1, 0], triangles=list(t), filled=b"\0", **scan)
                   for t in ((0, 1, 4294967295), (0, 0, 0), (0, 1), ())]
        controls = [ControlMesh(outer=[x] * 9, inner=[x] * 9, triangles=[0, 1, 2], outer_fixed=b"\0\0\0", inner_fixed=b"\1\1\1", names=["a", "a", ""],
                                lines=[ControlLine(name="chest", nodes=[0, 7, 2])], **scan) for x in wild]
        fits = [FitState(status=status, outer=[x] * 231, inner=[x] * 231,
                         lines=[LineResult(name="chest", course=[x] * 5, course_at_rest=[x] * 6, nodes=[0, 999])], **scan)
                for x in wild for status in ("converged", "solving", "no such status")]
        points = [Landmarks(points=[Landmark(name="crotch", position=[x, x, x], confidence=x)], body_from_scan=[x] * 16, **scan) for x in wild]
        models = [BodyModel(vertices=[x] * 300, turns=[x] * 9, shape=[x], scale=x, **scan) for x in wild]
        self.publish({"body/mesh": meshes, "control/mesh": controls, "control/deformed": fits, "body/landmarks": points, "body/model": models,
                      "body/deformed": [DeformedMesh(vertices=[x] * 9, distortion=[x], status="converged", **scan) for x in wild]})

    def clouds(self):
        def cloud(**changes):
            fields = [PointField(name, offset, PointField.FLOAT32, 1) for name, offset in (("x", 0), ("y", 4), ("z", 8))]
            return PointCloud2(**dict(dict(header=Header(stamp=rospy.Time.now()), height=1, width=100, fields=fields, point_step=12, row_step=1200,
                                           data=bytes(1200)), **changes))
        wild = struct.pack("<f", NONE) * 300
        self.publish({"scan/points": [cloud(), cloud(data=wild), cloud(width=4294967295), cloud(height=4294967295, width=0), cloud(point_step=0),
                                      cloud(data=self.dice.randbytes(1200)), cloud(fields=[]), cloud(row_step=1, height=100)]})

    def garments(self):
        def line(**changes):
            return GarmentLine(**dict(dict(name="chest", ratio=0.9), **changes))
        lines = [[line(ratio=x)] for x in (NONE, 0, -1, ENDLESS)] + [[line(name=strange, ratio=0.9)] for strange in STRANGE]
        lines += [[line(points=[NONE] * 9)], [line(through=["nobody"] * 100_000)], [line(name=f"line {i}") for i in range(10_000)],
                  [line(points=[1e38, 0, 0, -1e38, 0, 0])], [line(law="table", stretch=[1, 1], tension=[ENDLESS, NONE])], [line(width=1e9, smooth=-1)]]
        garments = [Garment(name=strange, regions=["bust"], lines=[line()]) for strange in STRANGE]
        garments += [Garment(name="odd", regions=["bust", strange], lines=of) for strange, of in zip(STRANGE * 9, lines)]
        self.publish({"garment": garments})
        return [self.call("set_garment", SetGarment, garment=garment, lines=["chest", "no such"], ratios=[NONE]) for garment in garments]

    def reports(self):
        """Lies on /diagnostics: stages that refused, are done, or work, without a word more."""
        array = DiagnosticArray()
        for node in ("reconstruction", "landmarks", "control_mesh", "tensegric", "tffd", "assembler", "nobody"):
            for state in ("refused", "failed", "done", "working", "nonsense"):
                for values in ({}, {"scan_id": self.newest}, {"scan_id": "another"}, {"working_seconds": "nan", "scan_id": "x" * 100_000}):
                    array.status.append(DiagnosticStatus(name=f"{self.booth}/{node}: {node}", level=3, values=[KeyValue("state", state)] + [
                        KeyValue(key, value) for key, value in values.items()]))
        self.publish({"/diagnostics": [array, DiagnosticArray(status=[DiagnosticStatus(name=strange) for strange in STRANGE])]})

    def captures(self):
        """Goals that no booth can meet, with reports that lie meanwhile: some are refused at once, the others end with any code."""
        client = actionlib.SimpleActionClient(f"/{self.booth}/capture", CaptureAction)
        if not client.wait_for_server(rospy.Duration(20)):
            return [WRONG + "no server"]
        answers = []
        refused = [CaptureGoal(sensors=["no topic!"]), CaptureGoal(sensors=["body/landmarks"]), CaptureGoal(timeout=NONE), CaptureGoal(timeout=-5),
                   CaptureGoal(timeout=1e300)]
        unmet = [CaptureGoal(sensors=sensors, timeout=1) for sensors in ([""], ["x" * 100_000], ["a"] * 100_000)]
        for number, goal in enumerate(refused + unmet):
            client.send_goal(goal)
            self.reports()
            answered = client.wait_for_result(rospy.Duration(20))
            code = client.get_result().code if answered else "no answer"
            right = answered and (code == "bad_option" if number < len(refused) else code != "")
            answers.append(code if right else WRONG + code)
            client.cancel_all_goals()
        return answers

    def folders(self):
        """Exports to, and deletion in, folders that are none of ours."""
        places = ("/", "/etc", "/proc/self", "/dev/null", "relative", "", "/nonexistent/" + "x" * 5000, self.folder + "/..", self.folder + "/link",
                  self.folder + "/customer", self.folder + "/customer/fit.json")
        answers = [self.call("export_fit", ExportFit, directory=place, scan_id=scan) for place in places for scan in ("", "../x")]
        answers += [self.call("delete_export", DeleteExport, directory=place, scan_id=scan) for place in places for scan in ("", "..", "another")]
        return answers + [self.call("forget", Forget, scan_id="another", folders=list(places), scan_file=True)]

    def orders(self):
        """To forget, from somebody who is not the vault: of no scan, of another, of a strange one."""
        self.publish({"forget/order": [ForgetOrder(step=step, scan_id=strange, scan_file=True) for strange in STRANGE for step in (0, 1, 2, 255)]})
        self.publish({"forget/order": [ForgetOrder(step=ForgetOrder.GO_ON)], "forget/answer": [ForgetAnswer(node=strange, scan_id=strange) for strange in STRANGE]})

    def transforms(self):
        def transform(parent, child, x):
            made = TransformStamped(header=Header(frame_id=parent), child_frame_id=child)
            made.transform.translation.x = made.transform.rotation.w = x
            return made
        self.publish({"/tf_static": [TFMessage([transform(a, b, x)]) for a, b in (("left", "left"), ("", ""), ("a", "b"), ("b", "a"), (STRANGE[1], "left"))
                                     for x in (NONE, 0, 1)]})


def main():
    booth, attack, folder = sys.argv[1:4]
    rospy.init_node("malicious", anonymous=True, disable_signals=True)
    print(json.dumps(getattr(Attacker(booth, folder), attack)()), flush=True)


if __name__ == "__main__":
    main()
