#!/usr/bin/env python3
"""Who may include whom in nodes/: reads the #include lines."""
import pathlib
import re
import sys
import tempfile
import unittest

NODES = pathlib.Path(__file__).resolve().parent.parent / "nodes"

# Room -> room that it includes: why. Mains (*_node.cpp) are left out: they wire stages to each other.
ALLOWED = {
    ("inspect", "geometry"): "pictures are of shapes",
    ("inspect", "mesh_files"): "a fit as a 3D model",
    ("inspect", "files"): "a model in a page",
    ("mesh_files", "geometry"): "files of shapes",
    ("ros", "geometry"): "messages of shapes",
    ("ros", "inspect"): "markers, images and exports are pictures",
    ("rviz", "geometry"): "shows shapes",
    ("rviz", "inspect"): "shows what inspect draws and decides",
    ("rviz", "ros"): "reads messages",
    ("body_model", "geometry"): "core",
    ("body_model", "ros"): "the registered model as a message",
    ("reconstruction", "geometry"): "core",
    ("reconstruction", "ros"): "handler",
    ("reconstruction", "body_model"): "a reconstruction registers the model to mend and close by it",
    ("landmarks", "geometry"): "core",
    ("landmarks", "ros"): "handler",
    ("landmarks", "body_model"): "landmarks are carried by the registered model",
    ("control_mesh", "geometry"): "core",
    ("control_mesh", "ros"): "handler",
    ("control_mesh", "body_model"): "a template may place nodes on the registered model, and arms are left out by its parts",
    ("tensegric", "geometry"): "core",
    ("tensegric", "ros"): "handler",
    ("tffd", "geometry"): "core",
    ("tffd", "ros"): "handler",
    ("correlation", "geometry"): "core",
    ("correlation", "ros"): "handler",
    ("files", "geometry"): "refusals by name",
    ("ros", "mesh_files"): "the customer's page marks places of the model; exports have files for makers' programs",
    ("ros", "files"): "exports are folders, pages and tables",
    ("scan_files", "geometry"): "clouds",
    ("scan_files", "files"): "bags are checked before they are read",
    ("assembler", "geometry"): "clouds",
    ("assembler", "ros"): "handler",
    ("depth_cameras", "geometry"): "refusals by name, checked YAML",
    ("capture", "geometry"): "refusals by name",
    ("capture", "ros"): "handler",
    ("virtual_body", "geometry"): "skin and its measures",
    ("virtual_body", "body_model"): "virtual bodies are shapes of the model",
    ("virtual_booth", "geometry"): "clouds of skin",
    ("virtual_booth", "body_model"): "random bodies are shapes of the model",
    ("virtual_booth", "virtual_body"): "what its sensors see",
    ("virtual_booth", "scan_files"): "it writes scans",
    ("virtual_booth", "mesh_files"): "its bodies as booths deliver meshes",
    ("virtual_booth", "files"): "files that are there whole or not at all",
    ("virtual_booth", "ros"): "transforms as messages",
    ("fit", "geometry"): "the chain in one process wires all stages",
    ("fit", "inspect"): "its pictures",
    ("fit", "files"): "its tables and pages",
    ("scan_files", "mesh_files"): "scans in mesh files, and in which unit and axes",
    ("fit", "scan_files"): "it reads scan files",
    ("fit", "mesh_files"): "it writes files for makers, and says how files were read",
    ("fit", "body_model"): "wires all stages",
    ("fit", "reconstruction"): "wires all stages",
    ("fit", "landmarks"): "wires all stages",
    ("fit", "control_mesh"): "wires all stages",
    ("fit", "tensegric"): "wires all stages",
    ("fit", "tffd"): "wires all stages",
    ("fit", "correlation"): "wires all stages",
    ("batch", "fit"): "many scans through the chain",
    ("batch", "files"): "its tables and page",
    ("batch", "geometry"): "refusals by name, workers, shipped files",
}

# The sides that know ROS: these rooms and these names. All others are core. A header *_bag.hpp is core, too: its source
# alone knows that bags are files of ROS.
ROS_ROOMS = {"ros", "rviz"}
ROS_NAMES = re.compile(r"(_handler\.[ch]pp|_node\.cpp|_messages?\.[ch]pp|_bag\.cpp)$")
ROS_HEADER = re.compile(r"(actionlib|class_loader|message_filters|pcl_conversions|pluginlib|ros|rosbag|rviz|tensegric_fit"
                        r"|tf2|tf2_ros|topic_tools|xmlrpcpp|\w+_msgs|std_srvs)/|XmlRpc")
INCLUDE = re.compile(r'\s*#\s*include\s*([<"])([^>"]+)[>"]')


def includes(nodes):
    """(file, line number, '<' or '"', what is included) of all sources, files by their paths in nodes/."""
    for path in sorted(nodes.glob("*/**/*")):
        if path.suffix not in (".cpp", ".hpp"):
            continue
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            match = INCLUDE.match(line)
            if match:
                yield path.relative_to(nodes).as_posix(), number, match.group(1), match.group(2)


def room(file):
    return file.split("/")[0]


def knows_ros(file):
    return room(file) in ROS_ROOMS or bool(ROS_NAMES.search(file))


def edges(nodes):
    """(from, to): lines, between rooms; mains left out."""
    found = {}
    rooms = {path.name for path in nodes.iterdir() if path.is_dir()}
    for file, number, quote, header in includes(nodes):
        pair = (room(file), room(header))
        if quote == '"' and pair[1] in rooms and pair[0] != pair[1] and not file.endswith("_node.cpp"):
            found.setdefault(pair, []).append(f'nodes/{file}:{number}: #include "{header}"')
    return found


def core_faults(nodes):
    """A core includes no ROS and no file that knows ROS."""
    return [f"nodes/{file}:{number}: a core file includes {header}, which is ROS or knows it"
            for file, number, quote, header in includes(nodes)
            if not knows_ros(file) and (ROS_HEADER.match(header) if quote == "<" else knows_ros(header))]


def edge_faults(nodes, allowed):
    """No room includes another but where it may."""
    return [f"{line}: {pair[0]} may not include {pair[1]}"
            for pair, lines in edges(nodes).items() if pair not in allowed for line in lines]


def circle(pairs):
    """Rooms that include each other in a circle, or nothing."""
    left = set(pairs)
    while left:
        ends = {to for _, to in left} - {start for start, _ in left}
        if not ends:
            return sorted({start for start, _ in left})
        left = {pair for pair in left if pair[1] not in ends}
    return []


class Rooms(unittest.TestCase):
    def test_cores_know_no_ros(self):
        self.assertEqual(core_faults(NODES), [])

    def test_rooms_include_only_what_they_may(self):
        self.assertEqual(edge_faults(NODES, ALLOWED), [])

    def test_no_edge_is_allowed_that_nobody_needs(self):
        self.assertEqual(sorted(set(ALLOWED) - set(edges(NODES))), [])

    def test_arrows_go_one_way(self):
        self.assertEqual(circle(edges(NODES)), [])

    def test_stages_are_not_included_by_what_they_share(self):
        stages = {path.name for path in NODES.iterdir() if list(path.glob("*_handler.hpp"))} | {"body_model"}
        for pair, lines in edges(NODES).items():
            self.assertFalse(pair[0] in ("geometry", "inspect", "ros", "rviz") and pair[1] in stages, lines)


class FaultsAreFound(unittest.TestCase):
    """On trees that are made up."""

    def faults(self, files):
        with tempfile.TemporaryDirectory() as folder:
            nodes = pathlib.Path(folder)
            for name in ("geometry", "ros", "tffd", "tensegric"):
                (nodes / name).mkdir()
            for name, text in files.items():
                (nodes / name).write_text(text + "\n", encoding="utf-8")
            return core_faults(nodes) + edge_faults(nodes, ALLOWED), circle(edges(nodes))

    def test_ros_in_a_core(self):
        for header in ("<ros/ros.h>", "<sensor_msgs/PointCloud2.h>", "<tensegric_fit/Garment.h>", '"ros/flat.hpp"',
                       '"tffd/tffd_handler.hpp"', "<XmlRpcValue.h>"):
            text = "#include " + header
            self.assertEqual(len(self.faults({"tffd/weights.hpp": text})[0]), 1, header)
            self.assertEqual(self.faults({"tffd/tffd_handler.cpp": text})[0], [], header)

    def test_a_stage_in_another(self):
        text = '#include "geometry/ply.hpp"\n#include "tensegric/garment.hpp"'
        for file in ("tffd/weights.cpp", "tffd/tffd_handler.hpp", "ros/stage.cpp"):
            faults, _ = self.faults({file: text})
            self.assertEqual(len(faults), 1, file)
            self.assertIn(f'nodes/{file}:2: #include "tensegric/garment.hpp"', faults[0])
        self.assertEqual(self.faults({"tffd/tffd_node.cpp": text})[0], [])  # a main wires

    def test_circles(self):
        files = {"tffd/a.hpp": '#include "tensegric/a.hpp"', "tensegric/a.hpp": '#include "ros/a.hpp"'}
        self.assertEqual(self.faults(files)[1], [])
        files["ros/a.hpp"] = '#include "tffd/a.hpp"'
        self.assertEqual(self.faults(files)[1], ["ros", "tensegric", "tffd"])


if __name__ == "__main__":
    if not NODES.is_dir():
        sys.exit(f"{NODES} is not there")
    unittest.TestCase.maxDiff = None
    unittest.main()
