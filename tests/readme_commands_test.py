#!/usr/bin/env python3
"""The commands of README.md, taken from the page and run in their order, as somebody who knows only the page would.

Without arguments: what runs on a tree that is built, in a folder that looks like the clone; what installs, builds and tests is looked at, not run.
With --full: everything, in a fresh clone of this repository (root or sudo, network, an hour). BUILD is the build folder (default: build)."""
import argparse
import os
import pathlib
import shlex
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
LONG = ("path/to/tensegric_fit/", "cmake ")  # the gate's: .ci/run
LIVE = "roslaunch "
MADE_BY = {  # files that the page promises
    "launch/demo.sh": ["build/demo/fit/report.json", "build/demo/fit/front.png"],
    "virtual_booth": ["build/booth/scan.ply"],
    "fit --scan": ["build/results/report.json", "build/results/deformed.ply", "build/results/front.png"],
}


def commands(text):
    """Lines of code blocks, without what a number sign says of them."""
    return [line.split(" # ")[0].strip() for line in text.splitlines() if line.startswith("    ") and line.strip()]


class Shell:
    """One bash in which the commands follow each other, as in a terminal."""

    def __init__(self, folder, home):
        environment = {"PATH": os.environ["PATH"], "HOME": str(home), "LANG": "C.UTF-8", "PWD": str(folder)}
        self.process = subprocess.Popen(["bash"], cwd=folder, env=environment, stdin=subprocess.PIPE, text=True,
                                        stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def run(self, command):
        """(exit code, output)"""
        self.process.stdin.write(f"{command}\necho \"@@ends $?\"\n")
        self.process.stdin.flush()
        output = ""
        for line in self.process.stdout:
            if line.startswith("@@ends "):
                return int(line.split()[1]), output
            output += line
        return -1, output


def live(command, full):
    """A launch file does not end by itself: in full for half a minute, else what it would start."""
    if full:
        return f"timeout -s INT 30 xvfb-run -a {command}; [ $? = 124 ]"
    words = shlex.split(command)
    return f"{words[0]} --nodes {' '.join(words[1:])} | grep -c /"


def check_tests(build):
    """ctest's own line of the page finds the tests, whatever was built before."""
    listed = subprocess.run(["ctest", "--test-dir", str(build), "-N"], capture_output=True, text=True, check=True)
    return int(listed.stdout.rsplit("Total Tests: ", 1)[1].split()[0])


def run(page, folder, home, full):
    faults, ran = [], 0
    shell = Shell(folder, home)
    for command in commands(page):
        if command.startswith(LONG) and not full:
            script = command.split()[0].replace("path/to/tensegric_fit/", "")
            if "/" in script and not os.access(ROOT / script, os.X_OK):
                faults.append(f"{command}: there is no program {script}")
            continue
        asked = command.replace("path/to/tensegric_fit", str(folder))
        code, output = shell.run(live(asked, full) if command.startswith(LIVE) else asked)
        ran += 1
        print(f"{'ok' if code == 0 else 'FAILS'}  {command}", flush=True)
        if code != 0:
            faults.append(f"{command}: ended with {code}\n{output[-2000:]}")
        for part, files in MADE_BY.items():
            if part in command:
                faults += [f"{command}: made no {file}" for file in files if not (folder / file).is_file()]
    code, output = shell.run("rosrun tensegric_fit fit --help")  # the page on programs: after the page's `source`
    if code != 0 or "--scan" not in output:
        faults.append(f"rosrun tensegric_fit fit: ended with {code}\n{output[-500:]}")
    return faults, ran


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", nargs="?", default=ROOT / "build", type=pathlib.Path)
    parser.add_argument("--full", action="store_true")
    arguments = parser.parse_args()
    page = (ROOT / "README.md").read_text()
    with tempfile.TemporaryDirectory(prefix="readme_commands.") as place:
        home, clone = pathlib.Path(place, "home"), pathlib.Path(place, "tensegric_fit")
        home.mkdir()
        if arguments.full:
            subprocess.run(["git", "clone", "--quiet", str(ROOT), str(clone)], check=True)
        else:
            (clone / "build").mkdir(parents=True)
            (clone / "build" / "devel").symlink_to((arguments.build / "devel").resolve())
        faults, ran = run(page, clone, home, arguments.full)
        tests = check_tests(clone / "build" if arguments.full else arguments.build)
        if arguments.full:
            shutil.rmtree(clone)
    if ran < 4:
        faults.append(f"only {ran} commands of README.md were run: is the page read rightly?")
    if tests < 100:
        faults.append(f"ctest finds {tests} tests")
    print("\n".join(faults), file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
