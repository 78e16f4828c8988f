#!/usr/bin/env python3
"""Faults in the graph: two booths on one master, launched as a shop would (launch/keep_running.py, respawn:=true), and what comes out
after each fault.

Usage: build/devel/env.sh python3 tests/faults/graph.py --work DIR [--kills 100] [--only kill,master,...] [--anew]

A line of JSON per case in DIR/results.jsonl; cases that are there are not done again. Faults: kill (SIGKILL to a random node at a random
moment of a scan), surface (SIGKILL to the process that makes the surface), master, stop (SIGSTOP for 30 s), clock (an hour forward, an
hour back), deaf (a subscriber that never reads), full (exports to a full disk), read_only. After each, the scan that is newest must have
the result that it has without faults, to the bit, at most 5 s after the node is back, or after the scan where none was gone; that of the
other booth, beside a node that is killed or stopped, at most 10 s after its scan. No result is another scan's; a scan without a result is
named on /diagnostics. Exit: 0 all hold, 2 a usage error, 1 otherwise."""
import argparse
import json
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.dont_write_bytecode = True  # not into the sources
sys.path.insert(0, str(HERE.parent))
from launched import free_port, nodes_at, program, wait_until

BOOTHS = ("left", "right")
STAGES = ("reconstruction", "landmarks", "control_mesh", "tensegric", "tffd")
NODES = STAGES + ("capture", "vault")
BODIES = 3
SOON = 5  # seconds from a node's return, or from the scan where none was gone, to the result
BESIDE = 2 * SOON  # seconds from its scan to the result of the other booth: both compute at once, and the killed node starts beside it
WHOLE = 30  # seconds from the death of the master until a scan goes through again
PATIENCE = 60  # seconds that anything may take; what takes longer is lost
STOPPED = 30  # seconds
HOUR = 3600


class Shop:
    """The process that publishes and listens: shop.py."""

    def __init__(self, port, bodies, log):
        environment = dict(os.environ, ROS_MASTER_URI=f"http://localhost:{port}", ROS_HOSTNAME="localhost")
        self.process = subprocess.Popen([sys.executable, HERE / "shop.py", *bodies], env=environment, stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, stderr=log, text=True)
        self.bodies = {}  # (booth, stamp) -> body
        self.answer()

    def answer(self):
        line = self.process.stdout.readline()
        if not line:
            raise RuntimeError("shop.py has ended")
        answer = json.loads(line)
        if isinstance(answer, dict) and "failed" in answer:
            raise RuntimeError(answer["failed"])
        return answer

    def ask(self, *words):
        self.process.stdin.write(" ".join(map(str, words)) + "\n")
        self.process.stdin.flush()
        return self.answer()

    def scan(self, booth, body):
        stamp = self.ask("scan", booth, body)
        self.bodies[booth, stamp] = body
        return stamp

    def result(self, booth, stamp):
        return next((r for r in self.ask("results") if r["booth"] == booth and r["stamp"] == stamp), None)

    def close(self):
        self.process.kill()
        self.process.wait()


class Graph:
    """The launched chains. Context manager."""

    def __init__(self, work, bodies, own_clock, soon, exports=None):
        self.port, self.work, self.bodies, self.own_clock = free_port(), work, bodies, own_clock
        self.log = open(work / "launch.log", "a", encoding="utf-8")
        self.keeper = subprocess.Popen([sys.executable, ROOT / "launch/keep_running.py", "--port", str(self.port),
                                        HERE / "two_booths.launch", f"exports:={exports or work / 'exports'}",
                                        f"sim_time:={str(own_clock).lower()}"], stdout=self.log, stderr=self.log,
                                       env=dict(os.environ, ROS_HOSTNAME="localhost"))
        self.soon, self.shop = soon, None
        self.expected = {}  # body -> digest

    def __enter__(self):
        try:
            self.listen()
            for body in range(BODIES):
                self.expected[body] = self.wait(BOOTHS[0], self.shop.scan(BOOTHS[0], body), PATIENCE)["digest"]
            if len(set(self.expected.values())) != BODIES:
                raise RuntimeError("bodies that look alike prove nothing")
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        if self.shop:
            self.shop.close()
        self.keeper.send_signal(signal.SIGINT)
        self.keeper.wait(60)
        self.log.close()

    def listen(self):
        """A new listener, once all nodes are there."""
        wait_until(lambda: len(self.processes()) == len(BOOTHS) * len(NODES), "the nodes", PATIENCE)
        if self.shop:
            self.shop.close()
        self.shop = Shop(self.port, self.bodies, self.log)
        if self.own_clock:
            self.shop.ask("clock", time.time())
        wait_until(lambda: len([n for n in self.shop.ask("reports") if n.split("/")[-1] in STAGES]) == len(BOOTHS) * len(STAGES),
                   "reports of all stages", PATIENCE)

    def processes(self):
        """booth/node -> process."""
        return nodes_at(f"http://localhost:{self.port}", NODES)

    def wait(self, booth, stamp, seconds):
        """The result of that scan."""
        wait_until(lambda: self.shop.result(booth, stamp), f"result of {booth}'s scan {stamp}", seconds)
        return self.shop.result(booth, stamp)

    def mixed(self):
        """Results so far that are not those of their scan."""
        return [r for r in self.shop.ask("results")
                if r["digest"] != self.expected.get(self.shop.bodies.get((r["booth"], r["stamp"])))]


def beginning_of_id(stamp):
    """Of the scan's id, which goes on with a checksum."""
    return f"{stamp // 10 ** 9}.{stamp % 10 ** 9:09}-"


def outcome(graph, booth, stamp, back, limit=SOON):
    """What became of the scan: seconds from `back`, the node's return or the scan where none was gone, to its result, or who named its loss.
    `limit` is that of a machine which is not shared."""
    try:
        result = graph.wait(booth, stamp, PATIENCE)
    except TimeoutError:
        named = [node for node, report in graph.shop.ask("reports").items()
                 if node.startswith(booth) and report["last_error_scan_id"].startswith(beginning_of_id(stamp))]
        return {"fine": False, "lost": True, "named_by": named}
    seconds = result["at"] - back
    return {"fine": seconds <= limit - SOON + graph.soon and not graph.mixed(), "seconds": round(seconds, 2), "mixed": len(graph.mixed())}


def kill(graph, dice, _):
    booth, node, delay = dice.choice(BOOTHS), dice.choice(NODES), dice.uniform(0, 3)
    other = next(b for b in BOOTHS if b != booth)
    process = graph.processes()[f"{booth}/{node}"]
    stamp = graph.shop.scan(booth, dice.randrange(BODIES))
    other_stamp, other_scanned = graph.shop.scan(other, dice.randrange(BODIES)), time.monotonic()
    time.sleep(delay)
    os.kill(process, signal.SIGKILL)
    killed = time.monotonic()

    def is_back():
        if graph.processes().get(f"{booth}/{node}", process) == process:
            return False
        return node not in STAGES or graph.shop.ask("reports")[f"{booth}/{node}"]["at"] > killed + 0.3
    wait_until(is_back, f"{booth}/{node}", PATIENCE)
    back = time.monotonic()
    result = outcome(graph, booth, stamp, back)
    beside = outcome(graph, other, other_stamp, other_scanned, BESIDE)
    return {"booth": booth, "node": node, "delay": round(delay, 2), "return": round(back - killed, 2), **result,
            "fine": result["fine"] and beside["fine"], "other": beside}


def surface(graph, dice, _):
    """The loss is named, and the next scan goes through."""
    booth = dice.choice(BOOTHS)
    stamp = graph.shop.scan(booth, dice.randrange(BODIES))
    parent, found = graph.processes()[f"{booth}/reconstruction"], []

    def started():
        found[:] = [int(p) for p in subprocess.run(["pgrep", "-P", str(parent), "poisson"], capture_output=True, text=True,
                                                   check=False).stdout.split()]
        return found
    wait_until(started, "the process that makes the surface", PATIENCE)
    os.kill(found[0], signal.SIGKILL)

    def named():
        report = graph.shop.ask("reports")[f"{booth}/reconstruction"]  # it keeps the error of the case before
        return report["last_error"] == "surface_failed" and report["last_error_scan_id"].startswith(beginning_of_id(stamp))
    wait_until(named, "its name", PATIENCE)
    again = time.monotonic()
    result = outcome(graph, booth, graph.shop.scan(booth, dice.randrange(BODIES)), again)
    lost = graph.shop.result(booth, stamp) is None  # a late one would be there by now
    return {"booth": booth, **result, "fine": result["fine"] and lost}


def master(graph, dice, _):
    core = next(int(p) for p in subprocess.check_output(["pgrep", "-f", f"rosmaster --core -p {graph.port}"], text=True).split())
    before = set(graph.processes().values())
    os.kill(core, signal.SIGKILL)
    killed = time.monotonic()
    wait_until(lambda: not before & set(graph.processes().values()), "the end of the nodes", PATIENCE)
    graph.listen()
    results = [outcome(graph, booth, graph.shop.scan(booth, dice.randrange(BODIES)), time.monotonic()) for booth in BOOTHS]
    whole = time.monotonic() - killed
    return {"whole": round(whole, 1), "results": results, "fine": whole <= WHOLE - SOON + graph.soon and all(r["fine"] for r in results)}


def stop(graph, dice, case):
    node = STAGES[case % len(STAGES)]
    process = graph.processes()[f"left/{node}"]
    os.kill(process, signal.SIGSTOP)
    try:
        stamp = graph.shop.scan("left", dice.randrange(BODIES))
        beside = outcome(graph, "right", graph.shop.scan("right", dice.randrange(BODIES)), time.monotonic(), BESIDE)
        time.sleep(STOPPED)
        silent = time.monotonic() - graph.shop.ask("reports")[f"left/{node}"]["at"]
    finally:
        os.kill(process, signal.SIGCONT)
    result = outcome(graph, "left", stamp, time.monotonic())
    return {"node": node, **result, "other": beside, "silent": round(silent, 1), "fine": result["fine"] and beside["fine"]}


def clock(graph, dice, _):
    results = []
    for jump in (HOUR, -HOUR, -HOUR, HOUR):
        stamps = {booth: graph.shop.scan(booth, dice.randrange(BODIES)) for booth in BOOTHS}
        time.sleep(dice.uniform(0, 1))
        graph.shop.ask("clock", time.time() + jump)
        results += [outcome(graph, booth, stamps[booth], time.monotonic()) for booth in BOOTHS]
        stamps = {booth: graph.shop.scan(booth, dice.randrange(BODIES)) for booth in BOOTHS}
        results += [outcome(graph, booth, stamps[booth], time.monotonic()) for booth in BOOTHS]
        graph.shop.ask("clock", time.time())
    return {"results": results, "fine": all(r["fine"] for r in results)}


def deaf(graph, dice, _):
    peaks = []
    for topic in ("body/mesh", "body/model", "body/landmarks", "control/mesh", "control/deformed", "body/deformed"):
        graph.shop.ask("deaf", "left", topic)
    results = []
    for _ in range(12):
        began = time.monotonic()
        results.append(outcome(graph, "left", graph.shop.scan("left", dice.randrange(BODIES)), began))
        peaks.append(sum(float(report["peak_mebibytes"] or 0) for node, report in graph.shop.ask("reports").items()
                         if node.startswith("left")))
    return {"results": [r.get("seconds") for r in results], "mebibytes": [round(peaks[3]), round(peaks[-1])],
            "fine": all(r["fine"] for r in results)}


def exports(graph, dice, options):
    """Into a folder on a file system mounted with these options: refused by name, and nothing is left there."""
    folder = graph.work / "mounted"
    folder.mkdir(exist_ok=True)
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", options, "tmpfs", folder], capture_output=True, text=True, check=False)
    if mounted.returncode != 0:
        return {"skipped": mounted.stderr.strip(), "fine": True}
    try:
        stamp = graph.shop.scan("left", dice.randrange(BODIES))
        graph.wait("left", stamp, PATIENCE)
        answer = graph.shop.ask("export", "left", folder)
        left = [str(path.relative_to(folder)) for path in folder.rglob("*")]
    finally:
        subprocess.run(["umount", folder], check=True)
    again = outcome(graph, "left", graph.shop.scan("left", dice.randrange(BODIES)), time.monotonic())
    return {"code": answer["code"], "left": left, **again,
            "fine": not answer["exported"] and bool(answer["code"]) and not left and again["fine"]}


def full(graph, dice, _):
    return exports(graph, dice, "size=64k")


def read_only(graph, dice, _):
    return exports(graph, dice, "ro")


FAULTS = {"kill": kill, "surface": surface, "master": master, "stop": stop, "deaf": deaf, "full": full, "read_only": read_only,
          "clock": clock}
COUNTS = {"surface": 5, "master": 1, "stop": len(STAGES), "deaf": 1, "full": 1, "read_only": 1, "clock": 1}


def names_in(known):
    """For argparse: names with commas between them. A wrong one would run nothing, and pass."""
    def names(text):
        for name in text.split(","):
            if name not in known:
                raise argparse.ArgumentTypeError(f"'{name}' is none of {', '.join(known)}")
        return text.split(",")
    return names


def done_cases(path):
    if not path.exists():
        return {}
    return {(r["fault"], r["case"]): r for r in map(json.loads, path.read_text(encoding="utf-8").splitlines())}


def bodies_in(work):
    for n in range(BODIES):
        if not (work / str(n)).exists():
            subprocess.run([program("virtual_booth"), "--seed", str(n + 1), "--points", "9000", "--out", work / str(n)], check=True,
                           stdout=subprocess.DEVNULL)
    return [work / str(n) / "scan.ply" for n in range(BODIES)]


def run(graph, fault, case, path):
    dice = random.Random(f"{fault} {case}")
    try:
        result = FAULTS[fault](graph, dice, case)
    except (TimeoutError, RuntimeError) as error:
        result = {"fine": False, "error": str(error)}
    with open(path, "a", encoding="utf-8") as file:
        file.write(json.dumps({"fault": fault, "case": case, **result}) + "\n")
    print(fault, case, json.dumps(result), flush=True)
    return "error" not in result


def table(results):
    """Prints a line per fault; whether all hold."""
    for fault in FAULTS:
        rows = [r for r in results if r["fault"] == fault]
        if not rows:
            continue
        seconds = sorted(r["seconds"] for r in rows if "seconds" in r)
        spread = f", {seconds[len(seconds) // 2]:.1f} s in the middle, {seconds[-1]:.1f} s at most" if seconds else ""
        print(f"{fault}: {len(rows)} cases, {sum(r['fine'] for r in rows)} fine ({sum('skipped' in r for r in rows)} skipped), {sum(r.get('lost', False) for r in rows)} lost, "
              f"{sum(r.get('mixed', 0) for r in rows)} mixed{spread}")
    return all(r["fine"] for r in results)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--work", type=pathlib.Path, required=True)
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--only", type=names_in(FAULTS), default=list(FAULTS))
    parser.add_argument("--soon", type=float, default=SOON, help="seconds that a result may take, on a machine that is shared")
    parser.add_argument("--anew", action="store_true", help="do the cases that are there again")
    arguments = parser.parse_args()
    work = arguments.work.resolve()
    work.mkdir(parents=True, exist_ok=True)
    path, bodies = work / "results.jsonl", bodies_in(work)
    if arguments.anew:
        path.unlink(missing_ok=True)
    cases = [(fault, case) for fault in FAULTS if fault in arguments.only for case in range(dict(COUNTS, kill=arguments.kills)[fault])]
    for by_clock in (False, True):  # of its own launch
        left = [c for c in cases if (c[0] == "clock") == by_clock and c not in done_cases(path)]
        while left:
            with Graph(work, bodies, by_clock, arguments.soon) as graph:
                while left and run(graph, *left[0], path):
                    left.pop(0)
                left = left[1:]  # after an error in a new graph
    return 0 if table([r for key, r in done_cases(path).items() if key in cases]) else 1


if __name__ == "__main__":
    with tempfile.TemporaryDirectory(prefix="ros_") as home:
        os.environ.setdefault("ROS_HOME", home)
        sys.exit(main())
