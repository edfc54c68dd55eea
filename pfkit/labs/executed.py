"""What the cells of a running notebook defined last, so that a check judges what stands in them.

In Jupyter the check is a cell of its own. If the answer's cell ran again and did not parse, raised
an error too early, or no longer defines its name, the name still holds what an earlier version
defined. IPython tells us of every cell that runs: `watch` listens, and `outdated` says in a
sentence why a check must not judge. A program without IPython, such as the grader, hears nothing
and is never refused.

A cell is known by the id that JupyterLab, Notebook 7 and VS Code send; without one (nbclient),
only a cell that names what it fails to define is noticed. A kernel does not hear of a cell that
was edited and not run, nor of one that is empty: front ends do not run those.
"""

import ast
import re
import symtable
import sys
from typing import Any

from pfkit.labs.names import UNREADABLE, binds, bound_and_used


def shell() -> Any:
    """The IPython shell that runs us, or None."""
    ipython = sys.modules.get("IPython")
    return ipython.get_ipython() if ipython else None


class Executed:
    """Which cell defined a name last, and which names are outdated.

    ``running`` is the source of the cell that runs now.
    """

    def __init__(self) -> None:
        self.running = ""
        self._owner: dict[str, Any] = {}
        self._outdated: dict[str, str] = {}

    def before(self, info: Any) -> None:
        """IPython's event ``pre_run_cell``."""
        self.running = info.raw_cell or ""

    def after(self, result: Any) -> None:
        """IPython's event ``post_run_cell``."""
        info = result.info
        source, cell = info.raw_cell or "", getattr(info, "cell_id", None)
        tree = _parsed(source)
        made = _made(tree, result.error_in_exec) if tree else set()
        if cell is None:  # any cell that should have defined a name may be the one
            meant = bound_and_used(source)[0] if tree else _defined_in(source)
        else:
            meant = {name for name, owner in self._owner.items() if owner == cell}
        for name in (meant & self._owner.keys()) - made:
            self._outdated[name] = _why(name, tree, result)
        for name in made:
            self._owner[name] = cell
            self._outdated.pop(name, None)

    def outdated(self, item: str) -> str:
        """Why the answer that the running cell hands to a check must not be judged; or ""."""
        for call in (n for n in ast.walk(_parsed(self.running) or ast.Module([], []))
                     if isinstance(n, ast.Call) and len(n.args) > 1):  # fmt: skip
            if isinstance(call.args[0], ast.Constant) and call.args[0].value == item:
                names = {n.id for n in ast.walk(call.args[1]) if isinstance(n, ast.Name)}
                for name in sorted(names & self._outdated.keys()):
                    return self._outdated[name]
        return ""


def _parsed(source: str) -> ast.Module | None:
    """The cell without lines of magic; None if it is no Python."""
    try:
        return ast.parse(re.sub(r"^(\s*)[%!].*$", r"\1pass", source, flags=re.MULTILINE))
    except UNREADABLE:
        return None


def _defined_in(source: str) -> set[str]:
    """Names that a text which does not parse seems to define."""
    return set(re.findall(r"^(?:def\s+|class\s+)?([^\W\d]\w*)\s*[=(:]", source, re.MULTILINE))


def _line(error: BaseException) -> int:
    """The line of the cell that raised: IPython's own frames stand above that of the cell."""
    step = error.__traceback__
    while step and step.tb_frame.f_code.co_name != "<module>":
        step = step.tb_next
    return step.tb_lineno if step else 0


def _made(tree: ast.Module, error: BaseException | None) -> set[str]:
    """Names defined by the statements that came to their end, and not deleted again.

    ``f = lab.use("q1", f)`` passes on what another cell defined, and does not count.
    """
    names = set[str]()
    for statement in tree.body:
        if error and (statement.end_lineno or 0) >= _line(error):
            break
        if isinstance(statement, ast.Delete):
            names -= {t.id for t in statement.targets if isinstance(t, ast.Name)}
        elif not isinstance(statement, ast.AugAssign):
            top = symtable.symtable(ast.unparse(statement), "<cell>", "exec").get_symbols()
            names |= {n.get_name() for n in top if binds(n) and not n.is_referenced()}
    return names


def _why(name: str, tree: ast.Module | None, result: Any) -> str:
    if tree is None:
        error = result.error_before_exec
        line = f" (line {error.lineno}: {error.msg})" if isinstance(error, SyntaxError) else ""
        return f"the cell that defines {name} does not parse{line}"
    if result.error_in_exec:
        kind = type(result.error_in_exec).__name__
        return f"the cell that defines {name} ended in {kind} before it did"
    return f"the cell that defined {name} ran again without defining it: keep the name"


def watch() -> Executed:
    """What this kernel executed; listens from the first call on."""
    running = shell()
    if running is None or not hasattr(running, "events"):
        return Executed()
    found = getattr(running, "pfkit_executed", None)
    if found is None:
        found = running.pfkit_executed = Executed()
        running.events.register("pre_run_cell", found.before)
        running.events.register("post_run_cell", found.after)
    return found
