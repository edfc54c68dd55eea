"""Notation, glossary and links: what a chapter writes must stand where readers look it up.

The notation page has two tables: letters of the whole course, and letters that live in one chapter
only. A chapter's formulas may use no other. Each check is a function from text to a list of faults,
so that the last tests can show that a broken text is caught.
"""

import json
import re
from itertools import pairwise
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
CHAPTERS = sorted((ROOT / "notebooks").glob("*.ipynb"))
LABS = sorted((ROOT / "notebooks" / "labs").glob("*.ipynb"))
PAGES = sorted((ROOT / "book").glob("*.md")) + sorted((ROOT / "book").glob("*.ipynb"))

# What first-year mathematics has settled; everything else needs a row.
FUNCTIONS = set("sin cos tan atan2 arctan exp log ln sqrt det max min arg".split())
GREEK = set(
    "alpha beta gamma delta epsilon varepsilon zeta eta theta iota kappa lambda mu nu xi rho sigma "
    "tau phi varphi chi psi omega Gamma Delta Theta Lambda Sigma Phi Psi Omega ell".split()
)
ACCENTS = set("hat tilde bar overline dot".split())
OPERATORS = {"oplus", "ominus"}
WORDS = {"bel"}  # names of several letters that are written without \mathrm

TOKEN = re.compile(r"\\[A-Za-z]+|\\.|[A-Za-z]+|\d+|\S|\s+")
NO_SYMBOL = re.compile(r"\\(?:text|begin|end)\s*\{[^{}]*\}")
INDEX = re.compile(r"(?:[tTKknijmhs](?![A-Za-z])|\d|[-+:,.*_ <>=()\[\]])+")


# ---------------------------------------------------------------- text


def text_of(path):
    """The prose of a page; of a notebook, its markdown cells."""
    raw = path.read_text(encoding="utf-8")
    if path.suffix == ".ipynb":
        cells = json.loads(raw)["cells"]
        raw = "\n\n".join("".join(c["source"]) for c in cells if c["cell_type"] == "markdown")
    return re.sub(r"<!--.*?-->", "", raw, flags=re.S)


def formulas(text):
    """Every formula of a text: math directives, $$...$$ and $...$, never code."""
    found = re.findall(r"```\{math\}\n(?:[ \t]*:\w+:[^\n]*\n)*(.*?)```", text, flags=re.S)
    text = re.sub(r"^([`~:]{3,}).*?^\1", "", text, flags=re.S | re.M)
    text = re.sub(r"`[^`\n]*`", "", text)
    found += re.findall(r"\$\$(.+?)\$\$", text, flags=re.S)
    text = re.sub(r"\$\$.+?\$\$", "", text, flags=re.S)
    return found + re.findall(r"(?<!\\)\$((?:\\.|[^$\\])+)\$", text, flags=re.S)


# ---------------------------------------------------------------- symbols


def group(tokens, i):
    """The argument that starts at token i, and the place after it."""
    while i < len(tokens) and tokens[i].isspace():
        i += 1
    if i >= len(tokens):
        return "", i
    if tokens[i] != "{":
        if tokens[i] in (r"\mathrm", r"\text", r"\mathcal") or tokens[i][1:] in ACCENTS:
            inner, end = group(tokens, i + 1)
            return tokens[i] + "{" + inner + "}", end
        if tokens[i].isalnum() and len(tokens[i]) > 1:  # x_ab is x_a b
            tokens[i : i + 1] = list(tokens[i])
        return tokens[i], i + 1
    depth, start = 1, i + 1
    while depth and i + 1 < len(tokens):
        i += 1
        depth += {"{": 1, "}": -1}.get(tokens[i], 0)
    return "".join(tokens[start:i]), i + 1


def plain(subscript):
    """A subscript without its typography: `\\mathrm{hit}` and `{hit}` are `hit`."""
    subscript = re.sub(r"\\(mathrm|text|mathcal)\b\s*", "", subscript)
    subscript = re.sub(r"\\[,;!: ]|[{}\s]", "", subscript)
    return subscript.replace(r"\le", "<").replace(r"\dots", ".")


def symbols(formula):
    """The symbols of a formula in order, as `x_t`, `hat r`, `sigma_phi`, `Delta t`."""
    tokens, found, i = TOKEN.findall(re.sub(NO_SYMBOL, " ", formula)), [], 0
    while i < len(tokens):
        token, name = tokens[i], ""
        macro = token[1:] if token.startswith("\\") else ""
        if token.isalpha() and token not in WORDS and len(token) > 1:
            tokens[i : i + 1] = list(token)
            continue
        follower = tokens[i + 1] if i + 1 < len(tokens) else ""
        i += 1
        if macro in ACCENTS:
            inner, i = group(tokens, i)
            inside = symbols(inner)
            name = f"{macro} {inside[0]}" if inside else ""
        elif macro in ("mathrm", "mathcal"):
            inner, i = group(tokens, i)
            name = inner.strip() if macro == "mathrm" else f"{macro} {inner.strip()}"
        elif macro in ("Delta", "delta") and (following := next_symbol(tokens, i)):
            name, i = f"{macro} {following[0]}", following[1]
        elif macro in GREEK | OPERATORS:
            name = macro
        elif token == "d" and (follower.isalpha() or follower[1:] in GREEK):
            continue  # a differential: of dx, d\theta only the x, the theta
        elif token == "e" and tokens[i : i + 2] == ["^", "{"]:
            name = "e^"  # the number: no row has it, it is written exp
        elif token.isalpha():
            name = token
        subscript, inner_found = "", []
        while i < len(tokens) and tokens[i] in "_^'":
            kind = tokens[i]
            if kind == "'":
                i += 1
                continue
            inner, i = group(tokens, i + 1)
            if inner == "*" and kind == "^" and name:
                name += "*"
            elif kind == "_" and name:
                subscript = plain(inner)
            elif inner.strip() == "T" and kind == "^" and macro not in ("sum", "prod", "int"):
                inner_found.append("^T")  # a transpose: no row has it, it is written \top
            elif inner.strip() != r"\top" and not re.fullmatch(r"\[\w\]", inner):
                inner_found += symbols(inner)
        if name and name not in FUNCTIONS:
            found.append(f"{name}_{subscript}" if subscript else name)
        found += inner_found
    return found


def next_symbol(tokens, i):
    """The letter that a Delta belongs to, as in `\\Delta t`, or nothing."""
    while i < len(tokens) and tokens[i].isspace():
        i += 1
    if i < len(tokens) and (tokens[i][1:] in GREEK - {"delta", "Delta"} or tokens[i].isalpha()):
        if len(tokens[i]) > 1 and tokens[i].isalpha():
            tokens[i : i + 1] = list(tokens[i])
        return tokens[i].lstrip("\\"), i + 1
    return None


def without_index(symbol):
    """`x_{t-1}` is the symbol x at another time; `sigma_r` is a symbol of its own."""
    base, _, subscript = symbol.partition("_")
    return base if INDEX.fullmatch(subscript) else symbol


# ---------------------------------------------------------------- the tables


def definitions(cell):
    """Symbols that a cell of the first column defines, and those it only writes in a formula.

    `$r,\\ \\phi$` defines two. `$p(z \\mid x)$` is an example of p, `$A = ...$` defines A.
    """
    sure, examples = [], []
    for formula in re.findall(r"\$([^$]+)\$", cell):
        left, _, right = formula.partition("=")
        if left.strip().startswith("("):
            left = left.strip()[1:].rpartition(")")[0]
        if right.strip().startswith("("):
            left += "," + right.strip()[1:].rpartition(")")[0]
        called = re.sub(r"\(.*\)", "", left)
        operators = [s for s in symbols(left) if s in OPERATORS]
        if operators:
            sure += operators
        elif called != left:
            examples += symbols(called)
        else:
            named = symbols(left)
            sure += named
            if r"\dots" in left and len(named) == 2:
                base, first, last = (*named[0].split("_"), named[1].split("_")[1])
                sure += [f"{base}_{k}" for k in range(int(first) + 1, int(last))]
    return sure, examples


def tables(page):
    """Rows of both tables: [(symbols, examples, meaning, code)] and {chapter: the same}."""
    course, local = [], {}
    for line in page.splitlines():
        cells = [c.strip() for c in re.split(r"(?<!\\)\|", line.strip())[1:-1]]
        if len(cells) != 4:
            continue
        if "$" in cells[0]:
            course.append((*definitions(cells[0]), cells[2], cells[1]))
        elif "$" in cells[1]:
            for chapter in cells[0].split(","):
                local.setdefault(chapter.strip(), []).append(
                    (*definitions(cells[1]), *cells[:1:-1])
                )
    return course, local


def label(path):
    """How the second table names a chapter: `particle filter`, `gallery`, `lab3`."""
    topic = re.match(r"\d\d_(\w+)", path.stem)
    if topic:
        return topic[1].replace("_", " ")
    name = path.stem.removeprefix("autopsy_")
    return name.partition("_")[0] if name.startswith("lab") else name.replace("_", " ")


def table_problems(page):
    """One symbol, one meaning; a letter borrowed by a chapter says what it is elsewhere."""
    course, local = tables(page)
    found = []
    everywhere = {without_index(s) for sure, *_ in course for s in sure}
    for name, rows in [("the course", course), *local.items()]:
        sure = [s for row in rows for s in row[0]]
        found += [
            f"{s} has two rows for {name}" for s in sorted({s for s in sure if sure.count(s) > 1})
        ]
    for chapter, rows in local.items():
        for sure, examples, meaning, _ in rows:
            for symbol in sure + examples:
                if symbol in everywhere and "elsewhere" not in meaning:
                    found.append(f"{symbol} of {chapter} has another meaning elsewhere: say so")
    return found


def known(page, chapter):
    course, local = tables(page)
    rows = course + local.get(chapter, [])
    names = {s for sure, examples, *_ in rows for s in sure + examples}
    return names | {s[:-2] for s in names if s.endswith("_t")}


def unknown_symbols(text, page, chapter):
    """Symbols of a chapter's formulas that have no row, each with its formula."""
    names = known(page, chapter)
    return sorted(
        {
            f"{s} in ${' '.join(formula.split())}$"
            for formula in formulas(text)
            for s in symbols(formula)
            if s not in names and without_index(s) not in names
        }
    )


def stale_rows(page, texts):
    """Rows that nobody uses; `texts` is {chapter: (prose, code)}."""
    course, local = tables(page)
    used = {
        name: {s for f in formulas(prose) for s in symbols(f)} for name, (prose, _) in texts.items()
    }
    for name in used:
        used[name] |= {without_index(s) for s in used[name]}
    anywhere = set().union(*used.values())
    words = set(re.findall(r"\w+", " ".join(code for _, code in texts.values())))
    codes = {tuple(r[0] + r[1]): set(re.findall(r"\w+", r[3])) for r in course}
    found = [
        f"{', '.join(names)}: no chapter uses it"
        for names, code in codes.items()
        if names and not anywhere & set(names) and not words & code
    ]
    for chapter, rows in local.items():
        if chapter not in used:
            found.append(f"{chapter} is no chapter")
        for sure, examples, *_ in rows if chapter in used else []:
            found += [
                f"{s} of {chapter} is not used there"
                for s in sure + examples
                if s not in used[chapter]
            ]
    return found


# ---------------------------------------------------------------- glossary


def glossary_terms(page):
    body = re.search(r"```\{glossary\}\n(.*?)```", page, flags=re.S)[1]
    return [line.strip() for line in body.splitlines() if line and not line[0].isspace()]


def term_uses(text):
    """What `{term}` roles point to, in lower case, as Sphinx looks terms up."""
    roles = [" ".join(r.split()) for r in re.findall(r"\{term\}`([^`]+)`", text)]
    return [re.sub(r"^.*<(.+)>$", r"\1", r).lower() for r in roles]


def glossary_problems(page, chapters, other_pages):
    """Order, doubles, terms that nobody links, links to terms that nobody defined."""
    terms = glossary_terms(page)
    lower = [t.lower() for t in terms]
    by_chapters = {u for text in chapters for u in term_uses(text)}
    everywhere = by_chapters | {u for text in [page, *other_pages] for u in term_uses(text)}
    found = [f"{b} must stand before {a}" for a, b in pairwise(lower) if b < a]
    found += [f"{t} is defined twice" for t in sorted({t for t in lower if lower.count(t) > 1})]
    found += [f"no chapter links {t}" for t in lower if t not in by_chapters]
    return found + [f"{u} is not in the glossary" for u in sorted(everywhere - set(lower))]


# ---------------------------------------------------------------- links


def anchors(path):
    """Labels and the ids of headings of a page."""
    text = text_of(path)
    headings = re.findall(r"^#{1,6} +(.+)$", text, flags=re.M)
    slugs = {re.sub(r"[^\w\- ]", "", h.lower()).strip().replace(" ", "-") for h in headings}
    return slugs | set(re.findall(r"^\(([\w.:-]+)\)=\s*$", text, flags=re.M))


def link_problems(text, folder, toc, keys):
    """Links of one page that lead nowhere: {doc}, [..](..) and {cite}."""
    text = re.sub(r"^(`{3,}|~{3,})(?!\{).*?^\1", "", text, flags=re.S | re.M)
    found = []
    for role in re.findall(r"\{doc\}`([^`]+)`", text):
        target = re.sub(r"^.*<(.+)>$", r"\1", role, flags=re.S)
        base = ROOT if target.startswith("/") else folder
        page = (base / target.lstrip("/")).resolve()
        if not page.is_relative_to(ROOT) or page.relative_to(ROOT).as_posix() not in toc:
            found.append(f"{{doc}} {target}: no such page in the table of contents")
    for target in re.findall(r"\]\(([^()\s]+)\)", text):
        address, _, anchor = target.partition("#")
        page = folder / address
        if re.match(r"[a-z]+:", target):
            continue
        if address and not page.is_file():
            found.append(f"{target}: no such file")
        elif address and anchor and anchor not in anchors(page):
            found.append(f"{target}: no such heading")
    for role in re.findall(r"\{cite(?::\w+)?\}`([^`]+)`", text):
        found += [
            f"{k} is not in the bibliography"
            for k in map(str.strip, role.split(","))
            if k not in keys
        ]
    return found


def toc_pages():
    toc = (ROOT / "_toc.yml").read_text(encoding="utf-8")
    return set(re.findall(r"(?:file|root): *(\S+)", toc))


def bibliography():
    return set(
        re.findall(
            r"^@\w+\{([^,\s]+)", (ROOT / "book/references.bib").read_text("utf-8"), flags=re.M
        )
    )


# ---------------------------------------------------------------- tests

NOTATION = (ROOT / "book" / "notation.md").read_text(encoding="utf-8")
GLOSSARY = (ROOT / "book" / "glossary.md").read_text(encoding="utf-8")


def code_of(path):
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    return "\n".join("".join(c["source"]) for c in cells)


def test_one_symbol_has_one_meaning():
    assert table_problems(NOTATION) == []


@pytest.mark.parametrize(
    "path",
    CHAPTERS + LABS + [p for p in PAGES if p.stem != "notation"],  # which says what others mean
    ids=lambda p: p.stem,
)
def test_every_symbol_is_in_the_notation_table(path):
    assert unknown_symbols(text_of(path), NOTATION, label(path)) == []


def test_no_row_of_the_tables_is_stale():
    texts = {label(p): (text_of(p), code_of(p)) for p in CHAPTERS + LABS}
    assert stale_rows(NOTATION, texts) == []


def test_glossary_and_chapters_agree():
    pages = [text_of(p) for p in PAGES if p.name != "glossary.md"]
    assert glossary_problems(GLOSSARY, map(text_of, CHAPTERS + LABS), pages) == []


@pytest.mark.parametrize("path", CHAPTERS + LABS + PAGES, ids=lambda p: p.stem)
def test_links_lead_somewhere(path):
    assert link_problems(text_of(path), path.parent, toc_pages(), bibliography()) == []


# ---------------------------------------------------------------- the checks can fail

TABLE = r"""
| $x_t = (x, y)$ | `x` | state | m |
| $\sigma,\ \sigma_r$ | `sigma` | deviation | m |
| $\hat r$ | | expected range | m |
| $\alpha_1 \dots \alpha_3$ | `alpha` | noise | |
| $p(x_t \mid u)$ | | model | |
| motion | $c$ | | chord |
"""


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        (r"\overline{bel}(x_{t-1}) = \eta\, w_t^{[m]}", ["overline bel", "x_t-1", "eta", "w_t"]),
        (r"\int f(x)\,dx \quad \frac Tn", ["f", "x", "x", "T", "n"]),
        (
            r"\hat\phi + \sigma_{\mathrm{hit}}^2 \text{ for all } r^*",
            ["hat phi", "sigma_hit", "r*"],
        ),
        (r"\Delta t\,\sin(\omega\Delta\theta/2)", ["Delta t", "omega", "Delta theta"]),
        (r"e^{-M V_h} + e^2 + A^T B^{-1}", ["e^", "M", "V_h", "e", "A", "^T", "B"]),
        (r"A^\top (B)^T + \sum_{t=1}^T x_t", ["A", "B", "^T", "t", "T", "x_t"]),
        (r"\mathrm{Var}_p[f] \sim \mathcal N(0, I)", ["Var_p", "f", "mathcal N", "I"]),
        (r"\begin{pmatrix} a \\ b \end{pmatrix}", ["a", "b"]),
        (r"\sum_{k=1}^{K} x^{n}", ["k", "K", "x", "n"]),
    ],
)
def test_symbols_of_a_formula(formula, expected):
    assert symbols(formula) == expected


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        (r"So $\zeta = x_t$.", "zeta"),
        ("$$\n\\hat\\zeta\n$$", "hat zeta"),
        ("```{math}\n:label: e\n\\sigma_q\n```", "sigma_q"),
        (r"$\bar r$", "bar r"),
        (r"$\alpha_4$", "alpha_4"),
        (r"$c$", "c"),
        (r"$x_t + \sigma_r \hat r\, \alpha_2 p(x)$ and `$zeta$`", ""),
    ],
)
def test_a_symbol_without_a_row_is_found(text, fault):
    found = unknown_symbols(text, TABLE, "sensing")
    assert [f.partition(" in $")[0] for f in found] == [fault] * bool(fault)


def test_a_letter_of_one_chapter_holds_in_that_chapter_only():
    assert unknown_symbols("$c$", TABLE, "motion") == []
    assert unknown_symbols("$c$", TABLE, "sensing") != []


def test_a_symbol_with_two_meanings_is_found():
    assert table_problems(TABLE) == []
    assert "x has two rows" in " ".join(table_problems(TABLE + "| $x$ | | box | m |"))
    assert "c has two rows for motion" in table_problems(TABLE + "| motion | $c$ | | cost |")
    assert "say so" in " ".join(table_problems(TABLE + "| motion | $x$ | | share |"))
    assert table_problems(TABLE + "| motion | $x$ | | share (elsewhere the state) |") == []


def test_a_stale_row_is_found():
    used = {"motion": (r"$x\ \sigma\ \hat r\ \alpha_1\ c\ p(x_t \mid u)$", "")}
    assert stale_rows(TABLE, used) == []
    assert stale_rows(TABLE + "| motion | $Y$ | | |\n| motor | $Y$ | | |", used) == [
        "Y of motion is not used there",
        "motor is no chapter",
    ]
    assert stale_rows(TABLE + "| $Y$ | `box` | | |", used) == ["Y: no chapter uses it"]
    assert (
        stale_rows(TABLE + "| $Y$ | `box` | | |", {"motion": (used["motion"][0], "box = 1")}) == []
    )


def test_a_broken_glossary_is_found():
    page = "```{glossary}\nbelief\n  What is known.\n\nweight\n  A number.\n```"
    chapters = ["{term}`Belief`, {term}`weighs\n<weight>`"]
    assert glossary_problems(page, chapters, []) == []
    assert glossary_problems(page, chapters[:0], []) == [
        "no chapter links belief",
        "no chapter links weight",
    ]
    assert "drift is not in the glossary" in glossary_problems(page, chapters, ["{term}`drift`"])
    swapped = page.replace("belief", "zebra")
    assert "weight must stand before zebra" in glossary_problems(swapped, chapters, [])


@pytest.mark.parametrize(
    "text",
    [
        "{doc}`a chapter <05_nowhere>`",
        "{doc}`/book/nowhere`",
        "[notation](../book/nowhere.md)",
        "[notation](../book/notation.md#no-such-heading)",
        "![picture](nowhere.png)",
        "{cite}`nobody1900`",
    ],
)
def test_a_dead_link_is_found(text):
    folder, toc = ROOT / "notebooks", toc_pages()
    assert len(link_problems(text, folder, toc, bibliography())) == 1
    alive = "{doc}`/book/notation` [n](../book/notation.md#notation) <https://example.org> [w](https://e.org/)"
    assert link_problems(alive, folder, toc, bibliography()) == []
