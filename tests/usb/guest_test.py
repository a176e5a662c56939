"""The programs on a board that a real kernel has enumerated: the bytes of seq, reports, boards that
start from flash, and what goes wrong on a desk."""
import json
import pathlib
import re
import struct
import subprocess
import tempfile
import unittest

from guest import BIN, Guest

SIZE = "64x48"
SMALL = "24x18"
FLASHES = ("good", "flipped", "cut", "eight")  # /NAME.flash: boards that start from one
SCRIPT = f"""
run() {{ echo "== $1"; shift; "$@" 2>&1; echo "-- $?"; }}
as_nobody() {{ su nobody -c "LD_LIBRARY_PATH=/lib PATH=/programs $*"; }}
second=/sys/bus/usb/devices/usb1/1-0:1.0/usb1-port2/disable  # the board around the RTL comes later
echo 1 >$second
for i in $(seq 50); do [ -e /dev/hidraw0 ] && break; sleep 0.1; done
run devices gridrt-host --list-devices
run render gridrt-host /teapot.grt --size {SIZE} --device usb:virtual-1 --hits usb.npy -o usb.png \\
    --stats usb.json --progress off
run auto gridrt-host /teapot.grt --size {SIZE} -o auto.png
run other gridrt-host /teapot.grt --size {SIZE} --device usb:other -o other.png
run list gridrt-board list
run info gridrt-board info
run log gridrt-board log
gridrt-board log --follow 5 >followed 2>&1 &
sleep 1
run selftest gridrt-board selftest
run counters gridrt-board counters
run load gridrt-board load /teapot.grt
run loaded gridrt-board info
run reset gridrt-board reset
wait
run followed cat followed
run no-permission-frames as_nobody gridrt-host /teapot.grt --device usb --hits n.npy
run no-permission-reports as_nobody gridrt-board info
run no-permission-list as_nobody gridrt-board list
(gridrt-host /teapot.grt --size 640x480 --samples 16 --device usb -o big.png --progress off \\
    >unplugged 2>&1; echo "ended with $?" >>unplugged) &
for i in $(seq 100); do [ $(gridrt-board counters | sed -n 's/rays *//p') -gt 0 ] && break; done
run in-use gridrt-board load /teapot.grt
run reports-meanwhile gridrt-board counters
echo 1 >/sys/bus/usb/devices/1-1/remove
wait
run unplugged cat unplugged
run no-board gridrt-board info
gridrt-virtual-board --core seq --usbip 3240 --serial over-ip &
for i in $(seq 50); do usbip list -r 127.0.0.1 >exported 2>/dev/null && break; sleep 0.1; done
run usbip-list cat exported
run usbip-attach usbip attach -r 127.0.0.1 -b 1-1
for i in $(seq 50); do [ -e /dev/hidraw0 ] && break; sleep 0.1; done
run usbip-render gridrt-host /teapot.grt --size {SIZE} --device usb:over-ip -o ip.png
run usbip-selftest gridrt-board selftest
echo 0 >$second
for i in $(seq 50); do [ $(ls /dev | grep -c '^hidraw') = 2 ] && break; sleep 0.1; done
run rtl-flash gridrt-host /cube.grt --size {SMALL} --device usb:rtl --hits rtl-cube.npy --stats rtl.json
run rtl-render gridrt-host /teapot.grt --size {SMALL} --device usb:rtl --hits rtl.npy -o rtl.png
gridrt-board --device usb:rtl log >/dev/null
gridrt-board --device usb:rtl log --follow 60 >rtl-followed 2>&1 &
follower=$!
sleep 1
run rtl-selftest gridrt-board --device usb:rtl selftest
for i in $(seq 300); do grep -q SelfTest rtl-followed && break; sleep 0.1; done
kill $follower
run rtl-followed cat rtl-followed
boards=$(ls /dev | grep -c '^hidraw')
port=3241
for f in {" ".join(FLASHES)}; do
  gridrt-virtual-board --core seq --usbip $port --serial $f --flash /$f.flash &
  for i in $(seq 50); do usbip --tcp-port $port list -r 127.0.0.1 >/dev/null 2>&1 && break; sleep 0.1; done
  # Soon after another one it may fail to open the driver.
  for i in $(seq 50); do usbip --tcp-port $port attach -r 127.0.0.1 -b 1-1 && break; sleep 0.1; done
  port=$((port + 1)); boards=$((boards + 1))
done
for i in $(seq 50); do [ $(ls /dev | grep -c '^hidraw') = $boards ] && break; sleep 0.1; done
for f in {" ".join(FLASHES)}; do
  run $f-info gridrt-board --device usb:$f info
  run $f-log gridrt-board --device usb:$f log
  run $f-render gridrt-host /teapot.grt --size {SMALL} --device usb:$f --hits $f.npy -o $f.png --stats $f.json
done
run other-scene gridrt-host /cube.grt --size {SMALL} --device usb:good --hits cube.npy --stats cube.json
run back-again gridrt-host /teapot.grt --size {SMALL} --device usb:good --hits back.npy --stats back.json
"""


def crc32c(data):
    crc = 0xFFFFFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0x82F63B78 if crc & 1 else 0)
    return struct.pack("<I", crc ^ 0xFFFFFFFF)


def for_eight_pes(flash):
    """The flash image with a header as of a board with eight PEs, and with right CRCs."""
    flash = bytearray(flash)
    payload = 36 + 20  # behind FlashHeader and FrameHeader
    length, = struct.unpack_from("<I", flash, payload - 8)
    image = payload + 16  # behind LoadHead
    total, = struct.unpack_from("<I", flash, payload + 8)
    flash[image + 7] = 8  # ImageHeader.pes
    flash[image + total - 4:image + total] = crc32c(flash[image:image + total - 4])
    flash[payload + length:payload + length + 4] = crc32c(flash[payload:payload + length])
    return flash


class OnADesk(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.path = pathlib.Path(scratch.name)
        cls.program("gridrt-image", "builtin:teapot?tessellation=6", "--layout", "compact", "-o",
                    "teapot.grt")
        cls.program("gridrt-host", "teapot.grt", "--size", SIZE, "--device", "seq", "--hits",
                    "seq.npy", "-o", "seq.png")
        cls.program("gridrt-host", "teapot.grt", "--size", SMALL, "--device", "seq", "--hits",
                    "small.npy", "-o", "small.png")
        cls.program("gridrt-image", "builtin:cube", "--layout", "compact", "-o", "cube.grt")
        cls.program("gridrt-host", "cube.grt", "--size", SMALL, "--device", "seq", "--hits",
                    "seq-cube.npy")
        cls.make_flashes()
        files = ["teapot.grt", "cube.grt", *(name + ".flash" for name in FLASHES)]
        with Guest(["gridrt-host", "gridrt-board", "gridrt-virtual-board", "/usr/sbin/usbip"],
                   {name: cls.read(name) for name in files}) as guest:
            boards = [guest.start_board("--core", "seq"),
                      guest.start_board("--core", "sim", "--serial", "rtl", "--flash",
                                        cls.path / "cube.flash")]
            console, cls.files = guest.run(SCRIPT, boards, timeout=400)
        print(console)
        cls.steps = {name: (text, int(code)) for name, text, code in
                     re.findall(r"(?ms)^== (\S+)\n(.*?)^-- (\d+)$", console)}

    @classmethod
    def program(cls, name, *words):
        subprocess.run([BIN / name, *words], cwd=cls.path, check=True, timeout=120)

    @classmethod
    def make_flashes(cls):
        cls.program("gridrt-image", "cube.grt", "--firmware", "cube.flash")
        cls.program("gridrt-image", "teapot.grt", "--firmware", "good.flash")
        good = cls.read("good.flash")
        (cls.path / "cut.flash").write_bytes(good[:len(good) // 2])
        flipped = bytearray(good)
        flipped[len(good) // 3] ^= 0x10
        (cls.path / "flipped.flash").write_bytes(flipped)
        (cls.path / "eight.flash").write_bytes(for_eight_pes(good))

    @classmethod
    def read(cls, name):
        return (cls.path / name).read_bytes()

    def step(self, name, code=0):
        """The words of a step, which ended with this exit code."""
        text, ended = self.steps[name]
        self.assertEqual(ended, code, f"{name}: {text}")
        return text

    def test_hits_and_picture_are_the_bytes_of_seq(self):
        self.step("render")
        self.assertEqual(self.files["usb.npy"], self.read("seq.npy"))
        self.assertEqual(self.files["usb.png"], self.read("seq.png"))

    def test_rays_went_through_the_board(self):
        stats = json.loads(self.files["usb.json"])
        self.assertEqual((stats["device"], stats["layout"]), ("usb:virtual-1", "compact"))
        self.assertGreater(stats["bytes_out"], 16 * 1000)
        self.assertGreater(stats["steps"], 1000)
        self.assertEqual(stats["frames_retried"], 0)

    def test_boards_are_listed_and_chosen(self):
        self.assertIn("usb:virtual-1 at 1-1: ready", self.step("devices"))
        self.assertRegex(self.step("list"), r"^usb:virtual-1  port 1-1  /dev/bus/usb/\d+/\d+  "
                                            r"/dev/hidraw0  ready\n$")
        self.assertIn("Device usb: a GridRT board is plugged in.", self.step("auto"))
        self.assertEqual(self.files["auto.png"], self.read("seq.png"))
        self.assertIn("no GridRT board with serial 'other' is plugged in", self.step("other", 6))
        self.assertNotIn("other.png", self.files)

    def test_reports(self):
        info = self.step("info")
        for line in (r"name +board", r"serial +virtual-1", r"PEs +4", r"clock +60000000 Hz",
                     r"self-test +Never: .*run 0"):
            self.assertRegex(info, rf"(?m)^{line}$")
        self.assertRegex(self.step("log"), r"(?m)^ *\d+  Started +\d+$")
        self.assertRegex(self.step("selftest"), r"^Passed: (\d+) of \1 bytes .* run 1\n$")
        self.assertRegex(self.step("counters"), r"(?m)^rays +\d+$")
        self.assertRegex(self.step("load"), r"teapot.grt: \d+ bytes in .*; the board answers rays")
        self.assertRegex(self.step("loaded"), r"(?m)^state +Ready$")
        self.assertEqual(self.step("reset"), "reset; state Empty\n")

    def test_what_the_board_says_by_itself_arrives(self):
        self.assertRegex(self.step("followed"), r"(?m)^ *\d+  SelfTestPassed +\d+$")

    def test_without_permission_the_rule_is_named(self):
        for name, node in (("frames", "/dev/bus/usb/"), ("reports", "/dev/hidraw0")):
            text = self.step(f"no-permission-{name}", 6)
            self.assertIn(f"no permission to use the board: {node}", text)
            self.assertIn("70-gridrt.rules", text)
        self.assertIn("no permission to use the board", self.step("no-permission-list"))

    def test_two_programs_at_once(self):
        self.assertIn("another program is using the board at 1-1", self.step("in-use", 6))
        self.assertRegex(self.step("reports-meanwhile"), r"(?m)^rays +[1-9]\d*$")

    def test_unplugged_in_the_middle(self):
        self.assertIn("the board was unplugged, or it lost its power", self.step("unplugged"))
        self.assertIn("ended with 6", self.step("unplugged"))
        self.assertNotIn("big.png", self.files)
        self.assertIn("no GridRT board is plugged in", self.step("no-board", 6))

    def test_linux_attaches_it_over_ip(self):
        self.assertIn("(1209:0001)", self.step("usbip-list"))
        self.step("usbip-attach")
        self.step("usbip-render")
        self.assertEqual(self.files["ip.png"], self.read("seq.png"))
        self.assertRegex(self.step("usbip-selftest"), r"^Passed: ")

    def test_the_rtl_renders_and_its_firmware_answers(self):
        self.step("rtl-render")
        self.assertEqual(self.files["rtl.npy"], self.read("small.npy"))
        self.assertEqual(self.files["rtl.png"], self.read("small.png"))
        self.assertRegex(self.step("rtl-selftest"), r"^Passed: (\d+) of \1 bytes .* run 1\n$")
        self.assertRegex(self.step("rtl-followed"), r"(?m)^ *\d+  SelfTestPassed +\d+$")

    def stats(self, name):
        return json.loads(self.files[name + ".json"])

    def test_a_board_with_an_image_in_flash_needs_no_upload(self):
        self.assertRegex(self.step("good-info"), r"(?m)^state +Ready$")
        self.assertRegex(self.step("good-info"), r"(?m)^image in flash +Booted, \d+ bytes, answers rays now$")
        self.assertRegex(self.step("good-log"), r"(?m)^ *\d+  Booted +\d+$")
        self.step("good-render")
        self.assertEqual(self.stats("good")["uploads"], 0)
        upload = self.stats("cut")["bytes_out"] - self.stats("good")["bytes_out"]
        self.assertGreater(upload, 0.9 * len(self.read("good.flash")))
        self.assertEqual(self.files["good.npy"], self.read("small.npy"))
        self.assertEqual(self.files["good.png"], self.read("small.png"))

    def test_an_upload_takes_the_place_of_the_image_in_flash(self):
        self.step("other-scene")
        self.assertEqual(self.stats("cube")["uploads"], 1)
        self.assertEqual(self.files["cube.npy"], self.read("seq-cube.npy"))
        self.step("back-again")
        self.assertEqual(self.stats("back")["uploads"], 1)
        self.assertEqual(self.files["back.npy"], self.read("small.npy"))

    def test_a_wrong_image_in_flash_is_named_and_an_upload_does(self):
        reasons = {"flipped": "BadPayloadCrc", "cut": r"\w+", "eight": r"\w+"}
        for name, reason in reasons.items():
            with self.subTest(name=name):
                info = self.step(f"{name}-info")
                self.assertRegex(info, r"(?m)^state +Empty$")
                self.assertRegex(info, rf"(?m)^image in flash +Failed, Refused \({reason}, detail \d+\), ")
                self.assertNotIn("answers rays now", info)
                self.assertRegex(self.step(f"{name}-log"), r"(?m)^ *\d+  BootFailed +\d+$")
                self.step(f"{name}-render")
                self.assertEqual(self.stats(name)["uploads"], 1)
                self.assertEqual(self.files[name + ".npy"], self.read("small.npy"))
                self.assertEqual(self.files[name + ".png"], self.read("small.png"))

    def test_the_rtl_starts_from_flash(self):
        self.step("rtl-flash")
        self.assertEqual(self.stats("rtl")["uploads"], 0)
        self.assertEqual(self.files["rtl-cube.npy"], self.read("seq-cube.npy"))

    def test_a_flash_that_cannot_be_read_is_no_board(self):
        for path in ("none.flash", "."):
            done = subprocess.run([BIN / "gridrt-virtual-board", "--flash", path, "--redirect", "socket"],
                                  cwd=self.path, capture_output=True, text=True, timeout=60, check=False)
            self.assertEqual((done.returncode, done.stderr),
                             (4, f"gridrt-virtual-board: {path}: cannot be read\n"))


if __name__ == "__main__":
    unittest.main()
