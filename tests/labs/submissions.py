"""Submissions of lab 3 for the grader's tests: honest, broken and hostile.

`CASES` maps a file name to (what writes the file, the status it must get, a part of its detail).
"""

import copy
import json
import os
import zipfile
from pathlib import Path

import solutions

ROOT = Path(__file__).parents[2]
LAB3 = json.loads((ROOT / "notebooks/labs/lab3_particle_filter.ipynb").read_text(encoding="utf-8"))
LAB4 = ROOT / "notebooks/labs/lab4_tuning_outliers.ipynb"
RIGHT = {
    "p1a": 'p1a = "c"',
    "p1b": "p1b = 0.75, 0.75**4, 0.75**10",
    "p2a": "p2a = 0.5 / 0.2, 0.3 / 0.3, 0.2 / 0.5",
    "p2b": "def estimate(values, target, proposal):\n"
    "    w = target / proposal\n    return np.sum(w * values) / np.sum(w)",
}
SOLUTIONS = solutions.published("lab3")
RIGHT_POINTS = 5.0
STUB = 'p1a = ...  # a letter, such as "a"'


def notebook(answers, change=None):
    """Lab 3 with some answers; ``change(notebook)`` may spoil it."""
    book = copy.deepcopy(LAB3)
    for cell in book["cells"]:
        item = cell["metadata"].get("answer")
        if item in answers:
            cell["source"] = answers[item]
    if change:
        change(book)
    return book


def write(path, content):
    """Store a notebook, bytes, or whatever a function makes of the path."""
    path.parent.mkdir(parents=True, exist_ok=True)
    if callable(content):
        content(path)
    elif isinstance(content, bytes):
        path.write_bytes(content)
    else:
        path.write_text(json.dumps(content), encoding="utf-8")


def answered(change=None, **cells):
    return notebook(RIGHT | cells, change)


def before(code):
    """The right answer to p1b, after some lines that do harm."""
    return answered(p1b=code + "\n" + RIGHT["p1b"])


def cell_of(book, item):
    return next(c for c in book["cells"] if c["metadata"].get("answer") == item)


def drop(*items):
    def change(book):
        book["cells"] = [c for c in book["cells"] if c["metadata"].get("answer") not in items]

    return change


def twice(source):
    """A copy of the answer cell p1a, after it."""

    def change(book):
        cell = cell_of(book, "p1a")
        where = book["cells"].index(cell) + 1
        book["cells"].insert(where, cell | {"id": "copy", "source": source})

    return change


def renamed(book):
    for k, cell in enumerate(book["cells"]):
        cell["id"] = f"other-{k}"


def rename_answer(book):
    cell_of(book, "p1b")["metadata"]["answer"] = "p1z"


def helper_elsewhere(book):
    book["cells"].append({"cell_type": "code", "metadata": {}, "source": "def helper(): return 1"})


def sparse(path):
    with path.open("wb") as file:
        file.truncate(200_000_000)


def much_output(book):
    stored = {"output_type": "stream", "name": "stdout", "text": "x" * 10_000_000}
    cell_of(book, "p1b")["outputs"] = [stored]


def old_format(book):
    book["nbformat"] = 3


def export(answers, lab="lab3", predictions=None):
    kept = {i: {"source": s, "version": "0"} for i, s in answers.items()}
    return {"schema": 1, "lab": lab, "answers": kept, "predictions": predictions or {}}


def windows(path):
    text = json.dumps(answered(), indent=1).replace("\n", "\r\n")
    path.write_bytes(b"\xef\xbb\xbf" + text.encode())


def archive(path):
    with zipfile.ZipFile(path, "w") as file:
        file.writestr("lab3.ipynb", json.dumps(answered()))


def by_hand():
    data = export(RIGHT, predictions={"p4a": {"choice": "c", "sure": float("nan")}})
    return data | {"answers": data["answers"] | {"p1b": {"source": 12345}}}


def latin(path):
    text = json.dumps(answered(p3c='p3c = "Zoë"'), ensure_ascii=False)
    path.write_bytes(text.encode("latin-1"))


def cases(precious, tag):
    """All submissions.

    Parameters
    ----------
    precious : Path
        A folder outside that hostile answers try to change.
    tag : str
        An argument of programs that must not survive.
    """
    target = str(precious / "file.txt")
    bounded = "import time\ntime.sleep(100)"
    return {
        # honest
        "right.ipynb": (answered(), "ok", ""),
        "all right.ipynb": (notebook(SOLUTIONS), "ok", ""),
        "wrong.ipynb": (notebook({"p1a": 'p1a = "a"', "p1b": "p1b = 1, 2, 3"}), "ok", ""),
        "Zoë O'Neil/lab 3 (final).ipynb": (answered(), "ok", ""),
        "renamed cells.ipynb": (answered(renamed), "ok", ""),
        "magic.ipynb": (before("%matplotlib inline\n!ls"), "ok", ""),
        "same cell twice.ipynb": (answered(twice(RIGHT["p1a"])), "ok", "2 answer cells"),
        "stub beside answer.ipynb": (answered(twice(STUB)), "ok", ""),
        "export.json": (export(RIGHT), "ok", "another version"),
        "saved.json": (export({"p1a": "'c'", "p1b": "array([0.75, 0.316, 0.0563])"}), "ok", ""),
        "generator.ipynb": (
            answered(p2b="def estimate(v, t, p):\n    while True:\n        yield 1"), "ok", ""),
        "Right.ipynb": (answered(), "ok", ""),
        "windows.ipynb": (windows, "ok", ""),
        "by hand.json": (by_hand(), "ok", "another version"),
        "Ольга 😀.ipynb": (answered(), "ok", ""),
        "10 MB of output.ipynb": (answered(much_output), "ok", ""),
        "thread.ipynb": (before(
            "import threading, time\nthreading.Thread(target=time.sleep, args=(60,)).start()"),
            "ok", ""),
        "prints a gigabyte.ipynb": (before("for _ in range(1000): print('x' * 10**6)"), "ok", ""),
        "writes a gigabyte to 1.ipynb": (before(
            "import os\nfor _ in range(1000): os.write(1, b'x' * 10**6)"), "ok", ""),
        "fork that runs on.ipynb": (before("import os\nos.fork()"), "ok", ""),
        "own folder.ipynb": (before("import os\nopen('a.txt', 'w').write('a')\nos.chmod('.', 0)"),
                             "ok", ""),
        # an answer raises
        "syntax.ipynb": (answered(p1b="p1b = ("), "errors", "p1b: SyntaxError"),
        "raises.ipynb": (before("1 / 0"), "errors", "ZeroDivisionError"),
        "helper elsewhere.ipynb": (
            answered(helper_elsewhere, p1b="p1b = helper()"), "errors", "is not run"),
        "helper of a function.ipynb": (
            answered(helper_elsewhere, p2b="def estimate(v, t, p):\n    return helper()"),
            "errors", "helper is made in a cell"),
        "input.ipynb": (before("input('name? ')"), "errors", "EOFError"),
        "sys exit.ipynb": (before("import sys\nsys.exit(0)"), "errors", "SystemExit"),
        "exit.ipynb": (before("exit()"), "errors", ""),
        "recursion.ipynb": (before("def f(): f()\nf()"), "errors", "RecursionError"),
        "interrupts itself.ipynb": (before("raise KeyboardInterrupt"), "errors", "Keyboard"),
        "null byte.ipynb": (answered(p1b="p1b = 1\0"), "errors", "null byte"),
        "half a character.ipynb": (before("x = '\ud800'"), "errors", "Unicode"),
        "20 GB.ipynb": (before("a = np.ones(int(2.5e9))"), "errors", "Memory"),
        "gigabyte on disk.ipynb": (before(
            "with open('big', 'wb') as f:\n    for _ in range(1000): f.write(bytes(10**6))"),
            "errors", "OSError"),
        # something is not there
        "unanswered.ipynb": (notebook({}), "missing", "nothing is answered"),
        "no answers.json": (export({}), "missing", "nothing is answered"),
        "deleted.ipynb": (answered(drop("p1b")), "missing", "no answer cell for p1b"),
        "all deleted.ipynb": (answered(drop(*SOLUTIONS)), "missing", "p1a"),
        "renamed answer.ipynb": (answered(rename_answer), "missing", "unknown answer cell 'p1z'"),
        # time
        "loop.ipynb": (before("while True: pass"), "timeout", "p1b: not done in 5 s"),
        "ignores SIGINT.ipynb": (before(
            "import signal\nsignal.signal(signal.SIGINT, signal.SIG_IGN)\n"
            "while True:\n    try:\n        while True: pass\n    except BaseException: pass"),
            "timeout", "p1b: not done in 5 s"),
        "slow cells.ipynb": (notebook(
            {i: s + "\nimport time; time.sleep(4.5)" for i, s in SOLUTIONS.items()}),
            "timeout", "not done in 25 s"),
        # the process dies
        "os._exit.ipynb": (before("import os\nos._exit(0)"), "crashed", "code 0 in p1b"),
        "exits in a check.ipynb": (
            answered(p2b="import os\ndef estimate(v, t, p): os._exit(3)"), "crashed", "in p2b"),
        "closes all.ipynb": (before("import os\nos.closerange(0, 99)"), "crashed", "in p1b"),
        "segfault.ipynb": (before("import ctypes\nctypes.string_at(0)"), "crashed", "-11"),
        "abort.ipynb": (before("import os\nos.abort()"), "crashed", "-6"),
        # not a submission of this lab
        "empty file.ipynb": (b"", "malformed", "empty"),
        "bad.ipynb": (b'{"cells": [', "malformed", "JSON"),
        "deep.ipynb": (b"[" * 200_000, "malformed", "JSON"),
        "list.ipynb": (b"[]", "malformed", "list"),
        "cells.ipynb": (b'{"nbformat": 4, "cells": 7}', "malformed", "cells"),
        "sources.ipynb": (b'{"nbformat": 4, "cells": [{"source": 7}]}', "malformed", "source"),
        "zipped.ipynb": (archive, "malformed", "unpack it"),
        "zipped.zip": (archive, "malformed", "unpack it"),
        "nbformat 3.ipynb": (answered(old_format), "malformed", "nbformat is 3"),
        "lab4.ipynb": (LAB4.read_bytes(), "malformed", "notebook of lab4"),
        "stranger.ipynb": (b'{"nbformat": 4, "cells": []}', "malformed", "something else"),
        "of lab4.json": (export(RIGHT, lab="lab4"), "malformed", "lab4"),
        "latin.ipynb": (latin, "malformed", "UTF-8"),
        "200 MB.ipynb": (sparse, "malformed", "200 MB"),
        "essay.pdf": (b"%PDF", "malformed", "neither"),
        "link.ipynb": (lambda p: p.symlink_to("/etc/passwd"), "malformed", "regular"),
        "pipe.ipynb": (os.mkfifo, "malformed", "regular"),
        # hands on what is not theirs
        "two answers.ipynb": (answered(twice('p1a = "b"')), "review", "2 answers compete"),
        "patches check.ipynb": (before("lab.check = print"), "review", "changes lab.check"),
        "takes the key.ipynb": (
            answered(p1a="p1a = lab.LAB.items['p1a'].key"), "review", "uses lab.LAB"),
        "takes the reference.ipynb": (
            answered(p2b='estimate = lab.use("p2b", ...)'), "review", "uses lab.use"),
        "hidden patch.ipynb": (before(
            "inner = getattr(lab, 'LA' + 'B')\ninner.items['p1b'] = inner.items['p1a']"),
            "review", "changed the items.p1b"),
        "patches numpy.ipynb": (answered(
            p2b="def estimate(v, t, p):\n    for n in ('all' + 'close',): "
            "type(np).__setattr__(np, n, lambda *a, **k: True)\n    return 0"),
            "review", "changed numpy.allclose"),
        "rewrites the checker.ipynb": (before(
            "try:\n    open(pf.__file__, 'r+').close()\nexcept OSError: pass"),
            "review", "changes /"),
        "deletes outside.ipynb": (before(
            f"import os\ntry:\n    os.remove({target!r})\nexcept OSError: pass"), "review", target),
        "shell outside.ipynb": (before(f"import os\nos.system('echo x > {target}')"),
                                "review", "starts a program"),
        "C outside.ipynb": (before(
            f"import ctypes\nctypes.CDLL(None).unlink({target.encode()!r})"), "review", "ctypes"),
        "network.ipynb": (before(
            "import socket\ntry:\n    socket.create_connection(('127.0.0.1', 9))\n"
            "except OSError: pass"), "review", "network"),
        "kills the warden.ipynb": (before(
            "import os\ntry:\n    os.kill(os.getppid(), 9)\nexcept OSError: pass"),
            "review", "sends signal 9"),
        "writes to every channel.ipynb": (before(
            "import os\nfor fd in range(3, 40):\n    try:\n        os.write(fd, b'passed\\n')\n"
            "    except OSError: pass"), "review", "channel"),
        "fork outlives.ipynb": (before(
            "import os\nif os.fork() == 0:\n    os.setsid()\n    if os.fork() == 0:\n        "
            + bounded.replace("\n", "\n        ") + "\n    os._exit(0)"),
            "review", "1 of its processes ran on"),
        "50 forks.ipynb": (before(
            "import os, time\nfor _ in range(50):\n    if os.fork() == 0:\n"
            "        time.sleep(100)\n        os._exit(0)"),
            "review", "50 of its processes ran on"),
        "program outlives.ipynb": (before(
            "import subprocess\n"
            f"subprocess.Popen(['sleep', '{tag}'], start_new_session=True, env={{}})"),
            "review", "1 of its processes ran on"),
    }  # fmt: skip
