#!/usr/bin/env python3
"""A batch that is killed again and again: `fit_batch` with all its workers by SIGKILL at random times, until it is through. The merged
table must have the same bytes as one of a batch that was left alone. Resumable: run it again with the same --work, or, where that is gone, with
the same --results: each of --parts is a batch of its own, and has a line there. The seconds of a part that was resumed are those since then.

--full-scans: so many of the rows, spread evenly, are clouds of full size; the others are meshes of 6,000 triangles (--kind mesh) or clouds of
9,000 points (--kind scan).

Usage: kill_campaign.py FOLDER_OF_THE_PROGRAMS --work DIR [--results FILE] [--rows N] [--parts P] [--full-scans F] [--bodies M] [--kind scan|mesh]
[--seed S] [--jobs J] [--between-kills SECONDS]"""
import argparse
import csv
import json
import os
import pathlib
import random
import shutil
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


def make_meshes(work, programs, count):
    """Small meshes of the small scans, `work`/small/N/mesh.ply: a row of one takes a fraction of a scan's time."""
    for n in range(1, count + 1):
        folder = work / f"small/{n}"
        if not (folder / "mesh.ply").exists():
            subprocess.run([programs / "fit", "--scan", folder / "scan.ply", "--body-triangles", "6000", "--out", folder / "fit"], check=True,
                           stdout=subprocess.DEVNULL)
            (folder / "fit/body.ply").rename(folder / "mesh.ply")
            shutil.rmtree(folder / "fit")


def manifest_of(folder, work, rows, arguments):
    """Rows of M random bodies, each with ratios of its own."""
    manifest = folder / "manifest.csv"
    with open(manifest, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(("name", "scan", "mesh", "garment", "ratio"))
        for row in rows:
            body = row % arguments.bodies + 1
            full = row * arguments.full_scans // arguments.rows != (row + 1) * arguments.full_scans // arguments.rows
            small = {"scan": (f"{work}/small/{body}/scan.ply", ""), "mesh": ("", f"{work}/small/{body}/mesh.ply")}[arguments.kind]
            writer.writerow((row, *((f"{work}/full/{body}/scan.ply", "") if full else small), "B1", f"{0.99 - 0.09 * row / arguments.rows:.6f}"))
    return manifest


def run_killed(command, seed, count, between):
    """Kills the batch and its workers, as a power cut would, every `between` seconds on average, until it ends by itself; how often, over all
    starts, stands in the file `count`."""
    kills = int(count.read_text()) if count.exists() else 0
    dice = random.Random(f"{seed} {kills}")
    while True:
        process = subprocess.Popen(command, start_new_session=True)
        try:
            code = process.wait(dice.expovariate(1 / between) + 1)
            if code != 0:
                raise RuntimeError(f"fit_batch ended with {code}")
            return kills
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            kills += 1
            count.write_text(str(kills))


def run_part(part, work, arguments):
    """What came of one part, as a line of the results."""
    folder = work / f"part{part}"
    folder.mkdir(exist_ok=True)
    rows = range(part * arguments.rows // arguments.parts, (part + 1) * arguments.rows // arguments.parts)
    manifest = manifest_of(folder, work, rows, arguments)
    fit_batch = arguments.programs / "fit_batch"
    options = ["--quiet", *(["--jobs", str(arguments.jobs)] if arguments.jobs else [])]
    begin = time.monotonic()
    kills = run_killed([fit_batch, manifest, "--out", folder / "killed", *options], f"{arguments.seed} {part}", folder / "kills.txt",
                       arguments.between_kills)
    middle = time.monotonic()
    subprocess.run([fit_batch, manifest, "--out", folder / "alone", *options], check=True)
    end = time.monotonic()
    for name in ("killed", "alone"):
        subprocess.run([fit_batch, "merge", folder / name, "--out", folder / f"{name}_table", "--quiet"], check=True)
    tables = [(folder / f"{name}_table/table.csv").read_bytes() for name in ("killed", "alone")]
    return {"part": part, "parts": arguments.parts, "rows": len(rows), "full_scans": arguments.full_scans // arguments.parts,
            "kind": arguments.kind, "bodies": arguments.bodies, "seed": arguments.seed, "date": time.strftime("%Y-%m-%d"), "kills": kills,
            "seconds_with_kills": round(middle - begin), "seconds_without": round(end - middle),
            "lines_in_table": tables[0].count(b"\n") - 1, "equal": tables[0] == tables[1]}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("--work", type=pathlib.Path, required=True)
    parser.add_argument("--results", type=pathlib.Path, help="JSON lines; parts that it has are left out")
    parser.add_argument("--rows", type=int, default=10000)
    parser.add_argument("--parts", type=int, default=1)
    parser.add_argument("--full-scans", type=int, default=0)
    parser.add_argument("--bodies", type=int, default=100)
    parser.add_argument("--kind", choices=("scan", "mesh"), default="scan")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, help="scans at once; default: one per core")
    parser.add_argument("--between-kills", type=float, default=25, help="seconds, on average")
    arguments = parser.parse_args()
    work = arguments.work.resolve()
    work.mkdir(parents=True, exist_ok=True)
    results = arguments.results or work / "results.jsonl"
    done = [json.loads(line) for line in results.read_text(encoding="utf-8").splitlines()] if results.exists() else []
    make_bodies(work / "small", arguments.programs, arguments.bodies, ("--points", "9000"))
    if arguments.kind == "mesh":
        make_meshes(work, arguments.programs, arguments.bodies)
    if arguments.full_scans:
        make_bodies(work / "full", arguments.programs, arguments.bodies, ())
    for part in range(arguments.parts):
        if any((line["part"], line["parts"]) == (part, arguments.parts) for line in done):
            continue
        done.append(run_part(part, work, arguments))
        print(json.dumps(done[-1]), flush=True)
        with open(results, "a", encoding="utf-8") as file:
            file.write(json.dumps(done[-1]) + "\n")
        shutil.rmtree(work / f"part{part}")
    whole = all(line["equal"] and line["lines_in_table"] == line["rows"] for line in done)
    print(f"{sum(line['rows'] for line in done)} rows, {sum(line['kills'] for line in done)} kills: " + ("equal" if whole else "NOT equal"))
    return 0 if whole else 1


if __name__ == "__main__":
    sys.exit(main())
