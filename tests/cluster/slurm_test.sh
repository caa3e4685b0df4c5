#!/bin/sh
# A sweep under a real Slurm: its tasks are killed, requeued and terminated, slurmd dies and comes again, the number of
# shards changes half way, and the arrays are smaller than the number of shards. The merged table is that of one process.
here=$(dirname "$0")
. "$here/common.sh"
need slurmctld slurmd munged sbatch rev
[ "$(id -u)" -eq 0 ] || skip "a Slurm of its own needs root"

end() {
  [ ! -f "$place/slurm/slurm.conf" ] || scancel --user=root 2>/dev/null || :
  sh "$here/slurm_here.sh" stop "$place/slurm"
  sleep 1
  clean_up
}
trap end EXIT

SLURM_CONF=$(sh "$here/slurm_here.sh" start "$place/slurm" 6) || {
  tail -n 5 "$place"/slurm/log/* >&2
  fail "Slurm does not start"
}
export SLURM_CONF

wait_for_queue() {
  tries=0
  until [ -z "$(squeue -h 2>/dev/null)" ]; do
    tries=$((tries + 1))
    [ $tries -le 600 ] || {
      squeue >&2
      fail "the queue does not empty"
    }
    # Slurm holds back for two minutes what it requeues.
    for job in $(squeue -h -t PENDING -o '%i %r' | awk '$2 == "BeginTime" { print $1 }'); do
      scontrol update JobId="$job" StartTime=now 2>/dev/null || :
    done
    sleep 0.5
  done
}

# The programs of running tasks; not the shells around them.
tasks() { pgrep -f "^[^ ]*clothlab-cli sweep --out $place/parts" || :; }

wait_for_tasks() {
  tries=0
  until [ -n "$(tasks)" ]; do
    tries=$((tries + 1))
    [ $tries -le 300 ] || return 0
    sleep 0.1
  done
}

signal_one() {
  wait_for_tasks
  victim=$(tasks | shuf -n 1)
  [ -z "$victim" ] || kill "-$1" "$victim" 2>/dev/null || :
}

write_plan 20 1
run_whole
# 13 shards in arrays of at most 5.
"$cli" sweep emit "$place/parts" --plan "$place/p.sweep.json" --for slurm --shards 13 --at-once 6 >/dev/null
sh "$place/parts/slurm/submit.sh" | tee "$place/submitted.txt"
[ "$(grep -c shards "$place/submitted.txt")" -eq 3 ] || fail "13 shards at MaxArraySize 6 are not three arrays"

for round in 1 2 3 4; do
  signal_one KILL
  sleep 0.3
done
signal_one TERM
running=$(squeue -h -t RUNNING -r -o %i | head -n 1)
[ -z "$running" ] || scontrol requeue "$running" || :
kill -KILL "$(cat "$place/slurm/run/slurmd.pid")"
sleep 1
rm -f "$place/slurm/run/slurmd.pid"
sh "$here/slurm_here.sh" slurmd "$place/slurm"
wait_for_queue
"$cli" sweep status "$place/parts"
missing=$("$cli" sweep status "$place/parts" --missing --shards 13)
[ -n "$missing" ] || fail "five tasks were killed, and no point is missing"
echo "missing: shards $missing of 13"

# The rest in another number of parts; submit.sh submits those that lack points alone.
"$cli" sweep emit "$place/parts" --for slurm --shards 7 >/dev/null
sh "$place/parts/slurm/submit.sh"
wait_for_queue
[ -z "$("$cli" sweep status "$place/parts" --missing --shards 13)" ] || fail "points are missing"
expect_the_same parts
sh "$place/parts/slurm/submit.sh" >"$place/again.txt"
grep -q "no shard lacks a point" "$place/again.txt" || fail "a complete sweep is submitted again"
