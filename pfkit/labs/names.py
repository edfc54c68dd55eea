"""The names that a cell binds and reads, from its source alone."""

import ast
import builtins
import symtable

UNREADABLE = (SyntaxError, ValueError, RecursionError, MemoryError)  # what a parser may raise


def binds(name: symtable.Symbol) -> bool:
    """Does the code assign, import or define this name?"""
    return name.is_assigned() or name.is_imported() or name.is_namespace()


def bound_and_used(source: str) -> tuple[set[str], set[str]]:
    """Names that a cell binds at its top level, and global names that it reads.

    What is local to a function counts as neither: an answer may call its log ``log``.
    A cell that is no Python binds and reads nothing.
    """
    try:
        top = symtable.symtable(source, "<cell>", "exec")
    except UNREADABLE:
        return set(), set()
    names = top.get_symbols()
    bound = {n.get_name() for n in names if binds(n)}
    used = {n.get_name() for n in names if n.is_referenced()}
    used |= bound & {  # ``x += 1`` reads x, of which a table of symbols does not speak
        n.target.id
        for n in ast.walk(ast.parse(source))
        if isinstance(n, ast.AugAssign) and isinstance(n.target, ast.Name)
    }
    inner = list(top.get_children())
    while inner:
        table = inner.pop()
        inner += table.get_children()
        used |= {n.get_name() for n in table.get_symbols() if n.is_global()}
    return bound, used - set(dir(builtins))
