#!/bin/sh
# A real Slurm of one node in one folder, for tests: no systemd, no cgroups, nothing outside the folder. As root.
#     slurm_here.sh start DIR [MAX_ARRAY_SIZE]   prints the SLURM_CONF to export
#     slurm_here.sh slurmd DIR                   starts slurmd again
#     slurm_here.sh stop DIR
# The node says that it has eight processors: tasks are to get in each other's way.
set -eu
verb=${1:?start, slurmd or stop}
mkdir -p "${2:?a folder}"
dir=$(readlink -f "$2")
export SLURM_CONF="$dir/slurm.conf"

# A port that nobody listens at, and the one after it.
free_port() {
  port=$((20000 + ($$ % 20000)))
  while ss -Htln 2>/dev/null | awk '{ print $4 }' | grep -qE ":($port|$((port + 1)))\$"; do port=$((port + 2)); done
  echo $port
}

wait_for_node() {
  tries=0
  until sinfo -h -o %T 2>/dev/null | grep -qE 'idle|mixed|allocated'; do
    tries=$((tries + 1))
    [ $tries -le 600 ] || {
      echo "slurm_here.sh: the node does not come up; see $dir/log" >&2
      exit 1
    }
    sleep 0.2
  done
}

write_conf() {
  host=$(hostname -s)
  port=$(free_port)
  cat >"$SLURM_CONF" <<END
ClusterName=lab
SlurmctldHost=$host(127.0.0.1)
AuthType=auth/munge
AuthInfo=socket=$dir/run/munge.sock
SlurmctldPort=$port
SlurmdPort=$((port + 1))
SlurmUser=root
SlurmdUser=root
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool
SlurmctldPidFile=$dir/run/slurmctld.pid
SlurmdPidFile=$dir/run/slurmd.pid
SlurmctldLogFile=$dir/log/slurmctld.log
SlurmdLogFile=$dir/log/slurmd.log
SlurmdParameters=config_overrides
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=sched_interval=5,bf_interval=5,sched_min_interval=10000,default_queue_depth=1000
MaxArraySize=${1:-1001}
MaxJobCount=20000
ReturnToService=2
MpiDefault=none
NodeName=$host NodeAddr=127.0.0.1 CPUs=8 State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP
END
}

case $verb in
  start)
    mkdir -p "$dir/run" "$dir/spool" "$dir/state" "$dir/log"
    dd if=/dev/urandom of="$dir/munge.key" bs=128 count=8 status=none
    chmod 400 "$dir/munge.key"
    write_conf "${3:-1001}"
    munged --key-file="$dir/munge.key" --socket="$dir/run/munge.sock" --pid-file="$dir/run/munged.pid" \
      --log-file="$dir/log/munged.log" --seed-file="$dir/state/munge.seed" --force >"$dir/log/munged.out" 2>&1
    slurmctld >"$dir/log/slurmctld.out" 2>&1
    slurmd >"$dir/log/slurmd.out" 2>&1
    wait_for_node
    echo "$SLURM_CONF"
    ;;
  slurmd)
    slurmd >>"$dir/log/slurmd.out" 2>&1
    wait_for_node
    ;;
  stop)
    for daemon in slurmd slurmctld munged; do
      [ ! -f "$dir/run/$daemon.pid" ] || kill "$(cat "$dir/run/$daemon.pid")" 2>/dev/null || :
    done
    ;;
  *)
    echo "usage: slurm_here.sh start|slurmd|stop DIR" >&2
    exit 2
    ;;
esac
