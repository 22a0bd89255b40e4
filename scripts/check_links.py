#!/usr/bin/env python3
"""Checks the links of documents and of the built site: files and anchors that they name exist, and the DOIs that sources name are
those of the bibliography. Standard library only; nothing is fetched.

    python3 scripts/check_links.py              # README.md and its neighbours, docs/ with its notebooks, crates/*/README.md, python/README.md
    python3 scripts/check_links.py SITE         # the pages that mdBook made, too

Exit code 1 where a link leads nowhere.
"""

import json
import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

ROOT = Path(__file__).resolve().parent.parent
FENCE = re.compile(r"^(```|~~~).*?^\1", re.MULTILINE | re.DOTALL)
CODE = re.compile(r"(`+).+?\1", re.DOTALL)
LINK = re.compile(r"\[(?:[^\[\]]|\[[^\[\]]*\])*\]\(\s*([^()\s]+(?:\([^()\s]*\))?)\s*\)")
REFERENCE = re.compile(r"^\[[^\]]+\]:\s*(\S+)", re.MULTILINE)
HEADING = re.compile(r"^#+\s+(.+?)\s*#*$", re.MULTILINE)
# With the pairs of brackets that old ones have, and without the text around them.
DOI = re.compile(r"doi:(10\.\d+/(?:\([^\s()]*\)|[^\s()\[\],;])*[^\s()\[\],;.:])")
BIBLIOGRAPHY = ROOT / "docs/bibliography.md"


def documents():
    """The documents of this repository."""
    some = [ROOT / name for name in ("README.md", "ARCHITECTURE.md", "CHANGELOG.md", "SECURITY.md", "python/README.md")]
    return some + sorted(ROOT.glob("crates/*/README.md")) + sorted((ROOT / "docs").rglob("*.md")) + sorted((ROOT / "docs").rglob("*.ipynb"))


def anchors(text):
    """The anchors of a document's headings, as GitHub and mdBook make them."""
    found = set()
    for heading in HEADING.findall(FENCE.sub("", text)):
        words = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "").lower()
        name = re.sub(r"[^\w\- ]", "", words).replace(" ", "-")
        count = 0
        while (name if count == 0 else f"{name}-{count}") in found:
            count += 1
        found.add(name if count == 0 else f"{name}-{count}")
    return found


class Page(HTMLParser):
    """The links and anchors of a page."""

    def __init__(self, text):
        super().__init__()
        self.links, self.anchors = [], set()
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("id", "name") and value:
                self.anchors.add(value)
            if name in ("href", "src") and value and tag != "base":
                self.links.append(value)


def read(path):
    """The links and anchors of a document or page."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".html":
        page = Page(text)
        return page.links, page.anchors
    if path.suffix == ".ipynb":
        text = "\n\n".join("".join(cell["source"]) for cell in json.loads(text)["cells"] if cell["cell_type"] == "markdown")
    prose = CODE.sub("", FENCE.sub("", text))
    return LINK.findall(prose) + REFERENCE.findall(prose), anchors(text)


def problem(path, link, outside):
    """What is wrong with a link, or None. Links may not leave `outside`."""
    parts = urlsplit(link)
    if parts.scheme or link.startswith("//"):
        return None if parts.scheme in ("http", "https", "mailto", "data", "javascript") else "has an unknown scheme"
    target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
    if not target.is_relative_to(outside):
        return "leaves the site" if path.suffix == ".html" else "leaves the repository"
    if not target.exists():
        return "leads nowhere"
    if parts.fragment and target.suffix in (".md", ".html") and unquote(parts.fragment) not in read(target)[1]:
        return "names an anchor that is not there"
    return None


def sources():
    """What may name a paper."""
    folders = ["benches", "crates", "docs", "examples", "python/walpha", "scripts", "src"]
    files = [path for folder in folders for suffix in ("rs", "py", "md") for path in (ROOT / folder).rglob(f"*.{suffix}")]
    return sorted(path for path in files if path != BIBLIOGRAPHY)


def wrong_dois():
    """DOIs that sources or the bibliography alone have."""
    listed = set(DOI.findall(BIBLIOGRAPHY.read_text(encoding="utf-8")))
    named = {}
    for path in sources():
        for doi in DOI.findall(path.read_text(encoding="utf-8")):
            named.setdefault(doi, path)
    wrong = [f"{path}: doi:{doi} is not in the bibliography" for doi, path in named.items() if doi not in listed]
    return wrong + [f"{BIBLIOGRAPHY}: doi:{doi} is named by no source" for doi in sorted(listed - named.keys())]


def main():
    pages = [(path, ROOT) for path in documents()]
    if len(sys.argv) > 1:
        site = Path(sys.argv[1]).resolve()
        # A page for all, to print, has no anchors of its own; 404.html may be shown at any address.
        made = [path for path in sorted(site.rglob("*.html")) if path.name not in ("print.html", "404.html", "toc.html")]
        if not made:
            sys.exit(f"{site}: no pages; build them with mdbook")
        pages += [(path, site) for path in made]
    wrong = wrong_dois()
    print("".join(f"{what}\n" for what in wrong), end="")
    count, failures = 0, len(wrong)
    for path, outside in pages:
        for link in read(path)[0]:
            count += 1
            if what := problem(path, link, outside):
                failures += 1
                print(f"{path}: {link} {what}")
    print(f"{count} links in {len(pages)} documents; {failures} links or DOIs are wrong")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
