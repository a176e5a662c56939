"""tools/arrows accepts a small tree that keeps the rules and refuses each way of breaking one."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ARROWS = pathlib.Path(__file__).resolve().parents[2] / "tools" / "arrows"

GOOD = {
    "hal/error.hpp": "#pragma once\n#include <string>\n",
    "hal/crc.hpp": '#include "hal/error.hpp"\n#include "gridrt_protocol.hpp"\n',
    "host/scene/scene.hpp": '#include <glm/vec3.hpp>\n#include "hal/error.hpp"\n',
    "host/scene/load.cpp": '#include "scene.hpp"\n',
    "host/grid/lattice.hpp": '#include "hal/error.hpp"\n',
    "host/image/image.hpp": '#include "host/grid/lattice.hpp"\n#include "host/scene/scene.hpp"\n',
    "host/app/main.cpp": '#include "host/image/image.hpp"\n#include "hal/crc.hpp"\n',
    "host/grid/CMakeLists.txt": "gridrt_library(gridrt_grid\n  a.cpp\n  LINK gridrt_hal fmt::fmt)\n",
    "host/image/CMakeLists.txt": "gridrt_library(gridrt_image LINK gridrt_grid gridrt_scene)\n",
    "tests/truth/tracer.cpp": '#include "host/scene/scene.hpp"\n#include "tests/truth/own.hpp"\n',
    "tests/truth/own.hpp": "",
    "tests/truth/CMakeLists.txt": "target_link_libraries(gridrt_truth PUBLIC gridrt_scene)\n",
    "tests/unit/a.cpp": '#include "host/image/image.hpp"\n#include "tests/truth/own.hpp"\n',
    "firmware/main.cpp": '#include "gridrt_protocol.hpp"\n#include <stdint.h>\n',
    "rtl/top.sv": '`include "gridrt_protocol_pkg.sv"\n',
    "examples/trace/trace.cpp": "#include <gridrt.hpp>\n",
    "host/scene/teapot_data.hpp": "1,\n" * 500,
}

# What is broken -> (file, its text, where and what the answer must name).
BAD = {
    "hal sees host": ("hal/bad.hpp", '#include "host/grid/lattice.hpp"\n', "hal/bad.hpp:1: hal "),
    "angle brackets do not hide": (
        "hal/bad.hpp", "\n#include <host/grid/lattice.hpp>\n", "hal/bad.hpp:2: hal "),
    "scene sees grid": (
        "host/scene/bad.hpp", '#include "host/grid/lattice.hpp"\n', "host/scene must not"),
    "scene sees more of hal": ("host/scene/bad.hpp", '#include "hal/crc.hpp"\n', "hal/crc.hpp"),
    "scene sees the protocol": (
        "host/scene/bad.hpp", '#include "gridrt_protocol.hpp"\n', "gridrt_protocol.hpp"),
    "grid sees image": (
        "host/grid/bad.cpp", '#include "host/image/image.hpp"\n', "host/grid must not include"),
    "grid sees image by a relative path": (
        "host/grid/bad.cpp", '#include "../image/image.hpp"\n', "host/grid must not include"),
    "image sees app": (
        "host/image/bad.cpp", '#  include "host/app/options.hpp"\n', "host/image must not include"),
    "truth sees the engine": (
        "tests/truth/bad.cpp", '#include "host/grid/lattice.hpp"\n', "tests/truth must not include"),
    "truth sees other tests": (
        "tests/truth/bad.cpp", '#include "tests/unit/a.cpp"\n', "tests/truth must not include"),
    "host sees tests": (
        "host/grid/bad.cpp", '#include "tests/truth/own.hpp"\n', "host/grid must not include"),
    "firmware sees host": ("firmware/bad.cpp", '#include "hal/error.hpp"\n', "firmware must not"),
    "rtl sees host": ("rtl/bad.sv", '`include "hal/error.hpp"\n', "rtl must not include"),
    "no such header": ("host/grid/bad.cpp", '#include "nowhere.hpp"\n', "neither in the tree"),
    "grid links image": (
        "host/grid/CMakeLists.txt", "gridrt_library(gridrt_grid\n a.cpp\n LINK gridrt_image)\n",
        "host/grid/CMakeLists.txt:1: host/grid must not link gridrt_image"),
    "grid links image by its alias": (
        "host/grid/CMakeLists.txt", "\ntarget_link_libraries(gridrt_grid PUBLIC GridRT::gridrt_pe)",
        "host/grid/CMakeLists.txt:2: host/grid must not link GridRT::gridrt_pe"),
    "truth links the engine": (
        "tests/truth/a.cmake", "target_link_libraries(gridrt_truth gridrt_grid)\n", "must not link"),
    "a long file": ("tests/unit/long.cpp", "\n" * 401, "tests/unit/long.cpp:401: 401 lines"),
    "a long script": ("tools/long", "\n" * 401, "tools/long:401: 401 lines"),
    "a path of one machine": ("README.md", "see /" + "home/someone/file\n", "README.md:1: a path"),
    "a registry": ("tools/get", "pip --index" + "-url=x\n", "tools/get:1: the address of a"),
}


def run(files):
    """Exit code and output of tools/arrows on a tree of these files."""
    with tempfile.TemporaryDirectory() as root:
        for name, text in files.items():
            path = os.path.join(root, name)
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path, "w", encoding="utf-8") as stream:
                stream.write(text)
        done = subprocess.run([sys.executable, ARROWS, "--root", root], capture_output=True,
                              text=True, check=False)
        return done.returncode, done.stdout + done.stderr


class Arrows(unittest.TestCase):
    def test_accepts_a_tree_that_keeps_the_rules(self):
        code, output = run(GOOD)
        self.assertEqual(code, 0, output)
        self.assertIn(f"{len(GOOD)} files, 0 violations", output)

    def test_refuses_each_violation_and_names_it(self):
        for what, (name, text, expected) in BAD.items():
            with self.subTest(what):
                code, output = run(GOOD | {name: text})
                self.assertEqual(code, 1, output)
                self.assertIn(expected, output)
                self.assertIn(" 1 violation\n", output)

    def test_a_missing_tree_is_a_usage_error(self):
        done = subprocess.run([sys.executable, ARROWS, "--root", "no-such-folder"],
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 2)
        self.assertIn("no-such-folder", done.stderr)


if __name__ == "__main__":
    unittest.main()
