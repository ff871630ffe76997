"""Makes the mutants of tied functions: every change of one constant, comparison, branch, sum or difference.

Each is a change of the text, and a numbered form of it. One program has all numbered forms, and runs the mutant whose
number it gets (mutants.py).
"""
import collections
import re
import sys
from pathlib import Path

root = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(root / "tests/project"))
from layout_test import code_alone  # noqa: E402
sys.path.insert(0, str(root / "proofs"))
import ties  # noqa: E402

# The replacement of each operator, and the tag that stands for both.
OPERATORS = {"<": ("<=", "less"), "<=": ("<", "at_most"), ">": (">=", "greater"), ">=": (">", "at_least"),
             "==": ("!=", "equal"), "!=": ("==", "unequal"), "&&": ("||", "both"), "||": ("&&", "any"),
             "&": ("|", "both_bits"), "|": ("&", "any_bit"), "+": ("-", "plus"), "-": ("+", "minus")}
ENUMERATORS = {"sign_type": ["negative", "zero", "positive", "uncertain"],
               "existence": ["no", "yes", "maybe_root", "maybe_inside"],
               "outcome": ["separate", "collides", "uncertain"],
               "kind": ["none", "one", "of_quadratic", "everywhere"]}
ENUMERATORS["kind_type"] = ENUMERATORS["kind"]
KINDS = {
    "case": r"\bcase\s+[^:]*(?:::\w+)*:(?!:)",
    "enumerator": rf"(?:\w+::)*\b(?:{'|'.join(ENUMERATORS)})::\w+",
    "argument": r"\b[a-z]\w*<\d+>(?=\()",
    "operator": r"(?<= )(?:<=|>=|==|!=|&&|\|\||[<>&|+-])(?= )",
    "truth": r"\b(?:true|false)\b",
    "number": r"(?<![\w.])(?:0x[\da-f.]+p[+-]?\d+|\d+(?:\.\d*)?(?:e[+-]?\d+)?)[fU]*\b",
    "extreme": r"(?:\bstd::|(?<![:\w]))(?:max|min)(?=\()",
    "condition": r"\b(?:if|while)(?= \()",
    "choice": r"(?<= )\?(?= )",
    "negation": r"(?<![\w)\]])!(?=[\w(*])",
}
FOUND = re.compile("|".join(f"(?P<{kind}>{pattern})" for kind, pattern in KINDS.items()))
# Second operands that must not be evaluated unless the first one is true, since they would read invalid memory or
# change something. (An omission is detected: then the code without a mutant differs.)
SUPPOSING = [r"\(\*", "->", r"\bterms_?\[", r"\broot_of\("]
# Parts of the code that only name types, or that only the compiler evaluates.
TYPES = [r"\bdecltype\([^;{]*?\)(?=[;,>])", r"static_assert\([^;]*;", r"^ *template <[^\n]*>$",
         r"\bconcept \w+ =.*?;$(?=\n\n)", r"\brequires\s*\(.*?\)(?= (?:constexpr|friend|inline))",
         r"enum class[^{;]*\{[^}]*\};",
         r"^ *(?:const )?(?:double|float|S) [^=(;]*\[[^=(;]*;$", r"std::array<S, [^>]*>",
         r"\(&\w+\)(?:\[\d+\])+", r"\bif constexpr \([^\n]*\)(?= |$)"]


class Mutant:
    """A change: text[start:end] becomes `new`, or `numbered` with the number K; None if it has no such form."""

    def __init__(self, path, text, start, end, new, numbered=None):
        self.path, self.numbered = path, numbered
        # The other operator has another precedence, unlike in the numbered program.
        self.binds_differently = text[start:end] in ("&&", "||", "&", "|")
        self.changes = [(start, end, new)]
        self.after = []  # insertions elsewhere, with a number or without
        self.line_number = text.count("\n", 0, start) + 1
        before = text[text.rfind("\n", 0, start) + 1:start]
        nth = before.count(text[start:end]) + 1
        line = re.sub(r"//.*", "", text.split("\n")[self.line_number - 1]).strip()
        self.change = f"{line} | {text[start:end]} -> {new}" + (f" ({nth})" if nth > 1 else "")

    def by_number(self, number):
        (start, end, _), *_ = self.changes
        return [(start, end, re.sub(r"\bK\b", str(number), self.numbered)), *self.after]

    def by_itself(self):
        return self.changes + self.after


def blanked(text, untied):
    """Returns the code with spaces for comments, literals, untied functions and arguments of types."""
    code = code_alone(text).split("\n")
    for first, lines in untied:
        for i in range(first - 1, first - 1 + lines):
            code[i] = " " * len(code[i])
    code = "\n".join(code)
    for pattern in TYPES:
        code = re.sub(pattern, lambda m: re.sub(r"[^\n]", " ", m[0]), code, flags=re.MULTILINE | re.DOTALL)

    def hide(m):  # except a function's number
        own = re.fullmatch(r"[a-z]\w*<\d+>", m[0]) and code[m.end():m.end() + 1] == "("
        return m[0] if own else m[1] + "\1" * (len(m[0]) - len(m[1]))
    before = None
    while code != before:  # innermost first
        before, code = code, re.sub(r"(\b\w+)<([^<>()&|;]|\(\))*>(?!\s*=)", hide, code)
    return code


def closing(code, opening):
    depth = 0
    for i in range(opening, len(code)):
        depth += (code[i] == "(") - (code[i] == ")")
        if depth == 0:
            return i
    raise ValueError("a parenthesis does not close")


def changed(kind, old, rest):
    """Returns the replacement of `old` and its numbered form, or None; `rest` is the rest of the line."""
    if kind == "enumerator":
        start, name = old.rsplit("::", 1)
        names = ENUMERATORS[start.rsplit("::", 1)[-1]]
        if name not in names:
            return None
        other = f"{start}::{names[(names.index(name) + 1) % len(names)]}"
        return other, f"::mutants::either<K>({old}, {other})"
    if kind == "argument":
        return re.sub(r"\d+", lambda n: str(int(n[0]) + 1), old), None
    if kind == "operator":
        new, tag = OPERATORS[old]
        opening, close = "<>" if tag in ("less", "at_most", "greater", "at_least") else (old, old)
        # Both operands would be evaluated, but the second may require the first.
        supposes = old in ("&&", "||") and re.search("|".join(SUPPOSING), rest)
        return new, None if supposes else f"{opening} ::mutants::{tag}<K>{{}} {close}"
    if kind == "truth":
        other = "false" if old == "true" else "true"
        return other, f"::mutants::either<K>({old}, {other})"
    if kind == "number":
        whole = re.fullmatch(r"(\d+)[uU]?", old)
        new = str(int(whole[1]) + 1) if whole else "1.0" if old == "0.0" else f"({old} * 0.875f)" if \
            old[-1] == "f" and "x" not in old else f"({old} * 0.875)"
        return new, f"::mutants::number<K>({old})"
    if kind == "extreme":
        return (old.replace("max", "min"), "::mutants::greatest<K>") if "max" in old else \
            (old.replace("min", "max"), "::mutants::least<K>")
    if kind == "choice":
        return "== false ?", "!= ::mutants::on(K) ?"
    return "!!", "::mutants::negation<K>{} ->* "


def condition(path, text, code, old, end):
    """Returns `if (c)` with !c, or None if c declares a variable."""
    opening = code.index("(", end)
    last = closing(code, opening)
    inside = text[opening + 1:last]
    if ";" in inside or re.search(r"\bauto\b", inside):
        return None
    mutant = Mutant(path, text, opening, opening + 1, "(!(", "(::mutants::on(K) != bool(")
    mutant.after = [(last, last, ")")]
    mutant.change = mutant.change.replace("( -> (!(", f"{old} -> {old} not")
    return mutant


def exchanged_cases(path, text, labels):
    """Yields mutants that swap adjacent labels of a switch."""
    for (s0, e0), (s1, e1) in zip(labels, labels[1:]):
        between = text[e0:s1]
        if "switch" not in between and "}" not in between and between.strip():
            mutant = Mutant(path, text, s0, e1, text[s1:e1] + between + text[s0:e0])
            mutant.change = f"{text[s0:e0]} <-> {text[s1:e1]}"
            yield mutant


def mutants_of(path, untied):
    """Returns the file's text and its mutants."""
    text = (root / path).read_text()
    code = blanked(text, untied)
    found, labels = [], []
    for m in FOUND.finditer(code):
        kind, (start, end) = m.lastgroup, m.span()
        if kind == "case":
            labels.append((start, end))
        elif kind == "condition":
            found.append(condition(path, text, code, text[start:end], end))
        elif change := changed(kind, text[start:end], text[start:text.find("\n", start)]):
            found.append(Mutant(path, text, start, end, *change))
    found = [mutant for mutant in found if mutant] + list(exchanged_cases(path, text, labels))
    functions, times = list(ties.functions(path)), collections.Counter()
    for mutant in found:  # a name has the file, function and change; equal names are numbered
        around = [name for name, first, lines in functions if first <= mutant.line_number < first + lines]
        name = f"{Path(path).name}, {around[0] if around else 'outside'}: {mutant.change}"
        times[name] += 1
        mutant.name = name + (f" [{times[name]}]" if times[name] > 1 else "")
    return text, found
