#!/usr/bin/env bash
# Looks at the sources without building them. static_checks.sh CHECK...: format, shell, python; without: all of these, and cppcheck,
# which takes some minutes. Ends with 1 where one finds something, with 2 where its program is not there.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

sources() { find nodes tests .ci launch -type f "$@" | sort; }
needs() { command -v "$1" >/dev/null || { echo "$1 is not installed: launch/install_dependencies.sh" >&2; exit 2; }; }

check_format() {
  needs clang-format
  sources '(' -name '*.cpp' -o -name '*.hpp' ')' | xargs clang-format --dry-run --Werror
}
check_shell() {
  needs shellcheck
  sources '(' -name '*.sh' -o -path .ci/run ')' | xargs shellcheck
}
check_python() {
  needs flake8
  sources -name '*.py' | xargs flake8
}
check_cppcheck() {
  needs cppcheck
  # useStlAlgorithm, *shadow*: taste; missingInclude: ROS and PCL are not looked at; unusedFunction: looks at one file at a time.
  cppcheck --std=c++17 --language=c++ --enable=warning,performance,portability --inline-suppr --quiet --error-exitcode=1 -j "$(nproc)" \
    --suppress=missingIncludeSystem --suppress=unknownMacro --suppress=internalAstError -I nodes nodes
}

[ $# -gt 0 ] || set -- format shell python cppcheck
for check in "$@"; do "check_$check"; done
