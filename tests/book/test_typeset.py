"""Formulas are typeset at build time, and fonts are cut to what the book shows."""

from __future__ import annotations

import fonts
import icons
import pytest
import typeset
from docutils import nodes
from fontTools.ttLib import TTFont

needs_mathjax = pytest.mark.skipif(
    not typeset.MATHJAX.exists(), reason="MathJax is not here: run python tools/npm_packages.py"
)


@pytest.fixture(scope="module")
def setter():
    running = typeset.Typesetter()
    yield running
    running.close()


@needs_mathjax
def test_a_formula_becomes_text_with_mathml_for_screen_readers(setter):
    html = setter.ask(tex=r"\hat\theta \approx x_t", display=False)["html"]
    assert html.startswith("<mjx-container") and "\\" not in html
    assert "<math " in html and "<mi>θ</mi>" in html
    assert 'display="true"' not in html
    assert 'display="true"' in setter.ask(tex="x", display=True)["html"]


@needs_mathjax
@pytest.mark.parametrize("tex", [r"\frac{1", r"\nosuchmacro", "x_1_2"])
def test_what_does_not_parse_is_an_error_and_the_next_formula_still_works(setter, tex):
    assert setter.ask(tex=tex, display=False)["error"]
    assert "html" in setter.ask(tex="y", display=False)


@needs_mathjax
def test_the_style_has_the_characters_of_the_formulas(setter):
    setter.ask(tex=r"\Sigma \mathcal{N}", display=False)
    shown = typeset.characters(setter.ask(finish=True)["css"])
    assert {"Σ", "N", "θ"} <= shown and "Ω" not in shown


def test_equations_of_one_block_stand_under_each_other():
    assert typeset.rows("a = b") == "a = b"
    assert typeset.rows(r"a &= b \\ c &= d") == r"\begin{split}a &= b \\ c &= d\end{split}"
    assert typeset.rows("a\n\nb") == r"\begin{aligned}a \\ b\end{aligned}"


@needs_mathjax
def test_a_warning_names_a_formula_that_does_not_parse(monkeypatch):
    said = []
    monkeypatch.setattr(typeset.logger, "warning", lambda text, *values, **_: said.append(values))
    assert typeset.html_of(r"\frac{1", False, nodes.math()) == r"<code>\frac{1</code>"
    assert said and said[0][1] == r"\frac{1"
    typeset.running.close()
    typeset.running = None


@needs_mathjax
def test_a_font_is_cut_to_its_characters_the_same_each_time(tmp_path):
    source = typeset.FONTS / "MathJax_Main-Regular.woff"
    for name in ("a.woff", "b.woff"):
        fonts.cut(source, "AB+", tmp_path / name)
    assert (tmp_path / "a.woff").read_bytes() == (tmp_path / "b.woff").read_bytes()
    assert set(TTFont(tmp_path / "a.woff").getBestCmap()) == {ord(c) for c in "AB+"}
    assert (tmp_path / "a.woff").stat().st_size < source.stat().st_size / 4


def test_rules_of_icons_that_no_page_names_go():
    css = (
        '.fa-bars:before,.fa-navicon:before{content:"\\f0c9"}.fa-crown:before{content:"\\f521"}'
        '.note{--icon:"\uf05a"}@font-face{src:url(x.woff2) format("woff2"),'
        'url(x.ttf) format("truetype")}'
    )
    short, signs = icons.shorten(css, {"fa-bars"})
    assert signs == {"\uf0c9", "\uf05a"}
    assert "fa-crown" not in short and 'src:url(x.woff) format("woff")' in short
