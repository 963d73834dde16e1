#!/bin/sh
# run.sh BUILD SECONDS TARGET: one fuzz target, from the corpus, what ever broke it, and what earlier
# runs found worth keeping. Its memory stays bounded whatever the file claims to hold.
set -eu
build=$1 seconds=$2 target=$3
run=$build/run/$target
mkdir -p "$run/corpus" "$run/crashes"
export GLOG_minloglevel=3 # Ceres
export ASAN_OPTIONS=quarantine_size_mb=64
if "$build/bin/fuzz_$target" -max_total_time="$seconds" -timeout=20 -seed="${SLIDEWAY_SEED:-0}" -rss_limit_mb=1024 \
  -malloc_limit_mb=64 -print_final_stats=1 -artifact_prefix="$run/crashes/" "$run/corpus" \
  "$(dirname "$0")"/*/"$target" >"$run/log" 2>&1; then
  echo "$target: $(sed -n 's/^stat::number_of_executed_units: *//p' "$run/log") inputs"
  exit
fi
grep -v "^#[0-9]" "$run/log" | tail -n 60
echo "fuzz_$target broke: the input is in $run/crashes; once mended, keep it in" \
  "tests/fuzz/crashes/$target" >&2
exit 255 # xargs starts no other
