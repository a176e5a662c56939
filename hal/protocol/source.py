"""Reads protocol.toml into the model and refuses every mistake that it can see."""

import re
import tomllib
from pathlib import Path

from checks import camel_name, check_keys, integer, require, snake_name, text, unique
from model import (TYPE_BYTES, BitField, ByteField, Constant, Enum, EnumValue, Layout, Protocol,
                   Record, SourceError, Struct, Table, Usb)
from peripherals import read_peripheral, read_window

MAX_RECORD_BITS = 128  # a record with widths from the header, each at most 32
MAX_WIDTH = 32


def read_constants(table: dict, group: str = "protocol") -> tuple[Constant, ...]:
    out = []
    for name, entry in table.items():
        place = f"{group}.{name}"
        snake_name(name, place)
        check_keys(entry, place, {"value", "doc"})
        out.append(Constant(name, integer(entry["value"], place, 0, 2**32 - 1),
                            text(entry["doc"], f"{place}.doc")))
    return tuple(out)


def read_enum(name: str, table: dict) -> Enum:
    place = f"enums.{name}"
    camel_name(name, place)
    check_keys(table, place, {"doc", "width", "values"})
    width = integer(table["width"], f"{place}.width", 8, 32)
    require(width in (8, 16, 32), f"{place}.width", "must be 8, 16 or 32")
    require(isinstance(table["values"], list) and table["values"], place, "needs values")
    values = []
    for entry in table["values"]:
        check_keys(entry, f"{place}.values", {"name", "value", "doc"})
        at = f"{place}.{entry['name']}"
        values.append(EnumValue(camel_name(entry["name"], at),
                                integer(entry["value"], at, 0, 2**width - 1),
                                text(entry["doc"], f"{at}.doc")))
    unique([v.name for v in values], place, "name")
    unique([v.value for v in values], place, "value")
    return Enum(name, text(table["doc"], f"{place}.doc"), width, tuple(values))


def read_byte_fields(entries: list, place: str) -> tuple[ByteField, ...]:
    require(isinstance(entries, list) and entries, place, "needs fields")
    fields = []
    offset = 0
    for entry in entries:
        check_keys(entry, f"{place}.fields", {"name", "type", "doc"})
        at = f"{place}.{entry['name']}"
        snake_name(entry["name"], at)
        match = re.fullmatch(r"([uif][0-9]+)(?:\[([0-9]+)\])?", str(entry["type"]))
        require(match is not None and match[1] in TYPE_BYTES, at,
                f"unknown type '{entry['type']}'")
        count = None if match[2] is None else integer(int(match[2]), at, 1, 4096)
        size = TYPE_BYTES[match[1]]
        require(offset % size == 0, at,
                f"at offset {offset} it is not aligned to its {size} bytes")
        fields.append(ByteField(entry["name"], match[1], count, offset,
                                text(entry["doc"], f"{at}.doc")))
        offset += fields[-1].bytes
    unique([f.name for f in fields], place, "field")
    return tuple(fields)


def read_struct(name: str, table: dict) -> Struct:
    place = f"structs.{name}"
    camel_name(name, place)
    check_keys(table, place, {"doc", "size", "fields"})
    fields = read_byte_fields(table["fields"], place)
    size = integer(table["size"], f"{place}.size", 1, 4096)
    end = fields[-1].offset + fields[-1].bytes
    require(end == size, place, f"size is {size}, but its fields take {end} bytes")
    require(size % 4 == 0, place, f"size {size} is not a multiple of 4")
    return Struct(name, text(table["doc"], f"{place}.doc"), size, fields)


REPORT_KINDS = ("feature", "input", "output")


def read_report(name: str, table: dict, report_bytes: int) -> Struct:
    place = f"reports.{name}"
    camel_name(name, place)
    check_keys(table, place, {"id", "doc", "fields"}, {"kinds"})
    kinds = table.get("kinds", ["feature"])
    require(isinstance(kinds, list) and kinds, f"{place}.kinds", "must be a list that is not empty")
    for kind in kinds:
        require(kind in REPORT_KINDS, f"{place}.kinds",
                f"may hold {', '.join(REPORT_KINDS)}, not '{kind}'")
    unique(kinds, f"{place}.kinds", "kind")
    fields = read_byte_fields(table["fields"], place)
    size = fields[-1].offset + fields[-1].bytes
    require(size < report_bytes, place,
            f"its {size} bytes and the id do not fit a report of {report_bytes}")
    return Struct(f"{name}Report", text(table["doc"], f"{place}.doc"), size, fields,
                  integer(table["id"], f"{place}.id", 1, 255), tuple(kinds))


def read_record(name: str, table: dict, header: Struct) -> Record:
    place = f"records.{name}"
    camel_name(name, place)
    check_keys(table, place, {"doc", "fields"}, {"bytes"})
    require(isinstance(table["fields"], list) and table["fields"], place, "needs fields")
    header_widths = {f.name for f in header.fields if f.type == "u8" and f.count is None}
    fields = []
    for entry in table["fields"]:
        check_keys(entry, f"{place}.fields", {"name", "width", "doc"}, {"count"})
        at = f"{place}.{entry['name']}"
        snake_name(entry["name"], at)
        width = entry["width"]
        if isinstance(width, str):
            require(width in header_widths, at, f"ImageHeader has no u8 field '{width}'")
        else:
            integer(width, f"{at}.width", 1, MAX_WIDTH)
        count = entry.get("count")
        if count is not None:
            integer(count, f"{at}.count", 2, 64)
        fields.append(BitField(entry["name"], width, count, text(entry["doc"], f"{at}.doc")))
    unique([f.name for f in fields], place, "field")
    record = Record(name, text(table["doc"], f"{place}.doc"), table.get("bytes"), tuple(fields))
    if record.bytes is None:
        require(record.name.endswith("Record"), place, "its name must end in Record")
        require(record.width_names != (), place, "needs 'bytes', since no width is a header field")
        most = sum((f.width if isinstance(f.width, int) else MAX_WIDTH) * f.elements
                   for f in fields)
        require(most <= MAX_RECORD_BITS, place,
                f"may take {most} bits, more than {MAX_RECORD_BITS}")
        return record
    require(record.width_names == (), place, "has 'bytes', so every width must be a number")
    size = integer(record.bytes, f"{place}.bytes", 4, 64)
    bits = sum(f.width * f.elements for f in fields)
    require(bits == 8 * size, place, f"its fields take {bits} bits, but bytes says {8 * size}")
    require(size == 4 or size % 8 == 0, f"{place}.bytes", "must be 4 or a multiple of 8")
    return record


CAPACITIES = {  # entries that an index of that width must reach
    "max_triangles": "triangle_index_bits",
    "max_vertices": "vertex_index_bits",
    "max_references": "first_bits",
    "max_cells": "base_bits",
}


def read_table(name: str, table: dict) -> Table:
    place = f"tables.{name}"
    check_keys(table, place, {"width", "doc", "values"})
    require(table["width"] in (8, 16, 32), f"{place}.width", "must be 8, 16 or 32")
    require(isinstance(table["values"], list) and table["values"] != [], f"{place}.values",
            "must be a list that is not empty")
    values = tuple(integer(v, f"{place}.values[{i}]", 0, (1 << table["width"]) - 1)
                   for i, v in enumerate(table["values"]))
    return Table(snake_name(name, place), table["width"], values, text(table["doc"], f"{place}.doc"))


def read_layouts(tables: dict, enums: tuple[Enum, ...], records: tuple[Record, ...]):
    known = next((e for e in enums if e.name == "Layout"), None)
    require(known is not None, "enums.Layout", "is missing")
    names = {v.name for v in known.values} - {"None"}
    require(set(tables) == names, "layouts", f"must be {', '.join(sorted(names))}")
    widths = {name for record in records for name in record.width_names}
    out = []
    for name, table in tables.items():
        place = f"layouts.{name}"
        check_keys(table, place, widths | CAPACITIES.keys() | {"max_blocks"})
        for key, value in table.items():
            integer(value, f"{place}.{key}", 1, MAX_WIDTH if key in widths else 2**32 - 1)
        for key, width in CAPACITIES.items():
            require(table[key] <= 2**table[width], f"{place}.{key}",
                    f"{table[key]} entries are out of reach of {width} = {table[width]}")
        out.append(Layout(name, dict(table)))
    require(all(list(a.values) == list(out[0].values) for a in out), "layouts",
            "every layout must list the same keys in the same order")
    return tuple(out)


USB_NUMBERS = {  # name: largest value
    "vendor_id": 0xFFFF, "product_id": 0xFFFF, "usb_release": 0x0210, "device_release": 0x9999,
    "configuration": 255, "bulk_interface": 1, "hid_interface": 1, "bulk_out": 0x0F,
    "bulk_in": 0x8F, "interrupt_out": 0x0F, "interrupt_in": 0x8F, "control_packet": 64,
    "bulk_packet_high": 512, "bulk_packet_full": 64, "interrupt_packet": 64,
    "interrupt_interval_high": 16, "interrupt_interval_full": 255, "max_power": 250,
    "microsoft_request": 255, "manufacturer_string": 255, "product_string": 255,
    "serial_string": 255, "bulk_string": 255, "hid_string": 255,
}
USB_TEXTS = {"manufacturer", "product", "bulk", "hid", "interface_guid"}


def read_usb(table: dict, report_bytes: int) -> Usb:
    check_keys(table, "usb", {"numbers", "texts"})
    check_keys(table["numbers"], "usb.numbers", set(USB_NUMBERS))
    check_keys(table["texts"], "usb.texts", USB_TEXTS)
    for name, value in table["texts"].items():
        require(text(value, f"usb.texts.{name}").isascii() and len(value) <= 126,
                f"usb.texts.{name}", "must be at most 126 characters of ASCII")
    numbers = read_constants(table["numbers"], "usb.numbers")
    for n in numbers:
        least = 0x81 if n.name.endswith("_in") else 0 if n.name.endswith("_interface") else 1
        integer(n.value, f"usb.numbers.{n.name}", least, USB_NUMBERS[n.name])
    usb = Usb(numbers, dict(table["texts"]))
    unique([usb["bulk_interface"], usb["hid_interface"]], "usb.numbers", "interface")
    unique([n.value for n in numbers if n.name.endswith(("_in", "_out"))], "usb.numbers",
           "endpoint")
    unique([n.value for n in numbers if n.name.endswith("_string")], "usb.numbers",
           "string index")
    require(usb["interrupt_packet"] == report_bytes, "usb.numbers.interrupt_packet",
            f"must be report_bytes, {report_bytes}")
    return usb


def read_protocol(path: Path) -> Protocol:
    """The checked content of the file; SourceError names the file and the place."""
    try:
        with open(path, "rb") as file:
            source = tomllib.load(file)
        return build(source)
    except (tomllib.TOMLDecodeError, SourceError) as error:
        raise SourceError(f"{path}: {error}") from error
    except OSError as error:
        raise SourceError(f"{path}: {error.strerror}") from error


def build(source: dict) -> Protocol:
    check_keys(source, "top level",
               {"protocol", "enums", "structs", "records", "tables", "layouts", "reports", "registers",
                "peripherals", "usb"})
    constants = read_constants(source["protocol"])
    report_bytes = next((c.value for c in constants if c.name == "report_bytes"), None)
    require(report_bytes is not None, "protocol.report_bytes", "is missing")
    enums = tuple(read_enum(n, t) for n, t in source["enums"].items())
    structs = tuple(read_struct(n, t) for n, t in source["structs"].items())
    header = next((s for s in structs if s.name == "ImageHeader"), None)
    require(header is not None, "structs.ImageHeader", "is missing")
    records = tuple(read_record(n, t, header) for n, t in source["records"].items())
    tables = tuple(read_table(n, t) for n, t in source["tables"].items())
    layouts = read_layouts(source["layouts"], enums, records)
    reports = tuple(read_report(n, t, report_bytes) for n, t in source["reports"].items())
    unique([r.report_id for r in reports], "reports", "id")
    windows = tuple(read_window(n, t, reports) for n, t in source["registers"].items())
    peripherals = tuple(read_peripheral(n, t) for n, t in source["peripherals"].items())
    unique([x.base for x in (*windows, *peripherals)], "registers", "base")
    names = [x.name for group in (enums, structs, records, reports) for x in group]
    unique(names, "top level", "type")
    return Protocol(constants, enums, structs, records, tables, layouts, reports, windows,
                    read_usb(source["usb"], report_bytes), peripherals)
