#!/usr/bin/env python3
"""A malicious node on the graph of two launched booths (two_booths.launch): what becomes of the booth, and of its exports.

Usage: build/devel/env.sh python3 tests/faults/malice.py --work DIR [--only bytes,garments,...] [--anew]

After each attack (malicious.py), whose calls of services and goals are all answered, the same processes run, exports and what lies beside them are untouched, and the next scan of both booths
has the right result, to the bit. A line of JSON per attack in DIR/malice.jsonl; attacks that held there are not made again. Exit: 0 all hold, 1 otherwise."""
import argparse
import hashlib
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.dont_write_bytecode = True  # not into the sources
sys.path[:0] = [str(HERE), str(HERE.parent)]
from graph import BOOTHS, PATIENCE, Graph, bodies_in, names_in, outcome

ATTACKS = ("bytes", "empty", "tags", "shapes", "clouds", "garments", "reports", "captures", "folders", "orders", "transforms")
SOON = 60  # seconds; how soon is not what is tried here
LASTING = 300  # seconds that an attack may last


def content_of(folder):
    """Path -> digest."""
    return {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else "folder" for path in folder.rglob("*")}


def attack(graph, name, exports):
    graph.wait("left", graph.shop.scan("left", 0), PATIENCE)
    processes, content = graph.processes(), content_of(exports.parent)
    environment = dict(os.environ, ROS_MASTER_URI=f"http://localhost:{graph.port}", ROS_HOSTNAME="localhost")
    done = subprocess.run([sys.executable, HERE / "malicious.py", "left", name, exports], env=environment, stdout=subprocess.PIPE, stderr=graph.log,
                          text=True, timeout=LASTING, check=False)
    answers = json.loads(done.stdout.splitlines()[-1]) if done.returncode == 0 else "the attack failed"
    graph.shop.ask("reset", "left")  # what it wore
    time.sleep(3)  # what is under way
    graph.shop.ask("clear")
    died = [node for node, process in graph.processes().items() if processes.get(node) != process] + [n for n in processes if n not in graph.processes()]
    changed = [path for path, digest in content_of(exports.parent).items() if content.get(path) != digest] + [p for p in content if not (exports.parent / p).exists()]
    results = [outcome(graph, booth, graph.shop.scan(booth, body), time.monotonic()) for body, booth in enumerate(BOOTHS)]
    fine = done.returncode == 0 and '"wrong: ' not in done.stdout and not died and not changed and all(result["fine"] for result in results)
    return {"attack": name, "fine": fine, "died": died, "changed": changed, "results": results, "answers": answers}


def attacks(names, work, results):
    """Whether all held."""
    exports = work / "shop" / "exports"
    exports.mkdir(parents=True, exist_ok=True)
    (exports.parent / "beside").write_text("nobody touches this")
    (exports / "link").unlink(missing_ok=True)
    (exports / "link").symlink_to(exports.parent / "beside")
    fine = True
    with open(results, "a", encoding="utf-8") as file, Graph(work, bodies_in(work), False, SOON, exports) as graph:
        stamp = graph.shop.scan("left", 1)
        graph.wait("left", stamp, PATIENCE)
        graph.shop.ask("export", "left", exports / "customer")
        for name in names:
            row = attack(graph, name, exports)
            file.write(json.dumps(row) + "\n")
            file.flush()
            print(json.dumps(row), flush=True)
            fine = fine and row["fine"]
    return fine


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--work", type=pathlib.Path, required=True)
    parser.add_argument("--only", type=names_in(ATTACKS), default=list(ATTACKS))
    parser.add_argument("--anew", action="store_true", help="make the attacks that are there again")
    arguments = parser.parse_args()
    work = arguments.work.resolve()
    work.mkdir(parents=True, exist_ok=True)
    results = work / "malice.jsonl"
    lines = results.read_text(encoding="utf-8").splitlines(keepends=True) if results.exists() else []
    rows = [json.loads(line) for line in lines if line.endswith("\n")]  # not one that a kill left unfinished
    rows = [row for row in rows if row["fine"] and not (arguments.anew and row["attack"] in arguments.only)]
    results.write_text("".join(json.dumps(row) + "\n" for row in rows), encoding="utf-8")
    held = {row["attack"] for row in rows}
    left = [name for name in arguments.only if name not in held]
    return 0 if not left or attacks(left, work, results) else 1


if __name__ == "__main__":
    with tempfile.TemporaryDirectory(prefix="ros_") as home:
        os.environ.setdefault("ROS_HOME", home)
        sys.exit(main())
