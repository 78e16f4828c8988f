#!/usr/bin/python3
"""silent_publisher.py

Publishers that the master knows and that do not answer the first request for a connection. Every stage has to ask again: roscpp by itself does not
(nodes/ros/watched_inputs.hpp). Exit 0 where all do, else 1.
"""
import os
import pathlib
import socketserver
import subprocess
import sys
import threading
import time
import xmlrpc.client
from xmlrpc.server import SimpleXMLRPCRequestHandler, SimpleXMLRPCServer

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from launched import free_port, program, wait_until  # noqa: E402

INPUT = {"reconstruction": "/scan/points", "landmarks": "/body/mesh", "control_mesh": "/body/mesh", "tensegric": "/body/mesh", "tffd": "/body/mesh",
         "correlation": "/body/mesh"}
TYPE = {"/scan/points": "sensor_msgs/PointCloud2", "/body/mesh": "tensegric_fit/TriangleMesh"}
PATIENCE = 60  # s: the node looks every 3 s and asks anew at the second look


class Server(socketserver.ThreadingMixIn, SimpleXMLRPCServer):
    daemon_threads = True


def main():
    requests, over = {node: [] for node in INPUT}, threading.Event()

    def request_topic(caller, topic, protocols):
        if INPUT.get(caller[1:]) == topic:
            requests[caller[1:]].append(time.monotonic())
        over.wait()  # no answer, ever
        return [0, "over", 0]
    port = free_port()
    uri = "http://127.0.0.1:%d/" % port
    server = Server(("127.0.0.1", port), SimpleXMLRPCRequestHandler, logRequests=False, allow_none=True)
    server.register_function(request_topic, "requestTopic")
    threading.Thread(target=server.serve_forever, daemon=True).start()

    environment = dict(os.environ, ROS_MASTER_URI="http://127.0.0.1:%d" % free_port(), ROS_IP="127.0.0.1")
    environment.pop("ROS_HOSTNAME", None)
    core = subprocess.Popen(["rosmaster", "--core", "-p", environment["ROS_MASTER_URI"].rsplit(":", 1)[1]], env=environment, stdout=subprocess.DEVNULL)
    nodes = []
    try:
        master = xmlrpc.client.ServerProxy(environment["ROS_MASTER_URI"])

        def registered():
            try:
                return all(master.registerPublisher("/silent", topic, kind, uri)[0] == 1 for topic, kind in TYPE.items())
            except OSError:
                return False
        wait_until(registered, "the master", PATIENCE)
        elsewhere = {"reconstruction": ["body/mesh:=other/mesh"]}  # its own would be one that answers
        nodes = [subprocess.Popen([program(node + "_node"), *elsewhere.get(node, [])], env=environment, stderr=subprocess.DEVNULL) for node in INPUT]
        try:
            wait_until(lambda: all(len(times) >= 2 for times in requests.values()), "second requests for connections", PATIENCE)
        except TimeoutError as error:
            print("failed:", error, requests)
            return 1
        for node, times in requests.items():
            print("%s asked again after %.1f s" % (node, times[1] - times[0]))
        return 0
    finally:
        over.set()
        for process in (*nodes, core):
            process.terminate()
        for process in (*nodes, core):
            process.wait(20)


if __name__ == "__main__":
    sys.exit(main())
