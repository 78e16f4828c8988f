#!/usr/bin/python3
"""silent_publisher.py

Publishers that the master knows and that do not answer the first request for a connection. Every stage has to ask again: roscpp by itself does not
(nodes/ros/watched_inputs.hpp). The second request gets a connection on which nothing comes: every stage has to connect once more, and not a third time.
Exit 0 where all do, else 1.
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


class Mute(socketserver.StreamRequestHandler):
    """A TCPROS publisher that answers the header of a connection and sends no message."""

    def handle(self):
        header, length = {}, int.from_bytes(self.rfile.read(4), "little")
        rest = self.rfile.read(length)
        while rest:
            size = int.from_bytes(rest[:4], "little")
            key, _, value = rest[4:4 + size].partition(b"=")
            header[key.decode()], rest = value, rest[4 + size:]
        fields = [b"callerid=/silent", b"latching=1", b"md5sum=" + header["md5sum"], b"type=" + header["type"]]
        answer = b"".join(len(field).to_bytes(4, "little") + field for field in fields)
        self.wfile.write(len(answer).to_bytes(4, "little") + answer)
        node = header["callerid"].decode()[1:]
        if INPUT.get(node) == header["topic"].decode():
            self.server.connections[node].append(time.monotonic())
        self.rfile.read(1)  # until it is closed


class Connections(socketserver.ThreadingTCPServer):
    daemon_threads = True

    def __init__(self):
        super().__init__(("127.0.0.1", 0), Mute)
        self.connections = {node: [] for node in INPUT}


class Server(socketserver.ThreadingMixIn, SimpleXMLRPCServer):
    daemon_threads = True


def main():
    requests, over, mute = {node: [] for node in INPUT}, threading.Event(), Connections()
    threading.Thread(target=mute.serve_forever, daemon=True).start()

    def request_topic(caller, topic, protocols):
        if INPUT.get(caller[1:]) == topic:
            requests[caller[1:]].append(time.monotonic())
        if len(requests.get(caller[1:], [])) > 1:
            return [1, "", ["TCPROS", "127.0.0.1", mute.server_address[1]]]
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
            wait_until(lambda: all(len(times) >= 2 for times in mute.connections.values()), "second connections", PATIENCE)
        except TimeoutError as error:
            print("failed:", error, requests, mute.connections)
            return 1
        for node, times in requests.items():
            first, second = mute.connections[node][:2]
            print("%s asked again after %.1f s, connected anew after %.1f s" % (node, times[1] - times[0], second - first))
        time.sleep(9)  # three looks
        third = [node for node, times in mute.connections.items() if len(times) > 2]
        print("failed: a third connection: " + ", ".join(third) if third else "and not a third time")
        return 1 if third else 0
    finally:
        over.set()
        for process in (*nodes, core):
            process.terminate()
        for process in (*nodes, core):
            process.wait(20)


if __name__ == "__main__":
    sys.exit(main())
