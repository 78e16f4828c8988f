"""The customers of one booth, as they come at random; a process beside the booth's nodes.

Usage: customers.py BOOTH --seed S --rate R --seconds T --begin TIME BODY.ply...

R customers per second on average, at random moments (a Poisson process), for T seconds from TIME on (time.time()). A customer who comes
while another is in the booth waits. A line of JSON per customer: body, seconds of coming, of her scan and of its result, and the
digest of the result; at the end a line with results that belong to no scan that was waited for."""
import argparse
import hashlib
import json
import pathlib
import random
import struct
import sys
import threading
import time

import rospy
from sensor_msgs import point_cloud2
from sensor_msgs.msg import PointCloud2
from std_msgs.msg import Header
from tensegric_fit.msg import DeformedMesh

sys.dont_write_bytecode = True  # not into the sources
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from launched import points_of, wait_until

PATIENCE = 120  # seconds after which a scan is lost


class Booth:
    def __init__(self, name, bodies):
        rospy.init_node(f"customers_of_{name}", disable_signals=True)
        self.clouds = [point_cloud2.create_cloud_xyz32(Header(frame_id=name), points_of(ply)) for ply in bodies]
        self.done, self.stamp, self.result, self.strays = threading.Event(), None, None, 0
        self.scans = rospy.Publisher(f"/{name}/scan/points", PointCloud2, queue_size=1)
        rospy.Subscriber(f"/{name}/body/deformed", DeformedMesh, self.take)
        wait_until(lambda: self.scans.get_num_connections() > 0, "a subscriber of scans", 60)
        time.sleep(1)  # what is latched comes now
        self.strays = 0

    def take(self, message):
        if message.status == "solving":
            return
        if message.header.stamp != self.stamp or self.done.is_set():
            self.strays += 1
            return
        digest = hashlib.sha256(struct.pack(f"<{len(message.vertices)}f", *message.vertices)).hexdigest()[:16]
        self.result = {"done": time.time(), "status": message.status, "digest": digest}
        self.done.set()

    def scan(self, body):
        """Seconds of time.time() when it was sent, and the result; none: lost."""
        cloud = self.clouds[body]
        self.result = None
        self.done.clear()
        self.stamp = cloud.header.stamp = rospy.Time.now()
        sent = time.time()
        self.scans.publish(cloud)
        self.done.wait(PATIENCE)
        return sent, self.result


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("booth")
    parser.add_argument("bodies", nargs="+")
    parser.add_argument("--seed", required=True)
    for name in ("rate", "seconds", "begin"):
        parser.add_argument(f"--{name}", type=float, required=True)
    asked = parser.parse_args()
    booth, dice = Booth(asked.booth, asked.bodies), random.Random(f"{asked.booth} {asked.seed}")
    coming = asked.begin + dice.expovariate(asked.rate)
    while coming < asked.begin + asked.seconds:
        time.sleep(max(0, coming - time.time()))
        body = dice.randrange(len(asked.bodies))
        sent, result = booth.scan(body)
        row = {"booth": asked.booth, "body": body, "came": coming - asked.begin, "sent": sent - asked.begin,
               "bytes": len(booth.clouds[body].data)}
        if result:
            row.update(result, done=result["done"] - asked.begin)
        print(json.dumps(row), flush=True)
        coming += dice.expovariate(asked.rate)
    time.sleep(1)  # what nobody waits for
    print(json.dumps({"booth": asked.booth, "strays": booth.strays}), flush=True)


if __name__ == "__main__":
    main()
