#!/usr/bin/env python3
"""How many booths does one machine carry? N booths on one master, each in a network namespace of its own, and customers who come more and
more often until the time from scan to result has doubled; then a long stretch at 70 % of that rate.

Usage: build/devel/env.sh python3 tests/booths/booths.py --work DIR [--booths 8] [--step 120] [--hold 3600] [--config FILE.yaml]

A line of JSON per stretch in DIR/results.jsonl: idle (no customers), one (customers in one booth alone), raise 0, 1, ... (each rate 1.4 times
the one before), hold 0, 1, ... (300 s each). Stretches that are there are not done again. Network namespaces need root; without them all is
on loopback, and the lines say so. Exit: 0 no scan was lost and every result is the one that its body has alone, to the bit; 1 otherwise."""
import argparse
import json
import os
import pathlib
import signal
import statistics
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.dont_write_bytecode = True  # not into the sources
sys.path[:0] = [str(HERE.parent), str(HERE)]
from costs import machine_seconds, mebibytes_of, seconds_of
from launched import nodes_at, program, wait_until
from network import network

NODES = ("reconstruction", "landmarks", "control_mesh", "tensegric", "tffd", "capture", "vault")
BODIES = 4
PORT = 11400
FIRST_RATE, FASTER = 0.2, 1.4  # customers per second in the whole shop, and how much more with each step
TWICE, SHARE = 2, 0.7
SLICE = 300  # seconds of the long stretch in one line
STARTING = 20  # seconds that the processes of customers may take to start
MOST_STEPS = 12


def percentile(values, share):
    values = sorted(values)
    return values[min(len(values) - 1, int(share * len(values)))]


class Shop:
    """Master and launched booths. Context manager."""

    def __init__(self, net, booths, bodies, config, work):
        self.net, self.bodies, self.config = net, bodies, config
        self.names = [f"booth_{n}" for n in range(1, booths + 1)]
        self.uri = f"http://{net.address(0)}:{PORT}"
        self.log = open(work / "launch.log", "a", encoding="utf-8")
        self.started = []

    def start(self, host, *command, **options):
        environment = dict(os.environ, ROS_MASTER_URI=self.uri, ROS_IP=self.net.address(host))
        environment.pop("ROS_HOSTNAME", None)
        return subprocess.Popen([*self.net.command(host), *map(str, command)], env=environment, **options)

    def __enter__(self):
        try:
            self.started.append(self.start(0, "roscore", "-p", PORT, stdout=self.log, stderr=self.log))
            for host, name in enumerate(self.names, 1):
                self.started.append(self.start(host, "roslaunch", "--wait", HERE / "one_booth.launch", f"booth:={name}",
                                               f"config:={self.config}", stdout=self.log, stderr=self.log))
            wait_until(lambda: len(nodes_at(self.uri, NODES)) == len(NODES) * len(self.names), "the nodes", 240)
            time.sleep(10)  # they are being made known to each other
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        for process in self.started[1:]:
            process.send_signal(signal.SIGINT)
        for process in self.started[1:]:
            try:
                process.wait(60)
            except subprocess.TimeoutExpired:
                process.kill()
        self.started[0].send_signal(signal.SIGINT)
        self.started[0].wait(60)
        self.log.close()

    def master(self):
        core = self.started[0].pid
        children = pathlib.Path(f"/proc/{core}/task/{core}/children").read_text(encoding="ascii").split()
        return next(int(child) for child in children if b"rosmaster" in pathlib.Path(f"/proc/{child}/cmdline").read_bytes())

    def costs(self):
        """What grows: processor seconds by node, of the master, of the machine; bytes by topic and between hosts."""
        by_node = dict.fromkeys(NODES, 0.0)
        for name, process in nodes_at(self.uri, NODES).items():
            by_node[name.split("/")[1]] += seconds_of(process)
        topics = self.start(0, sys.executable, "-B", HERE / "costs.py", self.uri, stdout=subprocess.PIPE, text=True)
        busy, idle = machine_seconds()
        costs = {f"seconds/{node}": seconds for node, seconds in by_node.items()}
        costs.update({"seconds/master": seconds_of(self.master()), "machine/busy": busy, "machine/idle": idle,
                      "bytes/between hosts": sum(self.net.bytes_of(host) for host in range(1, len(self.names) + 1))})
        costs.update({f"bytes/{topic}": count for topic, count in json.loads(topics.communicate()[0]).items()})
        return costs

    def memory(self):
        nodes = [mebibytes_of(process) for process in nodes_at(self.uri, NODES).values()]
        return {"mebibytes_per_booth": round(sum(nodes) / len(self.names), 1), "mebibytes_master": round(mebibytes_of(self.master()), 1)}

    def stretch(self, seed, rate, seconds, booths):
        """Customers for so long, in so many booths, at a rate of them all: what came out, and what it cost per second."""
        begin = time.time() + STARTING
        customers = [self.start(host, sys.executable, "-B", HERE / "customers.py", name, *self.bodies, "--seed", seed, "--rate",
                                rate / booths, "--seconds", seconds, "--begin", begin, stdout=subprocess.PIPE, text=True)
                     for host, name in list(enumerate(self.names, 1))[:booths]]
        try:
            time.sleep(max(0, begin - time.time()))
            before, began = self.costs(), time.time()
            time.sleep(max(0, begin + seconds - time.time()))
            after, ended = self.costs(), time.time()
            rows = [json.loads(line) for process in customers for line in process.communicate()[0].splitlines()]
        finally:
            for process in customers:
                process.kill()
        if len([row for row in rows if "strays" in row]) != booths:
            raise RuntimeError("customers.py has ended early")
        after["bytes/scan/points"] = sum(row.get("bytes", 0) for row in rows)
        spent = {what: (after[what] - before.get(what, 0)) / (ended - began) for what in after}
        return rows, {what: round(value, 4) for what, value in spent.items() if value > 0}


def summary(rows, expected, seconds):
    """Of the customers of a stretch. `expected`: body -> digest of its result; filled where a body comes for the first time."""
    scans = [row for row in rows if "came" in row]
    done = [row for row in scans if "done" in row]
    for row in done:
        expected.setdefault(str(row["body"]), row["digest"])
    took = [row["done"] - row["sent"] for row in done]
    return {"customers": len(scans), "lost": len(scans) - len(done),
            "mixed": sum(row["digest"] != expected[str(row["body"])] for row in done) + sum(row.get("strays", 0) for row in rows),
            "through_per_second": round(sum(row["done"] <= seconds for row in done) / seconds, 4),
            "median": round(statistics.median(took), 3), "p99": round(percentile(took, 0.99), 3), "longest": round(max(took), 3),
            "waiting_p99": round(percentile([row["sent"] - row["came"] for row in scans], 0.99), 3),
            "results": sorted({row["status"] for row in done})}


class Campaign:
    def __init__(self, shop, path):
        self.shop, self.path = shop, path
        self.done = {}
        if path.exists():
            self.done = {row["stretch"]: row for row in map(json.loads, path.read_text(encoding="utf-8").splitlines())}
        self.expected = dict(self.done["one"]["expected"]) if "one" in self.done else {}

    def keep(self, name, row):
        row = {"stretch": name, "booths": len(self.shop.names), "network": self.shop.net.kind, "cores": os.cpu_count(), **row}
        with open(self.path, "a", encoding="utf-8") as file:
            file.write(json.dumps(row) + "\n")
        print({key: value for key, value in row.items() if key not in ("cost", "expected")}, flush=True)
        self.done[name] = row

    def idle(self, seconds):
        if "idle" not in self.done:
            before = self.shop.costs()
            time.sleep(seconds)
            after = self.shop.costs()
            spent = {what: round((after[what] - before.get(what, 0)) / seconds, 4) for what in after}
            self.keep("idle", {"cost": {what: value for what, value in spent.items() if value > 0}, **self.shop.memory()})

    def customers(self, name, rate, seconds, booths):
        if name not in self.done:
            rows, cost = self.shop.stretch(name, rate, seconds, booths)
            row = {"rate": round(rate, 4), "seconds": seconds, "in_booths": booths, **summary(rows, self.expected, seconds), "cost": cost,
                   **self.shop.memory()}
            if name == "one":
                if len(set(self.expected.values())) != BODIES:
                    raise RuntimeError("bodies that look alike, or did not come, prove nothing")
                row["expected"] = self.expected
            self.keep(name, row)
        return self.done[name]

    def doubling(self, first, seconds):
        """Customers per second at which the median time has doubled, between two steps on a logarithmic scale."""
        booths = len(self.shop.names)
        limit = TWICE * self.done["one"]["median"]
        before = None
        for step in range(MOST_STEPS):
            row = self.customers(f"raise {step}", first * FASTER**step, seconds, booths)
            if row["median"] >= limit:
                if before is None:
                    return row["rate"]
                share = (limit - before["median"]) / (row["median"] - before["median"])
                return before["rate"] * (row["rate"] / before["rate"]) ** max(0, share)
            before = row
        raise RuntimeError(f"not twice as long at {before['rate']} customers per second")

    def run(self, asked):
        self.idle(min(30, asked.step))
        self.customers("one", asked.first_rate / 2, max(asked.step, 20 / asked.first_rate), 1)
        rate = self.doubling(asked.first_rate, asked.step) if asked.hold > 0 else asked.first_rate
        for part in range(-(-asked.hold // SLICE)):
            self.customers(f"hold {part}", SHARE * rate, min(SLICE, asked.hold - part * SLICE), len(self.shop.names))
        if asked.hold == 0:
            self.customers("short", asked.first_rate, asked.step, len(self.shop.names))


def table(done):
    """Prints what came out; whether nothing was lost or mixed."""
    print("| stretch | customers per second | through | median s | p99 s | waiting p99 s | lost | mixed | cores: nodes, master, all |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    fine = True
    for name, row in done.items():
        cost = row["cost"]
        nodes = sum(value for what, value in cost.items() if what.startswith("seconds/") and what != "seconds/master")
        cores = f"{nodes:.2f}, {cost['seconds/master']:.3f}, {cost['machine/busy']:.2f}"
        if "customers" not in row:
            print(f"| {name} | | | | | | | | {cores} |")
            continue
        fine = fine and row["lost"] == 0 and row["mixed"] == 0
        print(f"| {name} | {row['rate']} | {row['through_per_second']} | {row['median']} | {row['p99']} | {row['waiting_p99']} | {row['lost']} "
              f"of {row['customers']} | {row['mixed']} | {cores} |")
    return fine


def bodies_in(work):
    for n in range(1, BODIES + 1):
        if not (work / f"w{n}/scan.ply").exists():
            subprocess.run([program("virtual_booth"), "--seed", str(n), "--points", "9000", "--out", work / f"w{n}"], check=True,
                           stdout=subprocess.DEVNULL)
    return [work / f"w{n}/scan.ply" for n in range(1, BODIES + 1)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--work", type=pathlib.Path, required=True)
    parser.add_argument("--booths", type=int, default=8)
    parser.add_argument("--step", type=int, default=120, help="seconds at each rate")
    parser.add_argument("--hold", type=int, default=3600, help="seconds at 70 %% of the rate found; 0: no search, one stretch")
    parser.add_argument("--first-rate", type=float, default=FIRST_RATE)
    parser.add_argument("--config", type=pathlib.Path, default=HERE.parents[1] / "launch/config/preview.yaml")
    parser.add_argument("--anew", action="store_true", help="forgets what was done")
    asked = parser.parse_args()
    work = asked.work.resolve()
    work.mkdir(parents=True, exist_ok=True)
    if asked.anew:
        (work / "results.jsonl").unlink(missing_ok=True)
    with network(asked.booths) as net, Shop(net, asked.booths, bodies_in(work), asked.config.resolve(), work) as shop:
        campaign = Campaign(shop, work / "results.jsonl")
        campaign.run(asked)
    return 0 if table(campaign.done) else 1


if __name__ == "__main__":
    with tempfile.TemporaryDirectory(prefix="ros_") as home:
        os.environ.setdefault("ROS_HOME", home)
        sys.exit(main())
