"""What is tracked stays small, portable and consistent with itself."""

from __future__ import annotations

import re
import subprocess
import tomllib
from itertools import chain
from pathlib import Path

import checks
import pytest
import run

ROOT = Path(__file__).resolve().parents[1]
LARGEST_FILE, LARGEST_REPOSITORY = 1_000_000, 15_000_000  # bytes
LARGE_ALLOWED: dict[str, str] = {}  # path: why it must be so large
# Paths of one machine, addresses of package registries and mirrors, tokens in addresses.
OWN_MACHINE = re.compile(
    rb"/(?:home|Users)/[a-z]\w+/|[\"'= (]/(?:work|tmp|opt|root)/[a-z]"
    rb"|registry\.(?:npmjs|yarnpkg)|pypi\.org/simple|files\.pythonhosted|\"resolved\":"
    rb"|extra-index-url|https?://[^\s/@\"']+:[^\s/@\"']+@"
)
MAY_NAME_PATHS = {"tests/test_repository.py"}


def tracked() -> list[Path]:
    """List the files git tracks that exist."""
    done = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True)
    if done.returncode:
        pytest.skip("not a git checkout")
    return [ROOT / name for name in done.stdout.decode().split("\0") if (ROOT / name).is_file()]


def machine_paths(data: bytes) -> list[str]:
    """List what only makes sense on the machine of one author."""
    return [match.group().decode() for match in OWN_MACHINE.finditer(data)]


def test_repository_is_small():
    sizes = {path.relative_to(ROOT).as_posix(): path.stat().st_size for path in tracked()}
    assert sum(sizes.values()) < LARGEST_REPOSITORY
    large = {name for name, size in sizes.items() if size > LARGEST_FILE}
    assert large <= set(LARGE_ALLOWED)


def test_no_tracked_file_names_a_machine_or_a_registry():
    found = {}
    for path in tracked():
        name = path.relative_to(ROOT).as_posix()
        if name not in MAY_NAME_PATHS and (paths := machine_paths(path.read_bytes())):
            found[name] = paths[:3]
    assert found == {}


@pytest.mark.parametrize(
    "text",
    [b'"/root/book/x"', b"/home/ann/book", b" /tmp/a", b'"resolved": "x"', b"https://a:b@host/x"],
)
def test_a_machine_path_is_seen(text):
    assert machine_paths(b"x " + text)


def bounds(lines) -> dict[str, str]:
    """Map package names to their bounds."""
    found = {}
    for line in lines:
        requirement = line.split("#")[0].strip()
        if requirement and not requirement.startswith("pfkit["):
            name = re.match(r"[\w.-]+", requirement).group()
            found[name.lower()] = requirement[len(name) :]
    return found


def test_requirements_agree_with_the_extras():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    everything = [*project["dependencies"], *chain(*project["optional-dependencies"].values())]
    listed = bounds((ROOT / "requirements.txt").read_text(encoding="utf-8").splitlines())
    assert {k: v for k, v in listed.items() if k != "jupyterlab"} == bounds(everything)


@pytest.mark.parametrize("lock", ["requirements.lock", "requirements-book.lock"])
def test_locks_pin_what_is_required(lock):
    pins = bounds(line for line in (ROOT / lock).read_text().splitlines() if line[:1] not in " #")
    assert all(pin.startswith("==") for pin in pins.values())
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    extras = project["optional-dependencies"]
    wanted = bounds(extras["book"] if "book" in lock else chain(*extras.values()))
    assert set(wanted) <= set(pins)


def test_both_locks_agree():
    rows = [set((ROOT / name).read_text().split("\n")) for name in
            ("requirements.lock", "requirements-book.lock")]  # fmt: skip
    pins = [{row.split(" ;")[0] for row in part if "==" in row} for part in rows]
    assert pins[1] <= pins[0]


AUTOMATION = [".ci/run", ".pre-commit-config.yaml", *sorted(ROOT.glob(".github/workflows/*.yml"))]


@pytest.mark.parametrize("path", AUTOMATION, ids=lambda path: Path(path).name)
def test_automation_calls_what_exists(path):
    text = (ROOT / path).read_text(encoding="utf-8")
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    stages = {stage.name for stage in checks.stages()}
    for only in re.findall(r"--only (.+)", text):
        assert set(only.split()) <= stages
    for tool, command in re.findall(r"python (tools/\w+\.py) (\w+)", text):
        assert (ROOT / tool).is_file()
        assert command in ({"test", "lint"} if "checks" in tool else run.COMMANDS)
    for target in re.findall(r"^\W*(?:run: )?make (\w+)", text, re.M):
        assert re.search(rf"^\.PHONY:.* {target}\b", makefile, re.M)
    assert "github.com" not in text.replace("github.com/pre-commit/pre-commit-hooks", "")
