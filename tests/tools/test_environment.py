"""The commands say in one line what is wrong, and know when there is nothing to do."""

from __future__ import annotations

import ast
import subprocess
import sys

import environment
import npm_packages
import pytest
import run
from environment import ROOT, Stop

import book


@pytest.mark.parametrize("version", [(3, 10), (3, 14), (2, 7)])
def test_a_wrong_python_is_named(version, monkeypatch):
    monkeypatch.setattr(sys, "version_info", (*version, 0))
    with pytest.raises(Stop, match="is needed"):
        environment.require_python()


def test_this_python_will_do():
    environment.require_python()


@pytest.mark.parametrize("name", ["run.py", "python_version.py"])
def test_an_old_python_can_read_what_complains_of_it(name):
    """Python 2.7 and 3.6 stop at annotations, f-strings, unpacking and letters beyond ASCII."""
    source = (ROOT / "tools" / name).read_text(encoding="utf-8")
    assert source.isascii() and "__future__" not in source
    for node in ast.walk(ast.parse(source)):
        assert not isinstance(node, ast.JoinedStr | ast.AnnAssign | ast.NamedExpr)
        assert not (isinstance(node, ast.List | ast.Tuple | ast.Set) and _unpacks(node.elts))
        assert not (isinstance(node, ast.Dict) and None in node.keys)
        assert getattr(node, "annotation", None) is None and getattr(node, "returns", None) is None


def _unpacks(elements):
    return any(isinstance(element, ast.Starred) for element in elements)


@pytest.fixture
def pip_says(monkeypatch):
    """Let pip fail with a message of our choice."""

    def arrange(message):
        failed = subprocess.CompletedProcess([], 1, "", message)
        monkeypatch.setattr(environment.subprocess, "run", lambda *args, **kwargs: failed)

    return arrange


def test_no_network_is_one_line(pip_says):
    pip_says(
        "WARNING: Retrying (NewConnectionError)\n"
        "ERROR: Could not find a version that satisfies numpy (from versions: none)\n"
        "ERROR: No matching distribution found for numpy"
    )
    with pytest.raises(Stop) as stop:
        environment._pip("numpy")
    assert "Is there a network?" in str(stop.value)
    assert "\n" not in str(stop.value)


def test_another_failure_of_pip_does_not_blame_the_network(pip_says):
    pip_says("ERROR: No space left on device")
    with pytest.raises(Stop, match="No space left") as stop:
        environment._pip("numpy")
    assert "network" not in str(stop.value)


def test_npm_without_network_is_one_line(monkeypatch, tmp_path):
    failed = subprocess.CompletedProcess([], 1, "", "npm error code ENOTFOUND\nnpm error network")
    monkeypatch.setattr(npm_packages.subprocess, "run", lambda *args, **kwargs: failed)
    with pytest.raises(Stop, match="Is there a network") as stop:
        npm_packages.run("npm", "ci", folder=tmp_path)
    assert "\n" not in str(stop.value)


def test_the_stamp_follows_lock_and_project(monkeypatch, tmp_path):
    lock = tmp_path / "requirements.lock"
    lock.write_text("numpy==2.0.1\n")
    monkeypatch.setattr(environment, "LOCKS", {"all": lock})
    first = environment.fingerprint("all")
    lock.write_bytes(b"numpy==2.0.1\r\n")
    assert environment.fingerprint("all") == first
    lock.write_text("numpy==2.0.2\n")
    assert environment.fingerprint("all") != first


def test_warnings_are_picked_out_of_a_long_log():
    log = "reading\na.md:3: WARNING: no such label\nwriting\na.md:3: WARNING: no such label\n"
    assert book.explain(log) == "a.md:3: WARNING: no such label"
    assert "TypeError: no" in book.explain("Traceback\nTypeError: no\ndone\n")
    assert book.explain("something else") == "something else"


def test_every_command_has_its_tool():
    for _, tool, _ in run.COMMANDS.values():
        assert (ROOT / "tools" / f"{tool}.py").exists()
    assert set(run.COMMANDS) | {"clean"} <= set(run.__doc__.split())


def test_the_makefile_offers_every_command_a_reader_is_told_of():
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    offered = makefile.split(".PHONY:")[1].splitlines()[0].split()
    assert {*run.COMMANDS, "clean"} <= set(offered)
