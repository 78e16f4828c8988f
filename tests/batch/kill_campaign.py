#!/usr/bin/env python3
"""A batch that is killed again and again: `fit_batch` with all its workers by SIGKILL at random times, until it is through. The merged
table must have the same bytes as one of a batch that was left alone. Resumable: run it again with the same --work.

--full-scans: so many of the rows, spread evenly, are clouds of full size; the others are meshes as booths deliver them (--kind mesh) or clouds
of 9,000 points (--kind scan).

Usage: kill_campaign.py FOLDER_OF_THE_PROGRAMS --work DIR [--rows N] [--full-scans F] [--bodies M] [--kind scan|mesh] [--seed S]"""
import argparse
import csv
import json
import os
import pathlib
import random
import signal
import subprocess
import sys
import time


def make_bodies(work, programs, count, options):
    """The folders `work`/1, 2, ... of virtual_booth, each with body.ply and scan.ply."""
    for n in range(1, count + 1):
        if not (work / f"{n}/truth.json").exists():
            subprocess.run([programs / "virtual_booth", "--seed", str(n), *options, "--out", work / f"{n}"], check=True,
                           stdout=subprocess.DEVNULL)


def manifest_of(work, programs, arguments):
    """Rows of M random bodies, each with ratios of its own."""
    make_bodies(work / "small", programs, arguments.bodies, ("--points", "9000"))
    if arguments.full_scans:
        make_bodies(work / "full", programs, arguments.bodies, ())
    manifest = work / "manifest.csv"
    with open(manifest, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(("name", "scan", "mesh", "garment", "ratio"))
        for row in range(arguments.rows):
            body = row % arguments.bodies + 1
            full = row * arguments.full_scans // arguments.rows != (row + 1) * arguments.full_scans // arguments.rows
            small = {"scan": (f"small/{body}/scan.ply", ""), "mesh": ("", f"small/{body}/body.ply")}[arguments.kind]
            writer.writerow((row, *((f"full/{body}/scan.ply", "") if full else small), "B1", f"{0.99 - 0.09 * row / arguments.rows:.6f}"))
    return manifest


def run_killed(command, seed, count):
    """Kills the batch and its workers, as a power cut would, until it ends by itself; how often, over all starts, stands in the file
    `count`."""
    kills = int(count.read_text()) if count.exists() else 0
    dice = random.Random(f"{seed} {kills}")
    while True:
        process = subprocess.Popen(command, start_new_session=True)
        try:
            code = process.wait(dice.expovariate(1 / 25) + 1)
            if code != 0:
                raise RuntimeError(f"fit_batch ended with {code}")
            return kills
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            kills += 1
            count.write_text(str(kills))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("--work", type=pathlib.Path, required=True)
    parser.add_argument("--rows", type=int, default=10000)
    parser.add_argument("--full-scans", type=int, default=0)
    parser.add_argument("--bodies", type=int, default=100)
    parser.add_argument("--kind", choices=("scan", "mesh"), default="scan")
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    work = arguments.work.resolve()
    work.mkdir(parents=True, exist_ok=True)
    manifest = manifest_of(work, arguments.programs, arguments)
    fit_batch = arguments.programs / "fit_batch"
    begin = time.monotonic()
    kills = run_killed([fit_batch, manifest, "--out", work / "killed", "--quiet"], arguments.seed, work / "kills.txt")
    middle = time.monotonic()
    subprocess.run([fit_batch, manifest, "--out", work / "alone", "--quiet"], check=True)
    end = time.monotonic()
    for name in ("killed", "alone"):
        subprocess.run([fit_batch, "merge", work / name, "--out", work / f"{name}_table", "--quiet"], check=True)
    tables = [(work / f"{name}_table/table.csv").read_bytes() for name in ("killed", "alone")]
    print(json.dumps({"rows": arguments.rows, "full_scans": arguments.full_scans, "bodies": arguments.bodies, "kind": arguments.kind,
                      "seed": arguments.seed, "kills": kills, "seconds_with_kills": round(middle - begin), "seconds_without": round(end - middle),
                      "equal": tables[0] == tables[1]}))
    return 0 if tables[0] == tables[1] else 1


if __name__ == "__main__":
    sys.exit(main())
