"""Builds the site of documents in out/docs and checks it, for `./run docs`.

MkDocs makes the pages, Doxygen the C++ reference from the headers' comments, pdoc the Python reference from the
docstrings. All three take their input as it is written here. Sphinx would need docstrings in its own markup, and
Breathe, which reads Doxygen's names for it, does not parse all templates.

Run it with a Python that has MkDocs Material, pdoc and the package errbound; Doxygen must be on PATH. These are errors:
* a warning of these tools,
* a dead link, or a page that makes a browser fetch something,
* a list that is shown as plain text,
* a name in a page that the reference lacks or does not describe.
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
    """True if Doxygen's XML describes a name."""
    texts = [part for kind in ("briefdescription", "detaileddescription") for part in entry.findall(kind)]
    return any("".join(text.itertext()).strip() for text in texts)


def cpp_reference(folder):
    """Writes folder/cpp. Returns a dictionary: for each name, whether the reference describes it."""
    hidden = " ".join(f"{name} {name}::* *::{name} *::{name}::*" for name in INTERNAL)
    run("doxygen", ["doxygen", "-"], input=f"@INCLUDE = {HERE}/Doxyfile\nEXCLUDE_SYMBOLS = {hidden}\n"
        f"OUTPUT_DIRECTORY = {folder}\nXML_OUTPUT = {OUT}/xml\n")
    described = {}
    for file in (OUT / "xml").glob("*.xml"):
        for entry in ElementTree.parse(file).getroot().iter():
            if (entry.tag not in ("compounddef", "memberdef") or entry.get("prot") == "private"
                    or entry.get("kind") in ("file", "dir", "page", "friend")):
                continue
            name = entry.findtext("compoundname") or entry.findtext("qualifiedname")
            described[name] = described.get(name, False) or is_described(entry)
            described |= {f"{name}::{value.findtext('name')}": is_described(value) for value in entry.findall("enumvalue")}
    return described


def unknown_names(pages, described):
    """Yields an error for each C++ name in a page that the reference lacks or does not describe."""
    hidden = re.compile(rf"(\w+::)*({'|'.join(INTERNAL)})(::|$)")
    # CMake's targets have the form of names.
    targets = {target for folder in ("errbound", "ccd") for file in (ROOT / folder).rglob("CMakeLists.txt")
               for target in re.findall(r"add_library\((errbound::\w+) ALIAS", file.read_text())}
    for page in pages:
        if page.name == "CHANGELOG.md":  # names removed parts, too
            continue
        for name in re.findall(r"`((?:ccd|errbound)::\w+(?:::\w+)*)", page.read_text()):
            if name in targets or hidden.match(name) or described.get(name):
                continue
            yield (f"{page.relative_to(ROOT)}: {name}: " +
                   ("the C++ reference does not describe it" if name in described else "not in the C++ reference"))


def public_members(namespace):
    """Yields the public members of a pdoc module or class, and of those inside it."""
    inside = [*namespace.own_members, *(namespace.submodules if namespace.kind == "module" else [])]
    for member in inside:
        if not member.name.startswith("_"):
            yield member
            if member.kind in ("module", "class"):
                yield from public_members(member)


def python_reference(folder):
    """Writes folder/python. Returns a dictionary: for each class and function, whether it has a docstring. A class
    needs its own; a method may inherit that of its base class."""
    modules = ["errbound", "errbound.cuda"]
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
    errors += [f"{name}: no docstring" for name, described in of_python.items() if not described]
    print(f"{SITE.relative_to(ROOT)}/index.html: {len(pages)} pages of text, {found.pages} of the site; {found.links} "
          f"links, {len(found.external)} others not followed (external_links.txt); the references describe "
          f"{sum(of_cpp.values())} of {len(of_cpp)} names of C++, {sum(of_python.values())} of {len(of_python)} of "
          f"Python; {len(errors)} errors")
    if errors:
        sys.exit("\n".join(errors))


if __name__ == "__main__":
    main()
