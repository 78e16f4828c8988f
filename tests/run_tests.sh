#!/usr/bin/env bash
# Installs, builds and runs all tests. Arguments go to ctest.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
"$root/launch/build.sh"
ctest --test-dir "$root/build" --output-on-failure -j "$(($(nproc) + 1))" "$@"  # one more than cores: some wait for nodes
