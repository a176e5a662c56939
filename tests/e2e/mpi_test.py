"""The device mpi from outside: alone, under mpirun, over TCP, between network namespaces."""
import json
import os
import subprocess
import unittest

from mpi_support import mpirun
from programs import CHOICE, BIN, ProgramTest

SCENE = ("builtin:teapot", "--size", "64x48")
NETWORK = """
set -e
cleanup() { ip netns del "$a" || true; ip netns del "$b" || true; }
a=gridrt-a-$$ b=gridrt-b-$$
trap cleanup EXIT
ip netns add "$a"
ip netns add "$b"
ip link add "va$$" netns "$a" type veth peer name "vb$$" netns "$b"
ip -n "$a" addr add 10.83.0.1/24 dev "va$$"
ip -n "$b" addr add 10.83.0.2/24 dev "vb$$"
for n in "$a" "$b"; do ip -n "$n" link set lo up; done
ip -n "$a" link set "va$$" up
ip -n "$b" link set "vb$$" up
cat >agent <<EOT
#!/bin/sh
shift
exec ip netns exec $b unshare -u sh -c "hostname other; \\$*"
EOT
chmod +x agent
ip netns exec "$a" unshare -u sh -c 'hostname one; exec "$@"' - \
  mpirun --allow-run-as-root --oversubscribe --bind-to none --mca plm_rsh_agent "$PWD/agent" \
  --mca btl tcp,self --mca oob_tcp_if_include 10.83.0.0/24 --mca btl_tcp_if_include 10.83.0.0/24 \
  -H 10.83.0.1:2,10.83.0.2:2 -n 4 "$@"
"""


def namespaces_work():
    return os.geteuid() == 0 and subprocess.run(
        "ip netns add gridrt-try-$$ && ip netns del gridrt-try-$$ && unshare -u true", shell=True,
        check=False, capture_output=True).returncode == 0


class Answers(ProgramTest):
    def setUp(self):
        super().setUp()
        self.host(*SCENE, "--device", "seq", "--hits", "seq.npy")
        self.expected = self.read("seq.npy")

    def read(self, name):
        return (self.folder / name).read_bytes()

    def under_mpirun(self, ranks, *words, tcp=False):
        """Statistics of a run whose hits are those of seq."""
        done = subprocess.run(
            [*mpirun(ranks, tcp), BIN / "gridrt-host", *SCENE, *map(str, words), "--hits", "a.npy",
             "--stats", "a.json"], cwd=self.folder, check=False, capture_output=True, text=True,
            timeout=240)
        words = CHOICE.sub("", done.stderr)
        self.assertEqual((done.returncode, done.stdout, words), (0, "", ""))
        self.assertEqual(self.read("a.npy"), self.expected)
        return json.loads(self.read("a.json"))

    def test_alone_it_starts_ranks_of_its_own(self):
        for schedule in ("pes", "paper"):
            with self.subTest(schedule=schedule):
                done = self.host(*SCENE, "--device", "mpi", "--schedule", schedule, "--hits",
                                 "a.npy", "--stats", "a.json")
                self.assertEqual(done.stdout, "")
                self.assertEqual(self.read("a.npy"), self.expected)
                stats = json.loads(self.read("a.json"))
                self.assertEqual((stats["device"], stats["schedule"]), ("mpi", schedule))

    def test_under_mpirun_auto_is_mpi_with_more_than_one_rank(self):
        self.assertEqual(self.under_mpirun(1)["device"], "omp")
        for ranks in (2, 4):
            stats = self.under_mpirun(ranks)
            self.assertEqual((stats["device"], stats["schedule"]), ("mpi", "pes"))
            self.assertGreater(stats["exchange"]["feedbacks_sent"], 0)
        # Ranks that have nothing to do end as well.
        self.assertEqual(self.under_mpirun(2, "--device", "seq")["device"], "seq")

    def test_any_number_of_ranks_and_pes(self):
        for ranks, pes in ((1, 4), (2, 3), (3, 8), (8, 8), (8, 2)):
            with self.subTest(ranks=ranks, pes=pes):
                self.under_mpirun(ranks, "--device", "mpi", "--pes", pes)

    def test_groups_of_ranks_share_the_rays(self):
        for ranks, groups, pes, schedule in ((2, 2, 4, "pes"), (4, 2, 3, "pes"), (4, 4, 4, "pes"),
                                             (6, 3, 4, "pes"), (4, 2, 4, "paper")):
            with self.subTest(ranks=ranks, groups=groups, schedule=schedule):
                stats = self.under_mpirun(ranks, "--device", "mpi", "--groups", groups, "--pes",
                                          pes, "--schedule", schedule, "--batch", 1000)
                # Nothing travels along a traversal list that one rank holds all of.
                self.assertEqual(stats["exchange"]["feedbacks_sent"] > 0,
                                 ranks > groups and schedule == "pes")
        self.under_mpirun(2, "--groups", 2, tcp=True)
        self.host(*SCENE, "--device", "mpi", "--groups", 2, "--hits", "a.npy")  # of its own four
        self.assertEqual(self.read("a.npy"), self.expected)

    def test_a_number_of_groups_that_cannot_be(self):
        def error(ranks, *words):
            done = subprocess.run(
                [*mpirun(ranks), BIN / "gridrt-host", *SCENE, *words, "--hits", "a.npy"],
                cwd=self.folder, check=False, capture_output=True, text=True, timeout=60)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertFalse((self.folder / "a.npy").exists())
            return done.stderr
        self.assertIn("3 ranks cannot be split into 2 groups", error(3, "--groups", "2"))
        self.assertIn("2 ranks cannot be split into 4 groups", error(2, "--groups", "4"))
        self.assertIn("--groups", error(2, "--groups", "0"))
        done = self.host(*SCENE, "--device", "mpi", "--groups", "3", "--hits", "a.npy", code=2)
        self.assertIn("4 ranks cannot be split into 3 groups", done.stderr)
        done = self.host(*SCENE, "--device", "omp", "--groups", "2", "--hits", "a.npy", code=2)
        self.assertIn("'omp' has no ranks", done.stderr)

    def test_over_tcp(self):
        for schedule in ("pes", "paper"):
            stats = self.under_mpirun(2, "--schedule", schedule, tcp=True)
            self.assertGreater(stats["exchange"]["messages"], 0)

    def test_the_paper_has_a_barrier_a_ray(self):
        stats = self.under_mpirun(2, "--schedule", "paper")
        self.assertEqual(stats["exchange"]["barriers"],
                         stats["rays"]["total"] - stats["rays"]["outside"])
        self.assertGreater(stats["exchange"]["barrier_share"], 0)
        self.assertLessEqual(stats["exchange"]["synchronisation_share"], 1)

    @unittest.skipUnless(namespaces_work(), "needs root and network namespaces")
    def test_between_network_namespaces(self):
        for schedule in ("pes", "paper"):
            with self.subTest(schedule=schedule):
                done = subprocess.run(
                    ["bash", "-c", NETWORK, "-", BIN / "gridrt-host", *SCENE, "--schedule",
                     schedule, "--hits", "n.npy"], cwd=self.folder, check=False,
                    capture_output=True, text=True, timeout=240)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertEqual(self.read("n.npy"), self.expected)

    def test_errors_end_all_ranks(self):
        done = subprocess.run([*mpirun(3), BIN / "gridrt-host", "nosuch.obj", "--hits", "a.npy"],
                              cwd=self.folder, check=False, capture_output=True, text=True,
                              timeout=60)
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertEqual(done.stderr.count("gridrt-host: "), 1, done.stderr)

    def test_it_says_what_is_missing(self):
        done = self.host(*SCENE, "--device", "mpi", "--hits", "a.npy", code=5,
                         env=dict(os.environ, PATH="/nonexistent"))
        self.assertIn("openmpi-bin", done.stderr)
        done = self.host(*SCENE, "--device", "mpi", "--hits", "a.npy", code=5,
                         env=dict(os.environ, GRIDRT_RANK_PROGRAM="/nonexistent"))
        self.assertIn("gridrt-rank", done.stderr)
        self.host(*SCENE, "--device", "mpi", "--schedule", "rays", "--hits", "a.npy", code=2)


if __name__ == "__main__":
    unittest.main()
