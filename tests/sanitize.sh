#!/usr/bin/env bash
# Builds with sanitizers in a folder of its own and runs tests under them: sanitize.sh address|thread [arguments of ctest].
# Without arguments of ctest: all GoogleTest programs (units, stability, handlers), whose reports are errors. TARGETS: what to build
# (all of them). FOLDER: where (build/sanitize_KIND). Suppressions, each with its reason: tests/sanitize.*.txt.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
kind=${1:?"usage: sanitize.sh address|thread [arguments of ctest]"}
shift
case $kind in
  address) sanitizers=address,undefined ;;
  thread) sanitizers=thread ;;
  *) echo "neither address nor thread: $kind" >&2; exit 2 ;;
esac
folder=${FOLDER:-$root/build/sanitize_$kind}
# For the build, too: it runs programs that make scans for tests.
export ASAN_OPTIONS=detect_leaks=1:strict_string_checks=1:detect_stack_use_after_return=1
export LSAN_OPTIONS=suppressions=$root/tests/sanitize.leaks.txt:print_suppressions=0
export UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1
export TSAN_OPTIONS=suppressions=$root/tests/sanitize.threads.txt:halt_on_error=1
if command -v ninja >/dev/null; then export CMAKE_GENERATOR=${CMAKE_GENERATOR:-Ninja}; fi  # as launch/build.sh, which installs it
cmake -S "$root" -B "$folder" -DCATKIN_ENABLE_TESTING=ON -DCMAKE_BUILD_TYPE=None -DTENSEGRIC_FIT_SANITIZE="$sanitizers" >/dev/null
read -ra targets <<<"${TARGETS:-all}"
cmake --build "$folder" --parallel "$(nproc)" --target "${targets[@]}"
if (($# == 0)); then set -- -R gtest; fi
ctest --test-dir "$folder" --output-on-failure --timeout 3000 "$@"
