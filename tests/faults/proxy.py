#!/usr/bin/env python3
"""Messages dropped, delayed and reordered between the stages of one launched chain (proxied_booth.launch, unreliable.py).

Usage: build/devel/env.sh python3 tests/faults/proxy.py --work DIR [--scans 200] [--share 0.01] [--seed 1] [--late-states]

Scans one after the other. Each must have the result that it has without faults, to the bit, or, where something happened to a message of it, that be named as lost on
/diagnostics (a result without the registered model is another one); no result is another scan's. A line of JSON per scan in DIR/proxy.jsonl, which a later run goes on from. With
--late-states nothing is lost, but of each fit the last state on the way to it is sent after it: each scan must have its right result. Exit: 0 all hold, 1 otherwise."""
import argparse
import json
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import threading
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.dont_write_bytecode = True  # not into the sources
sys.path[:0] = [str(HERE), str(HERE.parent)]
from graph import BODIES, PATIENCE, STAGES, Shop, beginning_of_id, bodies_in
from launched import free_port, wait_until

SETTLED = 3  # seconds after which no late result of a scan comes
LATE_STATES = "late_states"  # as unreliable.py has it


class Chain:
    """The launched chain and its unreliable ways. Context manager."""

    def __init__(self, work, bodies, seed, share):
        """`share` of the messages are lost; or LATE_STATES"""
        self.work, self.bodies, self.seed, self.share = work, bodies, seed, share
        self.port, self.events, self.processes, self.shop = free_port(), [], [], None

    def __enter__(self):
        self.log = open(self.work / "proxy.log", "a", encoding="utf-8")
        environment = dict(os.environ, ROS_MASTER_URI=f"http://localhost:{self.port}", ROS_HOSTNAME="localhost")
        try:
            often = ["progress_period:=0.001"] if self.share == LATE_STATES else []
            self.processes.append(subprocess.Popen(["roslaunch", "-p", str(self.port), HERE / "proxied_booth.launch", *often], stdout=self.log,
                                                   stderr=self.log, env=environment, start_new_session=True))
            wait_until(lambda: subprocess.run(["rosnode", "list"], capture_output=True, env=environment, check=False).returncode == 0,
                       "the master", PATIENCE)
            ways = subprocess.Popen([sys.executable, HERE / "unreliable.py", str(self.seed), str(self.share)], stdout=subprocess.PIPE,
                                    stderr=self.log, env=environment, text=True)
            self.processes.append(ways)
            threading.Thread(target=self.hear, args=[ways.stdout], daemon=True).start()
            self.shop = Shop(self.port, self.bodies, self.log)
            wait_until(lambda: len(self.reports()) == len(STAGES), "reports of all stages", PATIENCE)
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        if self.shop:
            self.shop.close()
        for process in reversed(self.processes):
            process.send_signal(signal.SIGINT)
            try:
                process.wait(20)
            except subprocess.TimeoutExpired:
                process.kill()
        self.log.close()

    def hear(self, lines):
        for line in lines:
            self.events.append(json.loads(line))

    def reports(self):
        return {node: report for node, report in self.shop.ask("reports").items() if node.split("/")[-1] in STAGES and node.startswith("left/")}

    def named(self, stamp):
        """Stages that named the scan as lost, or refused it."""
        return {node.split("/")[-1]: report["last_error"] for node, report in self.reports().items()
                if report["last_error_scan_id"].startswith(beginning_of_id(stamp))}


def right_results(work, bodies):
    """Of each body, without faults."""
    with Chain(work, bodies, 0, 1e-9) as chain:
        found = []
        for body in range(BODIES):
            stamp = chain.shop.scan("left", body)
            wait_until(lambda: chain.shop.result("left", stamp), f"body {body}", PATIENCE)
            found.append(chain.shop.result("left", stamp)["digest"])
    if len(set(found)) != BODIES:
        raise RuntimeError("bodies that look alike prove nothing")
    return found


def scan(chain, case, right):
    dice = random.Random(f"{chain.seed} {case}")
    body = dice.randrange(BODIES)
    stamp, begin = chain.shop.scan("left", body), time.monotonic()

    def wait(condition):
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end and not condition():
            time.sleep(0.1)

    def newest():
        return next((r for r in reversed(chain.shop.ask("results")) if r["booth"] == "left" and r["stamp"] == stamp), None)

    def is_right():
        result = newest()
        return result is not None and result["digest"] == right[body]
    wait(lambda: newest() or chain.named(stamp))
    if not is_right():  # a message that is late may bring the right one
        wait(lambda: is_right() or chain.named(stamp))
    seconds = round(time.monotonic() - begin, 2)
    if not is_right():
        time.sleep(dice.uniform(0, SETTLED))
    result = newest()
    mixed = [r for r in chain.shop.ask("results") if r["digest"] in right and r["digest"] != right[chain.shop.bodies[r["booth"], r["stamp"]]]]
    named = chain.named(stamp)
    events = [f"{event['what']} {event['way']}" for event in chain.events if event.get("stamp") == stamp]
    is_named = bool(events) and "lost_message" in named.values()  # an untouched scan has no excuse
    return {"case": case, "body": body, "result": "right" if is_right() else "none" if result is None else "another", "named": named, "seconds": seconds,
            "mixed": len(mixed), "fine": not mixed and (is_right() or is_named), "events": events}


def table(rows):
    """Prints what came of it; whether all hold."""
    hit = [r for r in rows if r["events"]]
    count = {what: sum(event.startswith(what) for r in rows for event in r["events"]) for what in ("dropped", "delayed", "held")}
    print(f"{len(rows)} scans, {sum(r['fine'] for r in rows)} fine; {count['dropped']} messages dropped, {count['delayed']} delayed, {count['held']} held back, "
          f"of {len(hit)} scans; of these {sum(r['result'] == 'right' for r in hit)} came right, {sum(r['result'] == 'none' for r in hit)} were lost, "
          f"{sum(r['result'] == 'another' for r in hit)} were measured without the model; {sum(bool(r['named']) for r in hit)} named; "
          f"{sum(r['mixed'] for r in rows)} mixed; {max(r['seconds'] for r in rows):.1f} s at most")
    return all(r["fine"] for r in rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--work", type=pathlib.Path, required=True)
    parser.add_argument("--scans", type=int, default=200)
    parser.add_argument("--share", type=float, default=0.01)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--late-states", action="store_true")
    parser.add_argument("--anew", action="store_true", help="do the scans that are there again")
    arguments = parser.parse_args()
    work = arguments.work.resolve()
    work.mkdir(parents=True, exist_ok=True)
    path, bodies = work / ("late_states.jsonl" if arguments.late_states else "proxy.jsonl"), bodies_in(work)
    if arguments.anew:
        path.unlink(missing_ok=True)
    rows = [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()] if path.exists() else []
    right = right_results(work, bodies)
    share = LATE_STATES if arguments.late_states else arguments.share
    with Chain(work, bodies, f"{arguments.seed} {len(rows)}", share) as chain, open(path, "a", encoding="utf-8") as file:
        for case in range(len(rows), arguments.scans):
            rows.append(scan(chain, case, right))
            if arguments.late_states:
                rows[-1]["fine"] &= rows[-1]["result"] == "right" and len(rows[-1]["events"]) == 1
            file.write(json.dumps(rows[-1]) + "\n")
            file.flush()
            if rows[-1]["events"] or not rows[-1]["fine"]:
                print(json.dumps(rows[-1]), flush=True)
    return 0 if table(rows) else 1


if __name__ == "__main__":
    with tempfile.TemporaryDirectory(prefix="ros_") as home:
        os.environ.setdefault("ROS_HOME", home)
        sys.exit(main())
