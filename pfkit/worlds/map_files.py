r"""The two files of a ROS map: settings in YAML, cells in a PGM picture.

``map_server`` keeps a map as a grey picture and a small text file beside it that says how large
a pixel is and what its grey means:

.. code-block:: yaml

    image: office.pgm
    resolution: 0.05           # metres per pixel
    origin: [-10.0, -5.0, 0.0] # pose of the lower left corner: x, y, yaw
    negate: 0                  # 0: white is free
    occupied_thresh: 0.65      # above this a cell is a wall
    free_thresh: 0.196         # below it a cell is free; between them nobody knows

Six keys, so we read them by hand and need no YAML library. (A seventh, ``mode: trinary``, is
the default of the format and may stand there.) A PGM picture comes as text (P2) or as
bytes (P5); its first row is the *top* of the picture.

Whatever is wrong with a file is a `DataError` that names the file and the reason.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pfkit.errors import DataError

KEYS = ("image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh")


def read_settings(path: Path) -> dict[str, str | float | tuple[float, ...]]:
    """Read the YAML file of a map: six keys, all required, checked for type."""
    raw: dict[str, str] = {}
    for number, line in enumerate(_text(path).splitlines(), start=1):
        line = _without_comment(line)
        if not line.strip() or line.strip() == "---":
            continue
        key, colon, value = line.partition(":")
        key = key.strip()
        if line.lstrip().startswith("- ") and raw:  # a list written one entry per line
            last = next(reversed(raw))
            raw[last] = f"{raw[last]} {line.strip()[2:]},"
        elif not colon or key not in (*KEYS, "mode"):
            raise DataError(f"{path}, line {number}: expected one of {KEYS}, got {line.strip()!r}")
        elif key in raw:
            raise DataError(f"{path}, line {number}: {key} is given twice; keep one")
        else:
            raw[key] = value.strip().strip("'\"")
    missing = [key for key in KEYS if key not in raw]
    if missing:
        raise DataError(f"{path}: {', '.join(missing)} missing; a map needs {', '.join(KEYS)}")
    if raw.get("mode", "trinary") != "trinary":
        raise DataError(f"{path}: mode {raw['mode']} is not supported; use trinary thresholds")
    return _checked(path, raw)


def _without_comment(line: str) -> str:
    """Drop a comment: '#' at the start or after a blank, as YAML has it."""
    for i, letter in enumerate(line):
        if letter == "#" and (i == 0 or line[i - 1].isspace()):
            return line[:i]
    return line


def _checked(path: Path, raw: dict[str, str]) -> dict[str, str | float | tuple[float, ...]]:
    """Turn the text of each value into what it must be."""
    settings: dict[str, str | float | tuple[float, ...]] = {"image": raw["image"]}
    for key in KEYS[1:]:
        words = raw[key].strip(" []").replace(",", " ").split()
        try:
            numbers = tuple(float(word) for word in words)
        except ValueError:
            raise DataError(f"{path}: {key} must be a number, got {raw[key]!r}") from None
        wanted = 3 if key == "origin" else 1
        if len(numbers) != wanted or not np.isfinite(numbers).all():
            what = "[x, y, yaw]" if key == "origin" else "one finite number"
            raise DataError(f"{path}: {key} must be {what}, got {raw[key]!r}")
        settings[key] = numbers if key == "origin" else numbers[0]
    if settings["negate"] not in (0.0, 1.0):
        raise DataError(f"{path}: negate must be 0 or 1, got {raw['negate']!r}")
    return settings


def read_pgm(path: Path) -> tuple[NDArray[np.int64], int]:
    """Read a PGM picture, P2 or P5: grey values (rows, columns) from the top, and white's value."""
    data = _bytes(path)
    magic, width, height, white, start = _header(path, data)
    count = width * height
    if magic == b"P5":
        body = data[start : start + count]
        grey = np.frombuffer(body, dtype=np.uint8).astype(np.int64)
        extra = len(data[start + count :].strip())
    else:
        text = b"\n".join(line.partition(b"#")[0] for line in data[start:].split(b"\n"))
        try:
            grey = np.array(text.split(), dtype=np.int64)
        except (ValueError, OverflowError):
            raise DataError(f"{path}: a pixel is not a whole number; export it again") from None
        extra = max(grey.size - count, 0)
    if grey.size < count or extra:
        size = grey.size + (extra if magic == b"P5" else 0)
        raise DataError(
            f"{path}: the header promises {width} x {height} = {count} pixels, the file has "
            f"{size}; it is cut off or its header is wrong"
        )
    if grey.min() < 0 or grey.max() > white:
        raise DataError(f"{path}: a pixel is outside 0 .. {white}, the file's own white")
    return grey.reshape(height, width), white


def _header(path: Path, data: bytes) -> tuple[bytes, int, int, int, int]:
    """Magic number, width, height, white, and where the pixels start."""
    words: list[bytes] = []
    at = 0
    while len(words) < 4 and at < len(data):
        if data[at : at + 1].isspace():
            at += 1
        elif data[at : at + 1] == b"#":
            at = data.find(b"\n", at) if b"\n" in data[at:] else len(data)
        else:
            end = at
            while end < len(data) and not data[end : end + 1].isspace():
                end += 1
            words.append(data[at:end])
            at = end
    if not words or words[0] not in (b"P2", b"P5"):
        raise DataError(f"{path}: not a PGM picture: it must start with P2 or P5")
    if len(words) < 4 or not all(word.isdigit() for word in words[1:]):
        raise DataError(f"{path}: bad header {words}; a PGM has width, height and white's value")
    width, height, white = (int(word) for word in words[1:])
    if width < 1 or height < 1 or not 1 <= white <= 255:
        raise DataError(
            f"{path}: {width} x {height} pixels with white {white}; sizes must be >= 1 and white "
            "1 .. 255 (8 bits)"
        )
    return words[0], width, height, white, at + 1


def write_pgm(path: Path, grey: NDArray[np.uint8], text: bool = False) -> None:
    """Write grey values (rows, columns), top row first, as P5 or (text) P2 with white 255."""
    height, width = grey.shape
    head = f"{'P2' if text else 'P5'}\n{width} {height}\n255\n".encode()
    if text:  # the format asks for lines of at most 70 characters
        rows = [" ".join(map(str, part)) for row in grey for part in _pieces(row.tolist(), 17)]
        path.write_bytes(head + "\n".join(rows).encode() + b"\n")
    else:
        path.write_bytes(head + np.ascontiguousarray(grey, dtype=np.uint8).tobytes())


def _pieces(row: list[int], n: int) -> list[list[int]]:
    return [row[i : i + n] for i in range(0, len(row), n)]


def _text(path: Path) -> str:
    try:
        return _bytes(path).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise DataError(f"{path}: not a text file; give the map's .yaml, not its picture") from None


def _bytes(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as problem:
        raise DataError(f"{path}: cannot be read ({problem.strerror}); check the path") from None
