#!/usr/bin/env python3
"""Keeps a booth running: roslaunch, with a ROS master of its own.

Usage: keep_running.py [--port 11311] WHAT ROSLAUNCH TAKES...
       keep_running.py tensegric_fit pipeline.launch respawn:=true

roslaunch starts nodes again that have died (respawn:=true), but nothing in ROS 1 brings them back to a master that was started anew.
So where the master has died or does not answer, or roslaunch has ended, all that was started is stopped and started again. What lay
on the parameter server, as the garment worn, is lost with it. Ends, with all of it, at SIGINT and SIGTERM."""
import argparse
import http.client
import os
import pathlib
import signal
import subprocess
import sys
import time
import xml.parsers.expat
import xmlrpc.client

MARK = "TENSEGRIC_FIT_KEPT_BY"  # environment of all that is started here: roslaunch puts nodes into sessions of their own
LOOK = 1  # seconds between two looks
PATIENCE = 3  # seconds that the master may take to answer
MISSES = 2  # looks in a row without an answer that mean it is dead
STOPPING = 8  # seconds that nodes may take to end by themselves
PAUSE = 5  # seconds before the next start where the last one did not live that long


class Impatient(xmlrpc.client.Transport):
    def make_connection(self, host):
        return http.client.HTTPConnection(host, timeout=PATIENCE)


def say(words):
    print(time.strftime("%F %T ") + words, flush=True)


def kept():
    """Processes that were started here, and theirs."""
    mark = f"{MARK}={os.getpid()}".encode()
    found = []
    for environment in pathlib.Path("/proc").glob("[0-9]*/environ"):
        try:
            if mark in environment.read_bytes().split(b"\0"):
                found.append(int(environment.parent.name))
        except OSError:  # ended meanwhile, or another user's
            pass
    return found


def uri(port):
    return f"http://localhost:{port}"


def answers(port):
    """Whether a ROS master does."""
    try:
        return xmlrpc.client.ServerProxy(uri(port), transport=Impatient()).getPid("/keep_running")[0] == 1
    except (OSError, http.client.HTTPException, xmlrpc.client.Error, xml.parsers.expat.ExpatError, TypeError, LookupError):  # or another program
        return False


class Booth:
    """One life of master and nodes."""

    def __init__(self, port, arguments):
        environment = dict(os.environ, ROS_MASTER_URI=uri(port), **{MARK: str(os.getpid())})
        self.began, self.misses = time.monotonic(), 0
        self.port = port
        self.core = subprocess.Popen(["roscore", "-p", str(port)], env=environment, start_new_session=True)
        try:
            self.launch = subprocess.Popen(["roslaunch", "--wait", *arguments], env=environment, start_new_session=True)
        except OSError:
            self.core.terminate()
            raise

    def fault(self):
        """Why it cannot go on; empty: it can."""
        if self.core.poll() is not None:
            return "the ROS master has ended"
        if self.launch.poll() is not None:
            return f"roslaunch has ended ({self.launch.returncode})"
        self.misses = 0 if answers(self.port) or self.starting() else self.misses + 1
        return "the ROS master does not answer" if self.misses >= MISSES else ""

    def starting(self):
        return time.monotonic() - self.began < 10 * LOOK

    def stop(self):
        """Whole, whatever signals come meanwhile."""
        if self.launch.poll() is None:
            self.launch.send_signal(signal.SIGINT)  # it ends its nodes
        try:
            self.launch.wait(STOPPING)
        except subprocess.TimeoutExpired:
            pass
        for process in kept():
            try:
                os.kill(process, signal.SIGKILL)
            except ProcessLookupError:
                pass
        self.launch.wait()
        self.core.wait()


class Ending:
    """Whether SIGINT or SIGTERM has come. No exception: it would leave half of a stop undone."""

    def __init__(self):
        self.asked = False
        for ending in (signal.SIGINT, signal.SIGTERM):  # SIGINT, too: a shell's background jobs inherit it ignored
            signal.signal(ending, self.ask)

    def ask(self, *_):
        self.asked = True

    def comes_within(self, seconds):
        end = time.monotonic() + seconds
        while not self.asked and time.monotonic() < end:
            time.sleep(0.1)
        return self.asked


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--port", type=int, default=11311)
    parser.add_argument("arguments", nargs=argparse.REMAINDER, metavar="WHAT ROSLAUNCH TAKES")
    given = parser.parse_args()
    if not given.arguments:
        parser.error("what is to be launched?")
    if answers(given.port):  # roslaunch would go to it, and take the place of what runs there
        say(f"keep_running: a ROS master runs on port {given.port} already: end it and what it launched first, or choose another --port")
        return 1
    os.umask(0o077)  # logs of the master and of roslaunch
    ending = Ending()
    while not ending.asked:
        booth = Booth(given.port, given.arguments)
        try:
            fault = ""
            while not fault and not ending.comes_within(LOOK):
                fault = booth.fault()
            if fault:
                say(f"keep_running: {fault}: all is started anew")
        finally:
            booth.stop()
        ending.comes_within(PAUSE - (time.monotonic() - booth.began))
    return 0


if __name__ == "__main__":
    sys.exit(main())
