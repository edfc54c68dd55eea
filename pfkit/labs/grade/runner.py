"""Runs the steps of one submission; started by `warden`, one process each.

It differs from a notebook's kernel in four ways: cells that no answer needs are left out; lines
of magic (``%``, ``!``) do nothing; nothing is displayed; a variable that an answer should bind
is unbound before the answer runs. Code, names and order are otherwise those of the notebook.

Events go out as lines, each with a token in front that the answers do not know.
"""

import importlib
import json
import linecache
import os
import re
import signal
import sys
import types
from pathlib import Path
from typing import Any

MAGIC = re.compile(r"^(\s*)[%!].*$", re.MULTILINE)


class Channel:
    """The way out. Only this process uses it, not one that an answer forks."""

    def __init__(self, token: str) -> None:
        self._fd, self._token, self._pid = os.dup(1), token, os.getpid()
        nothing = os.open(os.devnull, os.O_RDWR)
        for fd in (0, 1, 2):
            os.dup2(nothing, fd)

    @property
    def mine(self) -> bool:
        return os.getpid() == self._pid

    def send(self, **event: Any) -> None:
        if self.mine:
            data = f"{self._token} {json.dumps(event)}\n".encode()
            while data:
                data = data[os.write(self._fd, data) :]


class Session:
    """One student's namespace, and what became of each item."""

    def __init__(self, job: dict[str, Any], channel: Channel) -> None:
        # imported here, so that a broken installation is told through the channel
        from pfkit.labs.grade import seal

        self._channel, self._variables = channel, job["variables"]
        self._lab = importlib.import_module(f"pfkit.labs.{job['lab']}").LAB
        self._lab.asks_how_sure = False
        self._lab.student(*job["student"])
        self._main = types.ModuleType("__main__")
        sys.modules["__main__"] = self._main
        self._names = vars(self._main)
        self._modules: dict[str, Any] = {}
        self._failed: dict[str, str] = {}
        self._seal, self._known = seal, set[str]()
        self._unchanged: seal.Unchanged | None = None

    def close(self, job: dict[str, Any]) -> None:
        """Import what the cells of ours need, then shut the doors."""
        for step in job["steps"]:
            if step["do"] == "ours" and "import" in step["source"]:
                self._execute(step)
        self._seal.limit_resources(job["memory"], job["wall"])
        self._channel.send(landlock=self._seal.confine([os.getcwd(), os.devnull]))
        self._seal.watch(os.getcwd(), lambda what: self._channel.send(doubt=what))
        self._unchanged = self._seal.Unchanged(self._lab)

    def run(self, steps: list[dict[str, str]]) -> None:
        for step in steps:
            signal.signal(signal.SIGINT, signal.default_int_handler)
            self._channel.send(begin=step["item"], do=step["do"])
            try:
                getattr(self, "do_" + step["do"])(step)
            except BaseException as error:
                self._failed[step["item"]] = _words(error)
                if step["do"] != "answer":
                    self._channel.send(item=step["item"], status="error", detail=_words(error))
            if not self._channel.mine:
                os._exit(0)  # a copy that an answer forked and let run on
            self._look(step["item"])

    def _look(self, item: str) -> None:
        for name in self._unchanged.changes()[:5] if self._unchanged else ():
            if name not in self._known:
                self._known.add(name)
                self._channel.send(doubt=f"{item}: changed {name}")

    def _execute(self, step: dict[str, str]) -> None:
        name = f"<ipython-input-{step['item'] or 'course'}>"
        source = MAGIC.sub(r"\1pass", step["source"])
        linecache.cache[name] = (len(source), None, source.splitlines(True), name)
        exec(compile(source, name, "exec", dont_inherit=True), self._names)

    def do_ours(self, step: dict[str, str]) -> None:
        self._names.update(self._modules)  # np is numpy again, whatever an answer made of it
        self._execute(step)
        for key, value in self._names.items():
            if isinstance(value, types.ModuleType):
                self._modules.setdefault(key, value)

    def do_answer(self, step: dict[str, str]) -> None:
        self._names.update(self._modules)
        self._names.pop(self._variables[step["item"]], None)
        self._execute(step)

    def do_check(self, step: dict[str, str]) -> None:
        item, bound = step["item"], step["source"] in self._names
        raised = self._failed.get(item, "")
        if raised and not bound:
            self._channel.send(item=item, status="error", detail=raised)
            return
        if not bound and step["source"].isidentifier():
            detail = f"the cell binds no {step['source']}"
            self._channel.send(item=item, status="error", detail=detail)
            return
        verdict = self._lab.check(item, eval(step["source"], self._names))
        lines = [x.says for x in verdict.lines]
        letter = re.match(r"\((\w+)\)", lines[0]) if lines else None
        choice = self._lab.predictions.get(item, {}).get("choice", "")
        wrong = (f"{x.says}: {x.detail}".rstrip(": ") for x in verdict.lines if not x.ok)
        detail = "; ".join(wrong) or (verdict.message if verdict.status == "locked" else "")
        self._channel.send(
            item=item,
            status=verdict.status,
            score=verdict.score,
            misconception=verdict.misconception,
            choice=choice or (letter.group(1) if letter else ""),
            detail=detail[:1000],
            hint=verdict.hint[:1000] if verdict.status not in ("passed", "recorded") else "",
            raised=raised,
        )  # fmt: skip

    def do_use(self, step: dict[str, str]) -> None:
        """As `Lab.use`, without judging again what was just judged."""
        verdict = self._lab.verdicts.get(step["item"])
        name = self._variables[step["item"]]
        if not verdict or verdict.status != "passed":
            self._names[name] = self._lab.items[step["item"]].solution()


def _words(error: BaseException) -> str:
    """One line; `pfkit.labs.guard` words it, the kind of error stands first."""
    from pfkit.labs.guard import describe

    if isinstance(error, SyntaxError):
        return f"{type(error).__name__}: {error.msg} (line {error.lineno} of the cell)"
    return describe(error)


def main(path: str) -> None:
    channel = Channel(sys.stdin.readline().strip())
    job = json.loads(Path(path).read_text(encoding="utf-8"))
    try:
        session = Session(job, channel)
        session.close(job)
    except BaseException as error:
        channel.send(broken=f"the grader cannot start: {type(error).__name__}: {error}"[:300])
        os._exit(1)
    session.run(job["steps"])
    channel.send(end=True)
    os._exit(0)  # threads and exit handlers of answers do not get another turn


if __name__ == "__main__":
    main(sys.argv[1])
