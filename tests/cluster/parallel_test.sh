#!/bin/sh
# A sweep under GNU parallel.
here=$(dirname "$0")
. "$here/common.sh"
need parallel rev

write_plan 4 0.5
run_whole
"$cli" sweep emit "$place/it's here" --plan "$place/p.sweep.json" --for parallel --shards 7 --at-once 3 >/dev/null
sh "$place/it's here/parallel/run.sh" >/dev/null
ls "$place/it's here/shards" | grep -q '^7-of-7' || fail "there is no seventh shard"
expect_the_same "it's here"
