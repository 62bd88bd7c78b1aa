"""Images of file systems on USB sticks, and a stand-in for systemd-mount that calls mount(8)."""

import ctypes
import os
import pathlib
import subprocess
import tempfile

CLONE_NEWNS = 0x00020000

# The device comes before its directory; --umount gets the directory. Calls are logged in `calls`; `hook` runs after a
# mount.
MOUNT = """#!/bin/sh -eu
folder={folder}
if [ "$1" = --umount ]; then umount "$2"; echo "umount ${{2##*/}}" >>$folder/calls; exit; fi
for word; do case $word in --options=*) options=${{word#*=}};; --type=*) type=${{word#*=}};; /*) device=${{place:-}} place=$word;; esac; done
mkdir -p "$place"
[ -e "$device" ] || exit 1
mount -t "$type" -o "loop,$options" "$device" "$place"
echo "mount ${{options%%,*}} ${{place##*/}}" >>$folder/calls
[ ! -e $folder/hook ] || sh -eu $folder/hook "${{options%%,*}}" "$place"
"""


def run(*command, **options):
    return subprocess.run(command, check=True, capture_output=True, text=True, **options)


def make(kind, image, size=16 << 20):
    with open(image, "wb") as made:
        made.truncate(size)
    run(f"mkfs.{kind}", *(["-q"] if kind != "vfat" else []), image,
        env={**os.environ, "PATH": os.environ["PATH"] + ":/usr/sbin:/sbin"})


def can_mount(kind):
    with tempfile.TemporaryDirectory() as folder:
        image, place = pathlib.Path(folder) / "image", pathlib.Path(folder) / "place"
        place.mkdir()
        try:
            make(kind, image)
        except (OSError, subprocess.CalledProcessError):
            return False
        if subprocess.run(["mount", "-o", "loop", image, place], capture_output=True, check=False).returncode != 0:
            return False
        run("umount", place)
        return True


def be_alone():
    """Makes mounts private, so that a mount namespace made meanwhile does not keep them mounted."""
    if ctypes.CDLL(None, use_errno=True).unshare(CLONE_NEWNS) != 0:
        raise OSError(ctypes.get_errno(), "unshare")
    run("mount", "--make-rslave", "/")


class Slots:
    """Sticks that are plugged into a box of plain files."""

    def __init__(self, folder):
        self.folder = folder
        for name in ("sticks", "block", "dev"):
            (folder / name).mkdir()
        self.mount, self.calls = folder / "mount", folder / "calls"
        self.mount.write_text(MOUNT.format(folder=folder))
        self.mount.chmod(0o755)
        self.calls.touch()

    def options(self):
        """adit-spare's options."""
        return ["--sticks", self.folder / "sticks", "--block", self.folder / "block", "--devices", self.folder / "dev",
                "--mount", self.mount]

    def place(self, name="sda1"):
        return self.folder / "sticks" / name

    def plug(self, image, name="sda1"):
        """Mounts the stick as services/adit-stick@.service does."""
        (self.folder / "dev" / name).symlink_to(image)
        block = self.folder / "block" / name
        block.mkdir()
        (block / "ro").write_text("0\n")
        self.mount_stick(name)

    def mount_stick(self, name="sda1"):
        subprocess.run([self.mount, "--type=vfat,exfat,ext4", "--options=ro,nosuid,nodev,noexec,noatime,errors=remount-ro",
                        self.folder / "dev" / name, self.place(name)], capture_output=True, check=False)
        self.calls.write_text("")

    def pull(self, name="sda1"):
        """Unplugs the stick, at any time."""
        for file in (self.folder / "block" / name).iterdir():
            file.unlink()
        (self.folder / "block" / name).rmdir()
        (self.folder / "dev" / name).unlink()
        subprocess.run(["umount", "--lazy", self.place(name)], capture_output=True, check=False)

    def unmount_all(self):
        for place in (self.folder / "sticks").iterdir():
            subprocess.run(["umount", "--lazy", place], capture_output=True, check=False)
