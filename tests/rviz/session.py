"""Real rviz on displays of its own, with a running chain, driven by keyboard."""
import contextlib
import os
import shutil
import signal
import socket
import subprocess
import time

import numpy as np
from matplotlib import image

PATIENCE = 120  # seconds, for a scan on a busy machine
STILL = 60  # seconds at most until the screen stands still
FRAMES = "Frame Rate: 30\n"  # of launch/rviz/*.rviz
BACKGROUND = (238, 240, 243)  # of launch/rviz/inspect.rviz
VIEW, PANEL = "840x709+0+62", "430x541+850+230"  # of the screen; the panel without the garment's name, where a cursor blinks
HERE = os.path.dirname(os.path.abspath(__file__))
LAUNCH = os.path.join(HERE, "..", "..", "launch")


class NotHere(Exception):
    """Something that it takes is not installed, or no display can be made."""


def free_port():
    with socket.socket() as listener:
        listener.bind(("localhost", 0))
        return listener.getsockname()[1]


def wait_for(what, condition, seconds=PATIENCE):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if condition():
            return
        time.sleep(0.05)
    raise AssertionError("in %d s there was no %s" % (seconds, what))


def pixels_of(path):
    return np.rint(255 * image.imread(path)[:, :, :3]).astype(int)


def run_test(session, drive):
    """Exit code for ctest, after a word: 0; 1 with a picture of where it failed, and what the chain did until then; 77,
    skipped, where something is missing."""
    try:
        with session() as running:
            try:
                drive(running)
            except AssertionError:
                running.picture(os.path.join(running.out, "failed.png"))
                raise
    except NotHere as missing:
        print("skipped: %s" % missing)
        return 77
    except AssertionError as failure:
        print("failed: %s" % failure)
        print("\n".join(running.history()))
        return 1
    print("passed")
    return 0


class Session:
    """Context manager. `out` gets the logs."""

    def __init__(self, out):
        for tool in ("Xvfb", "xdotool", "import", "rviz", "roslaunch"):
            if shutil.which(tool) is None:
                raise NotHere("%s is not installed" % tool)
        self.out, self.started, self.message, self.said, self.state = out, [], {}, [], {}
        os.makedirs(out, exist_ok=True)
        self.port, self.has_master = free_port(), False
        os.environ.update({"ROS_MASTER_URI": "http://localhost:%d" % self.port, "ROS_HOSTNAME": "localhost",
                           "LIBGL_ALWAYS_SOFTWARE": "1", "HOME": out, "ROS_HOME": os.path.join(out, "ros_home"),
                           "XDG_RUNTIME_DIR": out})

    def __enter__(self):
        os.environ["DISPLAY"] = self.new_display()
        return self

    def __exit__(self, *_):
        for process in reversed(self.started):
            self.end(process)

    def history(self):
        """Lines: what came, what each node said last of itself, and the chain's log; whole once the chain has ended."""
        log = os.path.join(self.out, "chain.log")
        return (["topics that came: " + (", ".join(sorted(self.message)) or "none")]
                + ["%s: %s" % node for node in sorted(self.state.items())]
                + (open(log, errors="replace").read().splitlines()[-60:] if os.path.exists(log) else ["no chain was started"]))

    def new_display(self):
        # noreset: a display that resets when its last client leaves refuses whoever connects meanwhile, such as rviz
        # between two looks for its window.
        read, write = os.pipe()
        self.start("xvfb", "Xvfb", "-displayfd", str(write), "-noreset", "-screen", "0", "1280x800x24", pass_fds=[write])
        os.close(write)
        with os.fdopen(read) as answer:
            number = answer.readline().strip()
        if not number:
            raise NotHere("no display can be made: see xvfb.log")
        return ":" + number

    @staticmethod
    @contextlib.contextmanager
    def at(display):
        """Keys, windows and pictures are those of that display."""
        usual = os.environ["DISPLAY"]
        os.environ["DISPLAY"] = display
        try:
            yield
        finally:
            os.environ["DISPLAY"] = usual

    def start(self, name, *command, **options):
        with open(os.path.join(self.out, name + ".log"), "w") as log:
            self.started.append(subprocess.Popen(command, stdout=log, stderr=subprocess.STDOUT, **options))
        return self.started[-1]

    @staticmethod
    def end(process):
        process.send_signal(signal.SIGINT)
        try:
            process.wait(20)
        except subprocess.TimeoutExpired:
            process.kill()

    def start_master(self):
        """It outlives the chains. Listens to what comes out from now on."""
        self.start("master", "roscore", "-p", str(self.port))

        def master_is_up():
            with socket.socket() as probe:
                return probe.connect_ex(("localhost", self.port)) == 0

        wait_for("ROS master", master_is_up)
        import rospy
        from diagnostic_msgs.msg import DiagnosticArray
        from rosgraph_msgs.msg import Log
        from tensegric_fit.msg import DeformedMesh, FitState, Garment, Landmarks, TriangleMesh

        rospy.init_node("rviz_session", anonymous=True, disable_signals=True)
        wait_for("run_id of the master", lambda: rospy.has_param("/run_id"))  # else a chain would bring its own
        for topic, kind in (("body/mesh", TriangleMesh), ("control/deformed", FitState), ("body/deformed", DeformedMesh),
                            ("body/landmarks", Landmarks), ("garment", Garment)):
            rospy.Subscriber(topic, kind, self.keep, topic)
        rospy.Subscriber("/rosout", Log, lambda line: self.said.append(line.msg))
        rospy.Subscriber("/diagnostics", DiagnosticArray,
                         lambda array: self.state.update((status.name, status.message) for status in array.status))
        self.has_master = True

    def start_chain(self, *command):
        """`command`: what roslaunch takes."""
        if not self.has_master:
            self.start_master()
        return self.start("chain", "roslaunch", *command)

    def keep(self, message, topic):
        self.message[topic] = message

    def wears(self, garment, ratio):
        """Whether the deformed body of this garment, all its lines at this ratio, is there."""
        fit, body = self.message.get("control/deformed"), self.message.get("body/deformed")
        return (fit is not None and body is not None and fit.garment == body.garment == garment
                and fit.status == body.status == "converged" and all(abs(line.request - ratio) < 1e-6 for line in fit.lines))

    def start_rviz(self, config, name="rviz", shows_a_body=True):
        """Returns it once its window stands still, with a body in it. It draws few frames: without a graphics card each
        takes the processor from the chain."""
        with open(config) as file:
            text = file.read()
        assert FRAMES in text
        path = os.path.join(self.out, name + "_slow.rviz")
        with open(path, "w") as file:
            file.write(text.replace(FRAMES, "Frame Rate: 5\n"))
        rviz = self.start(name, "rviz", "-d", path)
        wait_for("window of rviz", lambda: self.windows() or rviz.poll() is not None)
        assert rviz.poll() is None, "rviz has ended: see %s.log" % name
        subprocess.check_call(["xdotool", "windowfocus", self.windows()[-1]])  # there is no window manager to do it
        path = os.path.join(self.out, name + ".png")

        def is_drawn():
            self.picture(path, VIEW)
            background = (np.abs(pixels_of(path) - BACKGROUND).max(axis=2) <= 1).mean()
            return 0.1 < background < (0.8 if shows_a_body else 1)  # the scale of colours is a tenth of the view

        wait_for("picture of rviz", lambda: rviz.poll() is not None or is_drawn())
        self.still_picture(path)
        self.still_picture(path, PANEL)
        assert rviz.poll() is None, "rviz has ended: see %s.log" % name
        return rviz

    def quit_rviz(self, rviz):
        """From its menu, as its user does: after an interrupt rviz still renders into its closed window, and Mesa may crash."""
        self.press("ctrl+q")
        wait_for("end of rviz", lambda: rviz.poll() is not None, 20)
        assert rviz.returncode == 0, "rviz ended with %d" % rviz.returncode

    @staticmethod
    def windows():
        found = subprocess.run(["xdotool", "search", "--onlyvisible", "--name", "RViz"], stdout=subprocess.PIPE,
                               stderr=subprocess.DEVNULL, text=True, check=False)
        return found.stdout.split()

    @staticmethod
    def press(*keys):
        for key in keys:
            subprocess.check_call(["xdotool", "key", "--clearmodifiers", key])
            time.sleep(0.1)

    @staticmethod
    def write(words):
        subprocess.check_call(["xdotool", "type", "--delay", "60", "--", words])

    def put_on(self, garment):
        """By keyboard, as someone would at the panel."""
        self.press("alt+g", "ctrl+a")
        self.write(garment)
        self.press("Return")

    @staticmethod
    def picture(path, part="1280x800+0+0"):
        subprocess.check_call(["import", "-window", "root", "-crop", part, "+repage", "png24:" + path])  # RGB, also of a grey screen

    def still_picture(self, path, part=VIEW, unlike=None):
        """Takes pictures until two in a row are the same, and another one than the file `unlike`. The last stays."""
        def content(file):
            with open(file, "rb") as opened:
                return opened.read()

        def stands_still():
            before = content(path)
            time.sleep(0.3)
            self.picture(path, part)
            return content(path) == before and (unlike is None or before != content(unlike))

        self.picture(path, part)
        wait_for("picture that stays" + (", other than " + os.path.basename(unlike) if unlike else ""), stands_still, STILL)
