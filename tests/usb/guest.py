"""A small virtual machine with Debian's kernel and this build's programs, and a virtual board on its
USB: what the tests of the device usb run in. Software emulation only, nothing of the machine is
changed, no root needed."""
import os
import pathlib
import re
import shutil
import subprocess
import tarfile
import tempfile
import time

BIN = pathlib.Path(os.environ.get("GRIDRT_BIN", "build/bin")).resolve()
KERNEL = pathlib.Path(os.environ.get("GRIDRT_GUEST_KERNEL", "build/guest-kernel")).resolve()
MODULES = ("usb-common", "usbcore", "xhci-hcd", "xhci-pci", "hid", "hid-generic", "usbhid",
           "usbip-core", "vhci-hcd")
ADVICE = 'run "tools/setup test", which installs what the guest needs'
INIT = """#!/bin/busybox sh
/bin/busybox --install -s /bin
mount -t proc none /proc; mount -t sysfs none /sys; mount -t devtmpfs none /dev
for m in {modules}; do insmod /modules/$m.ko || echo "insmod $m failed"; done
ifconfig lo 127.0.0.1 up
export PATH=/bin:/programs LD_LIBRARY_PATH=/lib LC_ALL=C.UTF-8 HOME=/
stty raw -echo -F /dev/ttyS1
mkdir -p /out; cd /out
mkdir -p /usr/share/misc /var/run; touch /usr/share/misc/usb.ids  # for usbip
i=0  # until the kernel has seen the boards that are plugged in
while [ $(ls /dev | grep -c '^hidraw') -lt {boards} ] && [ $i -lt 300 ]; do
  sleep 0.1; i=$((i + 1))
done
echo guest: up after $(cut -d' ' -f1 /proc/uptime) s
. /test.sh
"""


class GuestError(Exception):
    """The guest did not come to the end of its script; the text has its console."""


def need(path, what):
    found = shutil.which(path) if os.sep not in str(path) else pathlib.Path(path)
    if not found or not pathlib.Path(found).exists():
        raise GuestError(f"{what} is missing ({path}): {ADVICE}")
    return pathlib.Path(found)


def libraries(program):
    """The shared libraries that a program is linked with."""
    listed = subprocess.run(["ldd", program], capture_output=True, text=True, check=False).stdout
    return {pathlib.Path(path) for path in re.findall(r"(/\S+) \(0x", listed)}


class Guest:
    """Boots, runs a shell script, and gives back what it printed and the files it left in /out."""

    def __init__(self, programs, files=None, memory_mb=1024):
        self.folder = tempfile.TemporaryDirectory(prefix="gridrt-guest-")
        self.path = pathlib.Path(self.folder.name)
        self.programs = [need(BIN / name, f"the program {name}") for name in programs]
        self.files = files or {}
        self.memory_mb = memory_mb
        self.qemu = need("qemu-system-x86_64", "QEMU")
        self.busybox = need("/bin/busybox", "a static busybox")
        self.kernel = need(next(iter(sorted(KERNEL.glob("vmlinuz-*"))), KERNEL / "vmlinuz"),
                           "the guest's kernel")
        self.boards = []

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for board in self.boards:
            board.kill()
            board.wait()
            board.stdout.close()
        self.folder.cleanup()

    def start_board(self, *words, program="gridrt-virtual-board"):
        """A virtual board for the guest's USB; returns the path of its socket."""
        socket = self.path / f"board{len(self.boards)}"
        words = [*map(str, words), *(["--redirect"] if program == "gridrt-virtual-board" else [])]
        self.boards.append(subprocess.Popen([need(BIN / program, "the board"), *words, socket],
                                            stdout=subprocess.PIPE, text=True))
        if "waiting" not in self.boards[-1].stdout.readline():
            raise GuestError("the virtual board did not start")
        return socket

    def initramfs(self, script, boards):
        root = self.path / "root"
        for name in ("bin", "etc", "lib", "lib64", "modules", "programs", "proc", "sys", "dev", "tmp"):
            (root / name).mkdir(parents=True, exist_ok=True)
        shutil.copy(self.busybox, root / "bin" / "busybox")
        for module in MODULES:
            shutil.copy(need(KERNEL / f"{module}.ko", "a module of the guest's kernel"),
                        root / "modules")
        needed = set()
        for program in self.programs:
            shutil.copy(program, root / "programs")
            needed |= libraries(program)
        for library in needed:
            # The loader is named by its path in every program, the others are looked for in /lib.
            place = "lib64" if library.name.startswith("ld-linux") else "lib"
            shutil.copy(library.resolve(), root / place / library.name)
        (root / "etc" / "passwd").write_text("root:x:0:0::/:/bin/sh\nnobody:x:65534:65534::/:/bin/sh\n",
                                             encoding="ascii")
        for name, content in self.files.items():
            (root / name).write_bytes(content)
        (root / "init").write_text(INIT.format(modules=" ".join(MODULES), boards=boards), encoding="utf-8")
        (root / "init").chmod(0o755)
        ending = ("\necho guest: test ends with $?\n"
                  "tar -c -f /dev/ttyS1 -C /out .\nsync\npoweroff -f\n")
        (root / "test.sh").write_text("(\n" + script + "\n)" + ending, encoding="utf-8")
        names = subprocess.run(["find", ".", "-print0"], cwd=root, capture_output=True, check=True)
        image = self.path / "initrd"
        with open(image, "wb") as file:
            subprocess.run([self.busybox, "cpio", "-o", "-H", "newc", "-0"], cwd=root, check=True,
                           input=names.stdout, stdout=file, stderr=subprocess.DEVNULL)
        return image

    def run(self, script, boards=(), timeout=300):
        """(console, {name: bytes} of /out). `boards` are sockets of start_board()."""
        console, parcel = self.path / "console", self.path / "parcel"
        words = [self.qemu, "-accel", os.environ.get("GRIDRT_GUEST_ACCEL", "tcg,thread=multi"), "-smp", "2", "-m", self.memory_mb,
                 "-machine", "pc", "-cpu", "max", "-nodefaults", "-no-user-config", "-display",
                 "none", "-no-reboot", "-kernel", self.kernel,
                 "-initrd", self.initramfs(script, len(boards)),
                 "-append", "console=ttyS0 quiet panic=-1 no_timer_check mitigations=off tsc=reliable "
                 "suspend.pm_test_delay=1",
                 "-serial", f"file:{console}", "-serial", f"file:{parcel}", "-device", "qemu-xhci"]
        for i, socket in enumerate(boards):
            words += ["-chardev", f"socket,id=board{i},path={socket}",
                      "-device", f"usb-redir,chardev=board{i}"]
        started = time.monotonic()
        machine = subprocess.Popen([str(w) for w in words], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True)
        try:
            _, errors = machine.communicate(timeout=timeout)
        except subprocess.TimeoutExpired:
            machine.kill()
            _, errors = machine.communicate()
            errors += f"not done after {timeout} s"
        self.seconds = time.monotonic() - started
        text = console.read_text(encoding="utf-8", errors="replace") if console.exists() else ""
        text = text.replace("\r\n", "\n")
        if machine.returncode != 0 or "guest: test ends with" not in text:
            raise GuestError(f"QEMU: {errors}\n{text}")
        return text, self.parcels(parcel)

    @staticmethod
    def parcels(parcel):
        files = {}
        with tarfile.open(parcel, "r:") as archive:
            for member in archive:
                if member.isfile():
                    files[pathlib.PurePath(member.name).name] = archive.extractfile(member).read()
        return files
