"""A network of its own for a shop: one namespace for the ROS master, one for each booth, joined by a bridge."""
import os
import subprocess

SUBNET = "10.77.0"


def ip(*words):
    subprocess.run(["ip", *map(str, words)], check=True, capture_output=True, text=True)


class Namespaces:
    """Context manager. The master's host is 0, booths are 1 to N; `command(host)` is what puts a process there."""

    kind = "network namespaces, joined by a bridge"

    def __init__(self, booths):
        self.names = [f"tfit{os.getpid()}h{host}" for host in range(booths + 1)]

    def __enter__(self):
        try:
            for host, name in enumerate(self.names):
                ip("netns", "add", name)
                ip("-n", name, "link", "set", "lo", "up")
                self.plug(host, name)
        except subprocess.CalledProcessError as error:
            self.__exit__()
            raise OSError(error.stderr.strip()) from error
        return self

    def plug(self, host, name):
        hub = self.names[0]
        if host == 0:
            ip("-n", hub, "link", "add", "hub", "type", "bridge")
            ip("-n", hub, "addr", "add", f"{self.address(0)}/24", "dev", "hub")
            ip("-n", hub, "link", "set", "hub", "up")
            return
        ip("-n", hub, "link", "add", f"booth{host}", "type", "veth", "peer", "name", "net", "netns", name)
        ip("-n", hub, "link", "set", f"booth{host}", "master", "hub", "up")
        ip("-n", name, "addr", "add", f"{self.address(host)}/24", "dev", "net")
        ip("-n", name, "link", "set", "net", "up")

    def __exit__(self, *_):
        for name in self.names:
            subprocess.run(["ip", "netns", "del", name], check=False, capture_output=True)

    @staticmethod
    def address(host):
        return f"{SUBNET}.{host + 1}"

    def command(self, host):
        return ["ip", "netns", "exec", self.names[host]]

    def bytes_of(self, host):
        """Bytes that the booth has sent to other hosts, and got from them."""
        counters = f"/sys/class/net/booth{host}/statistics"
        text = subprocess.run([*self.command(0), "cat", f"{counters}/rx_bytes", f"{counters}/tx_bytes"], check=True,
                              capture_output=True, text=True).stdout
        return sum(map(int, text.split()))


class Loopback:
    """Where namespaces cannot be made: all hosts are this one."""

    kind = "loopback"

    def __init__(self, _):
        pass

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    @staticmethod
    def address(_):
        return "127.0.0.1"

    @staticmethod
    def command(_):
        return []

    @staticmethod
    def bytes_of(_):
        return 0


def network(booths):
    """Of the kind that can be made here: namespaces need root."""
    try:
        with Namespaces(1):
            pass
    except OSError:
        return Loopback(booths)
    return Namespaces(booths)
