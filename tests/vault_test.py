#!/usr/bin/python3
"""The vault by itself: it says where an old export could not be deleted, and where other machines reach it.

Runs in the build's env.sh."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

sys.dont_write_bytecode = True  # not into the sources
import rospy  # noqa: E402
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus  # noqa: E402
from launched import free_port, program, wait_until  # noqa: E402

DAY = 86400


class Vault(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        port = free_port()
        os.environ.update(ROS_MASTER_URI=f"http://127.0.0.1:{port}", ROS_HOSTNAME="localhost")
        master = subprocess.Popen(["rosmaster", "--core", "-p", str(port)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        cls.addClassCleanup(master.wait)
        cls.addClassCleanup(master.terminate)
        wait_until(lambda: subprocess.run(["rosnode", "list"], capture_output=True, check=False).returncode == 0, "the master", 30)
        rospy.init_node("vault_test", disable_signals=True)
        cls.heard = []
        cls.diagnostics = rospy.Subscriber("/diagnostics", DiagnosticArray, lambda message: cls.heard.extend(message.status))

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.heard.clear()

    def tearDown(self):
        self.folder.cleanup()

    def export(self, name, files):
        folder = pathlib.Path(self.folder.name) / name
        folder.mkdir()
        (folder / "fit.json").write_text(json.dumps({"format": "tensegric_fit/fit", "scan": {"scan_id": "1.5-00000001"}}))
        for file in files:
            (folder / file).write_text("of somebody else")
        os.utime(folder / "fit.json", (time.time() - 40 * DAY,) * 2)
        return folder

    def status_and_words(self, environment):
        """The vault's first report and what it wrote."""
        rospy.set_param("/vault", {"folders": [self.folder.name], "retention_days": 30})
        vault = subprocess.Popen([program("vault_node")], env={**os.environ, **environment}, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        try:
            wait_until(lambda: any(status.name == "vault: retention" for status in self.heard), "a report", 30)
        finally:
            vault.terminate()
            words, _ = vault.communicate()
            wait_until(lambda: self.diagnostics.get_num_connections() == 0, "the end of its reports", 30)
        return next(status for status in self.heard if status.name == "vault: retention"), words

    def test_an_old_export_that_stays_is_named(self):
        gone, kept = self.export("gone", []), self.export("kept", ["notes.txt"])
        status, words = self.status_and_words({})
        self.assertFalse(gone.exists())
        self.assertTrue(kept.exists())
        self.assertEqual((status.level, status.message), (DiagnosticStatus.WARN, "old exports may be left in " + self.folder.name))
        self.assertIn("an old export may be left", words)
        self.assertNotIn("other machines", words)

    def test_all_is_well_where_nothing_stays(self):
        self.export("gone", [])
        status, _ = self.status_and_words({})
        self.assertEqual((status.level, status.message), (DiagnosticStatus.OK, "exports are kept for 30 days"))

    def test_it_says_that_other_machines_reach_it(self):
        _, words = self.status_and_words({"ROS_HOSTNAME": "127.0.0.1"})  # a name that another machine could have
        self.assertIn("nodes are reached from other machines", words)


if __name__ == "__main__":
    unittest.main()
