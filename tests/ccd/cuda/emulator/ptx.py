"""Parses the PTX of one module into functions, variables and instructions."""
import dataclasses
import functools
import re

WIDTHS = {"pred": 1} | {f"{kind}{bits}": bits for kind in "bus" for bits in (8, 16, 32, 64)} | {"f32": 32, "f64": 64}
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
TOP_LEVEL = re.compile(r"\s*(?:\.(?:visible|extern|weak)\s+)*\.(\w+)")
SIGNATURE = re.compile(r"\s*(?:\(([^)]*)\)\s*)?([\w$]+)\s*(?:\(([^)]*)\))?([^{;]*)([{;])")
# A brace of a scope, a label, or a statement, which may contain vectors in braces.
TOKEN = re.compile(r"\s*(?:([{}])|([\w$%]+)\s*:(?!:)|([^;{}]*(?:\{[^{}]*\}[^;{}]*)*);)")
INSTRUCTION = re.compile(r"(?:@(!?)([\w$%]+)\s+)?([\w.:]+)\s*(.*)$")
NAME = re.compile(r"(?<![\w.$%])[%$A-Za-z_][\w$]*")


class Unsupported(Exception):
    """PTX that the emulator does not implement."""


@dataclasses.dataclass
class Variable:
    name: str
    type: str
    align: int
    bytes: int
    initial: bytes


@dataclasses.dataclass
class Instruction:
    guard: str  # "", or the register that guards it, after "!" if negated
    name: str
    modifiers: list
    operands: list
    line: int
    text: str

    def type(self):
        return next(m for m in reversed(self.modifiers) if m in WIDTHS)

    def registers(self):
        return NAME.findall(" ".join([*self.operands, self.guard.lstrip("!")]))


def split(text):
    parts, depth, start = [], 0, 0
    for i, c in enumerate(text):
        depth += (c in "[{(") - (c in ")}]")
        if c == "," and depth == 0:
            parts.append(text[start:i].strip())
            start = i + 1
    return parts + [text[start:].strip()] if text.strip() else []


def bytes_of(text, type):
    result = b""
    for number in re.findall(r"[-\w$.]+", text or ""):
        if match := re.fullmatch(r"0[fFdD]([0-9a-fA-F]+)", number):
            value = int(match[1], 16)
        elif re.fullmatch(r"-?\d\w*", number):
            value = int(number, 0)
        else:
            raise Unsupported(f"initial value {number}")
        result += (value % (1 << WIDTHS[type])).to_bytes(WIDTHS[type] // 8, "little")
    return result


def variables(text):
    """The variables of a declaration such as `.align 4 .b8 name[16] = {..}, other[4]`."""
    head, rest = re.match(r"((?:\s*\.(?:align\s+\d+|ptr|\w+))*)\s*(.*)$", text.strip(), re.DOTALL).groups()
    type = next(t for t in reversed(re.findall(r"\.(\w+)", head)) if t in WIDTHS)
    size = max(1, WIDTHS[type] // 8)
    align = max(size, *(int(a) for a in re.findall(r"\.align\s+(\d+)", head)), 1)
    for item in split(rest):
        name, dimensions, initial = re.match(r"([\w$%]+)\s*((?:\[\s*\d*\s*\])*)\s*(?:=\s*(.*))?$", item, re.DOTALL).groups()
        count = 1
        for dimension in re.findall(r"\[\s*(\d*)\s*\]", dimensions):
            count *= int(dimension or 0)
        yield Variable(name, type, align, size * count, bytes_of(initial, type))


class Function:
    """A kernel or a function of a thread; its body is parsed when it is first used."""

    def __init__(self, name, is_kernel, returned, parameters, attributes, text, line):
        self.name, self.is_kernel, self.text, self.line = name, is_kernel, text, line
        self.returned = [v for item in split(returned or "") for v in variables(item.replace(".param", "", 1))]
        self.parameters = [v for item in split(parameters or "") for v in variables(item.replace(".param", "", 1))]
        self.max_threads = 1024
        if match := re.search(r"\.(?:maxntid|reqntid)\s+([\d, ]+)", attributes):
            self.max_threads = functools.reduce(lambda a, b: a * int(b), match[1].split(","), 1)

    @functools.cached_property
    def body(self):
        return Body(self.text, self.line)


class Body:
    """Registers, variables and instructions of a function. Names of inner scopes get a suffix."""

    def __init__(self, text, line):
        self.registers = {}  # name -> type
        self.local, self.shared, self.arguments = [], [], []  # variables; arguments are those of calls
        self.items = []  # instructions and labels (strings)
        self.tables = {}  # label -> targets of an indexed branch
        self.scopes, self.scope_count = [{}], 0
        end = 0
        for token in iter(lambda: TOKEN.match(text, end), None):
            brace, label, statement = token.groups()
            start = token.start(token.lastindex)
            line += text.count("\n", end, start)
            if brace == "{":
                self.scopes.append({})
                self.scope_count += 1
            elif brace == "}":
                self.scopes.pop()
            elif label:
                self.items.append(label)
            else:
                self.statement(" ".join(statement.split()), line)
            line += text.count("\n", start, token.end())
            end = token.end()
        if text[end:].strip():
            raise Unsupported(text[end:].strip()[:80])

    def statement(self, text, line):
        if text.startswith(".branchtargets"):
            self.tables[self.items.pop()] = split(text.split(None, 1)[1])
        elif text.startswith("."):
            self.declare(text)
        elif text:
            self.items.append(self.instruction(text, line))

    def declare(self, text):
        kind, rest = text.split(None, 1)
        if kind == ".reg":
            type, names = rest[1:].split(None, 1)
            for name in split(names):
                if match := re.match(r"([\w$%]+)<(\d+)>$", name):
                    self.registers |= {f"{match[1]}{i}": type for i in range(int(match[2]))}
                else:
                    self.registers[self.own(name)] = type
        elif kind in (".local", ".shared", ".param"):
            list_of = {".local": self.local, ".shared": self.shared, ".param": self.arguments}[kind]
            for variable in variables(rest):
                variable.name = self.own(variable.name)
                list_of.append(variable)
        elif kind != ".pragma":
            raise Unsupported(text)

    def own(self, name):
        if len(self.scopes) > 1:
            self.scopes[-1][name] = f"{name}_{self.scope_count}_"
        return self.scopes[-1].get(name, name)

    def instruction(self, text, line):
        renamed = text
        for scope in reversed(self.scopes[1:]):
            renamed = NAME.sub(lambda match: scope.get(match[0], match[0]), renamed)
        negated, guard, name, operands = INSTRUCTION.match(renamed).groups()
        name, *modifiers = name.replace("::", ".").split(".")
        return Instruction((negated or "") + (guard or ""), name, modifiers, split(operands), line, text)


class Module:
    def __init__(self, text):
        text = COMMENT.sub(lambda match: "\n" * match[0].count("\n"), text)
        self.functions, self.globals, self.shared = {}, {}, {}
        end = 0
        for match in iter(lambda: TOP_LEVEL.match(text, end), None):
            if match[1] in ("version", "target", "address_size"):
                end = text.index("\n", match.end())
            elif match[1] in ("global", "const", "shared"):
                end = text.index(";", match.end()) + 1
                of = self.shared if match[1] == "shared" else self.globals
                of |= {v.name: v for v in variables(text[match.end():end - 1])}
            elif match[1] in ("entry", "func"):
                end = self.function(text, match.end(), match[1] == "entry")
            else:
                raise Unsupported(f"directive .{match[1]}")
        if text[end:].strip():
            raise Unsupported(text[end:].strip()[:80])

    def function(self, text, start, is_kernel):
        """Stores a function unless it is only declared, and returns where it ends."""
        match = SIGNATURE.match(text, start)
        returned, name, parameters, attributes, opening = match.groups()
        end = match.end()
        if opening == "{":
            depth = 1
            for brace in re.compile(r"[{}]").finditer(text, end):
                depth += 1 if brace[0] == "{" else -1
                if depth == 0:
                    break
            body, end = text[end:brace.start()], brace.end()
            self.functions[name] = Function(name, is_kernel, returned, parameters, attributes, body,
                                            text.count("\n", 0, match.end()) + 1)
        return end
