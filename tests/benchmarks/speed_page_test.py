#!/usr/bin/env python3
"""The baseline of speed_guard names the stages that are measured, and the page says what was not found."""
import math
import pathlib
import re
import unittest

import speed_data
import speed_sections

FOLDER = pathlib.Path(__file__).resolve().parent


class Baseline(unittest.TestCase):
    def test_names_are_those_of_the_stages(self):
        measured = re.findall(r'measure\("(\w+)"', (FOLDER / "stage_costs.cpp").read_text(encoding="utf-8"))
        recorded = re.findall(r"^  (\w+): \{kernels", (FOLDER / "speed_baseline.yaml").read_text(encoding="utf-8"), re.M)
        self.assertEqual(recorded, measured, 'record it: speed_guard --update --reason "..."')


class Page(unittest.TestCase):
    def test_a_stage_that_one_side_lacks(self):
        row = {"stage": "tffd", "ms": 1.5, "kernels": 0.4, "baseline_kernels": None, "spread": 1.1, "time_ratio": None, "time": "FAILS",
               "mib": 2.0, "baseline_mib": None, "memory_ratio": None, "memory": "FAILS", "rounds": 7}
        text = speed_sections.guard_section([row])
        self.assertIn("Guard: fails", text)
        self.assertIn(">tffd<", text)

    def test_a_figure_that_was_not_found(self):
        run = {"run_type": "iteration", "run_name": "by_depth/9", "cpu_time": 5.0, "real_time": 5.0}
        results = speed_data.gather([{**run, "girth_mm": value} for value in (1.0, math.nan, 2.0)])
        self.assertEqual(speed_sections.number(results["by_depth/9"].value("girth_mm")), "not found")
        self.assertEqual(speed_sections.number(speed_data.gather([{**run, "girth_mm": 1.5}])["by_depth/9"].value("girth_mm")), "1.50")


if __name__ == "__main__":
    unittest.main()
