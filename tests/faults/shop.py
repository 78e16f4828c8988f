"""What two booths do, as seen from outside: scans go in, results and what nodes say of themselves come out.

A process of its own, as its ROS node must not outlive a master: commands come on standard input and are answered on standard output, a
line of JSON each.

    scan BOOTH BODY   publishes that body; answers with its stamp
    results           deformed bodies so far: booth, stamp, status, digest of the vertices, seconds of time.monotonic()
    reports           newest report of each node: state, scan_id, last_error, last_error_scan_id, seconds
    export BOOTH DIR  calls export_fit
    deaf BOOTH TOPIC  subscribes, and never reads
    reset BOOTH       puts the first garment on again
    clear             forgets the results so far
    clock SECONDS     the clock goes on from there (use_sim_time)
"""
import hashlib
import json
import pathlib
import socket
import struct
import sys
import threading
import time
import xmlrpc.client

import rosgraph
import rospy
from diagnostic_msgs.msg import DiagnosticArray
from rosgraph_msgs.msg import Clock
from sensor_msgs import point_cloud2
from sensor_msgs.msg import PointCloud2
from std_msgs.msg import Header
from std_srvs.srv import Trigger
from tensegric_fit.msg import DeformedMesh
from tensegric_fit.srv import ExportFit

sys.dont_write_bytecode = True  # not into the sources
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from launched import points_of

BOOTHS = ("left", "right")


class Shop:
    def __init__(self, bodies):
        rospy.init_node("shop", disable_signals=True)
        self.clouds = [points_of(ply) for ply in bodies]
        self.found, self.said, self.held = [], {}, []
        self.scans = {booth: rospy.Publisher(f"/{booth}/scan/points", PointCloud2, queue_size=1, latch=True) for booth in BOOTHS}
        for booth in BOOTHS:
            rospy.Subscriber(f"/{booth}/body/deformed", DeformedMesh, self.keep, booth)
        rospy.Subscriber("/diagnostics", DiagnosticArray, self.hear)
        self.time, self.clock_set = 0.0, False

    def keep(self, message, booth):
        if message.status == "solving":
            return
        digest = hashlib.sha256(struct.pack(f"<{len(message.vertices)}f", *message.vertices)).hexdigest()[:16]
        self.found.append({"booth": booth, "stamp": message.header.stamp.to_nsec(), "status": message.status, "digest": digest,
                           "at": time.monotonic()})

    def hear(self, array):
        for status in array.status:
            facts = {pair.key: pair.value for pair in status.values}
            self.said[status.name.split(":")[0]] = dict(
                {key: facts.get(key, "") for key in ("state", "scan_id", "last_error", "last_error_scan_id", "peak_mebibytes")},
                message=status.message, at=time.monotonic())

    def scan(self, booth, body):
        stamp = rospy.Time.now()
        self.scans[booth].publish(point_cloud2.create_cloud_xyz32(Header(stamp=stamp, frame_id=booth), self.clouds[int(body)]))
        return stamp.to_nsec()

    def results(self):
        return self.found

    def reports(self):
        return self.said

    @staticmethod
    def export(booth, folder):
        answer = rospy.ServiceProxy(f"/{booth}/export_fit", ExportFit)(directory=folder)
        return {"exported": answer.exported, "code": answer.code, "files": list(answer.files)}

    @staticmethod
    def reset(booth):
        return rospy.ServiceProxy(f"/{booth}/reset", Trigger)().message

    def clear(self):
        self.found.clear()
        return "cleared"

    def deaf(self, booth, topic):
        """The handshake of TCPROS, and no more."""
        name = f"/{booth}/{topic}"
        master = xmlrpc.client.ServerProxy(rosgraph.get_master_uri())
        publishers = dict(master.getSystemState("/shop")[2][0])[name]
        for node in publishers:
            uri = master.lookupNode("/shop", node)[2]
            _, _, (_, host, port) = xmlrpc.client.ServerProxy(uri).requestTopic("/deaf", name, [["TCPROS"]])
            connection = socket.socket()
            connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            connection.connect((host, port))
            fields = ["callerid=/deaf", f"topic={name}", "md5sum=*", "type=*"]
            header = b"".join(struct.pack("<I", len(field)) + field.encode() for field in fields)
            connection.sendall(struct.pack("<I", len(header)) + header)
            self.held.append(connection)
        return publishers

    def clock(self, seconds):
        self.time = float(seconds)
        if not self.clock_set:
            self.clock_set = True
            publisher = rospy.Publisher("/clock", Clock, queue_size=1)

            def tick():
                while not rospy.is_shutdown():
                    self.time += 0.05
                    publisher.publish(Clock(rospy.Time.from_sec(self.time)))
                    time.sleep(0.05)

            threading.Thread(target=tick, daemon=True).start()
        return self.time


def main():
    shop = Shop(sys.argv[1:])
    print(json.dumps("ready"), flush=True)
    for line in sys.stdin:
        command, *arguments = line.split()
        try:
            answer = getattr(shop, command)(*arguments)
        except Exception as error:  # the campaign decides what it means
            answer = {"failed": repr(error)}
        print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    main()
