#!/usr/bin/python3
"""One page of speed against error: runs fit_benchmark and speed_guard and writes OUT/page.html.

  speed_page.py                    everything, some minutes
  speed_page.py --page-only        the page alone, of an earlier run's OUT/benchmarks.json and guard.json
"""
import argparse
import html
import json
import pathlib
import subprocess
import sys
import time

import speed_data
import speed_sections as sections

ROOT = pathlib.Path(__file__).resolve().parents[2]
STYLE = """
:root { color-scheme: light dark; --line: #8884; --mark: #b3261e; }
body { font: 15px/1.45 system-ui, sans-serif; margin: 0 auto; max-width: 78rem; padding: 1rem; }
h1 { font-size: 1.5rem; } h2 { font-size: 1.15rem; margin: 2rem 0 .3rem; } p { max-width: 52rem; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: .87rem; margin: .4rem 0; }
th, td { border-bottom: 1px solid var(--line); padding: .15rem .6rem; text-align: left; vertical-align: top; }
td.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
td:first-child { min-width: 9rem; }
tr.default td { font-weight: 600; } tr.default td:first-child::before { content: "\\25CB  "; color: var(--mark); }
figure { margin: .5rem 0; max-width: 46rem; } figure svg { width: 100%; height: auto; background: white; }
figcaption { font-size: .8rem; opacity: .75; } summary { cursor: pointer; }
"""


def run(command, log):
    """A program's standard output goes to a log: libraries print there."""
    print(" ".join(map(str, command)), file=sys.stderr)
    with open(log, "w") as out:
        status = subprocess.run([str(word) for word in command], stdout=out).returncode
    return status


def measure(options):
    benchmarks = options.out / "benchmarks.json"
    status = run([options.programs / "fit_benchmark", f"--benchmark_repetitions={options.repetitions}",
                  "--benchmark_min_time=0.05", f"--benchmark_out={benchmarks}", "--benchmark_out_format=json"],
                 options.out / "benchmarks.log")
    if status:
        sys.exit(f"fit_benchmark ended with {status}: see {options.out / 'benchmarks.log'}")
    guard = options.out / "guard.json"
    guard.unlink(missing_ok=True)
    run([options.programs / "speed_guard", "--json", guard], options.out / "guard.log")  # the page says whether it fails
    if not guard.exists():
        sys.exit("speed_guard wrote no table")


def page(results, context, guard):
    machine = (f"{context['num_cpus']} cores at {context['mhz_per_cpu']} MHz, load {context['load_avg'][0]:.1f} at the start; "
               f"{html.escape(context['date'])}")
    text = f"""<!DOCTYPE html>
<html lang=en><head><meta charset=utf-8><meta name=viewport content="width=device-width"><title>Speed against error</title>
<style>{STYLE}</style></head>
<body>
<h1>Speed against error</h1>
<p>The default body of the virtual booth, which is known exactly, seen by twelve sensors with 0.8 mm noise, in register. Times
are the processor's, of all threads, since a machine does other things too: medians of n runs, with the least and the most of
them. MiB: by how much the process grows at most. {machine}.</p>
"""
    text += sections.headlines(results)
    text += sections.scene_section(results)
    for section in (sections.control_section, sections.solver_section, sections.tffd_section, sections.depth_section,
                    sections.points_section, sections.triangles_section, sections.yardstick_section):
        text += section(results)
    return text + sections.guard_section(guard) + "</body></html>\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--programs", type=pathlib.Path, default=ROOT / "build/devel/lib/tensegric_fit")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("speed_against_error"))
    parser.add_argument("--repetitions", type=int, default=5, help="of what is quick; 3 of what takes seconds")
    parser.add_argument("--page-only", action="store_true")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    start = time.monotonic()
    if not options.page_only:
        measure(options)
    measured, context = speed_data.load(options.out / "benchmarks.json")
    guard = json.loads((options.out / "guard.json").read_text())
    (options.out / "page.html").write_text(page(speed_data.Results(measured), context, guard))
    print(f"{options.out / 'page.html'} ({(time.monotonic() - start) / 60:.1f} minutes)")


if __name__ == "__main__":
    main()
