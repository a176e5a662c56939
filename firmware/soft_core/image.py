#!/usr/bin/env python3
"""Turns the firmware's ELF file into the soft core's memory, and holds it to its budget.

Writes gridrt_firmware_image.svh (assignments for rtl/soc/gridrt_cpu_ram.sv) and firmware.hex (a word
a line, for tools that exchange the content of a bitstream), and prints the sizes of code, variables
and the deepest stack. The stack is the largest sum along any path of calls that the compiler has
told (-fcallgraph-info=su). Fails if all that is more than the budget, or if the depth of the stack
cannot be known: recursion, a call through a pointer, memory taken from the stack at run time.
"""
import argparse
import pathlib
import re
import subprocess
import sys
import tempfile

NODE = re.compile(r'node: \{ title: "([^"]+)" label: "([^"]*)"')
EDGE = re.compile(r'edge: \{ sourcename: "([^"]+)" targetname: "([^"]+)"')
FRAME = re.compile(r"(\d+) bytes \((\w+)\)")


def read_calls(files):
    """({function: bytes of its frame}, {function: those that it calls})"""
    frames, calls = {}, {}
    for file in files:
        text = file.read_text(encoding="utf-8")
        for name, label in NODE.findall(text):
            found = FRAME.search(label)
            if not found:
                continue  # known to another file
            if found[2] != "static":
                sys.exit(f"image.py: {name} takes memory from the stack at run time")
            name = name.split(":")[-1]
            frames[name] = max(frames.get(name, 0), int(found[1]))
        for source, target in EDGE.findall(text):
            calls.setdefault(source.split(":")[-1], set()).add(target.split(":")[-1])
    return frames, calls


def deepest(frames, calls, name, path=()):
    """(bytes, functions on the way)"""
    if name in path:
        sys.exit(f"image.py: recursion: {' calls '.join((*path[path.index(name):], name))}")
    if name not in frames:
        sys.exit(f"image.py: the stack of {name} is not known; {path[-1] if path else '?'} calls it")
    best = (0, ())
    for target in sorted(calls.get(name, ())):
        best = max(best, deepest(frames, calls, target, (*path, name)))
    return frames[name] + best[0], (name, *best[1])


def sections(elf, size):
    """{section: bytes}"""
    said = subprocess.run([size, "-A", str(elf)], capture_output=True, text=True, check=True).stdout
    return {words[0]: int(words[1]) for words in (line.split() for line in said.splitlines())
            if len(words) == 3 and words[0].startswith(".")}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--objcopy", required=True)
    parser.add_argument("--size", required=True)
    parser.add_argument("--budget", type=int, required=True, help="bytes in all")
    parser.add_argument("--folder", type=pathlib.Path, required=True, help="where to write")
    parser.add_argument("elf", type=pathlib.Path)
    parser.add_argument("calls", type=pathlib.Path, nargs="+", help=".ci files of the compiler")
    options = parser.parse_args()

    stack, path = deepest(*read_calls(options.calls), "gridrt_main")
    parts = sections(options.elf, options.size)
    variables = parts.get(".bss", 0)
    with tempfile.TemporaryDirectory() as scratch:
        binary = pathlib.Path(scratch) / "image"
        subprocess.run([options.objcopy, "-O", "binary", str(options.elf), str(binary)], check=True)
        image = binary.read_bytes()
    total = len(image) + variables + stack
    report = (f"firmware: {len(image)} bytes of code and constants, {variables} of variables, "
              f"{stack} of stack: {total} of {options.budget}\n"
              f"deepest: {' > '.join(path)}\n")
    print(report.splitlines()[0])
    if total > options.budget:
        sys.exit(f"image.py: {total} bytes are more than the budget of {options.budget}")

    image += bytes(-len(image) % 4)
    words = [int.from_bytes(image[i:i + 4], "little") for i in range(0, len(image), 4)]
    options.folder.mkdir(parents=True, exist_ok=True)
    lines = ["// Made by firmware/soft_core/image.py.\n"]
    for at, word in enumerate(words):
        lines.append("".join(f"lane{lane}[{at}] = 8'h{word >> 8 * lane & 0xFF:02x}; "
                             for lane in range(4)).rstrip() + "\n")
    (options.folder / "gridrt_firmware_image.svh").write_text("".join(lines), encoding="utf-8")
    (options.folder / "firmware.hex").write_text("".join(f"{w:08x}\n" for w in words),
                                                 encoding="utf-8")
    (options.folder / "sizes.txt").write_text(report, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
