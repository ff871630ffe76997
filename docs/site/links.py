"""Checks a folder of web pages: every link leads to an existing page and place, nothing is fetched from elsewhere, and
no list is shown as plain text.
"""
import html.parser
import re
import urllib.parse
from dataclasses import dataclass, field


@dataclass
class Findings:
    """How many pages and links inside the folder, links that lead out of it, and what is wrong."""
    pages: int = 0
    links: int = 0
    external: list = field(default_factory=list)
    errors: list = field(default_factory=list)


class Page(html.parser.HTMLParser):
    """A page's links, as (tag, target), its anchors, and lines that should be items of a list."""

    def __init__(self, text):
        super().__init__()
        self.targets, self.anchors, self.plain_items = [], set(), []
        self.verbatim = 0
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.verbatim += tag in ("pre", "script", "style")
        self.anchors |= {given[key] for key in ("id", "name") if given.get(key)}
        self.targets += [(tag, given[key]) for key in ("href", "src") if given.get(key) is not None]

    def handle_endtag(self, tag):
        self.verbatim -= tag in ("pre", "script", "style")

    def handle_data(self, data):
        if not self.verbatim:
            self.plain_items += re.findall(r"\n *\* .*|\n *```.*", data)


def place_of(site, page, url):
    """The file that a link on the page leads to."""
    path = urllib.parse.unquote(url.path)
    if not path:
        return page
    file = (site / path[1:] if path.startswith("/") else page.parent / path).resolve()
    return file / "index.html" if file.is_dir() else file


def check(site):
    pages = {page: Page(page.read_text()) for page in sorted(site.rglob("*.html"))}
    found, external = Findings(pages=len(pages)), set()
    for page, content in pages.items():
        name = page.relative_to(site)
        found.errors += [f"{name}: not an item of a list: {line.strip()}" for line in content.plain_items]
        for tag, target in content.targets:
            url = urllib.parse.urlsplit(target)
            if url.scheme in ("javascript", "data", "mailto"):
                continue
            if url.scheme or url.netloc:
                external.add(target)
                if tag not in ("a", "area"):
                    found.errors.append(f"{name}: <{tag}> fetches {target}")
                continue
            # Doxygen links to lists of nested classes that it leaves out where all are private.
            if target == "#nested-classes":
                continue
            found.links += 1
            file, anchor = place_of(site, page, url), urllib.parse.unquote(url.fragment)
            if not file.exists():
                found.errors.append(f"{name}: {target}: no such page")
            elif anchor and file in pages and anchor not in pages[file].anchors:
                found.errors.append(f"{name}: {target}: no such place on that page")
    found.external = sorted(external)
    return found
