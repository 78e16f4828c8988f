#!/usr/bin/env python3
"""Fuzzing with clang, libFuzzer, AddressSanitizer and UBSan: builds the targets in a folder of their own and runs each until its coverage
has stood still. Resumable: the corpus that was found stays in --work.

Usage: tests/fuzz/run.py --work DIR [--still SECONDS] [--targets meshes,yaml,...]

Prints a line of JSON per target: executions, coverage of lines of what it tests, crashes (their inputs are in DIR/crashes)."""
import argparse
import json
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
CORPUS = ROOT / "tests/fuzz/corpus"
FLAGS = ("-g -O1 -fno-omit-frame-pointer -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined "
         "-fprofile-instr-generate -fcoverage-mapping")
TESTED = {  # whose lines count
    "meshes": ["nodes/mesh_files/obj.cpp", "nodes/mesh_files/stl.cpp", "nodes/mesh_files/gltf.cpp", "nodes/mesh_files/glb.cpp",
               "nodes/mesh_files/read_mesh.cpp", "nodes/mesh_files/samples.cpp", "nodes/geometry/ply.cpp",
               "nodes/scan_files/scan_file.cpp"],
    "yaml": ["nodes/geometry/checked_yaml.cpp", "nodes/tensegric/garment.cpp", "nodes/control_mesh/load_template.cpp",
             "nodes/control_mesh/shape_control.cpp", "nodes/fit/tissue_file.cpp"],
    "cloud": ["nodes/geometry/point_cloud.cpp"],
    "messages": ["nodes/ros/body_messages.cpp", "nodes/ros/flat.hpp", "nodes/body_model/model_message.cpp", "nodes/tensegric/fit_messages.cpp",
                 "nodes/tensegric/kept_garment_message.cpp", "nodes/tensegric/tensegric_handler.cpp",
                 "nodes/tffd/tffd_handler.cpp"],
    "bag": ["nodes/ros/bag_check.cpp", "nodes/ros/bag_scans.cpp", "nodes/scan_files/bag_messages.cpp", "nodes/scan_files/scan_bag.cpp"],
    "manifest": ["nodes/batch/manifest.cpp", "nodes/files/csv.cpp"],
}


LONGEST = {"bag": 16384}  # bytes of an input: an empty bag has 4 kB


def build(folder, targets):
    subprocess.run(["cmake", "-S", ROOT, "-B", folder, "-DCMAKE_CXX_COMPILER=clang++", "-DCMAKE_C_COMPILER=clang", "-DTENSEGRIC_FIT_FUZZ=ON",
                    "-DCATKIN_ENABLE_TESTING=ON", "-DCMAKE_BUILD_TYPE=None", f"-DCMAKE_CXX_FLAGS={FLAGS}"], check=True,
                   stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", folder, "--parallel", str(os.cpu_count()), "--target", *(f"fuzz_{t}" for t in targets)], check=True)


def program_of(folder, target):
    return next(path for path in folder.rglob(f"fuzz_{target}") if path.is_file() and os.access(path, os.X_OK))


def run_round(program, target, work, seconds):
    """One stretch of fuzzing: executions, edges covered, crashed."""
    found, crashes = work / "corpus" / target, work / "crashes"
    found.mkdir(parents=True, exist_ok=True)
    crashes.mkdir(exist_ok=True)
    environment = dict(os.environ, LLVM_PROFILE_FILE=str(work / f"{target}.profraw"),
                       ASAN_OPTIONS="detect_leaks=1:allocator_may_return_null=1", UBSAN_OPTIONS="print_stacktrace=1")
    log = subprocess.run([program, found, CORPUS / target, f"-max_total_time={seconds}", "-timeout=10", "-rss_limit_mb=2048", "-malloc_limit_mb=1024",
                          f"-max_len={LONGEST.get(target, 4096)}", "-print_final_stats=1", f"-artifact_prefix={crashes}/{target}-"], env=environment,
                         capture_output=True, text=True, errors="replace", check=False)
    executions = int(re.search(r"number_of_executed_units: (\d+)", log.stderr)[1]) if "number_of_executed" in log.stderr else 0
    covered = [int(n) for n in re.findall(r" cov: (\d+)", log.stderr)]
    if log.returncode != 0:
        (crashes / f"{target}.log").write_text(log.stderr)
    return executions, max(covered, default=0), log.returncode != 0


def line_coverage(program, target, work):
    """Percent of the lines of what is tested, of the whole corpus."""
    raw, data = work / f"{target}.profraw", work / f"{target}.profdata"
    environment = dict(os.environ, LLVM_PROFILE_FILE=str(raw))
    subprocess.run([program, "-runs=0", work / "corpus" / target, CORPUS / target], env=environment, capture_output=True, check=False)
    subprocess.run(["llvm-profdata", "merge", "-sparse", raw, "-o", data], check=True)
    libraries = [line.split()[2] for line in subprocess.run(["ldd", program], capture_output=True, text=True, check=True).stdout.splitlines()
                 if "libtensegric_fit" in line]
    objects = [word for library in libraries for word in ("-object", library)]
    sources = [ROOT / source for source in TESTED[target] if (ROOT / source).exists()]
    export = subprocess.run(["llvm-cov", "export", "-summary-only", program, *objects, f"-instr-profile={data}", *sources],
                            capture_output=True, text=True, check=True).stdout
    lines = json.loads(export)["data"][0]["totals"]["lines"]
    return round(100 * lines["covered"] / max(1, lines["count"]), 1)


def fuzz(program, target, work, still):
    """Until nothing new was covered for so long."""
    executions, best, quiet, crashed = 0, 0, 0, False
    step = min(60, still)
    while quiet < still and not crashed:
        more, covered, crashed = run_round(program, target, work, step)
        executions += more
        quiet = 0 if covered > best else quiet + step
        best = max(best, covered)
    return {"target": target, "executions": executions, "edges": best, "lines_percent": line_coverage(program, target, work),
            "crashed": crashed}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--work", type=pathlib.Path, required=True)
    parser.add_argument("--still", type=int, default=900)
    parser.add_argument("--targets", default=",".join(TESTED))
    arguments = parser.parse_args()
    work, targets = arguments.work.resolve(), arguments.targets.split(",")
    work.mkdir(parents=True, exist_ok=True)
    build(work / "build", targets)
    fine = True
    for target in targets:
        result = fuzz(program_of(work / "build", target), target, work, arguments.still)
        print(json.dumps(result), flush=True)
        fine = fine and not result["crashed"]
    return 0 if fine else 1


if __name__ == "__main__":
    sys.exit(main())
