"""Reads the registers of protocol.toml: windows of the shell and the soft core's other neighbours."""

from checks import camel_name, check_keys, integer, require, snake_name, text, unique
from model import Peripheral, Register, RegisterField, Struct, Window

WINDOW_BYTES = 64  # a window starts on a multiple of it and takes no more
SPACE = 2**12  # bytes of all of them
ACCESSES = ("read", "write", "read and write")


def read_access(access: object, place: str) -> tuple[bool, bool]:
    require(access in ACCESSES, place, f"must be one of: {', '.join(ACCESSES)}")
    return "read" in access, "write" in access


def read_base(value: object, place: str) -> int:
    base = integer(value, place, 0, SPACE - WINDOW_BYTES)
    require(base % WINDOW_BYTES == 0, place, f"is not a multiple of {WINDOW_BYTES}")
    return base


def read_window(name: str, table: dict, reports: tuple[Struct, ...]) -> Window:
    place = f"registers.{name}"
    check_keys(table, place, {"base", "access"})
    report = next((r for r in reports if r.name == f"{name}Report"), None)
    require(report is not None, place, "there is no report of this name")
    base = read_base(table["base"], f"{place}.base")
    require(report.bytes % 4 == 0, place,
            f"the report's {report.bytes} bytes are not whole words of 4")
    return Window(name, base, report, *read_access(table["access"], f"{place}.access"))


def read_register(entry: dict, place: str, address: int) -> Register:
    check_keys(entry, f"{place}.registers", {"name", "access", "doc"}, {"words", "fields"})
    snake_name(entry["name"], place)
    at = f"{place}.{entry['name']}"
    fields = []
    free = 0
    for field in entry.get("fields", []):
        check_keys(field, at, {"name", "bit", "width", "doc"})
        snake_name(field["name"], at)
        here = f"{at}.{field['name']}"
        bit = integer(field["bit"], here, free, 31)
        width = integer(field["width"], here, 1, 32 - bit)
        fields.append(RegisterField(field["name"], bit, width, text(field["doc"], here)))
        free = bit + width
    unique([f.name for f in fields], at, "field")
    return Register(entry["name"], address, integer(entry.get("words", 1), at, 1, 16),
                    *read_access(entry["access"], f"{at}.access"), text(entry["doc"], at),
                    tuple(fields))


def read_peripheral(name: str, table: dict) -> Peripheral:
    place = f"peripherals.{name}"
    camel_name(name, place)
    check_keys(table, place, {"base", "doc", "registers"})
    base = read_base(table["base"], f"{place}.base")
    require(isinstance(table["registers"], list) and table["registers"], place, "needs registers")
    registers = []
    address = base
    for entry in table["registers"]:
        registers.append(read_register(entry, place, address))
        address += 4 * registers[-1].words
    require(address <= base + WINDOW_BYTES, place, f"takes more than {WINDOW_BYTES} bytes")
    unique([r.name for r in registers], place, "register")
    return Peripheral(name, base, text(table["doc"], f"{place}.doc"), tuple(registers))
