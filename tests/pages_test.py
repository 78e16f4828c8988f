#!/usr/bin/env python3
"""The pages against the code: parameters, topics, services, actions, launch arguments, options, keys of files; links,
and how long README.md and the cells of tables are."""
import json
import math
import pathlib
import re
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as xml

import interface_in_code as code
import rooms_picture
import rooms_test

ROOT = code.ROOT
PAGES = ROOT / "launch" / "pages"
README_LINES = 120
CELL = 400  # characters: more is a paragraph, no cell


def markdown_files(root=ROOT):
    """Those that belong to the repository; without git all but what is built."""
    listed = subprocess.run(["git", "-C", root, "ls-files", "--cached", "--others", "--exclude-standard", "*.md"],
                            capture_output=True, text=True, check=False)
    if listed.returncode == 0:
        return [root / name for name in sorted(listed.stdout.splitlines()) if (root / name).is_file()]
    return [path for path in sorted(root.rglob("*.md")) if "build" not in path.relative_to(root).parts]


def without_code(text):
    """Lines in code blocks are blank; numbers of lines stay."""
    lines, fenced = [], False
    for line in text.splitlines():
        fence = line.lstrip().startswith("```")
        lines.append("" if fence or fenced or line.startswith("    ") else line)
        fenced ^= fence
    return lines


def cells(line):
    """Of a table's row; a stroke after a backslash is no border."""
    return [cell.strip().replace("\\|", "|") for cell in re.split(r"(?<!\\)\|", line.strip())[1:-1]]


def tables(text):
    """(headings above it, rows) of each table; the headings are the last of each level, without number signs."""
    headings, rows = {}, []
    for line in without_code(text) + [""]:
        if line.startswith("|"):
            rows.append(cells(line))
            continue
        if rows:
            yield [headings[level] for level in sorted(headings)], rows[2:]
            rows = []
        heading = re.match(r"(#+) (.*)", line)
        if heading:
            level = len(heading[1])
            headings = {other: words for other, words in headings.items() if other < level}
            headings[level] = heading[2].strip()


def rows_under(text, *headings):
    return [row for above, rows in tables(text) if [h.strip("`") for h in above[-len(headings):]] == list(headings)
            for row in rows]


def subheadings(text, heading):
    match = re.search(rf"^## {re.escape(heading)}\n(.*?)(?=^## |\Z)", text, re.M | re.S)
    return re.findall(r"^### `?(.*?)`?$", match[1], re.M) if match else []


def quoted(cell):
    return re.findall(r"`([^`]+)`", cell)


def same(written, value):
    """Does a page say this value? Numbers by their value, others letter by letter."""
    written = written.strip("` ")
    if isinstance(value, float):
        try:
            return math.isclose(float(written), value, rel_tol=1e-4, abs_tol=1e-12)
        except ValueError:
            return False
    return written == (value or "none")


def in_words(value):
    return f"{value:.10g}" if isinstance(value, float) else value or "none"


WORDS = {"flag": "true or false", "text": "text", "frame": "tf frame", "vector": "three numbers", "texts": "list of texts"}


def row_of(name, kind, default, bounds):
    """As the page should have it."""
    limits = (", ".join(bounds) if kind == "choice" else
              f"{in_words(bounds[0])} to {in_words(bounds[1])}" if bounds else WORDS[kind])
    return f"| `{name}` | {in_words(default)} | {limits} |"


def parameter_faults(text, expected):
    """Of a page with '### node' under '## Parameters', and rows of name, default, range, meaning."""
    faults = [f"no heading '### {node}'" for node in expected if node not in subheadings(text, "Parameters")]
    faults += [f"there is no node '{node}'" for node in subheadings(text, "Parameters") if node not in expected]
    for node, wanted in expected.items():
        rows = {row[0].strip("`"): row for row in rows_under(text, "Parameters", node)}
        faults += [f"{node} has no parameter '{name}'" for name in rows if name not in wanted]
        for name, (kind, default, bounds) in wanted.items():
            row = rows.get(name)
            right = row is not None and same(row[1], default)
            if right and kind == "choice":
                right = [word.strip("` ") for word in row[2].split(",")] == bounds
            elif right and bounds:
                ends = row[2].split(" to ")
                right = len(ends) == 2 and same(ends[0], bounds[0]) and same(ends[1], bounds[1])
            elif right:
                right = row[2] == WORDS[kind]
            if not right:
                faults.append(f"{node}: the code has {row_of(name, kind, default, bounds)}, the page {row}")
    return faults


def topic_faults(text, expected):
    """Rows of topic, type, from, to. Nodes are in backticks; what is not ours is plain text."""
    known, faults = set(code.nodes()) | {"rviz"}, []
    said = {}
    for topic, _, sender, taker, *_ in rows_under(text, "Topics"):
        for name in quoted(topic):
            said[name] = {"from": set(quoted(sender)) & known, "to": set(quoted(taker)) & known}
    wanted = {}
    for topic, way, who in expected:
        wanted.setdefault(topic, {"from": set(), "to": set()})[way].add(who)
    for topic in sorted(set(said) | set(wanted)):
        if said.get(topic) != wanted.get(topic):
            faults.append(f"topic {topic}: the page has {said.get(topic)}, the code {wanted.get(topic)}")
    return faults


def launch_faults(text, folder=ROOT / "launch"):
    """'### file' under '## Launch files', rows of argument, default."""
    faults, files = [], {path.name: path for path in sorted(folder.glob("*.launch"))}
    faults += [f"no heading '### {name}'" for name in files if name not in subheadings(text, "Launch files")]
    faults += [f"there is no {name}" for name in subheadings(text, "Launch files") if name not in files]
    for name, path in files.items():
        rows = {row[0].strip("`"): row[1].strip("`") for row in rows_under(text, "Launch files", name) if row[0]}
        wanted = {}
        for argument in xml.parse(path).getroot().findall("arg"):
            default = argument.get("default", "required").replace("$(find tensegric_fit)/", "") or "none"
            wanted[argument.get("name")] = "by `plain`" if "eval" in default else default
        for argument in sorted(set(rows) | set(wanted)):
            written, value = rows.get(argument), wanted.get(argument)
            if (written or "").replace("`", "") != (value or "").replace("`", "") or (written is None) != (value is None):
                faults.append(f"{name}: argument '{argument}': the page has {written}, the file {value}")
    return faults


def twice_named(root=ROOT):
    """Launch files of one name: roslaunch finds them by name anywhere in a package, and starts neither of two."""
    files = sorted(path for path in root.rglob("*.launch") if "build" not in path.relative_to(root).parts)
    return [str(path.relative_to(root)) for path in files if sum(path.name == other.name for other in files) > 1]


def range_faults(rows, expected):
    """Of rows of key, range: each number's range as the code has it."""
    said = {key: row[1] for row in rows for key in quoted(row[0])}
    faults = []
    for key, bounds in expected.items():
        ends = said.get(key, "").split(" to ")
        if len(ends) != 2 or not all(map(same, ends, bounds)):
            faults.append(f"{key}: the page has {said.get(key)}, the code {' to '.join(map(in_words, bounds))}")
    return faults


def anchors(path):
    """Of headings, as GitHub makes them."""
    return {re.sub(r"[^\w\- ]", "", words.strip().lower()).replace(" ", "-")
            for words in re.findall(r"^#+ (.*)$", path.read_text(encoding="utf-8"), re.M)}


def link_faults(path, root=ROOT):
    faults = []
    for number, line in enumerate(without_code(path.read_text(encoding="utf-8")), 1):
        for target in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"`[^`]*`", "", line)):
            if re.match(r"[a-z]+:", target):
                continue
            file, _, anchor = target.partition("#")
            other = (path.parent / file).resolve() if file else path
            where = f"{path.relative_to(root)}:{number}: {target}"
            if not other.exists():
                faults.append(where + " is not there")
            elif anchor and other.suffix == ".md" and anchor not in anchors(other):
                faults.append(where + " has no such heading")
    return faults


def cell_faults(path, root=ROOT):
    return [f"{path.relative_to(root)}:{number}: a cell of {len(cell)} characters: {cell[:60]}..."
            for number, line in enumerate(without_code(path.read_text(encoding="utf-8")), 1) if line.startswith("|")
            for cell in cells(line) if len(cell) > CELL]


def page(name):
    return (PAGES / name).read_text(encoding="utf-8")


class Interface(unittest.TestCase):
    """launch/pages/ros_interface.md"""

    def setUp(self):
        self.text = page("ros_interface.md")

    def test_parameters(self):
        self.assertEqual(parameter_faults(self.text, code.parameters()), [])

    def test_topics(self):
        self.assertEqual(topic_faults(self.text, code.topics()), [])

    def test_services_and_actions(self):
        rows = rows_under(self.text, "Services and action")
        said = {(quoted(row[0])[0], quoted(row[2])[0]) for row in rows}
        self.assertEqual(said, code.services() | code.actions())

    def test_messages(self):
        said = {name for row in rows_under(self.text, "Messages") for name in quoted(row[0])}
        files = {path.name for folder in ("msg", "srv", "action") for path in (ROOT / folder).iterdir()}
        self.assertEqual(said, files)

    def test_launch_files(self):
        self.assertEqual(launch_faults(self.text), [])

    def test_launch_files_have_names_of_their_own(self):
        self.assertEqual(twice_named(), [])


class Files(unittest.TestCase):
    """What people write, and what they read."""

    def test_options(self):
        text = page("programs.md")
        for program, file in (("fit", "fit/command_line.cpp"), ("correlate", "fit/correlate_line.cpp")):
            said = {word for row in rows_under(text, program) for word in re.findall(r"--[a-z-]+", row[0])}
            self.assertEqual(said, code.options(file), program)
        said = set(re.findall(r"--[a-z-]+", page("many_scans.md")))
        self.assertEqual(code.options("batch/batch_main.cpp") - said, set())

    def test_keys(self):
        text = page("garments_and_templates.md")
        for heading, ending in (("Garments", "/garment.cpp"), ("Tissue", "/tissue_file.cpp")):
            file = next(file for file in code.all_sources() if file.endswith(ending))
            rows = [row for above, rows in tables(text) if heading in above for row in rows]
            said = {key for row in rows for key in quoted(row[0])}
            self.assertEqual(said, code.keys(file), heading)
            self.assertGreater(len(code.numbers(file)), 4, heading)
            self.assertEqual(range_faults(rows, code.numbers(file)), [], heading)

    def test_keys_of_templates(self):
        text = (code.NODES / "control_mesh" / "README.md").read_text(encoding="utf-8")
        said = {word for words in quoted(text) for word in re.findall(r"\w+", words)}
        self.assertEqual(code.keys("control_mesh/load_template.cpp") - said, set())

    def test_report(self):
        text = page("results.md")
        file = next(file for file in code.all_sources() if file.endswith("fit/report.cpp"))
        for key in set(re.findall(r'\breport\["(\w+)"\]', code.source(file))):
            self.assertIn(f"`{key}`", text)

    def test_refusals(self):
        said = {code_ for row in rows_under(page("results.md"), "Refusals") for code_ in quoted(row[0])}
        names = set(re.findall(r'char k\w+\[\] =\s*"(\w+)"', code.source("geometry/status.hpp")))
        self.assertEqual(said, names)


class Rooms(unittest.TestCase):
    def test_architecture_has_every_room(self):
        rooms = {path.name for path in code.NODES.iterdir() if path.is_dir()}
        said = {quoted(row[0])[0].strip("/") for row in rows_under(page("architecture.md"), "Rooms")}
        self.assertEqual(said, rooms)

    def test_the_picture_is_of_these_rooms(self):
        self.assertEqual(rooms_picture.edges_in(rooms_picture.PICTURE), rooms_picture.edges_of(code.NODES),
                         "make it again: tests/rooms_picture.py")


class Pages(unittest.TestCase):
    def test_links(self):
        self.assertEqual([fault for path in markdown_files() for fault in link_faults(path)], [])

    def test_readme_is_short(self):
        self.assertLessEqual(len((ROOT / "README.md").read_text(encoding="utf-8").splitlines()), README_LINES)

    def test_cells_are_short(self):
        self.assertEqual([fault for path in markdown_files() for fault in cell_faults(path)], [])

    def test_every_page_is_linked(self):
        text = (ROOT / "README.md").read_text(encoding="utf-8")
        for path in markdown_files():
            if path.parent in (PAGES, ROOT) and path.name != "README.md":
                self.assertIn(f"({path.relative_to(ROOT)})", text)


class Schema(unittest.TestCase):
    def test_codes_of_warnings_and_notices(self):
        header = (ROOT / "nodes" / "geometry" / "fit_warning.hpp").read_text()
        words = re.findall(r"namespace (?:warning|notice) \{(.*?)\n\}", header, re.DOTALL)
        codes = {code for text in words for code in re.findall(r'k\w+\[\] = "(\w+)"', text)}
        self.assertGreater(len(codes), 5)
        schema = json.loads((ROOT / "launch" / "schemas" / "fit.schema.json").read_text())
        listed = schema["definitions"]["warnings"]["items"]["properties"]["code"]["enum"]
        self.assertEqual(codes, set(listed))


class FaultsAreFound(unittest.TestCase):
    """On pages that are made up."""

    PAGE = "## Parameters\n### tffd\n| a | b | c | d |\n| --- | --- | --- | --- |\n{}\n## Topics\n"
    NODE = {"tffd": {"beta": ("number", 0.0, (0.0, 20.0)), "setting": ("choice", "paper", ["paper", "x"])}}
    RIGHT = "| `beta` | 0 | 0 to 20 | |\n| `setting` | `paper` | `paper`, `x` | |"

    def test_parameters(self):
        self.assertEqual(parameter_faults(self.PAGE.format(self.RIGHT), self.NODE), [])
        for wrong, right in (("| 0 to 20 |", "| 0 to 21 |"), ("| 0 | 0", "| 1 | 0"), ("`beta`", "`bete`"), (", `x`", ""),
                             ("### tffd", "### tfft")):
            faults = parameter_faults(self.PAGE.format(self.RIGHT).replace(wrong, right), self.NODE)
            self.assertNotEqual(faults, [], right)
        more = self.RIGHT + "\n| `gamma` | 0 | 0 to 1 | |"
        self.assertEqual(parameter_faults(self.PAGE.format(more), self.NODE), ["tffd has no parameter 'gamma'"])

    def test_parameters_in_the_code(self):
        found = code.parameters()
        self.assertEqual(set(found), set(code.nodes()))
        self.assertEqual(found["tensegric"]["solver"][1], "equilibrium")  # an enum's default, by way of two structs
        self.assertEqual(found["assembler"]["slop"][1:], (0.2, (0.0, 60.0)))
        used = sum(len(re.findall(r"\bparameters\.(?:" + "|".join(code.KINDS) + r")\s*\(", code.source(file)))
                   for file in code.all_sources())
        seen = {(file, name) for main in code.nodes().values() for file in code.files_of(main)
                for match, (name, *_) in code.calls(code.source(file), r"\bparameters\.(?:" + "|".join(code.KINDS) + ")")}
        self.assertEqual(len(seen), used, "a parameter is read in a file that no node draws in")

    def test_topics(self):
        head = "## Topics\n| a | b | c | d |\n| --- | --- | --- | --- |\n"
        expected = {("body/mesh", "from", "reconstruction"), ("body/mesh", "to", "tffd")}
        self.assertEqual(topic_faults(head + "| `body/mesh` | | `reconstruction` | `tffd`, a bag |", expected), [])
        for row in ("| `body/mesh` | | `reconstruction` | |", "| `body/mush` | | `reconstruction` | `tffd` |", ""):
            self.assertNotEqual(topic_faults(head + row, expected), [])

    def test_launch_arguments(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "a.launch").write_text('<launch><arg name="bag"/><arg name="rate" default="0"/></launch>')
            text = "## Launch files\n### a.launch\n| a | b |\n| --- | --- |\n| `bag` | required |\n| `rate` | 0 |\n"
            self.assertEqual(launch_faults(text, folder), [])
            for wrong, right in (("| 0 |", "| 1 |"), ("| `rate` | 0 |", ""), ("`bag`", "`bug`"), ("a.launch", "b.launch")):
                self.assertNotEqual(launch_faults(text.replace(wrong, right), folder), [])

    def test_launch_files_of_one_name(self):
        with tempfile.TemporaryDirectory() as name:
            root = pathlib.Path(name)
            for file in ("launch/a.launch", "launch/b.launch", "tests/a.launch", "build/b.launch"):
                (root / file).parent.mkdir(exist_ok=True)
                (root / file).write_text("<launch/>")
            self.assertEqual(twice_named(root), ["launch/a.launch", "tests/a.launch"])

    def test_ranges(self):
        expected = {"ratio": (0.05, 10.0)}
        self.assertEqual(range_faults([["`ratio`", "0.05 to 10"]], expected), [])
        for row in (["`ratio`", "0.3 to 1.5"], ["`ratio`", "any"], ["`width`", "0.05 to 10"]):
            self.assertEqual(len(range_faults([row], expected)), 1)

    def test_links_and_cells(self):
        with tempfile.TemporaryDirectory() as name:
            root = pathlib.Path(name)
            path = root / "a.md"
            path.write_text("# One thing\n[a](a.md#one-thing) [b](b.md) [c](#two) `[d](d.md)`\n\n    [e](e.md)\n")
            self.assertEqual(link_faults(path, root), ["a.md:2: b.md is not there", "a.md:2: #two has no such heading"])
            path.write_text("| " + "x" * CELL + " |\n| " + "x" * (CELL + 1) + " |\n")
            self.assertEqual(len(cell_faults(path, root)), 1)


if __name__ == "__main__":
    assert rooms_test.NODES == code.NODES
    unittest.TestCase.maxDiff = None
    unittest.main()
