#!/usr/bin/env python3
"""The program fit_batch: manifests, workers that crash or hang, kills, shards, merging.

Usage: fit_batch_test.py FOLDER_OF_THE_PROGRAMS"""
import csv
import fcntl
import json
import os
import pathlib
import shutil
import signal
import sqlite3
import stat
import struct
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAMS = pathlib.Path(sys.argv.pop())
WOMEN = 2


def fit_batch(*arguments):
    return subprocess.run([PROGRAMS / "fit_batch", *map(str, arguments), "--quiet"], capture_output=True, text=True, check=False)


def lines_of(folder):
    return [json.loads(line) for file in sorted(folder.glob("*.jsonl")) for line in file.read_text().splitlines()]


def without_cost(line):
    return {key: value for key, value in line.items() if key != "cost"}


def take_for_another_builds(folder):
    """All that is in the folder becomes as if another build had written it."""
    own = json.loads((folder / "batch.json").read_text())["build"]
    for file in folder.iterdir():
        file.write_text(file.read_text().replace(own, len(own) * "0"))


def workers_of(process):
    """Process numbers. One that has not become the program yet does not count: its parent waits for that, for ever where it is stopped."""
    children = [n for task in pathlib.Path(f"/proc/{process}/task").glob("*/children") for n in task.read_text().split()]
    return [int(n) for n in children if b"worker" in pathlib.Path(f"/proc/{n}/cmdline").read_bytes().split(b"\0")]


def has_ended(process):
    """Also where the process that inherits orphans, as in some containers, never asks how they ended."""
    try:
        return pathlib.Path(f"/proc/{process}/stat").read_text(encoding="utf-8").rsplit(")", 1)[1].split()[0] == "Z"
    except (FileNotFoundError, ProcessLookupError):
        return True


def wait_until(true, seconds=60):
    end = time.monotonic() + seconds
    while not true():
        if time.monotonic() > end:
            raise AssertionError("waited in vain")
        time.sleep(0.02)


class FitBatch(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="fit_batch_test_"))
        for n in range(1, WOMEN + 1):
            subprocess.run([PROGRAMS / "virtual_booth", "--customer", str(n), "--out", cls.folder / f"w{n}"], check=True,
                           stdout=subprocess.DEVNULL)
        rows = [(f"woman {n}", f"w{n}/body.ply", "B1", "0.95") for n in range(1, WOMEN + 1)]
        rows += [("again", "w1/body.ply", "B1", "0.95"), ("refused", "broken.ply", "", "")]
        (cls.folder / "broken.ply").write_text("no mesh")
        cls.rows = len(rows)
        cls.manifest = cls.folder / "manifest.csv"
        with open(cls.manifest, "w", encoding="utf-8", newline="") as file:
            csv.writer(file).writerows([("name", "mesh", "garment", "ratio"), *rows])
        cls.whole = cls.folder / "whole"
        done = fit_batch(cls.manifest, "--out", cls.whole, "--jobs", 2)
        assert done.returncode == 0, done.stderr
        assert fit_batch("merge", cls.whole, "--out", cls.folder / "merged").returncode == 0
        cls.table = (cls.folder / "merged/table.csv").read_bytes()

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def start(self, *arguments):
        return subprocess.Popen([PROGRAMS / "fit_batch", *map(str, arguments), "--quiet"], stderr=subprocess.DEVNULL)

    def code_where_a_worker_gets(self, number, folder):
        process = self.start(self.manifest, "--out", folder, "--jobs", 1)
        wait_until(lambda: workers_of(process.pid))
        time.sleep(0.2)
        os.kill(workers_of(process.pid)[0], number)
        return process.wait()

    def merged(self, *folders):
        """Exit code of the merger and the table."""
        out = self.folder / "merged_again"
        shutil.rmtree(out, ignore_errors=True)
        code = fit_batch("merge", *folders, "--out", out).returncode
        return code, (out / "table.csv").read_bytes()

    def test_every_row_has_its_line(self):
        lines = {line["name"]: line for line in lines_of(self.whole)}
        self.assertEqual(len(lines), self.rows)
        self.assertEqual(lines["refused"]["reason"]["code"], "broken_file")
        for n in range(1, WOMEN + 1):
            line = lines[f"woman {n}"]
            self.assertEqual(line["status"], "ok")
            self.assertEqual(line["result"]["solver"]["status"], "converged")
            self.assertGreater(line["cost"]["peak_MB"], 1)
        self.assertEqual(lines["again"]["key"], lines["woman 1"]["key"])
        self.assertEqual(lines["again"]["result"], lines["woman 1"]["result"])
        self.assertEqual(sum("cost" in lines[name] for name in ("again", "woman 1")), 1)  # computed once

    def test_figures_are_those_of_fit(self):
        out = self.folder / "fit"
        subprocess.run([PROGRAMS / "fit", "--mesh", self.folder / "w1/body.ply", "--garment", "B1", "--ratio", "0.95", "--out",
                        out, "--quiet"], check=True)
        report = json.loads((out / "report.json").read_text())
        line = next(line for line in lines_of(self.whole) if line["name"] == "woman 1")
        for part in ("girths", "heights", "landmarks", "confidence", "lines", "effects", "regions"):
            self.assertEqual(line["result"][part], report[part], part)

    def test_started_again_it_has_nothing_to_do(self):
        before = lines_of(self.whole)
        self.assertEqual(fit_batch(self.manifest, "--out", self.whole).returncode, 0)
        self.assertEqual(lines_of(self.whole), before)

    def test_gnu_parallel_starts_shards_that_failed_again(self):
        if shutil.which("parallel") is None:
            self.skipTest("GNU parallel is not installed: shards were not run by it")
        out = self.folder / "parallel"
        out.mkdir()
        (out / "shard-2").write_text("a file where the folder should be")
        command = ["parallel", "--will-cite", "--joblog", out / "log.txt", "--resume-failed", PROGRAMS / "fit_batch", self.manifest,
                   "--out", out / "shard-{}", "--shard", "{}/2", "--jobs", "1", "--quiet"]
        run = lambda: subprocess.run(command, input="1\n2\n", text=True, capture_output=True, check=False,
                                     env={**os.environ, "HOME": str(out)}).returncode
        self.assertEqual(run(), 1)  # so many shards failed
        self.assertEqual(self.merged(out / "shard-1")[0], 4)
        (out / "shard-2").unlink()
        self.assertEqual(run(), 0)
        with open(out / "log.txt", encoding="utf-8", newline="") as file:
            shards = [row["Command"].split("--shard ")[1].split("/")[0] for row in csv.DictReader(file, delimiter="\t")]
        self.assertEqual(sorted(shards), ["1", "2", "2"])
        self.assertEqual(self.merged(out / "shard-1", out / "shard-2"), (0, self.table))

    def test_killed_at_any_time_it_goes_on(self):
        folder = self.folder / "killed"
        for seconds in (0.3, 1.6):
            process = self.start(self.manifest, "--out", folder, "--jobs", 2)
            time.sleep(seconds)
            process.kill()
            process.wait()
        shard = folder / "shard-1-of-1.jsonl"
        with open(shard, "a", encoding="utf-8") as file:
            file.write('{"row": 1, "torn')
        self.assertEqual(fit_batch(self.manifest, "--out", folder).returncode, 0)
        self.assertEqual(self.merged(folder), (0, self.table))

    def test_one_worker_gives_the_same_bytes(self):
        folder = self.folder / "alone"
        self.assertEqual(fit_batch(self.manifest, "--out", folder, "--jobs", 1).returncode, 0)
        self.assertEqual(self.merged(folder), (0, self.table))

    def test_shards_make_the_whole_in_any_order(self):
        folders = [self.folder / f"part{i}" for i in (1, 2)]
        for i, folder in enumerate(folders, 1):
            self.assertEqual(fit_batch(self.manifest, "--out", folder, "--shard", f"{i}/2").returncode, 0)
        self.assertEqual(self.merged(*folders), (0, self.table))
        self.assertEqual(self.merged(*reversed(folders)), (0, self.table))
        code, _ = self.merged(folders[0])
        self.assertEqual(code, 4)

    def test_a_crash_takes_one_scan_with_it(self):
        folder = self.folder / "crash"
        self.assertEqual(self.code_where_a_worker_gets(signal.SIGSEGV, folder), 0)
        lines = {line["row"]: line for line in lines_of(folder)}
        crashed = [line for line in lines.values() if line["status"] == "crashed"]
        self.assertEqual(len(lines), self.rows)
        self.assertIn(len({line["key"] for line in crashed}), (1,))
        self.assertIn("signal 11", crashed[0]["reason"]["message"])
        self.assertEqual(fit_batch(self.manifest, "--out", folder, "--retry").returncode, 0)
        self.assertEqual(self.merged(folder), (0, self.table))

    def test_a_worker_that_is_interrupted_leaves_its_row_to_the_next_start(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            folder = self.folder / f"interrupted_{int(number)}"
            self.assertEqual(self.code_where_a_worker_gets(number, folder), 130)
            self.assertEqual(len(lines_of(folder)), self.rows - 1)
            self.assertNotIn("crashed", [line["status"] for line in lines_of(folder)])
            self.assertEqual(fit_batch(self.manifest, "--out", folder).returncode, 0)
            self.assertEqual(self.merged(folder), (0, self.table))

    def test_a_hang_takes_one_scan_with_it(self):
        folder = self.folder / "hang"
        process = self.start(self.manifest, "--out", folder, "--jobs", 1, "--time", 20)
        wait_until(lambda: workers_of(process.pid))
        os.kill(workers_of(process.pid)[0], signal.SIGSTOP)
        self.assertEqual(process.wait(), 0)
        self.assertTrue(any(line["status"] == "timed_out" for line in lines_of(folder)))
        self.assertTrue(any(line["status"] == "ok" for line in lines_of(folder)))

    def test_too_much_memory_takes_one_scan_with_it(self):
        facets = 10_000_000  # 0.5 GB that are not on the disk; as corners and triangles another 0.9 GB
        with open(self.folder / "large.stl", "wb") as file:
            file.write(bytes(80) + struct.pack("<I", facets))
            file.truncate(84 + 50 * facets)
        manifest, folder = self.folder / "large.csv", self.folder / "memory"
        manifest.write_text("mesh,garment\nlarge.stl,B1\nw1/body.ply,B1\n")
        self.assertEqual(fit_batch(manifest, "--out", folder, "--jobs", 1, "--memory", 1).returncode, 0)
        lines = {line["row"]: line for line in lines_of(folder)}
        self.assertEqual({row: line["status"] for row, line in lines.items()}, {1: "out_of_memory", 2: "ok"}, lines[1]["reason"])

    def test_two_at_once_on_one_shard_are_refused(self):
        folder = self.folder / "both"
        folder.mkdir()
        with open(folder / "shard-1-of-1.jsonl", "w", encoding="utf-8") as file:
            fcntl.flock(file, fcntl.LOCK_EX)
            done = fit_batch(self.manifest, "--out", folder)
        self.assertEqual(done.returncode, 1)
        self.assertIn("another fit_batch", done.stderr)

    def test_results_are_for_their_owner_only(self):
        for file in [*self.whole.iterdir(), *(self.folder / "merged").iterdir()]:
            self.assertEqual(stat.S_IMODE(file.stat().st_mode) & 0o077, 0, file)

    def test_database_has_what_the_table_has(self):
        with sqlite3.connect(self.folder / "merged/table.sqlite") as database:
            rows = database.execute("SELECT row, status FROM runs ORDER BY row").fetchall()
            bust = dict(database.execute("SELECT row, value FROM figures WHERE figure = 'girths.bust'"))
        with open(self.folder / "merged/table.csv", encoding="utf-8", newline="") as file:
            table = list(csv.DictReader(file))
        self.assertEqual([(int(row["row"]), row["status"]) for row in table], rows)
        self.assertEqual({int(row["row"]): float(row["girths.bust"]) for row in table if row["girths.bust"]}, bust)

    def test_drift_against_another_version(self):
        other = self.folder / "other.csv"
        with open(self.folder / "merged/table.csv", encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        rows[1]["girths.bust"] = str(float(rows[1]["girths.bust"]) - 0.004)
        rows[1]["status"] = "refused"
        rows[1]["solver.status"] = "capped"
        rows[1]["girths.hip"] = ""
        refused = next(row for row in rows if row["status"] == "refused" and row["subject"] and row is not rows[1])
        refused["reason"] = "other_reason"
        rows.append({**rows[0], "row": "99", "subject": "gone"})
        with open(other, "w", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, rows[0])
            writer.writeheader()
            writer.writerows(rows)
        out = self.folder / "drift"
        self.assertEqual(fit_batch("merge", self.whole, "--out", out, "--against", other).returncode, 0)
        page = (out / "index.html").read_text()
        drifted = page[page.index("Against the other table"):page.index("<h2>Girths")]
        self.assertIn("<td>girths.bust</td>", drifted)
        self.assertIn("0.004", drifted)
        self.assertNotIn("<td>girths.waist</td>", drifted)
        self.assertIn("row 2: refused before, ok now", drifted)
        self.assertRegex(drifted, r"row \d+: refused \(other_reason\) before, refused \(\w+\) now")
        self.assertIn(" scans in common, 0 in this table alone, 1 in the other alone; 2 with another status or reason", drifted)
        self.assertIn("solver.status: another text in 1 scans, new in 0, gone in 0", drifted)
        self.assertIn("girths.hip: another text in 0 scans, new in 1, gone in 0", drifted)
        other.write_text("row,name\n1,woman\n")
        self.assertEqual(fit_batch("merge", self.whole, "--out", out, "--against", other).returncode, 3)

    def test_of_several_manifests_the_last_counts(self):
        folder, manifest, tables = self.folder / "changed", self.folder / "changed.csv", []
        for ratio in ("0.95", "0.93", "0.95"):
            manifest.write_text(f"mesh,garment,ratio\nw1/body.ply,B1,{ratio}\nw2/body.ply,,\n")
            self.assertEqual(fit_batch(manifest, "--out", folder).returncode, 0)
            tables.append(self.merged(folder))
        self.assertEqual(tables[0][0], 0)
        self.assertEqual(tables[0], tables[2])
        self.assertNotEqual(tables[0], tables[1])
        manifest.write_text("mesh\nw2/body.ply\n")  # fewer rows
        self.assertEqual(fit_batch(manifest, "--out", folder).returncode, 0)
        code, table = self.merged(folder)
        self.assertEqual((code, table.count(b"\n")), (0, 2))
        description = json.loads((folder / "batch.json").read_text())  # a run that was ended at its first row
        (folder / "batch.json").write_text(json.dumps({**description, "build": "another"}))
        self.assertEqual(self.merged(folder)[0], 4)
        other, beside = self.folder / "other_manifest.csv", self.folder / "changed_too"
        other.write_text("mesh\nbroken.ply\n")  # as many rows
        self.assertEqual(fit_batch(other, "--out", beside).returncode, 0)
        done = fit_batch("merge", folder, beside, "--out", self.folder / "mixed")
        self.assertEqual(done.returncode, 3)
        self.assertIn("another manifest", done.stderr)

    def test_folders_of_different_builds_are_refused(self):
        other = self.folder / "other_build"
        shutil.copytree(self.whole, other)
        take_for_another_builds(other)
        done = fit_batch("merge", self.whole, other, "--out", self.folder / "two_builds")
        self.assertEqual(done.returncode, 3)
        self.assertIn("another build", done.stderr)

    def test_a_scan_that_cannot_be_read_has_a_line_of_each_build(self):
        manifest, folder = self.folder / "not_there.csv", self.folder / "not_there"
        manifest.write_text("mesh\nnot_there.ply\n")
        for _ in range(2):
            self.assertEqual(fit_batch(manifest, "--out", folder).returncode, 0)
            self.assertEqual(self.merged(folder)[0], 0)
            take_for_another_builds(folder)
        self.assertEqual(len(lines_of(folder)), 2)

    def test_a_folder_that_others_wrote_is_refused(self):
        folder = self.folder / "of_others"
        deep = "[" * 1000000 + "]" * 1000000
        whole = json.loads((self.whole / "batch.json").read_text())
        line = next(line for line in lines_of(self.whole) if line["status"] == "ok")
        descriptions = [json.dumps({**whole, **change}) for change in
                        ({"rows": "3"}, {"rows": -1}, {"rows": 10 ** 15}, {"build": 5}, {"manifest_identity": None})]
        lines = [json.dumps({**line, **change}) for change in
                 ({"row": 0}, {"name": 5}, {"inputs": "a"}, {"settings": []}, {"status": "refused"}, {"status": None}, {"reason": "none"},
                  {"result": 5}, {"cost": {"seconds": "long"}})]
        lines.append(json.dumps({part: value for part, value in line.items() if part != "inputs"}))
        for description, text in [*((each, "") for each in [*descriptions, "{}", deep]), *((json.dumps(whole), each) for each in [*lines, deep])]:
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir()
            (folder / "batch.json").write_text(description)
            (folder / "shard-1-of-1.jsonl").write_text(text + "\n" if text else "")
            done = subprocess.run([PROGRAMS / "fit_batch", "merge", folder, "--out", self.folder / "of_others_merged"], capture_output=True, text=True,
                                  timeout=60, check=False)
            self.assertEqual((done.returncode, "broken_file" in done.stderr), (3, True), (description[:100], text[:100], done.stderr))

    def test_lines_of_an_earlier_build_may_lack_parts(self):
        folder = self.folder / "of_earlier_build"
        shutil.copytree(self.whole, folder)
        with open(folder / "shard-1-of-9.jsonl", "w", encoding="utf-8") as file:
            file.write(json.dumps({"row": 1, "key": "a", "status": "ok", "build": "earlier"}) + "\n")
        self.assertEqual(self.merged(folder), (0, self.table))

    def test_a_folder_from_before_manifests_had_an_identity_is_merged(self):
        folder = self.folder / "without_identity"
        shutil.copytree(self.whole, folder)
        description = json.loads((folder / "batch.json").read_text())
        description.pop("manifest_identity")
        (folder / "batch.json").write_text(json.dumps(description))
        for file in folder.glob("*.jsonl"):
            lines = [json.loads(text) for text in file.read_text().splitlines()]
            file.write_text("".join(json.dumps({part: value for part, value in line.items() if part != "manifest"}) + "\n" for line in lines))
        self.assertEqual(self.merged(folder), (0, self.table))

    def test_a_pipe_is_no_scan(self):
        manifest, folder = self.folder / "pipe.csv", self.folder / "pipe"
        os.mkfifo(self.folder / "pipe.ply")
        manifest.write_text("mesh\npipe.ply\n")
        subprocess.run([PROGRAMS / "fit_batch", manifest, "--out", folder, "--quiet"], check=True, timeout=60)
        self.assertEqual(lines_of(folder)[0]["reason"]["code"], "broken_file")

    def test_a_result_counts_before_a_line_without_one_in_a_file_of_other_shards(self):
        folder = self.folder / "other_shards"
        shutil.copytree(self.whole, folder)
        line = next(line for line in lines_of(folder) if line["row"] == 1)
        line.pop("result")
        line.update(status="timed_out", reason={"code": "timed_out", "message": ""})
        for shards in (0, 2):  # by name before and behind the file that has the result
            (folder / f"shard-1-of-{shards}.jsonl").write_text(json.dumps(line) + "\n")
        self.assertEqual(self.merged(folder), (0, self.table))

    def test_results_of_different_scans_in_files_of_other_shards_are_a_conflict(self):
        folder = self.folder / "changed_scan"
        shutil.copytree(self.whole, folder)
        line = next(line for line in lines_of(folder) if line["row"] == 1)
        line["key"] = "another"
        for shards in (0, 2):  # by name before and behind the other
            path = folder / f"shard-1-of-{shards}.jsonl"
            path.write_text(json.dumps(line) + "\n")
            self.assertEqual(self.merged(folder)[0], 4)
            path.unlink()
        self.assertEqual(self.merged(folder), (0, self.table))

    def test_results_stay_where_their_scans_were_moved(self):
        place, folder, out = self.folder / "moved", self.folder / "moved/results", self.folder / "moved/table"
        place.mkdir()
        manifest, mesh = place / "manifest.csv", place / "body.ply"
        manifest.write_text("mesh\nbody.ply\n")
        shutil.copy(self.folder / "w1/body.ply", mesh)
        self.assertEqual(fit_batch(manifest, "--out", folder).returncode, 0)
        lines, table = lines_of(folder), self.merged(folder)
        self.assertEqual((len(lines), table[0]), (1, 0))
        self.assertEqual(fit_batch("merge", folder, "--out", out, "--pictures", 1).stderr, "")
        self.assertTrue((out / "least_sure/1/front.png").exists())
        shutil.rmtree(out)
        mesh.unlink()
        self.assertEqual(fit_batch(manifest, "--out", folder).returncode, 0)
        self.assertEqual(lines_of(folder), lines)
        lost = {part: value for part, value in lines[0].items() if part not in ("result", "cost")}
        lost.update(key="", subject="", status="refused", reason={"code": "broken_file", "message": "cannot be read"})
        with open(folder / "shard-1-of-1.jsonl", "a", encoding="utf-8") as file:  # as earlier builds did
            file.write(json.dumps(lost) + "\n")
        self.assertEqual(self.merged(folder), table)
        for _ in range(2):
            done = fit_batch("merge", folder, "--out", out, "--pictures", 1)
            self.assertEqual(done.returncode, 0)
            self.assertIn("row 1: no picture", done.stderr)
            self.assertFalse((out / "least_sure").exists())
            shutil.copy(self.folder / "w2/body.ply", mesh)  # somebody else

    def test_names_are_no_formulas_of_a_spreadsheet(self):
        manifest, folder = self.folder / "names.jsonl", self.folder / "names"
        names = ["=1+2", "+1", "-1", "@a", "a=1"]
        manifest.write_text("".join(json.dumps({"name": name, "mesh": "broken.ply"}) + "\n" for name in names))
        self.assertEqual(fit_batch(manifest, "--out", folder).returncode, 0)
        self.assertEqual([line["name"] for line in lines_of(folder)], names)
        self.assertEqual(fit_batch("merge", folder, "--out", folder / "table").returncode, 0)
        with open(folder / "table/table.csv", encoding="utf-8", newline="") as file:
            self.assertEqual([row["name"] for row in csv.DictReader(file)], ["'=1+2", "'+1", "'-1", "'@a", "a=1"])
        with sqlite3.connect(folder / "table/table.sqlite") as database:
            self.assertEqual([name for name, in database.execute("SELECT name FROM runs ORDER BY row")], names)

    def test_a_file_does_not_take_the_place_of_a_shipped_garment(self):
        place = self.folder / "beside"
        place.mkdir()
        (place / "B1").write_text("no garment")
        shutil.copy(self.folder / "w1/body.ply", place)
        (place / "manifest.csv").write_text("mesh,garment,ratio\nbody.ply,B1,0.95\n")
        self.assertEqual(fit_batch(place / "manifest.csv", "--out", place / "out").returncode, 0)
        line = lines_of(place / "out")[0]
        self.assertEqual(line["key"], next(each["key"] for each in lines_of(self.whole) if each["row"] == 1))
        self.assertEqual(line["status"], "ok")

    def test_only_files_of_shards_are_merged(self):
        folder = self.folder / "with_manifest"
        shutil.copytree(self.whole, folder)
        (folder / "manifest.jsonl").write_text('{"mesh": "w1/body.ply"}\n')
        self.assertEqual(self.merged(folder), (0, self.table))

    def test_a_shard_that_has_not_begun_is_named(self):
        empty, out = self.folder / "not_begun", self.folder / "merged_with_nothing"
        empty.mkdir()
        done = fit_batch("merge", self.whole, empty, "--out", out)
        self.assertEqual(done.returncode, 0)  # no row is missing
        self.assertIn(f"{empty} has no batch.json", done.stderr)
        self.assertEqual(fit_batch("merge", empty, "--out", out).returncode, 3)

    def test_results_may_go_to_a_link_to_a_folder(self):
        manifest, link = self.folder / "to_link.csv", self.folder / "link"
        manifest.write_text("mesh\nbroken.ply\n")
        (self.folder / "behind_link").mkdir()
        link.symlink_to("behind_link")
        self.assertEqual(fit_batch(manifest, "--out", link).returncode, 0)
        self.assertEqual(self.merged(link)[0], 0)

    def test_a_refusal_names_its_own_file(self):
        manifest, tables = self.folder / "two_broken.csv", []
        for name in ("a.ply", "b.ply"):
            (self.folder / name).write_text("no mesh")
        manifest.write_text("mesh\na.ply\nb.ply\n")
        for shards in (1, 2):
            folders = [self.folder / f"refused-{n}-of-{shards}" for n in range(1, shards + 1)]
            for n, folder in enumerate(folders, 1):
                for name in ("two_broken.csv", "./two_broken.csv"):  # the second time there is nothing to do
                    done = subprocess.run([PROGRAMS / "fit_batch", name, "--out", folder, "--shard", f"{n}/{shards}", "--quiet"],
                                          cwd=self.folder, check=False)
                    self.assertEqual(done.returncode, 0)
                self.assertEqual(len(lines_of(folder)), 2 // shards)
            tables.append(self.merged(*folders))
        self.assertEqual(tables[0], tables[1])
        self.assertIn(b"b.ply: ", tables[0][1])

    def test_shards_may_share_a_folder(self):
        manifest, folder = self.folder / "many_broken.csv", self.folder / "shared"
        manifest.write_text("mesh\n" + "broken.ply\n" * 8)
        processes = [self.start(manifest, "--out", folder, "--shard", f"{n}/8", "--jobs", 1) for n in range(1, 9)]
        self.assertEqual([process.wait() for process in processes], [0] * 8)
        self.assertEqual(self.merged(folder)[0], 0)

    def test_garments_of_files_are_worn_at_once(self):
        manifest, folder = self.folder / "joined.csv", self.folder / "joined"
        garment = (pathlib.Path(__file__).parents[2] / "launch/garments/B1.yaml").read_text()
        manifest.write_text("mesh,garment\nw1/body.ply,own.yaml+H3\n")
        for ratio in ("0.95", "0.96"):  # files count by their content
            (self.folder / "own.yaml").write_text(garment.replace("ratio: 0.95", "ratio: " + ratio))
            self.assertEqual(fit_batch(manifest, "--out", folder).returncode, 0)
            line = lines_of(folder)[-1]
            self.assertEqual(line["status"], "ok", line["reason"])
            self.assertAlmostEqual(line["result"]["lines"][0]["request"], float(ratio))
            self.assertEqual(line["result"]["garment"], "B1+H3")  # by the names in the files

    def test_no_process_outlives_its_worker(self):
        manifest = self.folder / "scan.csv"
        manifest.write_text("scan\nw1/scan.ply\n")
        process = self.start(manifest, "--out", self.folder / "outlived", "--jobs", 1)
        surface = []

        def surface_is_made():
            surface[:] = [int(n) for worker in workers_of(process.pid) for task in pathlib.Path(f"/proc/{worker}/task").glob("*/children")
                          for n in task.read_text().split() if b"poisson" in pathlib.Path(f"/proc/{n}/cmdline").read_bytes()]
            return surface
        wait_until(surface_is_made)
        wait_until(lambda: os.readlink(f"/proc/{surface[0]}/fd/1") == "/dev/null")  # under way: PCL's messages go nowhere
        os.kill(surface[0], signal.SIGSTOP)
        os.kill(workers_of(process.pid)[0], signal.SIGKILL)
        wait_until(lambda: has_ended(surface[0]))
        self.assertEqual(process.wait(), 0)

    def test_bad_manifests_are_refused_by_line(self):
        cases = {
            'name,scan\n5" Anna,a.ply\n6" Eva,b.ply\n': "line 2: has a quote within a field",
            'scan\n"a.ply"b\n': "line 2: has text after a field in quotes",
            'scan\na.ply\n"b.ply\nc.ply\n': "line 3: has a field whose quotes are not closed",
            "scan,size\nw1/scan.ply,3\n": "line 1: there is no column 'size'",
            "scan,scan\n": "line 1: column 'scan' is there twice",
            "scan,ratio\nw1/scan.ply\n": "line 2: has 1 fields, the first line 2",
            "scan,garment,ratio\nw1/scan.ply,B1,seven\n": "line 2: --ratio: 'seven' is not a number",
            "scan,mesh\na.ply,b.ply\n": "line 2: --",
            "name\nnobody\n": "line 2: --scan or --mesh",
            "scan,bust_only\nw1/scan.ply,perhaps\n": "line 2: 'bust_only' is neither true nor false",
            "": "has no row",
            "scan\n": "has no row",
        }
        for text, message in cases.items():
            manifest = self.folder / "bad.csv"
            manifest.write_text(text)
            done = fit_batch(manifest, "--out", self.folder / "bad")
            self.assertEqual(done.returncode, 3, text)
            self.assertIn(message, done.stderr, text)
        manifest.write_bytes(b"scan\nM\xfcller.ply\n")
        self.assertIn("line 2: is not UTF-8", fit_batch(manifest, "--out", self.folder / "bad").stderr)
        manifest = self.folder / "bad.jsonl"
        for text, message in {'{"scan": "w1/scan.ply"}\n[1]\n': "line 2: is no JSON object",
                              '{"scan": {"a": 1}}\n': "line 1: 'scan' is no text",
                              '{"scan":' + 200000 * "[" + 200000 * "]" + "}\n": "line 1: is no JSON object, or is nested",
                              '{"colour": 1}\n': "line 1: there is no column 'colour'",
                              '{"scan": "a.ply", "ratio": 0.9, "ratio": 0.8}\n': "line 1: 'ratio' is there twice",
                              '{"scan": "a.ply", "name": ["a", "b"]}\n': "line 1: 'name' has several values"}.items():
            manifest.write_text(text)
            done = fit_batch(manifest, "--out", self.folder / "bad")
            self.assertEqual(done.returncode, 3, text)
            self.assertIn(message, done.stderr, text)

    def test_lines_of_json_read_like_rows(self):
        manifest = self.folder / "manifest.jsonl"
        with open(self.manifest, encoding="utf-8", newline="") as file:
            for row in csv.DictReader(file):
                cells = {key: value for key, value in row.items() if value}
                if "ratio" in cells:
                    cells["ratio"] = float(cells["ratio"])
                with open(manifest, "a", encoding="utf-8") as lines:
                    lines.write(json.dumps(cells) + "\n")
        folder = self.folder / "json"
        shutil.copytree(self.whole, folder)
        self.assertEqual(fit_batch(manifest, "--out", folder).returncode, 0)
        self.assertEqual(len(lines_of(folder)), self.rows)  # all were known


if __name__ == "__main__":
    unittest.main()
