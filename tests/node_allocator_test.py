#!/usr/bin/env python3
"""All nodes that run until ROS shuts down are linked with jemalloc and have its options: without, they keep most of what they free, and nothing else fails."""
import pathlib
import re
import subprocess
import sys
import unittest

SOURCES = pathlib.Path(__file__).resolve().parent.parent / "nodes"


def output_of(*command):
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, universal_newlines=True).stdout


class NodeAllocator(unittest.TestCase):
    def test_each_node_has_jemalloc(self):
        nodes = [source.stem for source in SOURCES.glob("*/*_node.cpp") if "run_node<" in source.read_text()]
        self.assertGreater(len(nodes), 10)
        for node in nodes:
            with self.subTest(node=node):
                self.assertRegex(output_of("readelf", "--dynamic", str(PROGRAMS / node)), r"NEEDED.*libjemalloc")
                self.assertTrue(re.search(r"OBJECT +GLOBAL +DEFAULT +[0-9]+ malloc_conf$", output_of("readelf", "--dyn-syms", "--wide", str(PROGRAMS / node)),
                                          re.MULTILINE))


if __name__ == "__main__":
    PROGRAMS = pathlib.Path(sys.argv.pop(1))
    unittest.main()
