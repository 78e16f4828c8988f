#!/usr/bin/env python3
"""Fuzzing with clang, libFuzzer, AddressSanitizer and UBSan: builds the targets in a folder of their own and runs each until its coverage
has stood still: that of the lines of what it tests, or with --edges that of all edges which guide the fuzzer. Resumable: the corpus that was found, and how far each target is, stay in --work. A new --work begins with what earlier
campaigns found (tests/fuzz/found); --keep adds to that: as few inputs as reach every edge.

Usage: tests/fuzz/run.py --work DIR [--still SECONDS] [--edges] [--targets meshes,yaml,...] [--results FILE] [--uncovered] [--no-build] [--keep]

Prints a line of JSON per target: executions, lines reached of what it tests and edges, for how many seconds there was no new one, crashes
(their inputs are in DIR/crashes). Seconds are the processor's, so that other work on the machine does not make coverage stand still."""
import argparse
import json
import os
import pathlib
import re
import resource
import subprocess
import sys
import tarfile
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
CORPUS, DICTIONARIES, FOUND = ROOT / "tests/fuzz/corpus", ROOT / "tests/fuzz/dictionaries", ROOT / "tests/fuzz/found"
FLAGS = ("-g1 -O2 -fno-omit-frame-pointer -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined "
         f"-fsanitize-coverage-allowlist={ROOT}/tests/fuzz/covered.txt -fprofile-instr-generate -fcoverage-mapping")
TESTED = {  # whose lines count
    "bag": ["nodes/files/bag_structure.cpp", "nodes/files/message_layout.cpp", "nodes/ros/bag_check.cpp", "nodes/ros/bag_scans.cpp", "nodes/scan_files/bag_messages.cpp",
            "nodes/scan_files/scan_bag.cpp"],
    "capture": ["nodes/capture/capture_handler.cpp", "nodes/capture/capture_watch.cpp", "nodes/capture/stage_board.cpp",
                "nodes/ros/stage_report_message.cpp"],
    "cloud": ["nodes/geometry/point_cloud.cpp"],
    "documents": ["nodes/batch/table.cpp", "nodes/batch/shard_file.cpp", "nodes/batch/drift.cpp", "nodes/batch/database.cpp", "nodes/batch/batch_page.cpp",
                  "nodes/fit/history.cpp", "nodes/fit/result_documents.hpp", "nodes/geometry/json_text.hpp"],
    "manifest": ["nodes/batch/manifest.cpp", "nodes/files/csv.cpp", "nodes/fit/command_line.cpp"],
    "meshes": ["nodes/mesh_files/obj.cpp", "nodes/mesh_files/stl.cpp", "nodes/mesh_files/gltf.cpp", "nodes/mesh_files/read_mesh.cpp",
               "nodes/mesh_files/samples.cpp", "nodes/mesh_files/reading.cpp", "nodes/geometry/ply.cpp", "nodes/scan_files/pcd_file.cpp",
               "nodes/scan_files/scan_file.cpp"],
    "messages": ["nodes/ros/body_messages.cpp", "nodes/ros/flat.hpp", "nodes/body_model/model_message.cpp", "nodes/tensegric/fit_messages.cpp",
                 "nodes/tensegric/kept_garment_message.cpp", "nodes/tensegric/tensegric_handler.cpp", "nodes/tffd/tffd_handler.cpp",
                 "nodes/landmarks/landmarks_handler.cpp", "nodes/control_mesh/control_mesh_handler.cpp",
                 "nodes/correlation/correlation_handler.cpp", "nodes/ros/fit_figures.cpp", "nodes/ros/fit_document.cpp", "nodes/ros/line_force.cpp",
                 "nodes/ros/scan_labels.cpp"],
    "parameters": ["nodes/ros/parameters.cpp"],
    "sensors": ["nodes/assembler/assembler.cpp", "nodes/assembler/assembler_handler.cpp", "nodes/assembler/assembly_message.cpp",
                "nodes/assembler/capture_join.cpp", "nodes/assembler/column_pairs.cpp", "nodes/assembler/registration.cpp",
                "nodes/assembler/shared_frames.cpp", "nodes/depth_cameras/camera_message.cpp"],
    "yaml": ["nodes/geometry/checked_yaml.cpp", "nodes/tensegric/garment.cpp", "nodes/control_mesh/load_template.cpp",
             "nodes/control_mesh/shape_control.cpp", "nodes/fit/tissue_file.cpp", "nodes/depth_cameras/camera_poses.cpp"],
}


ROUND = 320  # seconds of fuzzing between two looks at what was reached; three are 15 minutes
LONGEST = {"bag": 16384, "documents": 8192, "yaml": 8192}  # bytes of an input: an empty bag has 4 kB, a template 4
LEFT_OUT = {  # target -> source -> functions that no input of it can reach
    "bag": {"nodes/scan_files/scan_bag.cpp": ["write_bag_scan"]},  # writes
    "documents": {"nodes/batch/shard_file.cpp": ["ShardFile::ShardFile", "ShardFile::~ShardFile", "ShardFile::cut_unfinished_line", "ShardFile::add",
                                                 "ShardFile::line_at", "cannot_write"]},  # write
    "meshes": {"nodes/geometry/ply.cpp": ["ply_bytes", "write_ply_mesh"]},  # write
}


def build(folder, targets):
    subprocess.run(["cmake", "-S", ROOT, "-B", folder, "-DCMAKE_CXX_COMPILER=clang++", "-DCMAKE_C_COMPILER=clang", "-DTENSEGRIC_FIT_FUZZ=ON",
                    "-DCATKIN_ENABLE_TESTING=ON", "-DCMAKE_BUILD_TYPE=None", f"-DCMAKE_CXX_FLAGS={FLAGS}"], check=True,
                   stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", folder, "--parallel", str(os.cpu_count()), "--target", *(f"fuzz_{t}" for t in targets)], check=True)


def program_of(folder, target):
    return next(path for path in folder.rglob(f"fuzz_{target}") if path.is_file() and os.access(path, os.X_OK))


def kept_file(target):
    return FOUND / f"{target}.tar.xz"


def unpack_kept(target, folder):
    """What earlier campaigns kept, if anything, into the folder."""
    if kept_file(target).exists():
        with tarfile.open(kept_file(target)) as archive:
            archive.extractall(folder)


def corpus_in(work, target):
    """The folder of what was found; a new one has what was kept."""
    found = work / "corpus" / target
    if not found.exists():
        found.mkdir(parents=True)
        unpack_kept(target, found)
    return found


def keep(program, target, work):
    """The fewest inputs that reach every edge, as a file that is the same for the same inputs."""
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryDirectory() as before:
        unpack_kept(target, before)  # `work` may be older than it
        subprocess.run([program, "-merge=1", "-use_counters=0", f"-max_len={LONGEST.get(target, 4096)}", folder, CORPUS / target, before,
                        corpus_in(work, target)], env=dict(os.environ, LLVM_PROFILE_FILE="/dev/null"), capture_output=True, check=True)
        FOUND.mkdir(exist_ok=True)
        with tarfile.open(kept_file(target), "w:xz") as archive:
            for path in sorted(pathlib.Path(folder).iterdir()):
                entry = tarfile.TarInfo(path.name)
                entry.size = path.stat().st_size
                with open(path, "rb") as file:
                    archive.addfile(entry, file)


def run_round(program, target, work, seconds):
    """One stretch of fuzzing: executions, edges covered, seconds of the processor, crashed."""
    found, crashes = corpus_in(work, target), work / "crashes"
    crashes.mkdir(exist_ok=True)
    environment = dict(os.environ, LLVM_PROFILE_FILE="/dev/null", ASAN_OPTIONS="detect_leaks=1:allocator_may_return_null=1",
                       UBSAN_OPTIONS="print_stacktrace=1")
    words = DICTIONARIES / f"{target}.dict"
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    log = subprocess.run([program, found, CORPUS / target, f"-max_total_time={seconds}", "-timeout=60", "-rss_limit_mb=2048", "-malloc_limit_mb=1024",
                          f"-max_len={LONGEST.get(target, 4096)}", "-print_final_stats=1", "-reload=0", *([f"-dict={words}"] if words.exists() else []),
                          f"-artifact_prefix={crashes}/{target}-"], env=environment, capture_output=True, text=True, errors="replace", check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    executions = int(re.search(r"number_of_executed_units: (\d+)", log.stderr)[1]) if "number_of_executed" in log.stderr else 0
    covered = [int(n) for n in re.findall(r" cov: (\d+)", log.stderr)]
    if log.returncode != 0:
        (crashes / f"{target}.log").write_text(log.stderr)
    return executions, max(covered, default=0), after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, log.returncode != 0


def lines_of(program, target, work):
    """Of each file that is tested: line -> executions, with the whole corpus."""
    found = corpus_in(work, target)
    pattern, data = work / f"{target}-%m.profraw", work / f"{target}.profdata"
    for old in work.glob(f"{target}-*.profraw"):
        old.unlink()
    environment = dict(os.environ, LLVM_PROFILE_FILE=str(pattern))
    subprocess.run([program, "-runs=0", f"-max_len={LONGEST.get(target, 4096)}", found, CORPUS / target], env=environment,
                   capture_output=True, check=False)
    subprocess.run(["llvm-profdata", "merge", "-sparse", *work.glob(f"{target}-*.profraw"), "-o", data], check=True)
    libraries = [line.split()[2] for line in subprocess.run(["ldd", program], capture_output=True, text=True, check=True).stdout.splitlines()
                 if "libtensegric_fit" in line]
    objects = [word for library in libraries for word in ("-object", library)]
    sources = [ROOT / source for source in TESTED[target]]
    command = ["llvm-cov", "export", program, *objects, f"-instr-profile={data}"]
    lcov = subprocess.run([*command, "-format=lcov", *sources], capture_output=True, text=True, check=True).stdout
    lines, source = {}, ""
    for word, _, rest in (line.partition(":") for line in lcov.splitlines()):
        if word == "SF":
            source = str(pathlib.Path(rest).relative_to(ROOT))
            lines[source] = {}
        elif word == "DA":
            number, count = map(int, rest.split(",")[:2])
            lines[source][number] = count
    for source, left in LEFT_OUT.get(target, {}).items():
        for function in left:
            for number in span_of(ROOT / source, function):
                lines[source].pop(number, None)
    return lines


def span_of(source, function):
    """Numbers of the lines of a function, from the line that has its name and ( to the next } in the first column."""
    text = source.read_text(encoding="utf-8").splitlines()
    first = next(i for i, line in enumerate(text) if function + "(" in line and not line.startswith(" "))
    last = next(i for i in range(first, len(text)) if text[i].startswith("}"))
    return range(first + 1, last + 2)


def reached(lines):
    """How many, and of how many."""
    counts = [count for of_file in lines.values() for count in of_file.values()]
    return sum(count > 0 for count in counts), len(counts)


def percent(lines):
    some, every = reached(lines)
    return round(100 * some / max(1, every), 1)


def fuzz(program, target, work, still, by_edges):
    """Until nothing new was covered for so long; goes on from where it was stopped."""
    path = work / f"{target}.json"
    state = {"executions": 0, "processor_s": 0, "edges": 0, "edges_quiet": 0, "lines": 0, "lines_quiet": 0}
    if path.exists():
        state.update((key, value) for key, value in json.loads(path.read_text()).items() if key in state)
    else:
        state["lines"] = reached(lines_of(program, target, work))[0]  # of what it begins with
    crashed = False
    while state["edges_quiet" if by_edges else "lines_quiet"] < still and not crashed:
        more, edges, seconds, crashed = run_round(program, target, work, ROUND)
        state["executions"] += more
        state["processor_s"] = round(state["processor_s"] + seconds, 1)
        for what, covered in (("edges", edges), ("lines", reached(lines_of(program, target, work))[0])):
            state[f"{what}_quiet"] = 0 if covered > state[what] else round(state[f"{what}_quiet"] + seconds, 1)
            state[what] = max(state[what], covered)
        path.write_text(json.dumps(state))
    return {"target": target, **state, "lines_percent": percent(lines_of(program, target, work)), "crashed": crashed}


def show_uncovered(lines):
    for source, of_file in lines.items():
        missed = [number for number, count in sorted(of_file.items()) if count == 0]
        print(f"{source}: {percent({source: of_file})} %; not reached: {' '.join(map(str, missed))}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--work", type=pathlib.Path, required=True)
    parser.add_argument("--still", type=int, default=900, help="seconds of the processor")
    parser.add_argument("--edges", action="store_true", help="until no new edge was found, in place of no new line of what is tested")
    parser.add_argument("--targets", default=",".join(TESTED))
    parser.add_argument("--no-build", action="store_true", help="the targets are built")
    parser.add_argument("--keep", action="store_true", help="only keep what was found in tests/fuzz/found")
    parser.add_argument("--uncovered", action="store_true", help="only print which lines the corpus does not reach")
    parser.add_argument("--results", type=pathlib.Path, help="file of JSON lines that results are added to")
    arguments = parser.parse_args()
    work, targets = arguments.work.resolve(), arguments.targets.split(",")
    work.mkdir(parents=True, exist_ok=True)
    if not arguments.no_build:
        build(work / "build", targets)
    fine = True
    for target in targets:
        program = program_of(work / "build", target)
        if arguments.uncovered:
            show_uncovered(lines_of(program, target, work))
            continue
        if arguments.keep:
            keep(program, target, work)
            continue
        result = fuzz(program, target, work, arguments.still, arguments.edges)
        print(json.dumps(result), flush=True)
        if arguments.results and not result["crashed"]:
            with open(arguments.results, "a", encoding="utf-8") as file:
                file.write(json.dumps(dict(result, date=time.strftime("%Y-%m-%d"))) + "\n")
        fine = fine and not result["crashed"]
    return 0 if fine else 1


if __name__ == "__main__":
    sys.exit(main())
