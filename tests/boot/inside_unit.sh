#!/bin/sh
# Tries what adit.service's sandbox is to allow and to refuse, a line for each: "allowed WHAT" or "refused WHAT: why". Runs inside a copy of
# that unit, on what the image has (busybox), by inside_unit.py.
attempt() { # WHAT COMMAND...; what still runs after 30 s is allowed: less is too little for a busy machine to refuse it
  what=$1
  shift
  said=$(busybox timeout 30 "$@" 2>&1 </dev/null)
  case $? in
    0 | 143) echo "allowed $what" ;;
    *) echo "refused $what: $(echo "$said" | head -n 1)" ;;
  esac
}
write() { attempt "write $1" sh -c ": >$1/adit-was-here"; }
read_from() { attempt "read $1" head -c 1 "$1"; }

echo "is $(grep -E '^(CapEff|CapBnd|NoNewPrivs|Seccomp):' /proc/self/status | tr -s '\t\n' ' ')"
for folder in "$STATE_DIRECTORY" "$RUNTIME_DIRECTORY" /tmp; do write "$folder"; done
attempt "read its credentials" cat "$CREDENTIALS_DIRECTORY/team.token"
read_from /dev/urandom
for address in 127.0.0.1 203.0.113.1; do # the latter is the machine's own, too, for as long as this runs
  nc -l -p 8111 >/dev/null &
  attempt "connect to $address" sh -c "sleep 1; nc -w 2 $address 8111 || { sleep 5; nc -w 2 $address 8111; }"
  kill $! 2>/dev/null
done

for folder in / /boot /dev /dev/mqueue /dev/shm /etc /etc/adit /home /mnt /opt /root /run /run/lock /run/systemd/network /srv /sys/fs/cgroup \
  /usr /usr/bin /var /var/lib /var/log /var/lib/private /var/lib/private/adit; do
  write "$folder"
done
attempt "write /proc/sys" sh -c 'echo 1 >/proc/sys/net/ipv4/ip_forward'
attempt "write /sys" sh -c 'echo mem >/sys/power/state'
for file in /etc/adit/secrets/team.token /var/lib/private/adit/settings.json /dev/mem /dev/kmsg /dev/sda /dev/vda /dev/tty0 /dev/watchdog0 /dev/gpiochip0; do
  read_from "$file"
done
attempt "make a device" mknod /tmp/memory c 1 1
attempt "see the first process" cat /proc/1/cmdline

attempt "listen at port 81" nc -l -p 81
attempt "send a packet of its own" busybox arping -c 1 -I team0 10.0.0.77
attempt "set an interface" ip link set dev team0 mtu 1400
attempt "forward" busybox sysctl -w net.ipv4.ip_forward=1

attempt "mount" mount -t tmpfs tmpfs /tmp
attempt "be in a namespace of its own" busybox unshare -U true
attempt "be root" busybox start-stop-daemon -S -c 0 -p /tmp/none -x /usr/bin/busybox -- true
attempt "change its root" busybox chroot / true
attempt "set the clock" sh -c '! busybox date -s @0 2>&1 | grep "not permitted"'
attempt "set the host's name" busybox hostname adit-was-here
attempt "end another process" kill -0 1
# shellcheck disable=SC2016
attempt "make a program that gives rights" sh -c 'cp /usr/bin/busybox "$STATE_DIRECTORY/b" && chmod 4755 "$STATE_DIRECTORY/b"'
attempt "stop a unit" systemctl stop systemd-networkd.service
