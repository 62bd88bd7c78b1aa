# Starts the next slot of BOOT_ORDER that has tries left, and uses up one try. boot.cmd has read the environment from the sector adit_env;
# if a slot's try is counted already, adit_counted is its name. Only commands of 2017: see boot.cmd.

# An empty slot is skipped and uses up no try.
setenv adit_slot
for slot in ${BOOT_ORDER}; do
  if test -n "${adit_slot}"; then
    true
  elif test "${slot}" = "A" -a "${BOOT_A_LEFT}" != "0"; then
    if size ${devtype} ${devnum}:3 slot.scr; then
      setenv adit_slot a
      setenv adit_name A
      setenv adit_part 3
      setenv adit_left ${BOOT_A_LEFT}
    fi
  elif test "${slot}" = "B" -a "${BOOT_B_LEFT}" != "0"; then
    if size ${devtype} ${devnum}:4 slot.scr; then
      setenv adit_slot b
      setenv adit_name B
      setenv adit_part 4
      setenv adit_left ${BOOT_B_LEFT}
    fi
  fi
done

# One try less. A count that is not in the list was not set by RAUC, and counts as ten.
setenv adit_less 9
setenv adit_below 0
for count in 1 2 3 4 5 6 7 8 9 a; do
  if test "${adit_left}" = "${count}"; then
    setenv adit_less ${adit_below}
  fi
  setenv adit_below ${count}
done
if test "${adit_slot}" = "a"; then
  setenv BOOT_A_LEFT ${adit_less}
elif test "${adit_slot}" = "b"; then
  setenv BOOT_B_LEFT ${adit_less}
else
  echo "Adit: no slot has come up; retrying all slots"
  setenv BOOT_A_LEFT 3
  setenv BOOT_B_LEFT 3
fi
if test -z "${adit_slot}" -o "${adit_name}" != "${adit_counted}"; then
  env export -c -s 0x200 ${kernel_addr_r} BOOT_ORDER BOOT_A_LEFT BOOT_B_LEFT
  ${devtype} write ${kernel_addr_r} ${adit_env} 1
fi
if test -z "${adit_slot}"; then
  sleep 1
  reset
fi

# adit/boot.env on the card may add words to the kernel's command line: see rootfs/README.md.
setenv adit_cmdline
if load ${devtype} ${devnum}:2 ${kernel_addr_r} adit/boot.env; then
  env import -t ${kernel_addr_r} ${filesize}
fi

echo "Adit: slot ${adit_slot}"
load ${devtype} ${devnum}:${adit_part} ${scriptaddr} slot.scr && source ${scriptaddr}
echo "Adit: slot ${adit_slot} does not start"
sleep 1
reset
