r"""The two files of a ROS map: settings in YAML, cells in a picture.

``map_server`` keeps a map as a grey picture and a small text file beside it that says how large
a pixel is and what its grey means:

.. code-block:: yaml

    image: office.png
    resolution: 0.05           # metres per pixel
    origin: [-10.0, -5.0, 0.0] # pose of the lower left corner: x, y, yaw
    negate: 0                  # 0 or false, or no such line: white is free
    occupied_thresh: 0.65      # above this a cell is a wall
    free_thresh: 0.196         # below it a cell is free; between them nobody knows
    mode: trinary              # or scale, or raw; trinary if there is no such line

So few keys that we read them by hand and need no YAML library; keys of other programs are passed
over. The picture's first row is the *top* of the map. PGM, text (P2) or bytes (P5), we read
ourselves; PNG and the others through Pillow (``pip install 'pfkit[logs]'``).

The mode says what a grey means. *trinary* and *scale*: the darker, the more probably occupied.
They differ where a pixel is transparent: in *scale* nobody knows what is there, in *trinary* the
transparency counts as one more colour. *raw*: the grey is the probability in per cent, and what
is above 100 is unknown.

Whatever is wrong with a file is a `DataError` that names the file and the reason.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pfkit.errors import DataError

Array = NDArray[np.float64]
KEYS = ("image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh")
MODES = ("trinary", "scale", "raw")
TRUTH = {"0": False, "1": True, "false": False, "true": True, "no": False, "yes": True}


class Settings(NamedTuple):
    """What the YAML file says."""

    image: str
    resolution: float
    origin: tuple[float, float, float]
    occupied_thresh: float
    free_thresh: float
    negate: bool = False
    mode: str = "trinary"


def read_settings(path: Path) -> Settings:
    """Read the YAML file of a map."""
    raw = _entries(path)
    missing = [key for key in KEYS if key not in raw and key != "negate"]
    if missing:
        raise DataError(f"{path}: {', '.join(missing)} missing; a map needs {', '.join(KEYS)}")
    negate, mode = raw.get("negate", "0").lower(), raw.get("mode", "trinary").lower()
    if negate not in TRUTH:
        raise DataError(f"{path}: negate must be 0 or 1, got {raw['negate']!r}")
    if mode not in MODES:
        raise DataError(f"{path}: mode must be one of {', '.join(MODES)}, got {raw['mode']!r}")
    x, y, yaw = _numbers(path, "origin", raw["origin"], 3)
    (resolution,), (occupied,), (free,) = (
        _numbers(path, key, raw[key], 1) for key in ("resolution", "occupied_thresh", "free_thresh")
    )
    return Settings(raw["image"], resolution, (x, y, yaw), occupied, free, TRUTH[negate], mode)


def _entries(path: Path) -> dict[str, str]:
    """Keys at the left margin with the text behind them; lists may go over several lines."""
    raw: dict[str, str] = {}
    strangers: list[str] = []
    for number, line in enumerate(_text(path).splitlines(), start=1):
        line = _without_comment(line).rstrip()
        if not line.strip() or line.strip() == "---":
            continue
        key, colon, value = line.partition(":")
        last = next(reversed(raw), None)
        unfinished = last is not None and raw[last].count("[") > raw[last].count("]")
        if last is not None and (line.lstrip().startswith("- ") or unfinished):
            raw[last] = f"{raw[last]} {line.strip().removeprefix('- ')},"
        elif line[0].isspace():
            continue  # belongs to a key of another program
        elif not colon:
            raise DataError(f"{path}, line {number}: expected key: value, got {line.strip()!r}")
        elif key in raw:
            raise DataError(f"{path}, line {number}: {key} is given twice; keep one")
        else:
            raw[key] = value.strip().strip("'\"")
            if key not in (*KEYS, "mode"):
                strangers.append(f"line {number}: {key}")
    if strangers and "negate" not in raw:  # it may be what was meant
        raise DataError(
            f"{path}, {strangers[0]} is none of {', '.join(KEYS)}, and negate is missing; "
            "write negate: 0, or 1 where white is a wall"
        )
    return raw


def _without_comment(line: str) -> str:
    """Drop a comment: '#' at the start or after a blank, as YAML has it."""
    for i, letter in enumerate(line):
        if letter == "#" and (i == 0 or line[i - 1].isspace()):
            return line[:i]
    return line


def _numbers(path: Path, key: str, text: str, count: int) -> list[float]:
    """The finite numbers behind a key, as many as there must be."""
    words = text.replace("[", " ").replace("]", " ").replace(",", " ").split()
    try:
        numbers = [float(word) for word in words]
    except ValueError:
        raise DataError(f"{path}: {key} must be a number, got {text!r}") from None
    if len(numbers) != count or not np.isfinite(numbers).all():
        what = "[x, y, yaw]" if count == 3 else "one finite number"
        raise DataError(f"{path}: {key} must be {what}, got {text!r}")
    return numbers


def read_cells(path: Path, settings: Settings) -> Array:
    """The probability of each cell of being occupied: (rows, columns), row 0 at the bottom.

    Cells of which nothing is known lie halfway between the two thresholds.

    Parameters
    ----------
    path : Path of the YAML file; the picture is looked for beside it
    settings : Settings
    """
    picture = path.parent / settings.image
    channels, white, alpha = _read_picture(picture)
    colours = channels
    if alpha is not None and settings.mode == "trinary":
        colours = np.concatenate((channels, alpha[None]))
    shade = colours.mean(axis=0) / white
    unknown = np.zeros(shade.shape, dtype=bool)
    if settings.mode == "raw":
        percent = np.round(255 * (1.0 - shade if settings.negate else shade))
        p, unknown = percent / 100, percent > 100
    else:
        p = shade if settings.negate else 1.0 - shade
        if alpha is not None and settings.mode == "scale":
            unknown = alpha < white
    p = np.where(unknown, (settings.free_thresh + settings.occupied_thresh) / 2, p)
    return p[::-1]


def _read_picture(path: Path) -> tuple[Array, int, Array | None]:
    """Colours (1 or 3, rows, columns) from the top, white's value, and opacity if there is any."""
    if _bytes(path)[:2] in (b"P2", b"P5"):
        grey, white = read_pgm(path)
        return grey[None].astype(float), white, None
    try:
        from PIL import Image, UnidentifiedImageError
    except ImportError:
        raise DataError(
            f"{path}: not a PGM picture (P2 or P5), and Pillow is not there to read others; "
            "pip install 'pfkit[logs]'"
        ) from None
    try:
        with Image.open(path) as image:
            image.load()
            if image.mode in ("I", "I;16", "I;16B", "F"):
                deep = np.array(image, dtype=float)[None]
                return deep, 65535, None
            see_through = "A" in image.getbands() or "transparency" in image.info
            if image.mode in ("1", "L") and not see_through:
                return np.array(image.convert("L"), dtype=float)[None], 255, None
            pixels = np.moveaxis(np.array(image.convert("RGBA"), dtype=float), -1, 0)
    except UnidentifiedImageError:
        raise DataError(f"{path}: not a picture that is known; export it as PNG or PGM") from None
    except (OSError, SyntaxError, ValueError, Image.DecompressionBombError) as problem:
        raise DataError(f"{path}: no sound picture ({problem}); export it again") from None
    return pixels[:3], 255, pixels[3] if see_through else None


def read_pgm(path: Path) -> tuple[NDArray[np.int64], int]:
    """Read a PGM picture, P2 or P5: grey values (rows, columns) from the top, and white's value."""
    data = _bytes(path)
    magic, width, height, white, start = _header(path, data)
    count, size = width * height, 1 if white < 256 else 2
    if magic == b"P5":
        body = data[start : start + count * size]
        grey = np.frombuffer(body[: len(body) // size * size], dtype=f">u{size}").astype(np.int64)
        extra = len(data[start + count * size :].strip())
    else:
        text = b"\n".join(line.partition(b"#")[0] for line in data[start:].split(b"\n"))
        try:
            grey = np.array(text.split(), dtype=np.int64)
        except (ValueError, OverflowError):
            raise DataError(f"{path}: a pixel is not a whole number; export it again") from None
        extra = max(grey.size - count, 0)
    if grey.size < count or extra:
        found = grey.size + (extra if magic == b"P5" else 0)
        raise DataError(
            f"{path}: the header promises {width} x {height} = {count} pixels, the file has "
            f"{found}; it is cut off or its header is wrong"
        )
    if grey.min() < 0 or grey.max() > white:
        raise DataError(f"{path}: a pixel is outside 0 .. {white}, the file's own white")
    return grey.reshape(height, width), white


HEADER = re.compile(rb"(P[25])" + 3 * rb"(?:\s|#[^\n]*\n)+(\d+)" + rb"\s")


def _header(path: Path, data: bytes) -> tuple[bytes, int, int, int, int]:
    """Magic word, width, height and white's value of a PGM, and where its pixels start."""
    found = HEADER.match(data)
    if found is None:
        raise DataError(
            f"{path}: bad header {data[:20]!r}; a PGM starts with P2 or P5, width, height and "
            "white's value"
        )
    width, height, white = (int(word) for word in found.groups()[1:])
    if width < 1 or height < 1 or not 1 <= white <= 65535:
        raise DataError(
            f"{path}: {width} x {height} pixels with white {white}; sizes must be >= 1 and white "
            "1 .. 65535"
        )
    return found[1], width, height, white, found.end()


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
