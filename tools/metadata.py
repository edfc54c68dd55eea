"""Write `codemeta.json` and `.zenodo.json` from `CITATION.cff` and `pyproject.toml`.

A fact about the project as a whole is stated once: who wrote it, its name, version, date and terms
in `CITATION.cff`, what the package needs in `pyproject.toml`. Archives and search engines read
other files; this tool writes them.

    python tools/metadata.py            write them
    python tools/metadata.py --check    say whether they are current
"""

from __future__ import annotations

import json
import sys
import tomllib
from pathlib import Path
from typing import Any

import yaml

ROOT = Path(__file__).resolve().parent.parent


def facts() -> tuple[dict[str, Any], dict[str, Any]]:
    """The citation and the project table."""
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    return citation, project


def spdx(licence: str) -> str:
    """The address of a licence by its SPDX name."""
    return f"https://spdx.org/licenses/{licence}"


def names(citation: dict[str, Any]) -> list[str]:
    """The authors as they are printed."""
    return [
        a["name"] if "name" in a else f"{a['family-names']}, {a['given-names']}"
        for a in citation["authors"]
    ]


def codemeta() -> dict[str, Any]:
    """CodeMeta 2.0, as read by software archives."""
    citation, project = facts()
    return {
        "@context": "https://doi.org/10.5063/schema/codemeta-2.0",
        "@type": "SoftwareSourceCode",
        "name": citation["title"],
        "identifier": project["name"],
        "description": " ".join(citation["abstract"].split()),
        "version": project["version"],
        "datePublished": str(citation["date-released"]),
        "license": [spdx(licence) for licence in citation["license"]],
        "author": [{"@type": "Organization", "name": name} for name in names(citation)],
        "keywords": citation["keywords"],
        "programmingLanguage": f"Python {project['requires-python']}",
        "softwareRequirements": project["dependencies"],
        "developmentStatus": "active",
    } | ({"codeRepository": citation["repository-code"]} if "repository-code" in citation else {})


def zenodo() -> dict[str, Any]:
    """What Zenodo shows of a release."""
    citation, project = facts()
    return {
        "title": citation["title"],
        "description": " ".join(citation["abstract"].split()),
        "upload_type": "lesson",
        "version": project["version"],
        "publication_date": str(citation["date-released"]),
        "creators": [{"name": name} for name in names(citation)],
        "keywords": citation["keywords"],
        "license": "cc-by-4.0",
        "notes": "Text and figures: CC BY 4.0. Code: BSD 3-Clause. Data of others: see data/.",
        "language": "eng",
    }


FILES = {"codemeta.json": codemeta, ".zenodo.json": zenodo}


def text(record: dict[str, Any]) -> str:
    """A record as it is stored."""
    return json.dumps(record, indent=2, ensure_ascii=False) + "\n"


def main(arguments: list[str]) -> int:
    """Write the files, or compare them."""
    old = []
    for name, record in FILES.items():
        path, new = ROOT / name, text(record())
        if "--check" in arguments:
            old += [name] if not path.exists() or path.read_text(encoding="utf-8") != new else []
        else:
            path.write_text(new, encoding="utf-8")
    for name in old:
        print(f"{name} is out of date: python tools/metadata.py")
    return 1 if old else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
