# Starts the next slot of BOOT_ORDER that has tries left, and uses up one try. The counts are in the first sector of adit-env, with a
# checksum. A sector is written completely or not at all. RAUC sets a count to 3 after it has written a slot, and to ten when the slot has
# come up healthy. RAUC reads counts as hexadecimal: ten is a.
#
# This must also run in factory boot loaders of 2017 (board/espressobin/README.md): they have no setexpr, and their env import takes no
# names of variables (Marvell's cmd/nvedit.c, commit 6dd70774).
setenv BOOT_ORDER "A B"
setenv BOOT_A_LEFT a
setenv BOOT_B_LEFT a
part start ${devtype} ${devnum} 1 adit_env
if ${devtype} read ${kernel_addr_r} ${adit_env} 1; then
  env import -c ${kernel_addr_r} 0x200 || echo "Adit: no boot environment yet"
fi

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
env export -c -s 0x200 ${kernel_addr_r} BOOT_ORDER BOOT_A_LEFT BOOT_B_LEFT
${devtype} write ${kernel_addr_r} ${adit_env} 1
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
