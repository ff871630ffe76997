"""Builds the site of documents into out/docs and checks it: what `./run docs` runs.

Pages by MkDocs, the C++ reference from the headers' comments by Doxygen, the Python reference from the
package's docstrings by pdoc. These three, because each takes what is written here as it is: pages as they
are read in the repository, `///` comments, docstrings in Markdown. (Sphinx wants docstrings in a markup of
its own, and Breathe for Doxygen's names, of which it does not parse all templates.)

Run it by a Python that has MkDocs Material, pdoc and the package errbound; Doxygen has to be on PATH. Errors
are: any warning of these, a dead link, a page that a browser would have to fetch a part of, a list that is
none, and a name that pages use and the reference does not have or says nothing of.
"""
import importlib.util
import os
import pathlib
import re
import shutil
import subprocess
import sys
import warnings
from xml.etree import ElementTree

import links
import pdoc.doc

ROOT = pathlib.Path(__file__).resolve().parents[2]
HERE = ROOT / "docs/site"
OUT = ROOT / "out/docs"
SITE = OUT / "site"
PAGES = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "docs/*.md", "proofs/README.md", "packaging/README.md"]

# Namespaces that programs do not name (docs/architecture.md), and libraries' that a header adds to.
INTERNAL = ["detail", "errbound::filters", "errbound::integers", "errbound::linear", "errbound::roots", "Eigen", "ipc", "std"]


def run(what, command, **options):
    """Ends where there is a warning."""
    done = subprocess.run(command, cwd=ROOT, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **options)
    # Doxygen wants to know what std's class templates are a part of, where there are specialisations.
    unmeant = re.compile(r"Internal inconsistency: scope for class std::\w+<.*> not found!")
    warnings = [line for line in done.stdout.splitlines()
                if re.search(r"\bwarning\b", line, re.IGNORECASE) and not unmeant.search(line)]
    if done.returncode or warnings:
        sys.exit(f"run: {what}: " + ("\n".join(warnings) or done.stdout))


def stage(folder):
    """The pages and what they link to, where they lie in the repository. Returns the pages."""
    pages = sorted(page for pattern in PAGES for page in ROOT.glob(pattern))
    wanted = {*pages, *ROOT.glob("docs/*.png")}
    for page in pages:
        for target in re.findall(r"\]\(([^)#:]+)", page.read_text()):
            linked = page.parent.joinpath(target).resolve()
            if linked.is_dir():
                inside = sorted(f for f in linked.rglob("*") if f.is_file() and "__pycache__" not in f.parts)
                wanted |= set(inside)
                listing = "".join(f"* [{f.relative_to(ROOT)}]({f.relative_to(linked)})\n" for f in inside)
                index = folder / linked.relative_to(ROOT) / "index.md"
                index.parent.mkdir(parents=True, exist_ok=True)
                index.write_text(f"# {linked.relative_to(ROOT)}\n\n{listing}")
            elif linked.is_file():
                wanted.add(linked)
    for file in wanted:
        staged = folder / file.relative_to(ROOT)
        staged.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(file, staged)
    return pages


def is_described(entry):
    """Whether Doxygen's XML has words about a name."""
    texts = [part for kind in ("briefdescription", "detaileddescription") for part in entry.findall(kind)]
    return any("".join(text.itertext()).strip() for text in texts)


def cpp_reference(folder):
    """Into folder/cpp. Returns of each name whether the reference says something of it."""
    hidden = " ".join(f"{name} {name}::* *::{name} *::{name}::*" for name in INTERNAL)
    run("doxygen", ["doxygen", "-"], input=f"@INCLUDE = {HERE}/Doxyfile\nEXCLUDE_SYMBOLS = {hidden}\n"
        f"OUTPUT_DIRECTORY = {folder}\nXML_OUTPUT = {OUT}/xml\n")
    said = {}
    for file in (OUT / "xml").glob("*.xml"):
        for entry in ElementTree.parse(file).getroot().iter():
            if (entry.tag not in ("compounddef", "memberdef") or entry.get("prot") == "private"
                    or entry.get("kind") in ("file", "dir", "page", "friend")):
                continue
            name = entry.findtext("compoundname") or entry.findtext("qualifiedname")
            said[name] = said.get(name, False) or is_described(entry)
            said |= {f"{name}::{value.findtext('name')}": is_described(value) for value in entry.findall("enumvalue")}
    return said


def unknown_names(pages, said):
    """Names of C++ that pages use and the reference lacks, or says nothing of."""
    hidden = re.compile(rf"(\w+::)*({'|'.join(INTERNAL)})(::|$)")
    # CMake's targets have the form of names.
    targets = {target for folder in ("errbound", "ccd") for file in (ROOT / folder).rglob("CMakeLists.txt")
               for target in re.findall(r"add_library\((errbound::\w+) ALIAS", file.read_text())}
    for page in pages:
        if page.name == "CHANGELOG.md":  # has what was, too
            continue
        for name in re.findall(r"`((?:ccd|errbound)::\w+(?:::\w+)*)", page.read_text()):
            if name in targets or hidden.match(name) or said.get(name):
                continue
            yield (f"{page.relative_to(ROOT)}: {name}: " +
                   ("the C++ reference says nothing of it" if name in said else "not in the C++ reference"))


def public_members(namespace):
    """Of a module or class of pdoc's, and of those inside."""
    inside = [*namespace.own_members, *(namespace.submodules if namespace.kind == "module" else [])]
    for member in inside:
        if not member.name.startswith("_"):
            yield member
            if member.kind in ("module", "class"):
                yield from public_members(member)


def python_reference(folder):
    """Into folder/python. Returns of each class and function whether it has a docstring: a class its
    own, a method that of the class it comes from will do."""
    modules = ["errbound"]
    for module, needed, how in (("errbound.ipctk", "ipctk", "ERRBOUND_VIEWERS=1 ./run python"),
                                ("errbound.mpi", "errbound._mpi", "./run python where MPI is")):
        if importlib.util.find_spec(needed):
            modules.append(module)
        else:
            print(f"{module} is left out: {needed} is not installed ({how})")
    # A TypedDict does not know what it inherits from.
    inherited = "Cannot determine where errbound.ccd"
    warnings.filterwarnings("ignore", inherited, UserWarning)
    run("pdoc", [sys.executable, "-W", "error::UserWarning", "-W", f"ignore:{inherited}:UserWarning", "-m", "pdoc",
                 *modules, "-o", folder / "python", "--docformat", "markdown", "--no-show-source", "-t", HERE / "pdoc"])
    members = [member for name in modules for member in public_members(pdoc.doc.Module.from_name(name))]
    return {m.fullname: bool(m.obj.__doc__ if m.kind == "class" else m.docstring)
            for m in members if m.kind in ("class", "function")}


def main():
    shutil.rmtree(OUT, ignore_errors=True)
    staged = OUT / "pages"
    pages = stage(staged)
    of_cpp = cpp_reference(staged)
    of_python = python_reference(staged)
    (OUT / "mkdocs.yml").write_text(f"{(HERE / 'mkdocs.yml').read_text()}docs_dir: {staged}\nsite_dir: {SITE}\n")
    run("mkdocs", [sys.executable, "-m", "mkdocs", "build", "--strict", "-f", OUT / "mkdocs.yml"],
        env={**os.environ, "NO_MKDOCS_2_WARNING": "1"})  # of what is to come
    found = links.check(SITE)
    (OUT / "external_links.txt").write_text("".join(f"{url}\n" for url in found.external))
    errors = [*unknown_names(pages, of_cpp), *found.errors]
    errors += [f"{name}: no docstring" for name, said in of_python.items() if not said]
    print(f"{SITE.relative_to(ROOT)}/index.html: {len(pages)} pages of text, {found.pages} of the site; {found.links} "
          f"links, {len(found.external)} others not followed (external_links.txt); something is said of "
          f"{sum(of_cpp.values())} of {len(of_cpp)} names of C++, {sum(of_python.values())} of {len(of_python)} of "
          f"Python; {len(errors)} errors")
    if errors:
        sys.exit("\n".join(errors))


if __name__ == "__main__":
    main()
