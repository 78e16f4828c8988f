#!/usr/bin/env bash
# Installs the Debian 12 packages that package.xml names after "deb:". TARGET=product: without those for tests and pages alone
# (test_depend, doc_depend), unless CMake looks for them when it configures ("configure" beside them).
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
left_out=''
[ "${TARGET:-all}" != product ] || left_out='/<\(test\|doc\)_depend>/{/configure/!d};'
mapfile -t packages < <(sed -n "$left_out"'s/.*<!-- deb: \(.*\) -->.*/\1/p' "$root/package.xml" | tr ' ' '\n' | sort -u)

mapfile -t missing < <(comm -13 <(dpkg-query -W -f '${db:Status-Abbrev} ${Package}\n' "${packages[@]}" 2>/dev/null | sed -n 's/^.i  *//p' | sort -u) \
  <(printf '%s\n' "${packages[@]}"))
[ "${#missing[@]}" -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "Missing packages, and neither root nor sudo to install them: ${missing[*]}" >&2; exit 1; }
  as_root=(sudo)
fi
"${as_root[@]}" apt-get -o DPkg::Lock::Timeout=600 update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq -o DPkg::Lock::Timeout=600 --no-install-recommends "${missing[@]}"
