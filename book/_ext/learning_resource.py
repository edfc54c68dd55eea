"""Sphinx extension: each chapter and lab says in its page what a search engine should know of it.

A block of JSON-LD, a schema.org `LearningResource` that also follows the Bioschemas profile for
training material: what it teaches, how long it takes, for whom, under which licence. All of it is
read from the chapter's own first cells, so it cannot disagree with what a reader sees.
Sources: schema.org/LearningResource; Bioschemas TrainingMaterial 1.0.
"""

from __future__ import annotations

import json
import re
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx

PROFILE = "https://bioschemas.org/profiles/TrainingMaterial/1.0-RELEASE"
LICENCE = "https://creativecommons.org/licenses/by/4.0/"
KEYWORDS = ["particle filter", "Monte Carlo localisation", "robotics", "Bayes filter"]
AUDIENCE = "engineers and students who can program a little and know what a probability is"
TIME = re.compile(r"Time:? (?:about )?([\w ]+?) (minutes|hours)")
HALVES = {"one": 1, "two": 2, "two and a half": 2.5, "three": 3, "three and a half": 3.5}
HALVES |= {"four": 4, "five": 5, "five to six": 6, "six": 6}


def duration(text: str) -> str | None:
    """Read the time a chapter states and return it as ISO 8601, such as `PT65M`."""
    found = TIME.search(text)
    if not found:
        return None
    amount, unit = found.groups()
    number = HALVES[amount] if amount in HALVES else float(amount)
    return f"PT{round(number * (60 if unit == 'hours' else 1))}M"


def plain(node: nodes.Node) -> str:
    """The text of a node on one line, without the notes that tie a number to its cell."""
    return " ".join(re.sub(r"<!--.*?-->", "", node.astext()).split())


def objectives(document: nodes.document) -> list[str]:
    """The first list of a chapter or lab: what a reader can do afterwards."""
    for listing in document.findall(
        lambda n: isinstance(n, nodes.enumerated_list | nodes.bullet_list)
    ):
        before = listing.parent.index(listing) - 1
        lead = plain(listing.parent[before]) if before >= 0 else ""
        if "you can" in lead or "you will be able to do" in lead:
            items = [re.sub(r" \((?:checked by )?[^()]*\)[.;]?$", "", plain(i)) for i in listing]
            return [item.rstrip(".;") for item in items]
    return []


def describe(document: nodes.document, address: str = "") -> dict[str, Any] | None:
    """The JSON-LD of a page, or nothing for a page that states no objectives."""
    learns, takes = objectives(document), duration(plain(document))
    if not learns or takes is None:
        return None
    title = next(document.findall(nodes.title))
    question = next(document.findall(nodes.strong))
    record = {
        "@context": "https://schema.org",
        "@type": "LearningResource",
        "http://purl.org/dc/terms/conformsTo": {"@id": PROFILE, "@type": "CreativeWork"},
        "name": plain(title),
        "description": plain(question),
        "keywords": KEYWORDS,
        "teaches": learns,
        "timeRequired": takes,
        "educationalLevel": "Intermediate",
        "learningResourceType": ["lab" if "Lab" in plain(title) else "lecture", "notebook"],
        "audience": {"@type": "Audience", "audienceType": AUDIENCE},
        "inLanguage": "en-GB",
        "license": LICENCE,
        "isAccessibleForFree": True,
    }
    return record | ({"@id": address, "url": address} if address else {})


def add_record(app: Sphinx, page: str, _template: str, context: dict, document: Any) -> None:
    """Put the record into the head of a page that is a chapter or a lab."""
    if document is None:
        return
    base = app.config.html_baseurl
    record = describe(document, f"{base.rstrip('/')}/{page}.html" if base else "")
    if record is not None:
        text = json.dumps(record, ensure_ascii=False, sort_keys=True).replace("</", "<\\/")
        script = f'<script type="application/ld+json">{text}</script>'
        context["metatags"] = context.get("metatags", "") + script + "\n"


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the record of each page."""
    app.connect("html-page-context", add_record)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
