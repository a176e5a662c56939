"""An installed GridRT serves a program of its own: examples/trace finds, links and runs it.

Arguments: build tree, C++ compiler.
"""
import pathlib
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BUILD, COMPILER = sys.argv[1:3]
OPTIONS = """
#include <gridrt.hpp>
#include <host/render/waves.hpp>
#include <host/pe/software_device.hpp>
#include <hal/loopback.hpp>
using namespace gridrt;
void use(const DeviceOptions&, const ImageOptions&, const RenderOptions&, const Scene&, const Ray&,
         const Material&, const Light&, const Camera&, const LoopbackOptions&,
         const SoftwareDeviceOptions&, const Error&);
void make() {
  use({.name = "seq"}, {.pes = 2}, {.width = 1}, {.positions = {}}, {.tmin = 1.0}, {.name = "a"},
      {.kind = Light::Kind::kPoint}, {.fov_degrees = 1.0}, {.max_transfer = 1},
      {.name = "seq"}, {.kind = ErrorKind::kInternal});
}
"""
EXPECTED = "triangle 0 at t = 2\ntriangle -1 at t = inf\n"


def run(*command):
    """Output of a command that must succeed."""
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise AssertionError(f"{command}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.prefix = pathlib.Path(scratch.name) / "prefix"
        cls.build = pathlib.Path(scratch.name) / "build"
        run("cmake", "--install", BUILD, "--prefix", cls.prefix)

    def test_a_program_of_its_own_traces_rays(self):
        run("cmake", "-S", SOURCE / "examples" / "trace", "-B", self.build, "-G", "Ninja",
            f"-DCMAKE_PREFIX_PATH={self.prefix}", f"-DCMAKE_CXX_COMPILER={COMPILER}",
            "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror")
        run("cmake", "--build", self.build)
        self.assertEqual(run(self.build / "trace"), EXPECTED)

    def test_options_are_made_by_naming_some_of_them(self):
        users = pathlib.Path(self.prefix) / "options.cpp"
        users.write_text(OPTIONS, encoding="utf-8")
        run(COMPILER, "-std=c++23", "-Wall", "-Wextra", "-Werror", "-fsyntax-only",
            "-I", self.prefix / "include" / "gridrt", users)

    def test_programs_run_from_where_they_are_installed(self):
        for program in ("gridrt-host", "gridrt-image"):
            self.assertIn("0.1", run(self.prefix / "bin" / program, "--version"))

    def test_nothing_installed_remembers_the_build(self):
        scripts = list(self.prefix.rglob("*.cmake"))
        self.assertGreaterEqual(len(scripts), 3)
        for script in scripts:
            text = script.read_text(encoding="utf-8")
            for folder in (str(SOURCE) + "/", str(BUILD) + "/"):
                self.assertNotIn(folder, text, script)

    def test_every_header_that_is_included_is_installed(self):
        include = self.prefix / "include" / "gridrt"
        for header in include.rglob("*.hpp"):
            for line in header.read_text(encoding="utf-8").splitlines():
                if line.startswith('#include "'):
                    name = line.split('"')[1]
                    self.assertTrue((include / name).is_file() or (header.parent / name).is_file(),
                                    f"{header}: {name}")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
