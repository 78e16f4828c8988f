#!/usr/bin/python3
"""Parameters by node, as the launch files load them: is each name that of a node? roslaunch runs this before it starts anything, and ends where
it fails. What a node is given is the node's own to check.

Usage: check_config.py FILE.yaml"""
import pathlib
import sys
import xml.etree.ElementTree

import rosparam
import yaml


def nodes():
    """Names of this package's nodes in the launch files beside this one."""
    files = pathlib.Path(__file__).resolve().parent.glob("*.launch")
    found = (node for file in files for node in xml.etree.ElementTree.parse(file).iter("node"))
    return sorted({node.get("name") for node in found if node.get("pkg") == "tensegric_fit"})


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    try:
        loaded = [values for values, _ in rosparam.load_file(sys.argv[1])]
    except (rosparam.RosParamException, yaml.YAMLError, OSError, ValueError, TypeError) as error:
        print(f"{sys.argv[1]} cannot be read: {error}", file=sys.stderr)
        return 1
    if not all(isinstance(values, (dict, type(None))) for values in loaded):
        print(f"{sys.argv[1]} does not hold parameters by node", file=sys.stderr)
        return 1
    unknown = [name for values in loaded for name in values or {} if name not in nodes()]
    if unknown:
        print(f"{sys.argv[1]} has parameters of '{unknown[0]}', which is none of the nodes: {', '.join(nodes())}", file=sys.stderr)
        return 1
    print("known", end="")
    return 0


if __name__ == "__main__":
    sys.exit(main())
