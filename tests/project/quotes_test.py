"""Checks that quotes in documents equal their sources.

usage: quotes_test.py SOURCE_FOLDER

C++ blocks of a page must be in one of its programs, and Coq blocks in one of its proofs. Indentation and empty lines do
not matter. Rows of measured tables and figures with a unit must be in docs/measured.md. Relative links must lead to files,
folders and headings that exist.
"""
import re
import sys
from pathlib import Path

root = Path(sys.argv[1])

# The programs that C++ blocks of each page quote.
PROGRAMS = {
    "README.md": ["examples/three_uses.cpp"],
    "docs/authoring-predicates.md": ["examples/authoring.cpp"],
    "docs/collision-detection.md": ["examples/batch.cpp", "examples/steps.cpp", "examples/curves.cpp", "examples/bodies/turning.cpp",
                                    "examples/line_search.cpp", "examples/bounce.cpp", "examples/near_pairs.cpp",
                                    "examples/from_ipc_toolkit.cpp", "examples/from_tight_inclusion.cpp"],
    "docs/simulation.md": ["examples/simulation/own_solver.cpp"],
    "docs/program.md": ["examples/mpi/distributed_step.cpp"],
    "docs/in-ten-minutes.md": ["examples/in_ten_minutes.cpp"],
    "docs/how-wrong.md": ["examples/explain/variance.cpp", "examples/explain/over_all_inputs.cpp"],
    "docs/bound-rules.md": ["examples/functions/great_circle.cpp", "examples/research/rules_compared.cpp"],
}
# The proofs that Coq blocks of each page quote.
PROOFS = {"docs/collision-detection.md": ["proofs/contact/Contact.v", "proofs/contact/Exact.v"]}
# Pages with measured figures, and their section; an empty name is the whole page.
QUOTING = {"README.md": "", "docs/collision-detection.md": "What it costs", "docs/architecture.md": "",
           "docs/guarantees.md": ""}
MEASURED = "docs/measured.md"

NUMBER = r"\d[\d,]*(?:\.\d+)?"
FIGURE = re.compile(rf"(?:{NUMBER} (?:to|and|/) )?{NUMBER} (?:ns|ms|µs|%|times)(?!\w)"
                    rf"|\d{{1,3}}(?:,\d{{3}})+(?!\d)")


def read(name):
    return (root / name).read_text()


def lines(text):
    return [line.strip() for line in text.splitlines() if line.strip()]


def without_code(text):
    return re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL)


def is_include(line):
    return line.startswith("#include")


def holds(source, block):
    """True if the source has the block's includes anywhere, and the rest in one piece."""
    included = {line.split(">")[0] for line in source if is_include(line)}
    code = [line for line in block if not is_include(line)]
    return (all(line.split(">")[0] in included for line in block if is_include(line)) and
            any(source[i:i + len(code)] == code for i in range(len(source) - len(code) + 1)))


def missing_blocks(page, programs, language="cpp"):
    blocks = [lines(block)
              for block in re.findall(rf"^```{language}\n(.*?)^```", read(page), re.MULTILINE | re.DOTALL)]
    assert blocks, f"{page} has no block of {language}"
    sources = [lines(read(program)) for program in programs]
    for block in blocks:
        if not any(holds(source, block) for source in sources):
            yield f"{page}: not in {' or '.join(programs)}:\n  " + "\n  ".join(block)
    print(f"{page}: {len(blocks)} blocks of {language}")


def missing_figures(page, section, measured):
    text = without_code(read(page)).split("\n## Platforms\n")[0]  # guarantees.md's runs stand only there
    if section:
        text = text.split(f"\n## {section}\n")[-1]
    rows = [line for line in text.splitlines() if line.startswith("|") and len(re.findall(NUMBER, line)) > 2]
    for row in rows:
        if row not in measured.splitlines():
            yield f"{page}: a row that {MEASURED} does not have: {row}"
    prose = " ".join(line for line in text.splitlines() if line not in rows)
    figures = FIGURE.findall(prose)
    for figure in figures:
        if figure not in " ".join(measured.split()):
            yield f"{page}: {MEASURED} does not have '{figure}'"
    print(f"{page}: {len(rows)} rows, {len(figures)} figures")


def headings(page):
    found = {}
    for heading in re.findall(r"^#+ +(.*?) *$", without_code(page.read_text()), re.MULTILINE):
        text = re.sub(r"\[(.*?)\]\(.*?\)", r"\1", heading)
        name = re.sub(r"[^\w\- ]", "", text.lower()).replace(" ", "-")
        found[name] = found.get(name, -1) + 1
    return {f"{name}-{i}" if i else name for name, last in found.items() for i in range(last + 1)}


def dead_links():
    pages = [root / "README.md", root / "CONTRIBUTING.md", root / "proofs/README.md", root / "packaging/README.md",
             *sorted((root / "docs").glob("*.md"))]
    found = 0
    for page in pages:
        for target, heading in re.findall(r"\]\(([^)#:]*)(?:#([^)]*))?\)", without_code(page.read_text())):
            found += 1
            file = page.parent / target if target else page
            if not file.exists():
                yield f"{page.relative_to(root)}: '{target}' is not there"
            elif heading and heading not in headings(file):
                yield f"{page.relative_to(root)}: '{target}' has no heading '{heading}'"
    print(f"{len(pages)} pages: {found} links")


errors = list(dead_links())
for page, programs in PROGRAMS.items():
    errors += missing_blocks(page, programs)
for page, sources in PROOFS.items():
    errors += missing_blocks(page, sources, "coq")
for page, section in QUOTING.items():
    errors += missing_figures(page, section, read(MEASURED))
print(*errors, sep="\n")
sys.exit(bool(errors))
