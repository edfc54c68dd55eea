"""Each chapter's page tells a search engine what it teaches, and that is what the chapter says."""

from __future__ import annotations

import json
import re

import browser
import learning_resource as lr
import pytest

BLOCK = re.compile(r'<script type="application/ld\+json">(.*?)</script>', re.S)
CHAPTERS = [
    page
    for page in browser.pages()
    if re.match(r"notebooks/(?:labs/\w|(?!00_)\d\d_)", page) and page.endswith(".html")
]
# property: the test its value must pass. The first five rows are what Bioschemas calls the minimum
# of a TrainingMaterial, the rest what it recommends or schema.org has for a LearningResource.
REQUIRED = {
    "@context": lambda v: v == "https://schema.org",
    "@type": lambda v: v == "LearningResource",
    "http://purl.org/dc/terms/conformsTo": lambda v: v["@id"] == lr.PROFILE,
    "name": lambda v: len(v) > 3,
    "description": lambda v: len(v) > 30 and v[-1] in ".?!",
    "keywords": lambda v: "particle filter" in v,
    "teaches": lambda v: len(v) >= 3 and all(len(item) > 10 for item in v),
    "timeRequired": lambda v: 30 <= int(re.fullmatch(r"PT(\d+)M", v)[1]) <= 400,
    "educationalLevel": bool,
    "learningResourceType": lambda v: v[0] in ("lecture", "lab"),
    "audience": lambda v: v["audienceType"] == lr.AUDIENCE,
    "inLanguage": lambda v: v == "en-GB",
    "license": lambda v: v == lr.LICENCE,
    "isAccessibleForFree": lambda v: v is True,
}


def records(html: str) -> list[dict]:
    """The blocks of a page, parsed."""
    return [json.loads(text) for text in BLOCK.findall(html)]


def shortcomings(record: dict) -> list[str]:
    """The required properties that a record lacks or gives wrongly."""
    return [key for key, good in REQUIRED.items() if key not in record or not good(record[key])]


@pytest.mark.page
@pytest.mark.skipif(not CHAPTERS, reason="the book is not built: run make book first")
@pytest.mark.parametrize("page", CHAPTERS or [""])
def test_a_chapter_carries_one_complete_record(page):
    html = (browser.HTML / page).read_text(encoding="utf-8")
    (record,) = records(html)
    assert shortcomings(record) == []
    minutes = int(record["timeRequired"][2:-1])
    text = re.sub(r"<[^>]+>", "", html)
    assert lr.duration(" ".join(text.split())) == f"PT{minutes}M"


def test_a_record_with_a_gap_is_seen():
    assert "teaches" in shortcomings({"name": "Motion", "teaches": []})


@pytest.mark.parametrize(
    "text, expected",
    [
        ("Time 65 minutes. Before Bayes", "PT65M"),
        ("Time: about two and a half hours.", "PT150M"),
        ("Time flies", None),
    ],
)
def test_the_stated_time_is_read(text, expected):
    assert lr.duration(text) == expected


def test_an_amount_in_words_that_is_not_known_is_not_guessed():
    with pytest.raises(ValueError):
        lr.duration("Time: about a dozen hours.")
