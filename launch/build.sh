#!/usr/bin/env bash
# Installs what is missing and builds into build/, wherever it is called from. TARGET: what to build (all). Arguments go
# to cmake's configure step.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
"$root/launch/install_dependencies.sh"
export CMAKE_GENERATOR=${CMAKE_GENERATOR:-Ninja}  # a folder that make has built stays with make
cmake -S "$root" -B "$root/build" -DCATKIN_ENABLE_TESTING=ON "$@"
cmake --build "$root/build" --parallel "$(nproc)" --target "${TARGET:-all}"
