"""What goes wrong: exit codes, messages that name the place, nothing half-written, no hang."""
import os
import pty
import resource
import subprocess
import unittest

import numpy as np
from programs import BIN, QUAD_OBJ, ProgramTest, main

SMALL = ("--size", "16x12")


def limit_file_size(size):
    """For preexec_fn: files cannot grow beyond `size` bytes, as on a full disk."""
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))


class Usage(ProgramTest):
    def test_wrong_options_are_2_and_point_to_help(self):
        for words in ([], ["builtin:teapot"], ["builtin:teapot", "-o", "a.jpg"],
                      ["builtin:teapot", "-o", "a.png", "--size", "0x0"],
                      ["builtin:teapot", "-o", "a.png", "--device", "gpu"],
                      ["builtin:teapot", "-o", "a.png", "--schedule", "fast"],
                      ["builtin:nosuch", "-o", "a.png"], ["scene.xyz", "-o", "a.png"],
                      ["builtin:teapot", "-o", "a.png", "--eye", "0,0,0", "--look", "0,0,0"]):
            with self.subTest(words=words):
                self.assertIn("--help", self.host(*words, code=2).stderr)
        self.assertEqual(self.entries(), [])

    def test_what_is_not_built_in_is_5(self):
        done = self.host("builtin:teapot", "-o", "a.png", "--exact", code=5)
        self.assertIn("not built in yet", done.stderr)
        self.assertEqual(self.entries(), [])

    def test_a_board_that_is_not_there_is_6_and_auto_says_so(self):
        done = self.host("builtin:cube", "-o", "a.png", "--device", "usb:none", code=6)
        self.assertIn("no GridRT board with serial 'none' is plugged in", done.stderr)
        self.assertIn("gridrt-board list", done.stderr)
        self.host("builtin:cube", "-o", "a.png", "--device", "usb:none", "--schedule", "pes", code=2)
        self.assertEqual(self.entries(), [])
        done = self.run_program("gridrt-host", "builtin:cube", *SMALL, "-o", "a.png")
        self.assertRegex(done.stderr, r"\ADevice (omp|usb): .*board.*plugged in\.\n\Z")

    def test_waves_are_those_of_a_simulation(self):
        done = self.host("builtin:cube", "--device", "seq", "--trace", "w.fst", code=2)
        self.assertIn("--device sim", done.stderr)
        self.assertEqual(self.entries(), [])

    def test_help_version_and_devices(self):
        self.assertIn("Exit codes", self.host("--help").stdout)
        self.assertIn("Exit codes", self.image("--help").stdout)
        self.assertRegex(self.host("--version").stdout, r"^gridrt-host \d+\.\d+\.\d+ ")
        self.assertRegex(self.image("--version").stdout, r"^gridrt-image \d+\.\d+\.\d+ ")
        devices = self.host("--list-devices").stdout
        self.assertRegex(devices, r"(?m)^seq ")
        self.assertRegex(devices, r"(?m)^usb ")


class Input(ProgramTest):
    def test_missing_and_unreadable_files_are_4(self):
        self.host("none.obj", "-o", "a.png", code=4)
        self.host("none.grt", "-o", "a.png", code=4)
        self.write("q.obj", QUAD_OBJ)
        self.host("q.obj", "--rays", "none.npy", "--hits", "h.npy", code=4)
        self.image("--info", "none.grt", code=4)
        os.mkdir(self.folder / "dir.obj")
        self.host("dir.obj", "-o", "a.png", code=4)
        self.assertEqual(self.entries(), ["dir.obj", "q.obj"])

    def test_bad_content_is_3_and_names_the_file(self):
        self.write("bad.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        self.assertIn("bad.obj", self.host("bad.obj", "-o", "a.png", code=3).stderr)
        self.write("junk.grt", b"\x00\x01\x02" * 100)
        self.assertIn("junk.grt", self.host("junk.grt", "-o", "a.png", code=3).stderr)
        self.assertIn("junk.grt", self.image("--verify", "junk.grt", code=3).stderr)

    def test_truncated_and_flipped_images_are_3(self):
        self.image("builtin:cube", "-o", "s.grt")
        whole = self.read("s.grt")
        for size in (0, 1, 143, len(whole) // 2, len(whole) - 1):
            self.write("t.grt", whole[:size])
            self.host("t.grt", *SMALL, "-o", "a.png", code=3)
        for at in range(0, len(whole), max(1, len(whole) // 50)):
            flipped = bytearray(whole)
            flipped[at] ^= 0x10
            self.write("t.grt", bytes(flipped))
            self.image("--verify", "t.grt", code=3)
        self.assertNotIn("a.png", self.entries())

    def test_an_image_refuses_options_that_contradict_it(self):
        self.image("builtin:cube", "-o", "s.grt", "--pes", "2", "--bits", "12")
        self.host("s.grt", *SMALL, "-o", "a.png", "--pes", "2", "--bits", "12")
        for words in (["--pes", "4"], ["--bits", "17"], ["--grid", "1x2x3"], ["--layout", "compact"],
                      ["--mapping", "voxel"]):
            self.assertIn(words[0], self.host("s.grt", *SMALL, "-o", "a.png", *words, code=2).stderr)
        self.image("s.grt", "-o", "t.grt", code=2)

    def test_too_large_for_a_layout_is_5(self):
        done = self.image("builtin:sphere?subdivisions=6", "-o", "a.grt", "--layout", "compact", code=5)
        self.assertIn("81920 triangles", done.stderr)
        self.assertIn("16384", done.stderr)
        self.host("builtin:cube", *SMALL, "-o", "a.png", "--layout", "compact", "--bits", "20", code=5)
        self.assertEqual(self.entries(), [])


class Output(ProgramTest):
    ALL = ("-o", "a.png", "--hits", "h.npy", "--stats", "s.json", "--lattice", "l.npz")

    def test_all_outputs_or_a_clear_error(self):
        self.host("builtin:cube", *SMALL, *self.ALL)
        self.assertEqual(self.entries(), ["a.png", "h.npy", "l.npz", "s.json"])

    def test_places_that_do_not_exist_are_4_before_any_work(self):
        for option, name in zip(self.ALL[::2], self.ALL[1::2]):
            words = list(self.ALL)
            words[words.index(name)] = "none/" + name
            done = self.host("builtin:cube", *SMALL, *words, code=4)
            self.assertIn("none/" + name, done.stderr, option)
            self.assertEqual(self.entries(), [])
        self.image("builtin:cube", "-o", "none/s.grt", code=4)

    def test_a_full_disk_is_4_and_leaves_nothing(self):
        for size in (0, 100, 1000):
            for words in (self.ALL, ("-o", "a.exr"), ("-o", "a.pfm"), ("--hits", "h.npy"),
                          ("--lattice", "l.npz")):
                with self.subTest(size=size, words=words):
                    done = self.host("builtin:demo", *SMALL, *words, code=4,
                                     preexec_fn=limit_file_size(size))
                    self.assertIn("cannot write", done.stderr)
                    self.assertEqual(self.entries(), [])
        self.image("builtin:teapot", "-o", "s.grt", code=4, preexec_fn=limit_file_size(1000))
        self.assertEqual(self.entries(), [])

    def test_a_full_disk_keeps_what_was_there(self):
        self.write("a.png", "old")
        self.host("builtin:demo", *SMALL, "-o", "a.png", code=4, preexec_fn=limit_file_size(100))
        self.assertEqual(self.read("a.png"), b"old")

    def test_a_full_device_is_4_and_stays_a_device(self):
        os.symlink("/dev/full", self.folder / "a.png")
        self.host("builtin:cube", *SMALL, "-o", "a.png", code=4)
        self.host("builtin:cube", *SMALL, "--hits", "/dev/full", code=4)
        self.host("builtin:cube", *SMALL, "--stats", "/dev/full", code=4)
        self.image("builtin:cube", "-o", "a.png", code=4)
        self.assertEqual(os.stat("/dev/full").st_mode & 0o170000, 0o020000)

    def test_standard_output_that_is_full_is_4(self):
        for words in (["--help"], ["--list-devices"], ["builtin:cube", "--explain", "3,3"]):
            with open("/dev/full", "w", encoding="utf-8") as full:
                done = subprocess.run([BIN / "gridrt-host", *words], stdout=full, check=False,
                                      stderr=subprocess.PIPE, timeout=60)
            self.assertEqual(done.returncode, 4, words)

    def test_bad_rays_leave_nothing_of_any_output(self):
        self.write("q.obj", QUAD_OBJ)
        rays = np.tile([0.5, -0.5, 2, 0, 0, -1.0], (300000, 1))
        rays[-1] = 0
        np.save(self.folder / "in.npy", rays)
        done = self.host("q.obj", "--rays", "in.npy", "--hits", "h.npy", "--stats", "s.json", code=3)
        self.assertIn("row 299999", done.stderr)
        self.assertEqual(self.entries(), ["in.npy", "q.obj"])

    def test_no_memory_is_70_with_a_message(self):
        def limit_memory():
            resource.setrlimit(resource.RLIMIT_AS, (300 << 20, 300 << 20))
        done = self.host("builtin:cube", "--size", "16000x16000", "-o", "a.pfm", code=70,
                         preexec_fn=limit_memory)
        self.assertIn("not enough memory", done.stderr)
        self.assertEqual(self.entries(), [])

    def test_being_killed_leaves_nothing(self):
        running = subprocess.Popen([BIN / "gridrt-host", "builtin:demo", "--size", "4000x3000", "-o",
                                    "a.png", "--hits", "h.npy"], cwd=self.folder)
        with self.assertRaises(subprocess.TimeoutExpired):
            running.wait(1.5)
        running.kill()
        running.wait()
        self.assertEqual(self.entries(), [])


class Progress(ProgramTest):
    def terminal_output(self, *words):
        """What the program shows on standard error if that is a terminal."""
        master, slave = pty.openpty()
        with subprocess.Popen([BIN / "gridrt-host", *words], cwd=self.folder, stderr=slave) as running:
            os.close(slave)
            shown = b""
            while True:
                try:
                    piece = os.read(master, 4096)
                except OSError:  # the other end is closed
                    break
                if not piece:
                    break
                shown += piece
        os.close(master)
        self.assertEqual(running.returncode, 0)
        return shown

    def test_shown_on_a_terminal_and_not_in_a_pipe(self):
        words = ["builtin:demo", "--size", "200x150", "--samples", "4", "-o", "a.png"]
        self.assertIn(b"tracing", self.terminal_output(*words))
        self.assertEqual(self.terminal_output(*words, "--progress", "off"), b"")
        self.assertEqual(self.host(*words).stderr, "")
        shown = self.run_program("gridrt-host", *words, "--progress", "on", text=False).stderr
        self.assertIn(b"tracing", shown)
        self.assertTrue(shown.endswith(b"\r"), "the line is cleared in the end")


if __name__ == "__main__":
    main()
