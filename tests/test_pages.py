"""What the documentation points to is there, and what is stated twice agrees."""

import re
from pathlib import Path

import pytest

import gt_env

ROOT = Path(__file__).parents[1]
PAGES = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/*.md")])
LINK = re.compile(r"\]\((?!https?:)([^)#\s]*)(?:#([^)\s]+))?\)")


def prose(page):
    """A page without its blocks of code."""
    return re.sub(r"```.*?```", "", page.read_text(), flags=re.S)


def anchors(page):
    """What headings can be linked to by: lower case, spaces as hyphens, other marks left out."""
    headings = re.findall(r"^#+ (.+)$", prose(page), re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def test_there_are_pages():
    assert ROOT / "README.md" in PAGES
    assert len(PAGES) > 10


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_link_leads_somewhere(page):
    broken = []
    for file, anchor in LINK.findall(prose(page)):
        target = page.parent / file if file else page
        if not target.exists() or (anchor and anchor not in anchors(target)):
            broken.append(f"{file}#{anchor}")
    assert broken == []


def test_every_page_and_picture_is_linked_to():
    linked = {
        (page.parent / file).resolve() for page in PAGES for file, _ in LINK.findall(prose(page)) if file
    }
    kept = {*ROOT.glob("docs/*.md"), *ROOT.glob("docs/images/*")}

    assert {path.name for path in kept - linked} == set()


def test_the_citation_states_the_version():
    stated = re.search(r"^version: (.+)$", (ROOT / "CITATION.cff").read_text(), re.M).group(1)

    assert stated == gt_env.__version__
    assert f"## {stated}" in (ROOT / "CHANGELOG.md").read_text()
