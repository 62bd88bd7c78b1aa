"""Updates with other versions, made from the existing image: its root with another version, or with a missing file; and sticks with
updates."""

import os
import shutil
import subprocess

import boards


def bundle(folder, version, board="qemu-virt", without=None, source=boards.QEMU_VIRT):
    """A bundle for `board` from the image of `source`, signed as by toolchain/image. `without`: a file that its root lacks."""
    work, output = folder / f"work-{version}", folder / f"adit-{board}-{version}.raucb"
    made = source.images / "work"
    work.mkdir()
    root = work / "root"
    subprocess.run(
        ["unsquashfs", "-q", "-n", "-d", root, made / "root.squashfs"], check=True, stdout=subprocess.DEVNULL
    )
    release = root / "usr/lib/os-release"
    lines = [
        f"VERSION_ID={version}" if line.startswith("VERSION_ID=") else line for line in release.read_text().splitlines()
    ]
    release.write_text("\n".join(lines) + "\n")
    if without:
        (root / without).unlink()
    # Fast compression, large result.
    subprocess.run(
        [
            "mksquashfs",
            root,
            work / "root.squashfs",
            "-noI",
            "-noD",
            "-noF",
            "-all-root",
            "-noappend",
            "-no-xattrs",
            "-quiet",
            "-no-progress",
        ],
        check=True,
        stdout=subprocess.DEVNULL,
    )
    shutil.rmtree(root)
    (work / "boot.vfat").symlink_to(made / "boot.vfat")
    subprocess.run([boards.SOURCE / "rootfs" / "bundle", board, version, work, output], check=True)
    shutil.rmtree(work)
    return output


def bundle_of_nothing(folder, version, board):
    """A small signed bundle, for rejections before a slot is written."""
    work, output = folder / f"work-{version}", folder / f"adit-{board}-{version}.raucb"
    work.mkdir()
    for name in ("root.squashfs", "boot.vfat"):
        (work / name).write_bytes(os.urandom(1 << 16))  # what is packed to less than a block makes no bundle
    subprocess.run([boards.SOURCE / "rootfs" / "bundle", board, version, work, output], check=True)
    return output


def stick(folder, *files):
    """A USB stick's bytes: two partitions with FAT file systems, and these files in the second."""
    image = folder / "stick.img"
    sizes = [64, 256]  # MiB
    with open(image, "wb") as made:
        made.truncate((sum(sizes) + 2) << 20)
    table = "".join(f"size={size}MiB, type=c\n" for size in sizes)
    subprocess.run(["sfdisk", "--quiet", image], input=table.encode(), check=True)
    starts = [1, 1 + sizes[0]]
    for start, size in zip(starts, sizes):
        subprocess.run(["mformat", "-i", f"{image}@@{start}M", "-F", "-T", str((size << 20) // 512), "::"], check=True)
    subprocess.run(["mcopy", "-i", f"{image}@@{starts[1]}M", *files, "::"], check=True)
    return image
