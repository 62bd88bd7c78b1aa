# U-Boot's part of two slots: counts down the tries of the slot that is next in BOOT_ORDER, and starts it. The counts lie in the
# first sector of adit-env with a checksum, and a sector is written as a whole or not at all. RAUC sets them: 3 for a slot that it
# has written, ten once it came up healthy. Counts are hexadecimal, to RAUC and to setexpr: ten is a, and test would take it for none.
setenv BOOT_ORDER "A B"
setenv BOOT_A_LEFT a
setenv BOOT_B_LEFT a
part start ${devtype} ${devnum} 1 adit_env
if ${devtype} read ${kernel_addr_r} ${adit_env} 1; then
  env import -c ${kernel_addr_r} 0x200 BOOT_ORDER BOOT_A_LEFT BOOT_B_LEFT || echo "Adit: no boot environment yet"
fi

# A slot that holds nothing is passed over, and uses up no try.
setenv adit_slot
for slot in ${BOOT_ORDER}; do
  if test -n "${adit_slot}"; then
    true
  elif test "${slot}" = "A" -a "${BOOT_A_LEFT}" != "0"; then
    if size ${devtype} ${devnum}:3 slot.scr; then
      setexpr BOOT_A_LEFT ${BOOT_A_LEFT} - 1
      setenv adit_slot a
      setenv adit_name A
      setenv adit_part 3
    fi
  elif test "${slot}" = "B" -a "${BOOT_B_LEFT}" != "0"; then
    if size ${devtype} ${devnum}:4 slot.scr; then
      setexpr BOOT_B_LEFT ${BOOT_B_LEFT} - 1
      setenv adit_slot b
      setenv adit_name B
      setenv adit_part 4
    fi
  fi
done
if test -z "${adit_slot}"; then
  echo "Adit: no slot has come up; all are tried again"
  setenv BOOT_A_LEFT 3
  setenv BOOT_B_LEFT 3
fi
env export -c -s 0x200 ${kernel_addr_r} BOOT_ORDER BOOT_A_LEFT BOOT_B_LEFT
${devtype} write ${kernel_addr_r} ${adit_env} 1
if test -z "${adit_slot}"; then
  sleep 1
  reset
fi

# Whoever has the card may add words to the kernel's: see rootfs/README.md.
setenv adit_cmdline
if load ${devtype} ${devnum}:2 ${kernel_addr_r} adit/boot.env; then
  env import -t ${kernel_addr_r} ${filesize} adit_cmdline
fi

echo "Adit: slot ${adit_slot}"
load ${devtype} ${devnum}:${adit_part} ${scriptaddr} slot.scr && source ${scriptaddr}
echo "Adit: slot ${adit_slot} does not start"
sleep 1
reset
