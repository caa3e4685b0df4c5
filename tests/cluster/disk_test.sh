#!/bin/sh
# A sweep on a small disk that fills up: exit code 4, whole lines, and it goes on when there is room.
here=$(dirname "$0")
. "$here/common.sh"
need unshare rev
[ "$(id -u)" -eq 0 ] || skip "a disk of its own needs root"
if [ "${CLOTHLAB_OWN_MOUNTS:-}" != yes ]; then
  unshare -m true 2>/dev/null || skip "no mounts of its own are allowed here"
  CLOTHLAB_OWN_MOUNTS=yes unshare -m sh "$0" "$cli"
  exit
fi

write_plan 20 0.1
run_whole
mkdir "$place/parts"
mount -t tmpfs -o size=24k tmpfs "$place/parts" || skip "no tmpfs can be mounted here"
code=0
"$cli" sweep "$place/p.sweep.json" --out "$place/parts" --shard 1/1 || code=$?
[ $code -eq 4 ] || fail "on a full disk the exit code is $code"
"$cli" sweep status "$place/parts"
missing=$("$cli" sweep status "$place/parts" --json | awk -F '[:,]' '/"missing"/ { print $2 }')
[ "$missing" -gt 0 ] && [ "$missing" -lt 200 ] || fail "$missing points are missing on a full disk"
"$cli" sweep status "$place/parts" --json | grep -q '"damaged_lines": 0' || fail "there are lines that are no rows"
mount -o remount,size=4m "$place/parts"
"$cli" sweep --out "$place/parts"
expect_the_same parts
umount "$place/parts"
