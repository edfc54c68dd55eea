"""A number in the prose must be the one a cell printed; the checks are tried on wrong ones."""

from __future__ import annotations

from pathlib import Path

import prose_numbers as numbers
import pytest

NOWHERE = Path("nowhere")
PRINTED = """RMSE of filter = 0.0581 m
dead reckoning   31.70   4.10
converged_in: 17 s
after 10 steps off by 0.88 m
after 60 steps off by 0.21 m
copies of 1,347 particles
"""


def page(printed=PRINTED, code="M = 1_000\nsigma_r = 0.135"):
    output = {"output_type": "stream", "name": "stdout", "text": printed}
    cell = {"cell_type": "code", "id": "c", "metadata": {}, "source": code, "outputs": [output]}
    return {"cells": [cell], "metadata": {}}


def faults(text):
    return [fault.reason for fault in numbers.faults_of_text(text, "c", page(), NOWHERE)]


@pytest.mark.parametrize(
    "text",
    [
        "off by 0.06<!--= RMSE of filter --> m",
        "off by **0.058**<!--= rmse of FILTER --> m",
        "that is 5.8<!--= RMSE of filter * 100 --> cm",
        "31.7<!--= dead reckoning --> m and 4.1<!--= dead reckoning [2] --> degrees",
        "now 0.21<!--= after 60 steps off by --> m",
        "after 17<!--= converged in --> s",
        "Leung drove 1,354<!--given--> m",
        "with 1,000 particles and 0.135 m",  # from the code
        "some 5.8 % of it",  # 0.0581 of the output
        "in 2011, Figure 14, Table 4.4, seeds 7 and 3, version 1.0.4, lab3, `x = 99.5`, $y=77$",
        "five of 20",
    ],
)
def test_right_numbers_pass(text):
    assert faults(text) == []


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("off by 0.07<!--= RMSE of filter --> m", "the cell prints 0.0581"),
        ("off by 0.0<!--= RMSE of filter --> m", "the cell prints 0.0581"),
        ("off by 0.06<!--= RMSE of smoother --> m", "no cell prints"),
        ("4.1<!--= dead reckoning [3] -->", "no such number"),
        ("0.6<!--= missing#label -->", "no notebook on missing"),
        ("0.06<!--= RMSE -->", "no cell prints"),
        ("off by 0.77 m", "occurs in no cell"),
        ("with 5,000 particles", "occurs in no cell"),
    ],
)
def test_wrong_numbers_are_seen(text, reason):
    assert [reason in found for found in faults(text)] in ([True], [True, True])


def test_a_changed_result_makes_the_prose_wrong():
    text = "off by 0.058<!--= RMSE of filter --> m"
    changed = page(PRINTED.replace("0.0581", "0.0623"))
    (fault,) = numbers.faults_of_text(text, "c", changed, NOWHERE)
    assert fault.reason == "the cell prints 0.0623"
    assert "0.062<!--" in numbers.filled(text, changed, NOWHERE)


def test_a_label_with_two_values_is_refused():
    twice = page("RMSE = 1.5\nRMSE = 2.5")
    (fault,) = numbers.faults_of_text("1.5<!--= RMSE -->", "c", twice, NOWHERE)
    assert "[1.5, 2.5]" in fault.reason


def test_filling_keeps_decimals_emphasis_and_given_facts():
    text = "**0.0**<!--= dead reckoning -->, 1,354<!--given-->"
    assert numbers.filled(text, page(), NOWHERE) == (
        "**31.7**<!--= dead reckoning -->, 1,354<!--given-->"
    )


@pytest.mark.parametrize(
    ("shown", "exact", "good"),
    [
        ("0.06", 0.0581, True),
        ("0.058", 0.0586, False),
        ("−1.8", -1.7588, True),
        ("1e-9", 1e-9, True),
    ],
)
def test_rounding(shown, exact, good):
    assert numbers.agrees(shown, exact) is good
