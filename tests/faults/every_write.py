#!/usr/bin/env python3
"""Ends `fit` at every system call by which it writes its results: by SIGKILL there, and by a full disk (ENOSPC) there. What stands in the
folder then under a result's name is whole, a report stands only where all else does, and `fit` started again makes everything. Resumable;
left out with a word where strace is not installed or may not trace.

Usage: every_write.py FOLDER_OF_THE_PROGRAMS --work DIR [--every N] [--anew]   N: every N-th of them only"""
import argparse
import json
import pathlib
import re
import shutil
import subprocess
import sys

LEFT_OUT = 77  # ctest's SKIP_RETURN_CODE
CALLS = ("openat", "write", "writev", "pwrite64", "fsync", "rename", "mkdir")
FULL_DISK = 1  # exit code: cannot be written
LINE = re.compile(r"^(\d+)\s+(\w+)\((.*)$")


class Fit:
    def __init__(self, programs, work):
        self.work, self.mesh, self.out = work, work / "coarse.ply", work / "out"
        self.command = [programs / "fit", "--mesh", self.mesh, "--garment", "B1", "--export", "obj,glb,stl", "--quiet", "--out", self.out]
        if not self.mesh.exists():  # few triangles: the calls are the same, and each takes two fits
            for made in ([programs / "virtual_booth", "--seed", "5", "--points", "1000", "--out", work / "woman"],
                         [programs / "repose", work / "woman/body.ply", "--triangles", "8000", "--out", self.mesh]):
                subprocess.run(made, check=True, stdout=subprocess.DEVNULL)

    def run(self, *before):
        return subprocess.run([*before, *self.command], capture_output=True, text=True, check=False, timeout=300)

    def traced(self):
        """Calls of the main thread that concern the folder: name and place among its calls of that name."""
        trace = self.work / "trace.txt"
        done = self.run("strace", "-f", "-y", "-s", "0", "-e", "trace=" + ",".join(CALLS), "-o", trace)
        if done.returncode != 0:
            print("strace may not trace here:", done.stderr)
            return None
        counts, found, main = {}, [], None
        for line in trace.read_text(encoding="utf-8", errors="replace").splitlines():
            match = LINE.match(line)
            if not match:
                continue
            main = main or match[1]
            if match[1] != main:
                continue
            counts[match[2]] = counts.get(match[2], 0) + 1
            if str(self.out) in match[3]:
                found.append((match[2], counts[match[2]]))
        return found

    def results(self):
        return {file.name: content(file) for file in self.out.iterdir()} if self.out.exists() else {}


def content(file):
    if file.name != "report.json":
        return file.read_bytes()
    report = json.loads(file.read_text(encoding="utf-8"))
    report.pop("stages", None)
    report.get("solver", {}).pop("ms", None)
    return report


def faults_of(fit, whole, name, place, how):
    """What is wrong after one end at that call."""
    shutil.rmtree(fit.out, ignore_errors=True)
    done = fit.run("strace", "-f", "-o", "/dev/null", "-e", f"trace={name}", "-e", f"inject={name}:{how}:when={place}")
    faults, left = [], fit.results()
    if how.startswith("error"):
        if done.returncode != FULL_DISK or not done.stderr:
            faults.append(f"exit code {done.returncode}, words '{done.stderr}'")
        faults += [f"{file} is left" for file in left if file.endswith(".part")]
    faults += [f"{file} is half" for file, bytes_there in left.items() if not file.endswith(".part") and bytes_there != whole[file]]
    if "report.json" in left and set(whole) - set(left):
        faults.append("a report without " + ", ".join(sorted(set(whole) - set(left))))
    again = fit.run()
    if again.returncode != 0 or fit.results() != whole:
        faults.append(f"started again: exit code {again.returncode}, {sorted(set(fit.results()) ^ set(whole))} {again.stderr}")
    return faults


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("--work", type=pathlib.Path, required=True)
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--anew", action="store_true", help="forgets what was done")
    arguments = parser.parse_args()
    if shutil.which("strace") is None:
        print("strace is not installed: nothing was ended at its writes")
        return LEFT_OUT
    arguments.work.mkdir(parents=True, exist_ok=True)
    fit = Fit(arguments.programs, arguments.work.resolve())
    shutil.rmtree(fit.out, ignore_errors=True)
    calls = fit.traced()
    if calls is None:
        return LEFT_OUT
    whole = fit.results()
    if len(calls) < 3 * len(whole):  # each file is opened, written and renamed
        print(f"{len(calls)} calls for {len(whole)} files: they were not seen")
        return 1
    log = arguments.work / "results.jsonl"
    if arguments.anew:
        log.unlink(missing_ok=True)
    known = {line["call"]: line for line in map(json.loads, log.read_text(encoding="utf-8").splitlines())} if log.exists() else {}
    wrong = 0
    for name, place in calls[::arguments.every]:
        for how in ("signal=KILL", "error=ENOSPC"):
            call = f"{name} {place} {how}"
            if call not in known:
                known[call] = {"call": call, "faults": faults_of(fit, whole, name, place, how)}
                with open(log, "a", encoding="utf-8") as file:
                    file.write(json.dumps(known[call]) + "\n")
            if known[call]["faults"]:
                wrong += 1
                print(call, known[call]["faults"], flush=True)
    print(f"{len(known)} ends at {len(calls)} calls that write {len(whole)} files: {wrong} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
