"""The table of mutations still fits the source, and one cheap mutation is really noticed."""

import importlib.util
import shutil
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
spec = importlib.util.spec_from_file_location("mutation_check", ROOT / "tools/mutation_check.py")
check = importlib.util.module_from_spec(spec)
spec.loader.exec_module(check)


@pytest.mark.parametrize("mutation", check.MUTATIONS, ids=lambda m: m.name)
def test_each_mutation_names_one_line_and_existing_tests(mutation):
    source = check.source_of(mutation, ROOT).read_text(encoding="utf-8")
    assert source.count(mutation.old) == 1 and mutation.new != mutation.old
    for name in mutation.tests.split():
        assert (ROOT / "tests" / f"{name}.py").exists()


def test_there_are_at_least_ten_of_them():
    assert len({m.name for m in check.MUTATIONS}) == len(check.MUTATIONS) >= 10


def test_a_mutation_is_noticed_and_the_sound_copy_is_not(tmp_path):
    for part in ("pfkit", "tests"):
        shutil.copytree(ROOT / part, tmp_path / part)
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    wrong = next(m for m in check.MUTATIONS if m.name == "ess-square")
    killed = check.killer(wrong, tmp_path)
    assert killed is not None and killed.startswith("tests/particles/test_particle_set.py")
    assert check.killer(wrong._replace(new=wrong.old), tmp_path) is None
