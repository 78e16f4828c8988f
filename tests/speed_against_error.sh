#!/usr/bin/env bash
# Builds, runs all benchmarks and makes one page of them: speed_against_error/page.html in the folder it is called from, or
# wherever --out says. Arguments go to benchmarks/speed_page.py.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
"$root/launch/build.sh"
exec /usr/bin/python3 "$root/tests/benchmarks/speed_page.py" "$@"
