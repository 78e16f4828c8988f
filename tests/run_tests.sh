#!/usr/bin/env bash
# Installs, builds and runs all tests. Arguments go to ctest.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
"$root/launch/build.sh"
ctest --test-dir "$root/build" --output-on-failure -j2 "$@"  # two at a time: most of them wait for nodes
