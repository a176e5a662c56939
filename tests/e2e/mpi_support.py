"""What the tests of the device mpi share."""
import os
import pathlib
import time


def mpirun(ranks, tcp=False):
    """The beginning of a command line: more ranks than cores are fine, root too."""
    words = ["mpirun", "--oversubscribe", "--bind-to", "none", "--allow-run-as-root",
             "-n", str(ranks)]
    return words + (["--mca", "btl", "tcp,self"] if tcp else [])


def state_of(pid):
    """(parent, state, command line) of a process, or None if it is gone."""
    try:
        folder = pathlib.Path("/proc") / str(pid)
        # The name stands in parentheses and may hold anything.
        state, parent = (folder / "stat").read_text().rpartition(")")[2].split()[:2]
        return int(parent), state, (folder / "cmdline").read_bytes().replace(b"\0", b" ").decode()
    except (OSError, ValueError):
        return None


def seconds_of(pid):
    """Processor time that a process has used."""
    try:
        fields = (pathlib.Path("/proc") / str(pid) / "stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def descendants(pid):
    """Process ids of all children and theirs, zombies left out."""
    parents = {}
    for name in os.listdir("/proc"):
        if name.isdigit() and (state := state_of(name)) and state[1] != "Z":
            parents.setdefault(state[0], []).append(int(name))
    found, todo = [], [pid]
    while todo:
        children = parents.get(todo.pop(), [])
        found += children
        todo += children
    return found


def ranks_of(pid, program):
    """Descendants that run `program`."""
    return [p for p in descendants(pid) if (s := state_of(p)) and f"/{program} " in s[2] + " "
            and "mpirun" not in s[2].split(" ", maxsplit=1)[0]]


def wait_until(condition, seconds):
    """True as soon as the condition holds, False if it does not in time."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if condition():
            return True
        time.sleep(0.05)
    return False
