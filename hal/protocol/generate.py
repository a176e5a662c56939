"""Turns protocol.toml into C++, SystemVerilog and documentation.

usage: generate.py protocol.toml OUTPUT_DIRECTORY

Writes gridrt_protocol.hpp, gridrt_firmware_protocol.hpp, gridrt_protocol_pkg.sv and protocol.md,
and of the USB device gridrt_usb.hpp, gridrt_usb_pkg.sv, gridrt_usb.py and 70-gridrt.rules. The output depends on the
source alone. A mistake in the source ends the run with status 1 and nothing written.
"""

import sys
from pathlib import Path

from cpp import cpp_header
from document import document
from firmware import firmware_header
from model import SourceError
from source import read_protocol
from systemverilog import sv_package
from usb_output import udev_rule, usb_document, usb_header, usb_module, usb_package


def main(arguments: list[str]) -> int:
    if len(arguments) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    try:
        protocol = read_protocol(Path(arguments[0]))
        files = {
            "gridrt_protocol.hpp": cpp_header(protocol),
            "gridrt_firmware_protocol.hpp": firmware_header(protocol),
            "gridrt_protocol_pkg.sv": sv_package(protocol),
            "protocol.md": document(protocol) + usb_document(protocol),
            "gridrt_usb.hpp": usb_header(protocol),
            "gridrt_usb_pkg.sv": usb_package(protocol),
            "gridrt_usb.py": usb_module(protocol),
            "70-gridrt.rules": udev_rule(protocol),
        }
    except SourceError as error:
        print(f"generate.py: {error}", file=sys.stderr)
        return 1
    folder = Path(arguments[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in files.items():
        (folder / name).write_text(content, encoding="utf-8", newline="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
