"""In Jupyter a check judges what its answer's cell defined last, and says when it cannot."""

from __future__ import annotations

import queue

import pytest

from pfkit.labs.executed import Executed

RIGHT = "def circular_mean(theta, w):\n    return np.arctan2(w @ np.sin(theta), w @ np.cos(theta))"
CHECK = 'print(lab.check("p5b", circular_mean).headline)'
USE = 'circular_mean = lab.use("p5b", circular_mean)'
# What a reader may make of an answer that has passed: the new cell, and what the check then says.
BROKEN = {
    "colon deleted": (RIGHT.replace("):", ")"), "does not parse (line 1: expected ':')"),
    "retrun": (RIGHT.replace("return", "retrun"), "does not parse (line 2"),
    "bracket left open": (RIGHT[:-1], "does not parse"),
    "indentation broken": (RIGHT.replace("    return", "return"), "does not parse (line 2"),
    "only a comment left": ("# def circular_mean(theta, w):", "without defining it"),
    "renamed": (RIGHT.replace("circular_mean", "circular_meen"), "without defining it"),
    "deleted at the end": (RIGHT + "\ndel circular_mean", "NameError"),
    "raises before": ("nothing_here\n" + RIGHT, "ended in NameError before it did"),
    "pass": ("def circular_mean(theta, w):\n    pass", "unanswered"),
    "dots": ("def circular_mean(theta, w):\n    ...", "unanswered"),
    "None": ("circular_mean = None", "unanswered"),
    "a number": ("circular_mean = 3", "wrong"),
    "a wrong answer": ("def circular_mean(theta, w):\n    return theta @ w", "wrong"),
}


class Kernel:
    """A kernel, and cells that are sent to it with their ids, as a front end does."""

    def __init__(self, client):
        self.client = client

    def run(self, source, cell=None):
        """What a cell printed, and its error."""
        content = {"code": source, "silent": False, "store_history": True, "allow_stdin": False}
        session = self.client.session
        message = session.msg("execute_request", {**content, "user_expressions": {}})
        message["metadata"] = {"cellId": cell} if cell else {}
        self.client.shell_channel.send(message)
        told = []
        while True:
            try:
                answer = self.client.get_iopub_msg(timeout=60)
            except queue.Empty:
                raise AssertionError(f"the kernel is silent: {source!r}") from None
            if answer["parent_header"].get("msg_id") != message["header"]["msg_id"]:
                continue
            if answer["msg_type"] == "stream":
                told.append(answer["content"]["text"])
            if answer["msg_type"] == "error":
                told.append(f"{answer['content']['ename']}: {answer['content']['evalue']}")
            state = answer["content"].get("execution_state")
            if answer["msg_type"] == "status" and state == "idle":
                return "".join(told)


@pytest.fixture(scope="module")
def kernel():
    manager = pytest.importorskip("jupyter_client").KernelManager(kernel_name="python3")
    manager.start_kernel()
    client = manager.client()
    client.start_channels()
    client.wait_for_ready(timeout=60)
    made = Kernel(client)
    made.run("import os; os.environ['PFKIT_WIDGETS'] = 'off'", "c0")
    made.run("import numpy as np\nfrom pfkit.labs import lab3 as lab", "c1")
    yield made
    client.stop_channels()
    manager.shutdown_kernel(now=True)


@pytest.mark.parametrize("used", [False, True], ids=["", "used before"])
@pytest.mark.parametrize("how", BROKEN)
def test_a_broken_answer_does_not_pass_because_it_passed_before(kernel, how, used):
    source, told = BROKEN[how]
    kernel.run(RIGHT, "answer")
    assert "passed 3/3" in kernel.run(CHECK, "check")
    if used:
        kernel.run(USE, "use")
    kernel.run(source, "answer")
    says = kernel.run(CHECK.replace(".headline", ""), "check")
    if used and how == "deleted at the end":
        told = "NameError"
    assert "passed" not in says and told in says, says
    assert "the reference" in kernel.run(USE, "use") or "NameError" in says
    says = kernel.run(CHECK, "check")  # the reference that `use` gave is no answer
    assert "passed" not in says or how in SEEN_AS_ANSWER, says
    kernel.run(RIGHT, "answer")
    assert "passed 3/3" in kernel.run(CHECK, "check")


# These cells do define the name, and `use` then replaces it: what it gave is judged, as ever.
SEEN_AS_ANSWER = ("pass", "dots", "None", "a number", "a wrong answer")


@pytest.mark.parametrize("how", ["colon deleted", "retrun", "raises before"])
def test_without_ids_of_cells_a_definition_that_fails_is_noticed(kernel, how):
    kernel.run(RIGHT)
    assert "passed 3/3" in kernel.run(CHECK)
    kernel.run(BROKEN[how][0])
    says = kernel.run(CHECK.replace(".headline", ""))
    assert "passed" not in says and BROKEN[how][1] in says
    kernel.run(RIGHT)
    assert "passed 3/3" in kernel.run(CHECK)


def test_what_others_do_with_a_name_is_no_fault_of_the_answer(kernel):
    kernel.run(RIGHT, "answer")
    for source in (
        "print(circular_mean(np.array([3.1",
        "circular_mean(1, 2, 3)",
        "try:\n    x = circular_mean\n    1 / 0\nfinally:\n    circular_meen = 3",
        "%timeit -n 1 -r 1 circular_mean(np.ones(2), np.ones(2))",
        "y = 1 +",
    ):
        kernel.run(source, "scratch")
        assert "passed 3/3" in kernel.run(CHECK, "check"), source
    kernel.run("print('hello')\n" + RIGHT + "\n1 / 0", "answer")  # raises after the definition
    assert "passed 3/3" in kernel.run(CHECK, "check")


def test_a_wrong_redefinition_elsewhere_is_judged(kernel):
    kernel.run(RIGHT, "answer")
    kernel.run("circular_mean = np.sum", "scratch")
    assert "passed" not in kernel.run(CHECK, "check")
    kernel.run(RIGHT, "answer")


def test_a_prediction_in_an_outdated_cell_is_not_locked(kernel):
    kernel.run('p4a = ("a", 70)', "guess")
    kernel.run('p4a = ("b", 70', "guess")
    says = kernel.run('print(lab.predict("p4a", p4a))', "lock")
    assert "does not parse" in says and "locked" not in says
    kernel.run('p4a = ("b", 70)', "guess")
    assert "(b), 70 % sure; locked" in kernel.run('print(lab.predict("p4a", p4a))', "lock")


def test_plain_python_is_never_refused():
    assert Executed().outdated("p5b") == ""
