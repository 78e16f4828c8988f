#!/usr/bin/env bash
# fit_batch as an array of N jobs on a Slurm cluster, and the merger when all have ended.
# Usage: submit.sh MANIFEST OUT N [options of sbatch: --partition=... --cpus-per-task=...]
# MANIFEST, scans, OUT and this package lie where every node sees them. Prints the number of the merging job; run again with the
# same OUT, it does what is missing. FIT_BATCH: the program, where it lies neither beside this package nor in a workspace that is sourced.
set -euo pipefail
if (($# < 3)); then
  sed -n '2,5s/^# //p' "$0" >&2
  exit 2
fi
manifest=$(realpath -e "$1") out=$(realpath -m "$2") shards=$3
shift 3
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
if [[ -z ${FIT_BATCH:-} ]]; then
  # The devel space of the clone or of its catkin workspace, an install as share/tensegric_fit/launch/slurm, what is sourced.
  IFS=: read -ra sourced <<<"${CMAKE_PREFIX_PATH:-}"
  for prefix in "$here"/../../devel "$here"/../../../../devel "$here"/../../../.. "${sourced[@]}"; do
    FIT_BATCH=$prefix/lib/tensegric_fit/fit_batch
    [[ ! -x $FIT_BATCH ]] || break
  done
fi
if [[ ! -x $FIT_BATCH ]]; then
  echo "There is no program $FIT_BATCH: set FIT_BATCH to where fit_batch is" >&2
  exit 2
fi
FIT_BATCH=$(realpath -e "$FIT_BATCH")
export FIT_BATCH FIT_BATCH_ROUND=$((${FIT_BATCH_ROUND:-0} + 1))
mkdir -p "$out/log"
common=(--parsable --requeue --open-mode=append "$@")
array=$(sbatch "${common[@]}" --job-name=fit_batch --array="1-$shards" --output="$out/log/shard-%a.txt" \
  "$here/shard.sbatch" "$manifest" "$out")
sbatch "${common[@]}" --job-name=fit_batch_merge --dependency="afterany:${array%%;*}" --output="$out/log/merge.txt" \
  "$here/merge.sbatch" "$here" "$manifest" "$out" "$shards" "$@"
