#!/usr/bin/env bash
# Makes every number of docs/seed-planner.md, compare.md and paper-random.md again: runs the
# campaigns into the folder RESULTS (those that are there already are not run again), then fills the
# tables.
set -euo pipefail
results=$(realpath -m "${1:?usage: seed-planner.sh RESULTS}")
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
seatrial=${SEATRIAL:-$(tests/build)}
mkdir -p "$results"

# campaign FOLDER CAMPAIGN [OPTION...]
campaign() {
  local folder=$results/$1
  shift
  "$seatrial" campaign "$@" --out "$folder" --resume --quiet
}

# a campaign file with one option of zhuang-latched changed
changed() {
  printf '%s\n\n[planner.zhuang-latched]\n%s\n' "$(cat "campaigns/$1.toml")" "$2"
}

printed=(--planner zhuang-as-printed)
readings=("${printed[@]}" --planner zhuang --planner zhuang-goal-first --planner zhuang-when-safe
  --planner zhuang-class-in-beat --planner zhuang-latched)
repaired=(--planner zhuang-latched --planner zhuang-corrected)

campaign paper paper
for world in laboratory quick; do
  campaign "$world" "$world" "${readings[@]}" --planner zhuang-corrected --encounters 400
done
for world in paper-random paper-random-600; do
  campaign "$world" "$world" "${readings[@]}" --encounters 1000
done
campaign several campaigns/findings-several.toml --planner zhuang "${repaired[@]}" --encounters 500
campaign altering campaigns/findings-altering.toml --planner zhuang --encounters 500
campaign boundary campaigns/findings-boundary.toml --planner zhuang "${repaired[@]}" \
  --encounters 500
campaign close campaigns/findings-close.toml "${printed[@]}" --planner zhuang "${repaired[@]}" \
  --encounters 500
campaign late campaigns/findings-late.toml --planner zhuang "${repaired[@]}" --encounters 500
sed 's/yaw_rate_deg_s_max = 2.0/yaw_rate_deg_s_max = 60.0/' campaigns/findings-late.toml \
  > "$results/nimble.toml"
campaign nimble "$results/nimble.toml" --planner zhuang "${repaired[@]}" --encounters 500
changed quick 'radius_factor = 1.3' > "$results/margin.toml"
campaign margin "$results/margin.toml" "${repaired[@]}" --encounters 500
changed findings-several 'reference = "most-urgent"' > "$results/urgent.toml"
campaign urgent "$results/urgent.toml" "${repaired[@]}" --encounters 500
for world in laboratory quick; do
  campaign "corrected-$world" "$world" --planner zhuang-corrected --encounters 11112
done
"$seatrial" compare zhuang-as-printed zhuang zhuang-latched zhuang-corrected kuwata-vo sb-mpc \
  plain-vo hold-course --encounters 200 --out "$results/compare" --resume

cargo run --config .cargo/optimised.toml --locked --package seatrial --example measured -- \
  into "$results" docs/seed-planner.md docs/measured/compare.md docs/measured/paper-random.md
