#!/usr/bin/env python3
"""A batch over two nodes of a real Slurm (munged, slurmctld, two slurmd on loopback), one of them killed in the middle: the merged
table has the same bytes as one made without any engine. Left out with a word where Slurm is not installed.

Usage: slurm_test.py FOLDER_OF_THE_PROGRAMS [--rows N] [--scaling] [--keep]
--scaling: instead, how long one node takes and how long two, none killed."""
import argparse
import csv
import getpass
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

LEFT_OUT = 77  # ctest's SKIP_RETURN_CODE
LAUNCH = pathlib.Path(__file__).resolve().parents[2] / "launch/slurm"
WANTED = ("munged", "slurmctld", "slurmd", "sbatch", "scontrol", "squeue")
CONFIG = """ClusterName=bench
SlurmctldHost={host}(127.0.0.1)
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CryptoType=crypto/munge
SlurmctldPort={control_port}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool-%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=1,sched_interval=2,requeue_setup_env_fail
SlurmctldParameters=node_reg_mem_percent=1
MessageTimeout=5
SlurmdTimeout=5
KillWait=2
ReturnToService=2
MpiDefault=none
{nodes}
PartitionName=all Nodes={names} Default=YES MaxTime=INFINITE State=UP
"""


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


def wait_until(true, what, seconds):
    end = time.monotonic() + seconds
    while not true():
        if time.monotonic() > end:
            raise RuntimeError(f"{what}: not within {seconds} s")
        time.sleep(0.2)


def content(path):
    try:
        return path.read_bytes()
    except OSError:  # it has ended meanwhile
        return b""


class Cluster:
    """Nodes of one core each; daemons in the foreground, ended with it."""

    def __init__(self, folder, count=2):
        self.folder = folder
        self.nodes = [f"node{i}" for i in range(1, count + 1)]
        self.daemons = {}
        control_port, *ports = free_ports(1 + count)
        host = socket.gethostname()
        nodes = "\n".join(f"NodeName={node} NodeHostname={host} NodeAddr=127.0.0.1 Port={port} CPUs=1 State=UNKNOWN"
                          for node, port in zip(self.nodes, ports))
        (folder / "state").mkdir(parents=True)
        for node in self.nodes:
            (folder / f"spool-{node}").mkdir()
        (folder / "slurm.conf").write_text(CONFIG.format(host=host, user=getpass.getuser(), folder=folder, control_port=control_port,
                                                         nodes=nodes, names=",".join(self.nodes)))
        (folder / "cgroup.conf").write_text("CgroupPlugin=cgroup/v1\nCgroupAutomount=no\n")
        self.environment = dict(os.environ, SLURM_CONF=str(folder / "slurm.conf"))
        key = folder / "munge.key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o400)
        self.start("munged", "--foreground", "--force", f"--socket={folder}/munge.socket", f"--key-file={key}",
                   f"--pid-file={folder}/munged.pid", f"--log-file={folder}/munged.log", f"--seed-file={folder}/munged.seed")
        wait_until((folder / "munge.socket").exists, "munged", 20)
        self.start("slurmctld", "-D", "-i")
        for node in self.nodes:
            self.start("slurmd", "-D", "-N", node, name=node)
        wait_until(lambda: self.ask("sinfo", "-h", "-o", "%T %D").strip() == f"idle {count}", "idle nodes", 60)

    def start(self, program, *arguments, name=None):
        name = name or program
        with open(self.folder / f"{name}.out", "w", encoding="utf-8") as out:
            self.daemons[name] = subprocess.Popen([program, *arguments], env=self.environment, stdout=out, stderr=out,
                                                  start_new_session=True)

    def ask(self, *command):
        return subprocess.run(command, env=self.environment, capture_output=True, text=True, check=False).stdout

    def processes_of(self, node):
        """The daemon, then its step daemons, then what they started."""
        tasks = {int(p.parent.name) for p in pathlib.Path("/proc").glob("[0-9]*/environ")
                 if f"SLURMD_NODENAME={node}\0".encode() in content(p)}
        parents = {int(field) for task in tasks for field in content(pathlib.Path(f"/proc/{task}/stat")).split()[3:4]}
        steps = {p for p in parents if content(pathlib.Path(f"/proc/{p}/comm")).startswith(b"slurmstepd")}
        return [self.daemons[node].pid, *steps, *tasks]

    def hurry(self):
        """Slurm waits two minutes with what it queues again."""
        for job in self.ask("squeue", "-h", "-t", "PD", "-o", "%A").split():
            self.ask("scontrol", "update", f"JobId={job}", "StartTime=now")

    def kill_node(self, node):
        """As a power cut: the daemon and all that runs under it."""
        for process in self.processes_of(node):
            try:
                os.kill(process, signal.SIGKILL)
            except ProcessLookupError:
                pass
        self.daemons[node].wait()

    def stop(self):
        for name in (*self.nodes, "slurmctld", "munged"):
            if name in self.daemons and self.daemons[name].poll() is None:
                self.daemons[name].terminate()
        for daemon in self.daemons.values():
            try:
                daemon.wait(10)
            except subprocess.TimeoutExpired:
                daemon.kill()


def manifest_of(folder, programs, rows):
    for n in (1, 2):
        subprocess.run([programs / "virtual_booth", "--customer", str(n), "--out", folder / f"w{n}"], check=True,
                       stdout=subprocess.DEVNULL)
    manifest = folder / "manifest.csv"
    with open(manifest, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(("name", "mesh", "garment", "ratio"))
        for row in range(rows):
            writer.writerow((f"row {row}", f"w{row % 2 + 1}/body.ply", "B1", f"{0.99 - 0.09 * row / rows:.6f}"))
    return manifest


def rows_in(table):
    if not table.exists():
        return 0
    with open(table, encoding="utf-8", newline="") as file:
        return sum(1 for _ in csv.DictReader(file))


def lines_in(folder):
    return sum(len(file.read_text().splitlines()) for file in folder.glob("shard-*/*.jsonl"))


def run(folder, programs, rows):
    manifest = manifest_of(folder, programs, rows)
    fit_batch = programs / "fit_batch"
    begin = time.monotonic()
    subprocess.run([fit_batch, manifest, "--out", folder / "alone", "--jobs", "1", "--quiet"], check=True)
    one_core = time.monotonic() - begin
    subprocess.run([fit_batch, "merge", folder / "alone", "--out", folder / "alone_table", "--quiet"], check=True)
    cluster = Cluster(folder / "cluster")
    try:
        out = folder / "slurm"
        begin = time.monotonic()
        job = subprocess.run([LAUNCH / "submit.sh", manifest, out, "4"], env=dict(cluster.environment, FIT_BATCH=str(fit_batch)),
                             check=True, capture_output=True, text=True).stdout.strip()
        wait_until(lambda: lines_in(out) >= max(1, rows // 4), "first results", 60 + 10 * rows)
        done = lines_in(out)
        cluster.kill_node("node2")
        wait_until(lambda: cluster.hurry() or rows_in(out / "table/table.csv") == rows, f"job {job}", 120 + 10 * rows)
        seconds = time.monotonic() - begin
    finally:
        cluster.stop()
    same = (out / "table/table.csv").read_bytes() == (folder / "alone_table/table.csv").read_bytes()
    log = (folder / "cluster/slurmctld.log").read_text()
    requeued = "Requeuing JobId" in log
    print(f"{rows} rows: {one_core:.0f} s on one core without an engine; over two nodes, one killed after {done} rows, "
          f"{seconds:.0f} s, {'its task queued again by Slurm' if requeued else 'NOT QUEUED AGAIN'}; tables {'equal' if same else 'DIFFER'}")
    return 0 if same and requeued else 1


def scaling(folder, programs, rows):
    manifest = manifest_of(folder, programs, rows)
    seconds = {}
    for count in (1, 2):
        cluster = Cluster(folder / f"cluster{count}", count)
        out = folder / f"slurm{count}"
        try:
            begin = time.monotonic()
            subprocess.run([LAUNCH / "submit.sh", manifest, out, "4"],
                           env=dict(cluster.environment, FIT_BATCH=str(programs / "fit_batch")), check=True, capture_output=True)
            wait_until(lambda: rows_in(out / "table/table.csv") == rows, "the table", 120 + 10 * rows)
            seconds[count] = time.monotonic() - begin
        finally:
            cluster.stop()
    same = (folder / "slurm1/table/table.csv").read_bytes() == (folder / "slurm2/table/table.csv").read_bytes()
    print(f"{rows} rows in 4 shards: one node {seconds[1]:.0f} s, two {seconds[2]:.0f} s, {seconds[1] / seconds[2]:.2f} times as fast; "
          f"tables {'equal' if same else 'DIFFER'}")
    return 0 if same else 1


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("--rows", type=int, default=8)
    parser.add_argument("--scaling", action="store_true", help="one node against two, none killed")
    parser.add_argument("--keep", action="store_true", help="the folder with logs is kept")
    arguments = parser.parse_args()
    os.environ["PATH"] += ":/usr/sbin:/sbin"
    missing = [program for program in WANTED if shutil.which(program) is None]
    if missing:
        print("left out: Slurm's " + ", ".join(missing) + " not installed (apt-get install slurmctld slurmd slurm-client munge)")
        return LEFT_OUT
    if os.getuid() != 0:
        print("left out: slurmd needs root")
        return LEFT_OUT
    folder = pathlib.Path(tempfile.mkdtemp(prefix="slurm_test_"))
    folder.chmod(0o755)  # munged looks at the way to its socket
    try:
        return (scaling if arguments.scaling else run)(folder, arguments.programs.resolve(), arguments.rows)
    finally:
        if arguments.keep:
            print(folder)
        else:
            shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    sys.exit(main())
