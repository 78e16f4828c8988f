#!/usr/bin/env python3
"""Files for makers in the programs that read them: the Khronos validator, Valentina, and `fit` itself.
usage: maker_files_test.py PROGRAMS SCAN.ply FOLDER   FOLDER is for what is made on the way"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import time
import unittest

HERE = pathlib.Path(__file__).resolve().parent
PROGRAMS, SCAN, FOLDER = (pathlib.Path(argument) for argument in sys.argv[1:4])
OUT = FOLDER / "fit"


def run(*command, **options):
    return subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False, **options)


def girths(folder):
    return json.loads((folder / "report.json").read_text(encoding="utf-8"))["girths"]


class MakerFiles(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(FOLDER, ignore_errors=True)
        FOLDER.mkdir(parents=True)
        done = run(PROGRAMS / "fit", "--scan", SCAN, "--garment", "B1+H2", "--ratio", "0.95", "--export", "obj,glb,stl",
                   "--quiet", "--out", OUT)
        if done.returncode != 0:
            raise RuntimeError(done.stderr)

    def test_the_khronos_validator_finds_nothing(self):
        place = FOLDER / "npm"
        place.mkdir()
        for name in ("package.json", "package-lock.json", "validate.mjs"):
            shutil.copy(HERE / name, place)
        if shutil.which("npm") is None:
            self.skipTest("npm is not installed: fit.glb was not validated")
        try:
            installed = run("npm", "ci", "--no-audit", "--no-fund", "--ignore-scripts", cwd=place, timeout=100)
        except subprocess.TimeoutExpired:
            self.skipTest("npm did not install gltf-validator in 100 s: fit.glb was not validated")
        if installed.returncode != 0:
            self.skipTest("npm cannot install gltf-validator: fit.glb was not validated\n" + installed.stderr[-400:])
        found = run("node", "validate.mjs", OUT / "fit.glb", cwd=place)
        self.assertEqual(found.returncode, 0, found.stderr)
        issues = json.loads(found.stdout)
        self.assertEqual([issues[kind] for kind in ("numErrors", "numWarnings", "numInfos", "numHints")], [0] * 4, issues)
        # It does find something where there is something.
        broken = bytearray((OUT / "fit.glb").read_bytes())
        at = broken.index(b'"componentType":5126')
        broken[at:at + 20] = b'"componentType":5123'
        (FOLDER / "broken.glb").write_bytes(broken)
        issues = json.loads(run("node", "validate.mjs", FOLDER / "broken.glb", cwd=place).stdout)
        self.assertGreater(issues["numErrors"], 0)

    def test_the_lock_file_names_no_host(self):
        self.assertNotIn("://", (HERE / "package-lock.json").read_text(encoding="utf-8"))

    def test_valentina_opens_the_measurements(self):
        """Its window names the file; it refuses one that it does not know. The window is kept as tape.png."""
        for name in ("valentina-tape", "Xvfb", "xdotool", "import"):
            if shutil.which(name) is None:
                self.skipTest(f"{name} is not installed: measures.vit was not opened")
        unknown = FOLDER / "unknown.vit"
        text = (OUT / "measures.vit").read_text(encoding="utf-8")
        unknown.write_text(text.replace("body-measurements", "bodies"), encoding="utf-8")
        for file, opens in ((OUT / "measures.vit", True), (OUT / "measures_worn.vit", True), (unknown, False)):
            with self.subTest(file=file.name):
                self.assertEqual(self.opened(file), opens)

    def opened(self, file):
        home = FOLDER / "home"
        home.mkdir(exist_ok=True)
        reading, writing = os.pipe()
        with subprocess.Popen(["Xvfb", "-displayfd", str(writing), "-screen", "0", "1280x900x24", "-noreset"],
                              pass_fds=[writing], stderr=subprocess.DEVNULL) as server:
            display = ":" + os.read(reading, 16).decode().strip()
            environment = dict(os.environ, DISPLAY=display, HOME=str(home), XDG_RUNTIME_DIR=str(home))
            with subprocess.Popen(["valentina-tape", str(file)], env=environment, stdout=subprocess.DEVNULL,
                                  stderr=subprocess.DEVNULL) as tape:
                try:
                    return self.shows(file, tape, environment)
                finally:
                    tape.kill()
                    server.terminate()
                    os.close(reading)
                    os.close(writing)

    def shows(self, file, tape, environment):
        """Whether a window with the file's name comes and no other does but the question for the language."""
        end = time.monotonic() + 40
        while time.monotonic() < end and tape.poll() is None:
            titles = [run("xdotool", "getwindowname", window, env=environment).stdout.strip()
                      for window in run("xdotool", "search", "--onlyvisible", "--name", ".", env=environment).stdout.split()]
            for window in run("xdotool", "search", "--name", "Select language", env=environment).stdout.split():
                run("xdotool", "key", "--window", window, "Return", env=environment)
            if "error" in " ".join(titles).lower():
                return False
            if titles == [f"{file.name} \u2014 Tape"]:
                time.sleep(1)  # it draws
                run("import", "-window", "root", FOLDER / f"{file.stem}.png", env=environment)
                return True
            time.sleep(0.5)
        return False

    def test_fit_reads_its_own_glb_as_the_body_alone(self):
        """The lines' tubes are no surface."""
        for file in ("body.ply", "fit.glb"):
            done = run(PROGRAMS / "fit", "--mesh", OUT / file, "--quiet", "--out", FOLDER / file)
            self.assertEqual(done.returncode, 0, done.stderr)
        ply, glb = girths(FOLDER / "body.ply"), girths(FOLDER / "fit.glb")
        self.assertEqual(ply.keys(), glb.keys())
        for name, girth in ply.items():
            self.assertAlmostEqual(girth, glb[name], delta=1e-4, msg=name)

    def test_more_triangles_than_makers_take_are_said(self):
        done = run(PROGRAMS / "fit", "--mesh", SCAN.parent / "body.ply", "--export", "obj", "--quiet", "--out", FOLDER / "many")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("triangles; CLO takes 70000 at most", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
