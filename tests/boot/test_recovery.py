"""Killed, hung and panicked parts come back by themselves, and the lights are right."""

import dataclasses

import boards
import figures
import leds
import machine
from stage import Stage, Story, load_tests, note, setUpModule  # unittest looks for them here

PID = "systemctl show -p MainPID --value adit.service"
LATER = "/run/systemd/system/adit.service.d"  # what has systemd wait before it starts aditd again

HANG = (  # makes slot B, whose initrd loops instead of looking for its root
    "udevadm wait --timeout=100 /dev/disk/by-partlabel/adit-boot-a /dev/disk/by-partlabel/adit-boot-b /dev/disk/by-partlabel/adit-env",
    "mkdir /run/b && cd /run/b && dd if=/dev/disk/by-partlabel/adit-boot-a of=/dev/disk/by-partlabel/adit-boot-b bs=1M",
    "mount -t vfat /dev/disk/by-partlabel/adit-boot-b /mnt && busybox cpio -i init </mnt/initrd",
    "sed -i 's/^root=.*/while :; do :; done/' init && echo init | busybox cpio -o -H newc >>/mnt/initrd && umount /mnt && cd /",
)


class Recovery(Story):
    @classmethod
    def setUpClass(cls):
        cls.tell(Stage(board=dataclasses.replace(boards.QEMU_VIRT, words="adit.console")))  # with the image's own hardware watchdog

    def pid(self):
        return int(self.box.console.ask(PID))

    def comes_back(self):
        """Waits until another process answers. Returns the time since hit(), in words."""
        self.box.wait_until(
            lambda: self.pid() not in (0, self.before) and self.box.answers(), "another aditd to answer", 180
        )
        return self.box.took(self.when)

    def hit(self, how):
        type(self).before, type(self).when = self.pid(), self.box.moment()
        self.box.console.type(f"kill -{how} {self.before}")

    def test_prepared_card_sets_the_box_up(self):
        self.stage.start().began()
        note("first start of a prepared card, from power to the first answer on team0", self.box.start_took)
        self.box.console.wait_for_shell()
        self.assertEqual(self.box.ask("GET /adit/settings")[1]["tokens"]["scoring"], True)

    def test_lights_are_dark_or_show_a_fault_after_a_kill(self):
        leds.wait_for(self.box, health="on", scoring="on", mapping="on")
        self.box.console.ask(f"mkdir {LATER} && printf '[Service]\\nRestartSec=600\\n' >{LATER}/later.conf")
        self.box.console.reload()
        self.hit("KILL")
        self.box.wait_until(self.are_dark, "the lights not to pretend any more")
        note("dark after a kill -9", self.box.took(self.when))
        self.assertEqual(self.pid(), 0, "nobody else made them so")
        self.box.console.ask(f"rm -r {LATER}")
        self.box.console.reload()
        self.box.console.ask("systemctl restart adit")
        leds.wait_for(self.box, health="on", scoring="on")

    def are_dark(self):
        lights = self.box.lights()
        return not (lights["scoring"] or lights["mapping"] or lights["attention"])

    def test_and_it_is_started_again(self):
        self.hit("KILL")
        note("serves again after a kill -9", self.comes_back())
        leds.wait_for(self.box, health="on", scoring="on")

    def test_a_kernel_that_panics_starts_the_box_again(self):
        self.box.console.type("echo c > /proc/sysrq-trigger")
        self.restarts("a kernel panic")

    def test_and_that_start_stays_within_its_figures(self):
        self.box.console.wait_for_shell()
        figures.of_a_later_start(self.box)
        self.assertLessEqual(figures.memory_in_use(self.box), 64)

    def test_firewall_and_addresses_are_set_before_systemd(self):
        for unit in "adit-nftables", "adit-network-start":
            said = self.box.console.ask(f"systemctl show -P ConditionResult -P ActiveState {unit}").split()
            self.assertEqual(said, ["inactive", "no"])
        self.assertIn("chain from_team", self.box.console.ask("nft list table inet adit"))
        self.box.console.ask("systemctl is-active adit-devices.service; test -e /dev/watchdog0 -a -e /dev/disk/by-partlabel/adit-env")

    def test_units_have_only_the_rights_they_need(self):
        seen = list(figures.exposures(self.box))
        self.assertIn("adit.service", [unit for unit, *_ in seen])
        self.assertEqual([], [each for each in seen if each[1] > each[2]])

    def test_a_kernel_that_hangs_is_reset_by_the_hardware_watchdog(self):
        self.box.console.ask("echo 0 > /proc/sys/kernel/panic")  # so that the panic itself starts nothing
        self.box.console.type("echo c > /proc/sysrq-trigger")
        self.restarts("a kernel that hangs")

    def test_hanging_initrd_is_reset_by_the_watchdog_and_its_slot_left(self):
        self.box.console.wait_for_shell()
        for command in HANG:
            self.box.console.ask(command)
        self.box.console.ask("fw_setenv BOOT_ORDER 'B A' && fw_setenv BOOT_B_LEFT 1 && sync")
        heard = len(self.box.console.heard)
        self.box.console.type("echo b > /proc/sysrq-trigger")
        self.box.console.wait_for(rb"Adit: slot b.*Starting kernel.*Adit: slot a", 400, heard)
        self.box.wait_until(self.box.answers, "the good slot to answer", 400)

    def test_boot_that_systemd_gives_up_is_retried(self):
        self.box.cut_power()
        self.stage.disk.put("adit/boot.env", "adit_cmdline=adit.console systemd.unit=emergency.target\n")
        self.box.power_on()
        self.box.console.wait_for(machine.GAVE_UP.encode() + rb".*Starting kernel", 400)

    def restarts(self, why):
        began, heard = self.box.moment(), len(self.box.console.heard)
        self.box.console.wait_for(rb"Starting kernel", 400, heard)
        self.box.wait_until(self.box.answers, "the box to answer", 400)
        note(f"serves again after {why}", self.box.took(began))
