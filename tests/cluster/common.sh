# What the tests of schedulers share. $cli is clothlab-cli; $place becomes a folder that is removed at the end.
set -eu

cli=$1

skip() {
  echo "left out: $*"
  exit 77
}

fail() {
  echo "FAILED: $*" >&2
  exit 1
}

# The programs named, or the test is left out.
need() {
  for program in "$@"; do
    command -v "$program" >/dev/null 2>&1 || skip "$program is not installed"
  done
}

place=$(mktemp -d /tmp/clothlab-cluster-XXXXXX)
clean_up() { rm -rf -- "$place"; }
trap clean_up EXIT
trap 'exit 130' INT TERM

# A plan of $1 x 10 points, those of the stiffest cloths fail. $2: s that each simulates, a tenth of that to make.
write_plan() {
  cat >"$place/p.sweep.json" <<END
{ "format": "clothlab/sweep/1", "scene": "corners-free",
  "set": { "cloth.rows": 15, "cloth.columns": 15, "duration": $2, "integrator.time_step": 0.0004 },
  "vary": [ { "path": "springs.structural", "from": 50, "to": 20000, "count": $1, "scale": "log" },
            { "path": "damping", "from": 0.001, "to": 0.01, "count": 10 } ],
  "outputs": [ { "name": "peak", "of": "max_strain", "reduce": "max" }, { "of": "sag" } ] }
END
}

# sweep.csv of a folder without wall time and host.
table() { rev "$1/sweep.csv" | cut -d, -f3- | rev; }

# The sweep in one process, for comparison.
run_whole() {
  "$cli" sweep "$place/p.sweep.json" --out "$place/whole" >/dev/null
  table "$place/whole" >"$place/whole.txt"
}

expect_the_same() {
  table "$place/$1" >"$place/$1.txt"
  cmp -s "$place/whole.txt" "$place/$1.txt" || {
    diff "$place/whole.txt" "$place/$1.txt" | head -n 10 >&2
    fail "the table of $1 is not that of one process"
  }
  echo "$1: $(($(wc -l <"$place/$1.txt") - 1)) points as in one process"
}
