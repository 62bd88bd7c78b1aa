"""USB sticks for a container: images on this machine's loop devices, which the box's own units mount."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import container

sys.path.insert(0, str(container.SOURCE / "tests" / "applier"))
from mounting import can_mount, make, run  # noqa: E402

__all__ = ["Stick", "can_mount"]

DEVICES = "/run/devices"
# No device unit exists to bind to, so the stick must not look like a device to systemd, as files in /dev do.
UNITS = f"""units=/run/systemd/system
sed '/^BindsTo=/d; /^After=dev-/d; s,/dev/%i,{DEVICES}/%i,' /usr/lib/systemd/system/adit-stick@.service >$units/adit-stick@.service
mkdir -p $units/adit-spare.service.d {DEVICES}
printf '[Service]\\nExecStart=\\nExecStart=adit-spare --devices {DEVICES}\\n' >$units/adit-spare.service.d/devices.conf
systemctl daemon-reload"""


class Stick:
    """A stick with an ext4 file system."""

    def __init__(self, box, folder, name):
        self.box, self.image = box, folder / f"{name}.img"
        make("ext4", self.image)
        self.device = None

    def shell(self, script):
        done = self.box.run("sh", "-euc", script)
        assert done.returncode == 0, f"{script}: {done.stderr}"
        return done.stdout

    def unit(self):
        return f"adit-stick@{self.device.name}.service"

    def plug(self):
        """Starts the unit as udev does."""
        self.device = pathlib.Path(run("losetup", "--find", "--show", self.image).stdout.strip())
        number = self.device.stat().st_rdev
        here = f"{DEVICES}/{self.device.name}"
        self.shell(UNITS)
        self.shell(f"""test -b {self.device} || busybox mknod {self.device} b {os.major(number)} {os.minor(number)}
            test -b {here} || (touch {here}; mount --bind {self.device} {here}); systemctl start {self.unit()}""")

    def pull(self):
        if self.device is None:
            return
        self.shell(f"umount /run/adit-stick/{self.device.name}; rmdir /run/adit-stick/{self.device.name}; systemctl stop {self.unit()}")
        run("losetup", "--detach", self.device)
        self.device = None

    def as_it_is(self, name):
        """Reads a file on it, as another machine would."""
        with tempfile.TemporaryDirectory() as folder:
            image, place = pathlib.Path(folder) / "image", pathlib.Path(folder) / "place"
            place.mkdir()
            shutil.copy(self.image, image)
            run("mount", "-o", "loop,ro", image, place)
            try:
                return (place / name).read_bytes()
            finally:
                run("umount", place)

    def fill(self):
        """Unmounts it at a PC, with all bytes written."""
        name = self.device.name
        self.shell(f"umount /run/adit-stick/{name}; systemctl stop {self.unit()}")
        with tempfile.TemporaryDirectory() as place:
            run("mount", self.device, place)
            subprocess.run(["dd", "if=/dev/zero", f"of={place}/filler", "bs=4096"], capture_output=True, check=False)
            run("umount", place)
        self.shell(f"systemctl start {self.unit()}")
