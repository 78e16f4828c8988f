"""What a shop costs: processor time and memory by process, bytes by topic."""
import http.client
import os
import pathlib
import xmlrpc.client

TICKS = os.sysconf("SC_CLK_TCK")


def seconds_of(process):
    """Processor seconds so far, with those of children that have ended."""
    try:
        fields = pathlib.Path(f"/proc/{process}/stat").read_text(encoding="ascii").rsplit(")", 1)[1].split()
    except OSError:
        return 0
    return sum(map(int, fields[11:15])) / TICKS


def mebibytes_of(process):
    """Its share of memory: pages that several processes have count in parts."""
    rollup = pathlib.Path(f"/proc/{process}/smaps_rollup").read_text(encoding="ascii")
    return next(int(line.split()[1]) for line in rollup.splitlines() if line.startswith("Pss:")) / 1024


def machine_seconds():
    """Processor seconds of everything on this machine."""
    user, nice, system, idle, wait, *others = map(int, pathlib.Path("/proc/stat").read_text(encoding="ascii").split()[1:9])
    return (user + nice + system + sum(others[:2])) / TICKS, (idle + wait) / TICKS


def bytes_by_topic(master_uri):
    """Bytes that nodes of roscpp have sent so far, by topic without its booth. To be called where nodes can be reached."""
    master = xmlrpc.client.ServerProxy(master_uri)
    publishers = {node for _, nodes in master.getSystemState("/booths")[2][0] for node in nodes}
    sent = {}
    for node in publishers:
        try:
            answer = xmlrpc.client.ServerProxy(master.lookupNode("/booths", node)[2]).getBusStats("/booths")
        except (OSError, xmlrpc.client.Error, http.client.HTTPException):  # ended meanwhile
            continue
        if not isinstance(answer[0], list):  # rospy: [code, words, statistics]; roscpp gives the statistics alone
            continue
        for topic, connections in answer[0]:
            name = topic if topic.count("/") == 1 else topic.split("/", 2)[2]
            sent[name] = sent.get(name, 0) + sum(connection[1] for connection in connections)
    return sent


if __name__ == "__main__":  # in the network of the master
    import json
    import sys
    print(json.dumps(bytes_by_topic(sys.argv[1])))
