#!/bin/sh
# run.sh BUILD SECONDS TARGET: one fuzz target, from the corpus, what ever broke it, and what earlier
# runs found worth keeping, with the words of its format. Its memory stays bounded whatever the file
# claims to hold.
set -eu
build=$1 seconds=$2 target=$3
here=$(dirname "$0")
run=$build/run/$target
case $target in # bytes: a few times what the format needs for all it can say
  channel) longest=1024 ;;
  formula | manifest) longest=2048 ;;
  x3p | x3p_parts | recognition | problem) longest=8192 ;;
  report | results) longest=32768 ;;
  *) longest=4096 ;;
esac
mkdir -p "$run/corpus" "$run/crashes"
export GLOG_minloglevel=3 # Ceres
export ASAN_OPTIONS=quarantine_size_mb=64
if "$build/bin/fuzz_$target" -max_total_time="$seconds" -timeout=20 -seed="${SLIDEWAY_SEED:-0}" -rss_limit_mb=1024 \
  -malloc_limit_mb=64 -max_len=$longest -dict="$here/dictionaries/$target.dict" -print_final_stats=1 \
  -artifact_prefix="$run/crashes/" "$run/corpus" "$here"/*/"$target" >"$run/log" 2>&1; then
  echo "$target: $(sed -n 's/^stat::number_of_executed_units: *//p' "$run/log") inputs"
  exit
fi
grep -v "^#[0-9]" "$run/log" | tail -n 60
echo "fuzz_$target broke: the input is in $run/crashes; once mended, keep it in" \
  "tests/fuzz/crashes/$target" >&2
exit 255 # xargs starts no other
