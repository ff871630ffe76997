"""Checks the project's rules: sizes of folders, files and functions, and includes between rooms.

Argument: the source folder. Prints the counts; status 1 if a limit is exceeded.
"""
import ast
import collections
import pathlib
import re
import sys

FILES_PER_FOLDER = 22
ROOT_CMAKE_LINES = 80
README_LINES = 160
FUNCTION_LINES = 50

FOLDERS = ["ccd", "docs", "errbound", "include", "packaging", "python", "examples", "tests"]
CPP = {".hpp", ".cpp", ".cu", ".cuh"}
SOURCES = CPP | {".py"}

LAYERS = "docs/architecture.md"
INTERNAL = r"(errbound/(detail|integers|filters|linear|roots)|ccd/(exact|contact|batch|step|cuda|mpi|io|lab))/\w+\.hpp"
PUBLIC_HEADERS = r"include/(errbound/(rules/|validation/)?|ccd/((bodies|methods|study|adapters)/)?)\w+\.hpp$"


def blank(match):
    return re.sub(r"[^\n]", " ", match[0])


def code_alone(text):
    """Blanks comments, literals and preprocessor lines of C++. Line numbers stay."""
    literal = r'R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<![0-9a-fA-F])\'(?:\\.|[^\'\\\n])+\''
    text = re.sub(rf"//[^\n]*|/\*.*?\*/|{literal}", blank, text, flags=re.DOTALL)
    return re.sub(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", blank, text, flags=re.MULTILINE)


def without_brackets(text, opening, closing):
    kept, depth = [], 0
    for c in text:
        depth += c == opening
        if depth == 0:
            kept.append(c)
        depth -= c == closing and depth > 0
    return "".join(kept)


def kind_of_brace(head):
    """Classifies a brace at namespace or class scope by the text since the last statement."""
    plain = without_brackets(without_brackets(head, "(", ")"), "<", ">")
    declared = re.sub(r"\b(template|inline|constexpr|static|extern|typedef)\b", " ", plain).split()
    if not declared or declared[0] in ("namespace", "class", "struct", "union", "enum"):
        return "scope"
    if re.search(r"\brequires\s*$", plain):
        return "part of the head"
    if "operator" not in plain and "=" in plain:
        return "function" if re.search(r"=\s*(?:[\w:]+<[^;{]*>\(\s*)?\[[^]]*\]\s*\(", head) else "value"
    if "(" not in head or head.count("(") > head.count(")"):  # a default argument's
        return "value"
    in_initialisers = re.search(r"\)[^()]*:[^:]", head) and re.search(r"[\w>]\s*$", head)
    return "part of the head" if in_initialisers else "function"


def cpp_functions(text):
    code = code_alone(text)
    found, stack, start = [], [], 0
    for mark in re.finditer(r"[{};]|\b(?:public|private|protected)\s*:", code):
        i, c = mark.start(), mark[0]
        outside = all(kind == "scope" for kind, _ in stack)
        if c == "{":
            kind = kind_of_brace(code[start:i]) if outside else "inside"
            stack.append((kind, start))
            if kind == "scope":
                start = i + 1
        elif c == "}" and stack:
            kind, begin = stack.pop()
            if kind == "function":
                head = code[begin:i].split("{")[0]
                signature = re.sub(r"^\s*(template\s*<[^;{]*?>\s*(?=[\w\[:~]))?", "", head)
                first = code.count("\n", 0, begin + len(head) - len(signature)) + 1
                name = re.sub(r"\s+", " ", signature.split("\n")[0].strip())
                found.append((name, first, code.count("\n", 0, i) + 2 - first))
            if kind in ("scope", "function"):
                start = i + 1
        elif c != "}" and outside:
            start = mark.end()
    return found


def python_functions(text):
    return [(node.name, node.lineno, node.end_lineno + 1 - node.lineno)
            for node in ast.walk(ast.parse(text)) if isinstance(node, ast.FunctionDef)]


class findings:
    def __init__(self):
        self.failed = False

    def check(self, what, found, limit, where=""):
        self.failed |= found > limit
        print(f"{'FAILED' if found > limit else 'ok':7}{what}: {found} of at most {limit} {where}".rstrip())

    def wrong(self, what, cases):
        self.check(what, len(cases), 0)
        for case in cases:
            print(f"         {case}")


def check_sizes(root, sources, found):
    per_folder = collections.Counter(str(path.parent) for path in sources)
    folder, count = per_folder.most_common(1)[0]
    found.check("source files in a folder", count, FILES_PER_FOLDER, f"({folder})")
    for name, limit in (("CMakeLists.txt", ROOT_CMAKE_LINES), ("README.md", README_LINES)):
        found.check(f"lines of {name}", len((root / name).read_text().splitlines()), limit)


def check_functions(root, sources, found):
    functions = []
    for path in sources:
        text = (root / path).read_text()
        of = python_functions if path.suffix == ".py" else cpp_functions
        functions += [(lines, f"{path}:{first}: {name}") for name, first, lines in of(text)]
    functions.sort(reverse=True)
    longer = [case for case in functions if case[0] > FUNCTION_LINES]
    found.check(f"functions of more than {FUNCTION_LINES} lines, of {len(functions)}", len(longer), 0)
    for lines, where in longer or functions[:1]:
        print(f"{lines:12} lines: {where}")


class layers:
    """The table of layers in docs/architecture.md. Its files are folders, which end with a slash, or patterns."""

    def __init__(self, root):
        self.contents, self.patterns = {}, []
        for number, content, files in re.findall(r"^\| (\d+) \| (.*?) \| (.*?) \|$", (root / LAYERS).read_text(), re.MULTILINE):
            self.contents[int(number)] = content
            for pattern in re.findall("`(.*?)`", files):
                names = re.search(r"\{(.*?)\}", pattern)
                self.patterns += [(pattern.replace(names[0], name) if names else pattern, int(number))
                                  for name in (names[1].split(",") if names else [""])]
        # The most exact first: files, then patterns and folders by length.
        self.patterns.sort(key=lambda entry: (entry[0].endswith("/") or "*" in entry[0], -len(entry[0])))

    def of(self, path):
        return next((layer for pattern, layer in self.patterns
                     if (path.startswith(pattern) if pattern.endswith("/") else pathlib.PurePosixPath(path).match(pattern))), None)

    def name(self, layer):
        return f"layer {layer}, {self.contents[layer]}"


def includes(root, sources):
    own = {str(path) for path in sources}
    for path in own:
        if pathlib.Path(path).suffix not in CPP:
            continue
        text = (root / path).read_text()
        for name in re.findall(r'^[ \t]*#[ \t]*include[ \t]*[<"]([^">]+)[">]', text, re.MULTILINE):
            beside = str(pathlib.Path(path).parent / name)
            for candidate in ("include/" + name, name, beside):
                if candidate in own:
                    yield path, candidate
                    break


def cycle(edges):
    done, path = set(), []

    def visit(node):
        if node in path:
            return path[path.index(node):] + [node]
        if node in done:
            return []
        path.append(node)
        found = next((c for c in map(visit, sorted(edges.get(node, ()))) if c), [])
        path.pop()
        done.add(node)
        return found

    return next((c for c in map(visit, sorted(edges)) if c), [])


def room_of(path):
    """Returns a file's folder. A header directly in include/errbound or include/ccd is a separate room."""
    folder = str(pathlib.Path(path).parent)
    return path if folder in ("include/errbound", "include/ccd") else folder


def check_includes(root, sources, found):
    table = layers(root)
    homeless, upwards, of_tests = set(), [], []
    rooms = collections.defaultdict(set)
    for file, included in sorted(includes(root, sources)):
        if file.startswith(("tests/", "examples/")):
            continue
        if included.startswith("tests/"):
            of_tests.append(f"{file} includes {included}")
            continue
        if room_of(file) != room_of(included):
            rooms[room_of(file)].add(room_of(included))
        of = table.of(file), table.of(included)
        homeless |= {path for path, layer in zip((file, included), of) if layer is None}
        if None not in of and of[0] < of[1]:
            upwards.append(f"{file} ({table.name(of[0])}) includes {included} ({table.name(of[1])})")
    found.wrong("files of no layer", sorted(homeless))
    found.wrong("includes of a higher layer", upwards)
    found.wrong("includes of tests", of_tests)
    around = cycle(rooms)
    found.wrong("cycles of rooms", [" -> ".join(around)] if around else [])


def check_internals_unnamed(root, sources, found):
    """Checks that no comment recommends including an internal header."""
    named = []
    for path in [*sources, *(p.relative_to(root) for p in [root / "README.md", *root.glob("docs/*.md")])]:
        text = (root / path).read_text()
        if path.suffix == ".md" or path.parts[0] == "examples" and path.suffix in CPP:
            told = rf'#\s*include\s*[<"]({INTERNAL})[>"]'
        elif re.match(PUBLIC_HEADERS, str(path)):
            told = rf"^\s*//.*?({INTERNAL})"
        else:
            continue
        named += [f"{path} names {m[1]}" for m in re.finditer(told, text, re.MULTILINE)
                  if not (root / "include" / m[1]).exists()]
    found.wrong("internal headers named as something to include", named)


def check_version(root, found):
    of_cmake = re.search(r"project\(errbound VERSION (\S+)", (root / "CMakeLists.txt").read_text())[1]
    of_citation = re.search(r"^version: (\S+)", (root / "CITATION.cff").read_text(), re.MULTILINE)[1]
    differ = [] if of_citation == of_cmake else [f"CITATION.cff: {of_citation}, not {of_cmake}"]
    for page in [root / "README.md", *sorted((root / "docs").glob("*.md"))]:
        for said in re.findall(r"errbound[-_ ](\d+(?:\.\d+)+)", page.read_text()):
            if (of_cmake + ".").startswith(said + "."):
                continue
            differ.append(f"{page.relative_to(root)}: {said}, not {of_cmake}")
    found.wrong("versions that differ from CMakeLists.txt's", differ)


def main():
    root = pathlib.Path(sys.argv[1])
    sources = sorted(path.relative_to(root) for folder in FOLDERS
                     for path in (root / folder).rglob("*") if path.suffix in SOURCES)
    found = findings()
    for check in check_sizes, check_functions, check_includes, check_internals_unnamed:
        check(root, sources, found)
    check_version(root, found)
    return found.failed


if __name__ == "__main__":
    sys.exit(main())
