#!/bin/sh
# A stability map under a real Slurm: tasks of the array are killed and told to end, the array is submitted again with
# another number of shards, and the merge makes what is left. The table is that of one process.
here=$(dirname "$0")
. "$here/common.sh"
need slurmctld slurmd munged sbatch
[ "$(id -u)" -eq 0 ] || skip "a Slurm of its own needs root"

end() {
  [ ! -f "$place/slurm/slurm.conf" ] || scancel --user=root 2>/dev/null || :
  sh "$here/slurm_here.sh" stop "$place/slurm"
  sleep 1
  clean_up
}
trap end EXIT

SLURM_CONF=$(sh "$here/slurm_here.sh" start "$place/slurm") || {
  tail -n 5 "$place"/slurm/log/* >&2
  fail "Slurm does not start"
}
export SLURM_CONF

wait_for_queue() {
  tries=0
  until [ -z "$(squeue -h 2>/dev/null)" ]; do
    tries=$((tries + 1))
    [ $tries -le 600 ] || fail "the queue does not empty: $(squeue)"
    sleep 0.5
  done
}

# Finished cells of all parts.
cells() { cat "$place"/parts/shards/*/stability.csv 2>/dev/null | grep -vc '^method,' || :; }

study="stability corners-free --methods verlet,rk4 --periods 2000 --most-steps 100000 --x integrator.time_step=5e-4:4e-3:8:log \
  --y springs.*=20:500:8:log"
all=128

cat >"$place/map.sh" <<END
#!/bin/sh
exec "$cli" $study --out "$place/parts" "\$@"
END
submit() { sbatch --parsable --signal=B:TERM@60 --open-mode=append --output="$place/log.txt" "$@"; }

submit --array=1-7%4 "$place/map.sh" --shard auto >/dev/null
tries=0
until [ "$(cells)" -ge 20 ] || [ -z "$(squeue -h)" ]; do
  tries=$((tries + 1))
  [ $tries -le 600 ] || fail "no cells come"
  sleep 0.1
done
# shellcheck disable=SC2046 # names of tasks, split on purpose
set -- $(squeue -h -t RUNNING -r -o %i)
[ $# -ge 2 ] || fail "no two tasks run"
# Slurm tells a task that ends at once a second time, and complains that it is gone.
scancel --batch --signal=KILL "$1" || :
scancel --batch --signal=TERM "$2" || :
wait_for_queue
[ "$(cells)" -lt $all ] || fail "two tasks were ended, and no cell is missing"
echo "$(cells) of $all cells"

array=$(submit --array=1-5%4 "$place/map.sh" --shard auto)
submit --dependency=afterany:"$array" "$place/map.sh" >/dev/null
wait_for_queue
cat "$place/log.txt"
grep -Eq "going on with what [0-9]+ parts of the study have: $all runs are there" "$place/log.txt" ||
  fail "the merge had cells to make"
# shellcheck disable=SC2086
"$cli" $study --out "$place/whole" >/dev/null
cmp "$place/parts/stability.csv" "$place/whole/stability.csv" || fail "the merged table is another one"
