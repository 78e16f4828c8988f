#!/usr/bin/env python3
"""Exit codes of all programs that people call: 0 for --help, 2 for a usage error, as their pages say, and never a signal.

Usage: exit_codes_test.py FOLDER_OF_THE_PROGRAMS"""
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAMS = (("fit",), ("fit_batch",), ("fit_batch", "merge"), ("correlate",), ("history",), ("virtual_booth",), ("forget",), ("check_bag",))
FOLDER = pathlib.Path()


def code_of(*words):
    return subprocess.run([FOLDER / words[0], *words[1:]], capture_output=True, timeout=60).returncode


class ExitCodes(unittest.TestCase):
    def test_help(self):
        for program in PROGRAMS:
            with self.subTest(program):
                self.assertEqual(code_of(*program, "--help"), 0)

    def test_usage(self):
        for program in PROGRAMS:
            for words in ((), ("--no-such-option",)):
                if (program, words) == (("virtual_booth",), ()):
                    continue  # it makes a scan
                with self.subTest(program, words=words):
                    self.assertEqual(code_of(*program, *words), 2)

    def test_no_number(self):
        for words in (("fit_batch", __file__, "--out", "nowhere", "--memory", "nan"), ("fit_batch", __file__, "--out", "nowhere", "--time", "nan"),
                      ("fit_batch", __file__, "--out", "nowhere", "--time", "inf"), ("fit", "--mesh", "a.ply", "--garment", "B1", "--twist", "nan"),
                      ("correlate", "--fit", ".", "--worn", "a.ply", "--thickness", "nan")):
            with self.subTest(words=words):
                self.assertEqual(code_of(*words), 2)

    def test_options_that_act_on_nothing(self):
        for words in (("virtual_booth", "--shape", "torus", "--seed", "3"), ("virtual_booth", "--shape", "torus", "--sensors")):
            with self.subTest(words=words):
                self.assertEqual(code_of(*words), 2)

    def test_an_unset_variable_of_a_script(self):
        for words in (("history", "/tmp", "--customer", ""), ("history", "/tmp", "--out", "page.html"), ("fit", "--mesh", ""),
                      ("fit_batch", __file__, "--out", ""), ("fit_batch", "merge", "/tmp", "--out", "")):
            with self.subTest(words=words):
                self.assertEqual(code_of(*words), 2)

    def test_a_page_in_an_export(self):
        for document in ("fit.json", "sealed.json"):
            with self.subTest(document), tempfile.TemporaryDirectory() as export:
                page = pathlib.Path(export) / "page.html"
                (pathlib.Path(export) / document).write_text("{}", encoding="utf-8")
                self.assertEqual(code_of("history", export, "--customer", "4711", "--out", page), 2)
                self.assertFalse(page.exists())

    def test_a_page_by_its_name_alone(self):
        with tempfile.TemporaryDirectory() as folder:
            for page in ("page.html", "./page.html"):
                with self.subTest(page):
                    done = subprocess.run([FOLDER / "history", ".", "--customer", "4711", "--out", page], cwd=folder, capture_output=True, text=True,
                                          check=False, timeout=60)
                    self.assertEqual(done.returncode, 1)  # there is no such customer
                    self.assertNotIn("filesystem error", done.stderr)

    def test_results_in_an_export(self):
        for document in ("fit", "sealed"):
            with self.subTest(document), tempfile.TemporaryDirectory() as export:
                (pathlib.Path(export) / f"{document}.json").write_text(f'{{"format": "tensegric_fit/{document}"}}', encoding="utf-8")
                for folder in (".", "below", "far/below"):
                    self.assertEqual(code_of("fit", "--mesh", __file__, "--out", pathlib.Path(export) / folder), 2)

    def test_a_document_of_another_program_above(self):
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "fit.json").write_text('{"format": "another program\'s"}', encoding="utf-8")
            self.assertEqual(code_of("fit", "--mesh", __file__, "--out", pathlib.Path(folder) / "below"), 3)

    def test_what_nobody_foresaw(self):
        self.assertEqual(code_of("forget", "scan", "__name:=a/b"), 3)  # no name of a node
        self.assertEqual(code_of("fit_batch", "worker", "descriptor"), 1)


if __name__ == "__main__":
    FOLDER = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
