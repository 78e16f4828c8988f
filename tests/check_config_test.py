#!/usr/bin/env python3
"""A file of parameters with a name that no node has ends roslaunch before anything starts, with that name; the package's own files load.

Usage: env.sh check_config_test.py"""
import pathlib
import subprocess
import tempfile
import unittest

LAUNCH = pathlib.Path(__file__).resolve().parents[1] / "launch"


def loaded(text, launch_file="pipeline.launch", argument="config", given=()):
    """Whether roslaunch would start with such a file, and these further arguments, and what it says."""
    with tempfile.TemporaryDirectory(prefix="check config ") as folder:  # with a blank
        path = pathlib.Path(folder) / "own.yaml"
        path.write_text(text, encoding="utf-8")
        extra = ["simulate:=true"] if launch_file == "booth.launch" else []
        done = subprocess.run(["roslaunch", "--dump-params", "tensegric_fit", launch_file, f"{argument}:={path}", *extra, *given], capture_output=True, text=True,
                              timeout=60, check=False)
        return "Unable to load file" not in done.stdout + done.stderr, done.stdout + done.stderr  # the exit code is 0 in any case


class CheckConfig(unittest.TestCase):
    def test_own_files_load(self):
        for path in sorted((LAUNCH / "config").glob("*.yaml")):
            with self.subTest(path.name):
                done = subprocess.run([LAUNCH / "check_config.py", path], capture_output=True, text=True, timeout=60, check=False)
                self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_sound_files(self):
        merged = "reconstruction: &same {body_triangles: 6000}\ntffd: {<<: *same}\n"
        for text in ("reconstruction: {body_triangles: 6000}\n", "reconstruction/body_triangles: 6000\n", "/reconstruction: {body_triangles: 6000}\n", merged):
            with self.subTest(text):
                fine, words = loaded(text)
                self.assertTrue(fine, words)
                self.assertIn("/reconstruction/body_triangles: 6000", words)

    def test_files_without_parameters(self):
        for text in ("", "# nothing\n", "---\n", "null\n"):
            with self.subTest(text):
                fine, words = loaded(text)
                self.assertTrue(fine, words)

    def test_unknown_node(self):
        for launch_file, argument in (("pipeline.launch", "config"), ("booth.launch", "sensors")):
            with self.subTest(launch_file):
                fine, words = loaded("reconstruciton: {body_triangles: 6000}\n", launch_file, argument)
                self.assertFalse(fine)
                self.assertIn("'reconstruciton', which is none of the nodes: ", words)
                self.assertIn("reconstruction", words.partition("none of the nodes: ")[2])

    def test_a_section_twice(self):
        for text in ("tffd: {beta: 1.3}\ntensegric: {layers: 2}\ntffd: {beta: 1.7}\n", "tffd:\n  beta: 1.3\n  beta: 1.7\n"):
            with self.subTest(text):
                fine, words = loaded(text)
                self.assertFalse(fine)
                self.assertIn("twice", words)

    def test_no_parameters_by_node(self):
        for text in ("- 3\n", "a: [", "just words\n", "3\n"):
            with self.subTest(text):
                fine, words = loaded(text)
                self.assertFalse(fine)
                self.assertIn("own.yaml", words)
                self.assertNotIn("Traceback", words)

    def test_file_says_what_no_argument_does(self):
        file = """{vault: {folders: [/srv/exports], retention_days: 30}, control_mesh: {template_directory: /srv/templates},
                   tensegric: {garment: H1, garment_directory: /srv/garments}}"""
        _, words = loaded(file)
        for line in ("/vault/folders:\n- /srv/exports", "/vault/retention_days: 30", "/control_mesh/template_directory: /srv/templates", "/tensegric/garment: H1",
                     "/tensegric/garment_directory: /srv/garments"):
            self.assertIn(line + "\n", words)
        _, words = loaded(file, given=("garment:=B2", "exports:=/mnt/exports", "retention_days:=0"))
        for line in ("/vault/folders:\n- /mnt/exports", "/vault/retention_days: 0", "/tensegric/garment: B2"):
            self.assertIn(line + "\n", words)
        _, words = loaded("tffd: {setting: standard}\n")
        self.assertIn("tensegric_fit_exports\n", words)
        self.assertNotIn("/tensegric/garment", words)  # the node has a default

    def test_file_of_sensors_says_what_no_argument_does(self):
        file = "{assembler: {frame_id: hall}, simulated_booth: {frame_id: hall, customers: 5, family: implicit}, capture: {trigger: snap}}"
        _, words = loaded(file, "booth.launch", "sensors")
        for line in ("/assembler/frame_id: hall", "/simulated_booth/frame_id: hall", "/simulated_booth/customers: 5", "/simulated_booth/family: implicit",
                     "/capture/trigger: snap"):
            self.assertIn(line + "\n", words)
        _, words = loaded(file, "booth.launch", "sensors", ("frame_id:=shop", "customers:=0", "trigger:=scan"))
        for line in ("/assembler/frame_id: shop", "/simulated_booth/frame_id: shop", "/simulated_booth/customers: 0", "/capture/trigger: scan"):
            self.assertIn(line + "\n", words)


if __name__ == "__main__":
    unittest.main()
