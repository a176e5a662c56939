"""What every part of protocol.toml is checked for."""

import re

from model import SourceError

CPP_KEYWORDS = frozenset(
    "alignas alignof and asm auto bool break case catch char class const constexpr continue "
    "decltype default delete do double else enum explicit export extern false float for friend "
    "goto if inline int long mutable namespace new noexcept not nullptr operator or private "
    "protected public register requires return short signed sizeof static struct switch template "
    "this throw true try typedef typeid typename union unsigned using virtual void volatile while "
    "xor".split())


def require(condition: bool, place: str, message: str) -> None:
    if not condition:
        raise SourceError(f"{place}: {message}")


def check_keys(table: dict, place: str, needed: set[str], optional: set[str] = frozenset()) -> None:
    require(isinstance(table, dict), place, "must be a table")
    for key in sorted(needed - table.keys()):
        raise SourceError(f"{place}: '{key}' is missing")
    for key in sorted(table.keys() - needed - optional):
        raise SourceError(f"{place}: unknown key '{key}'")


def integer(value: object, place: str, low: int, high: int) -> int:
    require(isinstance(value, int) and not isinstance(value, bool), place, "must be an integer")
    require(low <= value <= high, place, f"{value} is outside [{low}, {high}]")
    return value


def text(value: object, place: str) -> str:
    require(isinstance(value, str) and value.strip() == value and value != "", place,
            "must be a text that is not empty")
    require("\n" not in value and "|" not in value and "*/" not in value and "\\" not in value,
            place, "may hold no line break, '|', '*/' or backslash")
    return value


def camel_name(value: object, place: str) -> str:
    require(isinstance(value, str) and re.fullmatch(r"[A-Z][A-Za-z0-9]*", value) is not None, place,
            f"'{value}' is not a CamelCase name")
    return value


def snake_name(value: object, place: str) -> str:
    require(isinstance(value, str) and re.fullmatch(r"[a-z][a-z0-9]*(_[a-z0-9]+)*", value)
            is not None, place, f"'{value}' is not a lower_case name")
    require(value not in CPP_KEYWORDS, place, f"'{value}' is a keyword of C++")
    return value


def unique(values: list, place: str, what: str) -> None:
    seen = set()
    for value in values:
        require(value not in seen, place, f"{what} {value} appears twice")
        seen.add(value)
