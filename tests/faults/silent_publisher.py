#!/usr/bin/python3
"""silent_publisher.py

A publisher of scan/points that the master knows, and that does not answer the first request for a connection. The reconstruction has to ask again:
roscpp by itself does not (nodes/ros/watched_input.hpp). Exit 0 where it does, else 1.
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

PATIENCE = 60  # s: the node looks every 3 s and asks anew at the second look


class Server(socketserver.ThreadingMixIn, SimpleXMLRPCServer):
    daemon_threads = True


def main():
    requests, over = [], threading.Event()

    def request_topic(caller, topic, protocols):
        requests.append((caller, time.monotonic()))
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
    node = None
    try:
        master = xmlrpc.client.ServerProxy(environment["ROS_MASTER_URI"])

        def registered():
            try:
                return master.registerPublisher("/silent", "/scan/points", "sensor_msgs/PointCloud2", uri)[0] == 1
            except OSError:
                return False
        wait_until(registered, "the master", PATIENCE)
        node = subprocess.Popen([program("reconstruction_node")], env=environment, stderr=subprocess.DEVNULL)
        try:
            wait_until(lambda: len(requests) >= 2, "a second request for a connection", PATIENCE)
        except TimeoutError as error:
            print("failed:", error, requests)
            return 1
        print("asked again after %.1f s" % (requests[1][1] - requests[0][1]))
        return 0
    finally:
        over.set()
        for process in (node, core):
            if process is not None:
                process.terminate()
                process.wait(20)


if __name__ == "__main__":
    sys.exit(main())
