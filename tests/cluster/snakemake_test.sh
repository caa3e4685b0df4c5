#!/bin/sh
# A sweep under Snakemake.
here=$(dirname "$0")
. "$here/common.sh"
need snakemake rev

write_plan 4 0.5
run_whole
"$cli" sweep emit "$place/it's here" --plan "$place/p.sweep.json" --for snakemake --shards 7 >/dev/null
# It keeps notes of its own in the folder that it is started in.
(cd "$place" && HOME=$place snakemake --snakefile "it's here/snakemake/Snakefile" --cores 2) >"$place/snakemake.txt" 2>&1 || {
  tail -n 20 "$place/snakemake.txt" >&2
  fail "snakemake ended with an error"
}
ls "$place/it's here/shards" | grep -q '^7-of-7' || fail "there is no seventh shard"
expect_the_same "it's here"
