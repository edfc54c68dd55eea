"""Docstrings as the template asks: examples that run, parameters with shapes, results, errors."""

from __future__ import annotations

import doctest
import importlib
import inspect
import re

import numpy as np
import pytest

import pfkit as pf
from pfkit.rooms import CORE

MODULES = [f"pfkit.{module}" for modules in CORE.values() for module in modules]
PUBLIC = {
    name: value
    for name in pf.__all__
    if inspect.isfunction(value := getattr(pf, name)) or inspect.isclass(value)
}
ERRORS = {n for n, v in PUBLIC.items() if inspect.isclass(v) and issubclass(v, Exception)}
FUNCTIONS = sorted(n for n, v in PUBLIC.items() if inspect.isfunction(v))
CLASSES = sorted(set(PUBLIC) - set(FUNCTIONS) - ERRORS)
# Words that say what an argument or a result is: its shape, its type, or its unit.
SHAPE = re.compile(
    r"\(.*\)|array|float|int\b|bool|str\b|number|function|Generator|any shape|path|list|tuple|"
    r"metres|radians|seconds|in \[|[A-Z]\w+|\{|as in|mapping|table"
)


def section(doc: str, title: str) -> str | None:
    """The text of a numpydoc section, or None."""
    found = re.search(rf"^{title}\n-+\n(.*?)(?=^\w[\w ]*\n-+\n|\Z)", doc, re.S | re.M)
    return found and found[1]


def described(doc: str, title: str) -> dict[str, str]:
    """Names of a section, each with what follows its colon."""
    names: dict[str, str] = {}
    for line in (section(doc, title) or "").splitlines():
        match = re.match(r"([\w, *]+?)(?: : (.*))?$", line)
        if match and not line.startswith(" "):
            for name in match[1].split(","):
                names[name.strip().lstrip("*")] = match[2] or ""
    return names


def arguments(value) -> list[str]:
    return [p for p in inspect.signature(value).parameters if p not in ("self", "kwargs")]


@pytest.mark.parametrize("module", MODULES)
def test_examples_run(module):
    found = importlib.import_module(module)
    failed, _ = doctest.testmod(found, extraglobs={"np": np, "pf": pf})
    assert not failed


@pytest.mark.parametrize("module", MODULES)
def test_each_module_teaches(module):
    """A first line, and at least half a dozen lines that a student can learn from."""
    doc = inspect.getdoc(importlib.import_module(module)) or ""
    assert doc.splitlines()[0].endswith((".", "?", "!")), f"{module}: the first line is a sentence"
    assert len(doc.split()) >= 40, f"{module}: {len(doc.split())} words are no half page"


@pytest.mark.parametrize("name", FUNCTIONS)
def test_functions_describe_arguments_and_results(name):
    value = PUBLIC[name]
    doc = inspect.getdoc(value) or ""
    twin = re.search(r"Parameters, returns and errors are those of `(\w+)`", doc)
    doc = (inspect.getdoc(PUBLIC[twin[1]]) or "") if twin else doc
    known = described(doc, "Parameters")
    missing = [a for a in arguments(value) if a not in known]
    assert not missing, f"{name}: describe {missing} under Parameters"
    vague = [a for a, what in known.items() if not (SHAPE.search(what) or what == "")]
    assert not vague, f"{name}: give the shape, type or unit of {vague}"
    result = inspect.signature(value).return_annotation
    assert result in ("None", None) or section(doc, "Returns"), f"{name}: say what it returns"


@pytest.mark.parametrize("name", CLASSES)
def test_classes_describe_what_they_are_built_from(name):
    value = PUBLIC[name]
    doc = inspect.getdoc(value) or ""
    assert doc and not doc.startswith(f"{name}("), f"{name} has no docstring of its own"
    if name in ("MotionModel", "SensorModel") or issubclass(value, tuple):
        return  # interfaces, and named tuples with their attributes
    known = {}
    for base in value.__mro__:  # a subclass describes what it adds
        doc = inspect.cleandoc(base.__doc__ or "")
        known |= described(doc, "Parameters") | described(doc, "Attributes")
    missing = [a for a in arguments(value) if a not in known]
    assert not missing, f"{name}: describe {missing} under Parameters"


@pytest.mark.parametrize("name", FUNCTIONS)
def test_errors_that_a_function_raises_are_announced(name):
    """A `raise` or a check in the body asks for a Raises section."""
    source = inspect.getsource(PUBLIC[name])
    if re.search(r"\braise \w|require_(?!method|callable|instance)\w+\(|as_numbers\(", source):
        assert section(inspect.getdoc(PUBLIC[name]) or "", "Raises"), f"{name}: add Raises"
