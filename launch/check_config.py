#!/usr/bin/python3
"""Parameters by node, as the launch files load them: is each name that of a node, and is each there once? roslaunch runs this before it starts anything, and ends where
it fails. What a node is given is the node's own to check.

Usage: check_config.py FILE.yaml"""
import pathlib
import sys
import xml.etree.ElementTree

import rosparam  # teaches yaml what rosparam reads, such as !degrees  # noqa: F401
import yaml


def nodes():
    """Names of this package's nodes in the launch files beside this one."""
    files = pathlib.Path(__file__).resolve().parent.glob("*.launch")
    found = (node for file in files for node in xml.etree.ElementTree.parse(file).iter("node"))
    return sorted({node.get("name") for node in found if node.get("pkg") == "tensegric_fit"})


class EachKeyOnce(yaml.SafeLoader):
    """Of two sections with one name YAML keeps the last, without a word."""

    def construct_mapping(self, node, deep=False):
        seen = set()
        for name, _ in node.value:
            if name.tag == "tag:yaml.org,2002:merge":
                continue
            key = self.construct_object(name, deep=True)
            if key in seen:
                raise yaml.constructor.ConstructorError(None, None, f"'{key}' stands there twice", name.start_mark)
            seen.add(key)
        return super().construct_mapping(node, deep)


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    try:
        loaded = yaml.load(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8"), Loader=EachKeyOnce)
    except (yaml.YAMLError, OSError, ValueError) as error:
        print(f"{sys.argv[1]} cannot be read: {error}", file=sys.stderr)
        return 1
    if not isinstance(loaded, (dict, type(None))):
        print(f"{sys.argv[1]} does not hold parameters by node", file=sys.stderr)
        return 1
    names = [str(name).strip("/").split("/")[0] for name in loaded or {}]  # also "node/parameter"
    known = nodes()
    for name in names:
        if name not in known:
            print(f"{sys.argv[1]} has parameters of '{name}', which is none of the nodes: {', '.join(known)}", file=sys.stderr)
            return 1
    print("known", end="")
    return 0


if __name__ == "__main__":
    sys.exit(main())
