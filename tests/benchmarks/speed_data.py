"""What fit_benchmark measured: its JSON, repetitions gathered, medians with spread."""
import json
import math
import statistics


class Measured:
    """One setting: its repetitions."""

    def __init__(self, name):
        self.name = name
        self.milliseconds = []
        self.wall_milliseconds = []
        self.counters = {}
        self.label = ""

    @property
    def n(self):
        return len(self.milliseconds)

    @property
    def ms(self):
        return statistics.median(self.milliseconds)

    @property
    def wall_ms(self):
        return statistics.median(self.wall_milliseconds)

    @property
    def range(self):
        return min(self.milliseconds), max(self.milliseconds)

    def value(self, counter, otherwise=None):
        """Median of a counter over the repetitions; NaN where one of them found none, as it has no place in an order."""
        values = self.counters.get(counter)
        if not values:
            return otherwise
        return math.nan if any(map(math.isnan, values)) else statistics.median(values)


def gather(runs):
    """Name -> Measured, of a list of benchmark runs as Google Benchmark writes them. Time is the processor's, of all
    threads where more than one works: what else the machine does matters little."""
    known = {"name", "run_name", "run_type", "repetitions", "repetition_index", "threads", "iterations", "real_time",
             "cpu_time", "time_unit", "family_index", "per_family_instance_index", "label", "error_occurred",
             "error_message", "aggregate_name", "aggregate_unit"}
    all_ = {}
    for run in runs:
        if run["run_type"] != "iteration" or run.get("error_occurred"):
            continue
        words = run["run_name"].split("/")
        name = "/".join(w for w in words if not w.startswith(("iterations:", "repeats:")) and w != "process_time")
        measured = all_.setdefault(name, Measured(name))
        measured.milliseconds.append(run["cpu_time"])
        measured.wall_milliseconds.append(run["real_time"])
        measured.label = run.get("label", "")
        for key, value in run.items():
            if key not in known:
                measured.counters.setdefault(key, []).append(value)
    return all_


def load(path):
    with open(path) as file:
        content = json.load(file)
    return gather(content["benchmarks"]), content["context"]


class Results(dict):
    """Name -> Measured; what was not built or not run is None."""

    def __missing__(self, name):
        return None

    def sweep(self, prefix):
        """[(argument, Measured)] of all names prefix/NUMBER, ascending."""
        found = []
        for name, measured in self.items():
            head, _, tail = name.rpartition("/")
            if head == prefix and tail.isdigit():
                found.append((int(tail), measured))
        return sorted(found)

    def ratio(self, over, under):
        """Median time of `over` in medians of `under`, least and most that the ranges allow; or None."""
        a, b = self[over], self[under]
        if a is None or b is None:
            return None
        return a.ms / b.ms, a.range[0] / b.range[1], a.range[1] / b.range[0]
