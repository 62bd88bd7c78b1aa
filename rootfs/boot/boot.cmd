# The first stage, which no update replaces. It chooses the script that decides which slot to start: decide.cmd of the image, which
# rootfs/boot/loader appends here, or decide.scr of a slot.
#
# The counts of tries are in the first sector of adit-env, with a checksum. A sector is written completely or not at all. RAUC sets a count
# to 0 before it writes a slot, to 3 after that, and to ten when the slot has come up healthy. RAUC reads counts as hexadecimal: ten is a.
#
# This must also run in factory boot loaders of 2017 (board/espressobin/README.md): they have no setexpr, and their env import takes no
# names of variables (Marvell's cmd/nvedit.c, commit 6dd70774).
setenv BOOT_ORDER "A B"
setenv BOOT_A_LEFT 9
setenv BOOT_B_LEFT 9
part start ${devtype} ${devnum} 1 adit_env
if ${devtype} read ${kernel_addr_r} ${adit_env} 1; then
  env import -c ${kernel_addr_r} 0x200 || echo "Adit: no boot environment yet"
fi

# A slot with ten tries has come up healthy and was not started since: its script may run. Its try is counted first. So a script that hangs
# or fails does not run again until the slot has come up healthy.
setenv adit_counted
for slot in ${BOOT_ORDER}; do
  if test -n "${adit_counted}"; then
    true
  elif test "${slot}" = "A" -a "${BOOT_A_LEFT}" = "a"; then
    if size ${devtype} ${devnum}:3 decide.scr; then
      setenv adit_counted A
      setenv adit_part 3
      setenv BOOT_A_LEFT 9
    fi
  elif test "${slot}" = "B" -a "${BOOT_B_LEFT}" = "a"; then
    if size ${devtype} ${devnum}:4 decide.scr; then
      setenv adit_counted B
      setenv adit_part 4
      setenv BOOT_B_LEFT 9
    fi
  fi
done
if test -n "${adit_counted}"; then
  env export -c -s 0x200 ${kernel_addr_r} BOOT_ORDER BOOT_A_LEFT BOOT_B_LEFT
  if ${devtype} write ${kernel_addr_r} ${adit_env} 1; then
    load ${devtype} ${devnum}:${adit_part} ${scriptaddr} decide.scr && source ${scriptaddr}
    echo "Adit: the script of slot ${adit_counted} cannot decide"
    sleep 1
    reset
  fi
fi
