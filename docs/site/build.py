"""Builds the site of documents into out/docs and checks its links: what `./run docs` runs.

Pages by MkDocs, the C++ reference from the headers' comments by Doxygen, the Python reference from the
package's docstrings by pdoc. Run it by a Python that has MkDocs Material, pdoc and the package errbound;
Doxygen has to be on PATH. Any warning of these, and any dead link, is an error.
"""
import html.parser
import importlib.util
import os
import pathlib
import re
import shutil
import subprocess
import sys
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parents[2]
HERE = ROOT / "docs/site"
OUT = ROOT / "out/docs"
SITE = OUT / "site"


def run(what, command, **options):
    """Its output, which holds no warning, or an end."""
    done = subprocess.run(command, cwd=ROOT, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **options)
    warnings = [line for line in done.stdout.splitlines() if re.search(r"\bwarning\b", line, re.IGNORECASE)]
    if done.returncode or warnings:
        sys.exit(f"run: {what}: " + ("\n".join(warnings) or done.stdout))
    return done.stdout


def stage(folder):
    """The pages and what they link to, where they lie in the repository."""
    tracked = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True)
    files = [name for name in tracked.stdout.split("\0") if name]
    pages = [name for name in files
             if re.fullmatch(r"(README|CONTRIBUTING|CHANGELOG|docs/[^/]+|proofs/README|packaging/README)\.md", name)]
    wanted = {*pages, *(name for name in files if re.fullmatch(r"docs/[^/]+\.png", name))}
    for page in pages:
        text = (ROOT / page).read_text()
        for target in re.findall(r"\]\(([^)#:]+)", text):
            linked = (ROOT / page).parent.joinpath(target).resolve()
            name = str(linked.relative_to(ROOT))
            inside = [f for f in files if f.startswith(name + "/")]
            wanted |= {f for f in files if f == name} | set(inside)
            if inside:
                listing = "".join(f"* [{f}]({f[len(name) + 1:]})\n" for f in inside)
                (folder / name).mkdir(parents=True, exist_ok=True)
                (folder / name / "index.md").write_text(f"# {name}\n\n{listing}")
    for name in wanted:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(ROOT / name, folder / name)
    return pages


class Links(html.parser.HTMLParser):
    """A page's targets of links, and its anchors."""

    def __init__(self, text):
        super().__init__()
        self.targets, self.anchors = [], set()
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.anchors |= {given[key] for key in ("id", "name") if given.get(key)}
        self.targets += [given[key] for key in ("href", "src") if given.get(key) is not None]


def dead_links():
    """Messages, and how many pages and links there are."""
    pages = {page: Links(page.read_text()) for page in sorted(SITE.rglob("*.html"))}
    count, dead = 0, []
    for page, links in pages.items():
        for target in links.targets:
            url = urllib.parse.urlsplit(target)
            # Doxygen links to lists of nested classes that it leaves out where all are private.
            if url.scheme or url.netloc or target == "#nested-classes":
                continue
            count += 1
            path = urllib.parse.unquote(url.path)
            file = page if not path else (SITE / path[1:] if path.startswith("/") else page.parent / path).resolve()
            if file.is_dir():
                file = file / "index.html"
            anchor = urllib.parse.unquote(url.fragment)
            if not file.exists():
                dead.append(f"{page.relative_to(SITE)}: {target}: no such page")
            elif anchor and file in pages and anchor not in pages[file].anchors:
                dead.append(f"{page.relative_to(SITE)}: {target}: no such place on that page")
    return dead, len(pages), count


def main():
    shutil.rmtree(OUT, ignore_errors=True)
    pages = stage(OUT / "pages")
    run("doxygen", ["doxygen", "-"], input=f"@INCLUDE = {HERE / 'Doxyfile'}\nOUTPUT_DIRECTORY = {OUT / 'pages'}\n")
    modules = ["errbound", *(["errbound.ipctk"] if importlib.util.find_spec("ipctk") else [])]
    run("pdoc", [sys.executable, "-W", "error::UserWarning", "-m", "pdoc", *modules, "-o", OUT / "pages/python",
                 "--docformat", "markdown", "--no-show-source"])
    configuration = (HERE / "mkdocs.yml").read_text()
    (OUT / "mkdocs.yml").write_text(f"{configuration}docs_dir: {OUT / 'pages'}\nsite_dir: {SITE}\n")
    run("mkdocs", [sys.executable, "-m", "mkdocs", "build", "--quiet", "--strict", "-f", OUT / "mkdocs.yml"],
        env={**os.environ, "NO_MKDOCS_2_WARNING": "1"})  # of what is to come
    dead, of_site, links = dead_links()
    print(f"{SITE.relative_to(ROOT)}/index.html: {len(pages)} pages of text, {of_site} of the site, {links} links, "
          f"{len(dead)} dead")
    if dead:
        sys.exit("\n".join(dead))


main()
