#!/usr/bin/env python3
"""Ends a program at every system call by which it writes its results: by SIGKILL there, and by a full disk (ENOSPC) there. Resumable; left out
with a word where strace is not installed or may not trace.
Without --export it is `fit`: what stands in the folder then under a result's name is whole, a report stands only where all else does, and `fit`
started again makes everything. With it `write_export`, which writes what a node exports: the folder is whole or not there, and the
next export of that name leaves nothing of the one that was ended.

Usage: every_write.py FOLDER_OF_THE_PROGRAMS --work DIR [--export] [--every N] [--anew]   N: every N-th of them, the first of each
kind, and what comes after the last byte was written"""
import argparse
import json
import pathlib
import re
import shutil
import signal
import subprocess
import sys

LEFT_OUT = 77  # ctest's SKIP_RETURN_CODE
CALLS = ("openat", "write", "writev", "pwrite64", "fsync", "rename", "renameat", "mkdir", "mkdirat")
FULL_DISK = 1  # exit code: cannot be written
LINE = re.compile(r"^(\d+)\s+(\w+)\((.*)$")


class Writer:
    """A program that writes results into the folder `out`, with nothing else of it in the folder around it."""

    def __init__(self, command, place):
        self.command, self.place, self.out = command, place, place / "out"

    def run(self, *before):
        return subprocess.run([*before, *self.command, self.out], capture_output=True, text=True, check=False, timeout=300)

    def clear(self):
        shutil.rmtree(self.place, ignore_errors=True)
        self.place.mkdir(parents=True)

    def traced(self):
        """Calls of the main thread that concern the folder: name and place among its calls of that name."""
        trace = self.place.parent / "trace.txt"
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
            if str(self.place) in match[3]:
                found.append((match[2], counts[match[2]]))
        return found

    def results(self):
        return {file.name: content(file) for file in self.out.iterdir()} if self.out.exists() else {}


class Fit(Writer):
    def __init__(self, programs, work):
        mesh = work / "coarse.ply"
        super().__init__([programs / "fit", "--mesh", mesh, "--garment", "B1", "--export", "obj,glb,stl", "--quiet", "--out"], work / "fit")
        if not mesh.exists():  # few triangles: the calls are the same, and each takes two fits
            for made in ([programs / "virtual_booth", "--seed", "5", "--points", "1000", "--out", work / "woman"],
                         [programs / "repose", work / "woman/body.ply", "--triangles", "8000", "--out", mesh]):
                subprocess.run(made, check=True, stdout=subprocess.DEVNULL)

    def faults_of_left(self, left, whole, refused):
        faults = [f"{file} is half" for file, content_there in left.items() if not file.endswith(".part") and content_there != whole.get(file)]
        if "report.json" in left and set(whole) - set(left):
            faults.append("a report without " + ", ".join(sorted(set(whole) - set(left))))
        return faults + [f"{file} is left" for file in left if refused and file.endswith(".part")]

    def make_way(self):
        """`fit` goes on in the folder that is there."""


class Export(Writer):
    def __init__(self, programs, work):
        super().__init__([programs / "write_export"], work / "exports")

    def faults_of_left(self, left, whole, refused):
        faults = ["the folder is half"] if self.out.exists() and left != whole else []
        return faults + [f"{entry.name} is left" for entry in self.place.iterdir() if refused]

    def make_way(self):
        shutil.rmtree(self.out, ignore_errors=True)  # a whole one, which is never overwritten


def content(file):
    if file.name != "report.json":
        return file.read_bytes()
    try:
        report = json.loads(file.read_text(encoding="utf-8"))
    except ValueError:
        return None  # half
    report.pop("stages", None)
    report.get("solver", {}).pop("ms", None)
    return report


def faults_of(writer, whole, name, place, how):
    """What is wrong after one end at that call."""
    writer.clear()
    done = writer.run("strace", "-f", "-o", "/dev/null", "-e", f"trace={name}", "-e", f"inject={name}:{how}:when={place}")
    refused = how.startswith("error")
    faults = writer.faults_of_left(writer.results(), whole, refused)
    if refused and (done.returncode != FULL_DISK or not done.stderr):
        faults.append(f"exit code {done.returncode}, words '{done.stderr}'")
    if not refused and done.returncode != -signal.SIGKILL:  # strace ends as what it traces
        faults.append(f"it was not ended there: exit code {done.returncode}")
    writer.make_way()
    again = writer.run()
    if again.returncode != 0 or writer.results() != whole:
        faults.append(f"started again: exit code {again.returncode}, {sorted(set(writer.results()) ^ set(whole))} {again.stderr}")
    faults += [f"{entry.name} is left beside it" for entry in writer.place.iterdir() if entry != writer.out]
    return faults


def chosen(calls, every):
    """Every N-th call, the first of each kind, and those after the last byte, by which a folder takes its name."""
    last = max(i for i, (name, _) in enumerate(calls) if name.startswith(("write", "pwrite")))
    first = {name: i for i, (name, _) in reversed(list(enumerate(calls)))}
    return [call for i, call in enumerate(calls) if i % every == 0 or i > last or i == first[call[0]]]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("--work", type=pathlib.Path, required=True)
    parser.add_argument("--export", action="store_true", help="of a node's export")
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--anew", action="store_true", help="forgets what was done")
    arguments = parser.parse_args()
    if shutil.which("strace") is None:
        print("strace is not installed: nothing was ended at its writes")
        return LEFT_OUT
    arguments.work.mkdir(parents=True, exist_ok=True)
    work = arguments.work.resolve()
    writer = Export(arguments.programs.resolve(), work) if arguments.export else Fit(arguments.programs.resolve(), work)
    writer.clear()
    calls = writer.traced()
    if calls is None:
        return LEFT_OUT
    whole = writer.results()
    if len(calls) < 3 * len(whole):  # each file is opened, written and taken to the disk
        print(f"{len(calls)} calls for {len(whole)} files: they were not seen")
        return 1
    log = work / f"{writer.place.name}.jsonl"
    if arguments.anew:
        log.unlink(missing_ok=True)
    known = {line["call"]: line for line in map(json.loads, log.read_text(encoding="utf-8").splitlines())} if log.exists() else {}
    wrong = 0
    for name, place in chosen(calls, arguments.every):
        for how in ("signal=KILL", "error=ENOSPC"):
            call = f"{name} {place} {how}"
            if call not in known:
                known[call] = {"call": call, "faults": faults_of(writer, whole, name, place, how)}
                with open(log, "a", encoding="utf-8") as file:
                    file.write(json.dumps(known[call]) + "\n")
            if known[call]["faults"]:
                wrong += 1
                print(call, known[call]["faults"], flush=True)
    print(f"{len(known)} ends at {len(calls)} calls that write {len(whole)} files: {wrong} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
