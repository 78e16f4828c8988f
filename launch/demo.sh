#!/usr/bin/env bash
# Installs, builds and runs the demo: virtual-booth scan -> whole chain -> pictures and report; rviz where there is a display.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
TARGET=product "$root/launch/build.sh"
programs=$root/build/devel/lib/tensegric_fit
demo=$root/build/demo

"$programs/virtual_booth" --seed 1 --out "$demo/booth"
"$programs/fit" --scan "$demo/booth/scan.ply" --garment B1 --ratio chest=0.90 --out "$demo/fit"
echo "report:   $demo/fit/report.json"
echo "pictures: $demo/fit/front.png, side.png, distortion.png"

if [ -z "${DISPLAY:-}" ] || [ ! -t 1 ]; then
  echo "rviz is not opened: it needs a display, and this output on a terminal"
else
  echo "rviz: Ctrl+C in this terminal ends it"
  set +u
  # shellcheck disable=SC1091
  source "$root/build/devel/setup.bash"
  export ROS_HOSTNAME=localhost  # the master, too: launch/pages/privacy.md
  umask 077
  roslaunch tensegric_fit demo.launch bag:="$demo/booth/scan.bag"
fi
