"""What protocol.toml holds, as typed values with every offset worked out."""

from dataclasses import dataclass

TYPE_BYTES = {
    "u8": 1, "u16": 2, "u32": 4, "u64": 8,
    "i8": 1, "i16": 2, "i32": 4, "i64": 8,
    "f32": 4,
}


class SourceError(Exception):
    """A mistake in the source; the message names the table and the field."""


@dataclass(frozen=True)
class Constant:
    name: str
    value: int
    doc: str


@dataclass(frozen=True)
class EnumValue:
    name: str
    value: int
    doc: str


@dataclass(frozen=True)
class Enum:
    name: str
    doc: str
    width: int
    values: tuple[EnumValue, ...]


@dataclass(frozen=True)
class ByteField:
    """`count` is None for a single value, else the number of array elements."""

    name: str
    type: str
    count: int | None
    offset: int
    doc: str

    @property
    def element_bytes(self) -> int:
        return TYPE_BYTES[self.type]

    @property
    def bytes(self) -> int:
        return self.element_bytes * (self.count or 1)


@dataclass(frozen=True)
class Struct:
    """A byte struct; `report_id` is None unless it is the body of a HID report."""

    name: str
    doc: str
    bytes: int
    fields: tuple[ByteField, ...]
    report_id: int | None = None
    report_kinds: tuple[str, ...] = ()


@dataclass(frozen=True)
class BitField:
    """`width` is a number of bits or the name of a field of ImageHeader."""

    name: str
    width: int | str
    count: int | None
    doc: str

    @property
    def elements(self) -> int:
        return self.count or 1


@dataclass(frozen=True)
class Record:
    """`bytes` is None where header fields give widths."""

    name: str
    doc: str
    bytes: int | None
    fields: tuple[BitField, ...]

    @property
    def width_names(self) -> tuple[str, ...]:
        names = [f.width for f in self.fields if isinstance(f.width, str)]
        return tuple(dict.fromkeys(names))


@dataclass(frozen=True)
class Table:
    """Values that records refer to by index."""

    name: str
    width: int
    values: tuple[int, ...]
    doc: str


@dataclass(frozen=True)
class Layout:
    name: str
    values: dict[str, int]


@dataclass(frozen=True)
class Window:
    """Registers that hold the body of a report, word by word."""

    name: str
    base: int
    report: Struct
    readable: bool
    writable: bool

    @property
    def words(self) -> int:
        return self.report.bytes // 4


@dataclass(frozen=True)
class RegisterField:
    name: str
    bit: int
    width: int
    doc: str


@dataclass(frozen=True)
class Register:
    """`words` words from `address` on."""

    name: str
    address: int
    words: int
    readable: bool
    writable: bool
    doc: str
    fields: tuple[RegisterField, ...]


@dataclass(frozen=True)
class Peripheral:
    name: str
    base: int
    doc: str
    registers: tuple[Register, ...]


@dataclass(frozen=True)
class Usb:
    """Numbers and texts of the USB device; descriptors are made in usb.py."""

    numbers: tuple[Constant, ...]
    texts: dict[str, str]

    def __getitem__(self, name: str) -> int:
        return next(n.value for n in self.numbers if n.name == name)


@dataclass(frozen=True)
class Protocol:
    constants: tuple[Constant, ...]
    enums: tuple[Enum, ...]
    structs: tuple[Struct, ...]
    records: tuple[Record, ...]
    tables: tuple[Table, ...]
    layouts: tuple[Layout, ...]
    reports: tuple[Struct, ...]
    windows: tuple[Window, ...]
    usb: Usb
    peripherals: tuple[Peripheral, ...]

    def layout(self, name: str) -> Layout:
        return next(layout for layout in self.layouts if layout.name == name)


def camel(name: str) -> str:
    """frame_magic -> FrameMagic."""
    return "".join(part[:1].upper() + part[1:] for part in name.split("_"))


def snake(name: str) -> str:
    """FrameHeader -> frame_header, NoOp -> no_op."""
    out = ""
    for i, c in enumerate(name):
        if c.isupper() and i and not name[i - 1].isupper():
            out += "_"
        out += c.lower()
    return out
