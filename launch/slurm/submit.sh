#!/usr/bin/env bash
# fit_batch as an array of N jobs on a Slurm cluster, and the merger when all have ended.
# Usage: submit.sh MANIFEST OUT N [options of sbatch: --partition=... --cpus-per-task=...]
# MANIFEST, scans, OUT and this package lie where every node sees them. Prints the number of the merging job; run again with the
# same OUT, it does what is missing. FIT_BATCH: the program, where it is not beside this package's build.
set -euo pipefail
if (($# < 3)); then
  sed -n '2,5s/^# //p' "$0" >&2
  exit 2
fi
manifest=$(realpath -e "$1") out=$(realpath -m "$2") shards=$3
shift 3
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
if [[ -z ${FIT_BATCH:-} ]]; then
  # In the source tree, or installed as share/tensegric_fit/launch/slurm.
  for FIT_BATCH in "$here"/../../devel/lib/tensegric_fit/fit_batch "$here"/../../../../lib/tensegric_fit/fit_batch; do
    [[ ! -x $FIT_BATCH ]] || break
  done
fi
FIT_BATCH=$(realpath -e "$FIT_BATCH")
export FIT_BATCH FIT_BATCH_ROUND=$((${FIT_BATCH_ROUND:-0} + 1))
mkdir -p "$out/log"
common=(--parsable --requeue --open-mode=append "$@")
array=$(sbatch "${common[@]}" --job-name=fit_batch --array="1-$shards" --output="$out/log/shard-%a.txt" \
  "$here/shard.sbatch" "$manifest" "$out")
sbatch "${common[@]}" --job-name=fit_batch_merge --dependency="afterany:${array%%;*}" --output="$out/log/merge.txt" \
  "$here/merge.sbatch" "$here" "$manifest" "$out" "$shards" "$@"
