"""Stamps: is a stored notebook still what executing it would give?

Executing a notebook records which modules of pfkit it imported and which data files it opened. The
stamp is a hash of its code cells, of those modules and of those files, kept in the notebook's
metadata under `pfkit`. An edit of anything it depends on makes it stale; an edit of something it
never touched does not. Comments, docstrings and blank lines of modules do not count: the same
program gives the same outputs.
"""

from __future__ import annotations

import ast
import hashlib
import io
import json
import tokenize
from collections.abc import Iterable
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def read(path: Path) -> dict:
    """Read a notebook as plain JSON, with each text that is stored as lines joined."""
    return join_lines(json.loads(path.read_text(encoding="utf-8")))


def join_lines(notebook: dict) -> dict:
    """Join the lists of lines that nbformat writes to files into strings, in place."""
    for cell in notebook["cells"]:
        for output in cell.get("outputs", []):
            for part in (output, output.get("data", {})):
                for key, value in part.items():
                    if isinstance(value, list) and key != "traceback":
                        part[key] = "".join(value)
        if isinstance(cell["source"], list):
            cell["source"] = "".join(cell["source"])
    return notebook


def code_cells(notebook: dict) -> list[dict]:
    """Return the code cells in order."""
    return [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]


def program_text(source: str) -> str:
    """Strip comments, docstrings and blank lines from Python source, the same on every version."""
    rows = source.splitlines()
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type == tokenize.COMMENT:
            row, column = token.start
            rows[row - 1] = rows[row - 1][:column]
    for node in ast.walk(ast.parse(source)):
        body = getattr(node, "body", None)
        first = body[0] if isinstance(body, list) and body else None
        if isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant):
            if isinstance(first.value.value, str):
                for row in range(first.lineno - 1, first.end_lineno):
                    rows[row] = ""
    return "\n".join(row.rstrip() for row in rows if row.strip())


def file_digest(path: Path) -> str:
    """Hash a file's meaning: the program of a module, the bytes of anything else."""
    if path.suffix == ".py":
        data = program_text(path.read_text(encoding="utf-8")).encode()
    else:
        data = path.read_bytes().replace(b"\r\n", b"\n")
    return hashlib.sha256(data).hexdigest()


def stamp(notebook: dict, files: Iterable[str], root: Path = ROOT) -> str:
    """Hash the code cells and the files they depend on (a missing file counts as such)."""
    digest = hashlib.sha256()
    for cell in code_cells(notebook):
        digest.update(cell["source"].encode() + b"\0")
    for name in sorted(files):
        path = root / name
        digest.update(f"{name} {file_digest(path) if path.is_file() else 'missing'}\n".encode())
    return digest.hexdigest()[:32]


def why_stale(notebook: dict, root: Path = ROOT) -> str:
    """Say why the stored outputs are out of date, or return an empty string."""
    record = notebook["metadata"].get("pfkit", {})
    if "stamp" not in record:
        return "never executed by make notebooks"
    if stamp(notebook, record["files"], root) == record["stamp"]:
        return ""
    gone = [name for name in record["files"] if not (root / name).is_file()]
    if gone:
        return f"a file it used is gone: {gone[0]}"
    return "its code, a pfkit module it imports, or a data file it reads has changed"
