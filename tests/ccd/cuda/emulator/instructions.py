"""Translates a PTX instruction to C++ expressions and statements with the functions of ptx.hpp."""
import re

from ptx import WIDTHS, Unsupported

CPP = {type: "bool" if type == "pred" else type.replace("b", "u") for type in WIDTHS}
SPECIAL = {"%laneid": "l.id", "WARP_SZ": "32u", "%lanemask_eq": "(1u << l.id)", "%lanemask_lt": "((1u << l.id) - 1)",
           "%lanemask_le": "((2u << l.id) - 1)", "%lanemask_gt": "~((2u << l.id) - 1)",
           "%lanemask_ge": "~((1u << l.id) - 1)"}
for index, axis in enumerate("xyz"):
    SPECIAL[f"%tid.{axis}"] = f"l.tid[{index}]"
    for register in ("ntid", "ctaid", "nctaid"):
        SPECIAL[f"%{register}.{axis}"] = f"l.block->{register}[{index}]"
SPACES = {"global", "local", "shared", "param"}
STRONG = {"relaxed": " | strong", "volatile": " | is_volatile"}
IGNORED = {"membar": {"cta"}, "nanosleep": {"u32"}}  # the threads of a warp advance together, blocks in turn

# name: modifiers other than the type, an expression of the operands, and their types: t is the instruction's, u the
# unsigned one of its width. T and U are those types in C++. The first fitting row of an instruction counts.
OPERATIONS = [(name, set(modifiers.split()), of, expression, operands) for name, modifiers, of, expression, operands in (
    ("add", "rn", "f", "{0} + {1}", "t t"),
    ("sub", "rn", "f", "{0} - {1}", "t t"),
    ("mul", "rn", "f", "{0} * {1}", "t t"),
    ("div", "rn", "f", "{0} / {1}", "t t"),
    ("fma", "rn", "f", "std::fma({0}, {1}, {2})", "t t t"),
    ("rcp", "rn", "f", "{T}(1) / {0}", "t"),
    ("sqrt", "rn", "f", "std::sqrt({0})", "t"),
    ("abs", "", "f", "std::fabs({0})", "t"),
    ("neg", "", "f", "-{0}", "t"),
    ("copysign", "", "f", "std::copysign({1}, {0})", "t t"),
    ("min", "", "f", "float_min({0}, {1})", "t t"),
    ("max", "", "f", "float_max({0}, {1})", "t t"),
    ("add", "", "us", "{U}({0} + {1})", "u u"),
    ("sub", "", "us", "{U}({0} - {1})", "u u"),
    ("add", "cc", "us", "add_carry({0}, {1}, false, carry)", "u u"),
    ("sub", "cc", "us", "subtract_borrow({0}, {1}, false, carry)", "u u"),
    ("addc", "cc", "us", "add_carry({0}, {1}, carry, carry)", "u u"),
    ("subc", "cc", "us", "subtract_borrow({0}, {1}, carry, carry)", "u u"),
    ("mul", "lo", "us", "{U}(u64({0}) * {1})", "u u"),
    ("mad", "lo", "us", "{U}(u64({0}) * {1} + {2})", "u u u"),
    ("mul", "hi", "us", "multiply_high({0}, {1})", "t t"),
    ("div", "", "us", "divide({0}, {1})", "t t"),
    ("rem", "", "us", "remainder({0}, {1})", "t t"),
    ("abs", "", "s", "{U}({0} < 0 ? -{U}({0}) : {0})", "t"),
    ("neg", "", "s", "{U}(-{U}({0}))", "t"),
    ("min", "", "us", "{T}({0} < {1} ? {0} : {1})", "t t"),
    ("max", "", "us", "{T}({0} < {1} ? {1} : {0})", "t t"),
    ("and", "", "bp", "{T}({0} & {1})", "t t"),
    ("or", "", "bp", "{T}({0} | {1})", "t t"),
    ("xor", "", "bp", "{T}({0} ^ {1})", "t t"),
    ("not", "", "p", "!{0}", "t"),
    ("not", "", "b", "{T}(~{0})", "t"),
    ("shl", "", "b", "shift_left({0}, {1})", "t u32"),
    ("shr", "", "bus", "shift_right({0}, {1})", "t u32"),
    ("popc", "", "b", "u32(std::popcount({0}))", "t"),
    ("clz", "", "b", "u32(std::countl_zero({0}))", "t"),
    ("brev", "", "b", "reverse({0})", "t"),
    ("bfind", "shiftamt", "u", "u32({0} == 0 ? -1 : std::countl_zero({0}))", "t"),
    ("bfi", "", "b", "insert({0}, {1}, {2}, {3})", "t t u32 u32"),
    ("bmsk", "clamp", "b", "bit_mask({0}, {1})", "u32 u32"),
    ("prmt", "", "b", "permute({0}, {1}, {2})", "u32 u32 u32"),
    ("selp", "", "busf", "{2} ? {0} : {1}", "t t pred"),
)]
COMPARISONS = {"eq": "==", "ne": "!=", "lt": "<", "le": "<=", "gt": ">", "ge": ">="}
ATOMICS = {"add": "old + x", "min": "old < x ? old : x"}


class Writer:
    """C++ of the instructions of one function."""

    def __init__(self, module, function, members):
        self.module, self.function, self.body = module, function, function.body
        self.members = members  # registers of a kernel that live across blocks
        self.called = set()
        moved = {i.operands[1] for i in self.body.items if not isinstance(i, str) and i.name == "mov"}
        # The address of a function's parameter is one of local memory.
        self.addressed = [] if function.is_kernel else [v for v in function.parameters if v.name in moved]
        self.frame, self.frame_bytes = self.layout([*self.body.local, *self.addressed])
        static = [*self.body.shared, *(v for v in module.shared.values() if v.bytes)]
        dynamic = [v for v in module.shared.values() if not v.bytes]
        self.shared, self.shared_bytes = self.layout([*static, *dynamic])
        self.parameters, self.parameter_bytes = self.layout(function.parameters)
        self.pointers = {v.name: f"returned{i}" for i, v in enumerate(function.returned)}
        if not function.is_kernel:
            self.pointers |= {v.name: f"parameter{i}" for i, v in enumerate(function.parameters)}
        self.pointers |= {v.name: self.identifier(v.name) for v in self.body.arguments}

    @staticmethod
    def layout(variables):
        offsets, end = {}, 0
        for variable in variables:
            end = -(-end // variable.align) * variable.align
            offsets[variable.name] = end
            end += variable.bytes
        return offsets, end

    @staticmethod
    def identifier(name):
        return "v_" + re.sub(r"\W", "_", name)

    def register(self, name):
        return ("r." if name in self.members else "") + self.identifier(name)

    def address_of(self, name):
        if name in self.frame:
            return f"(l.frame + {self.frame[name]})"
        if name in self.shared:
            return f"u64({self.shared[name]})"
        if name in self.pointers:
            return f"reinterpret_cast<u64>({self.pointers[name]})"
        if name in self.parameters:
            return f"(reinterpret_cast<u64>(l.block->parameters) + {self.parameters[name]})"
        if name in self.module.globals:
            return f"g_{self.identifier(name)}"
        raise Unsupported(f"name {name}")

    def value(self, operand, type):
        """The value of an operand as a C++ expression of the given type."""
        cpp = CPP[type]
        if operand.startswith("!"):
            return "!" + self.value(operand[1:], type)
        if operand in self.body.registers:
            same = CPP[self.body.registers[operand]] == cpp
            return self.register(operand) if same else f"as<{cpp}>({self.register(operand)})"
        if operand in SPECIAL:
            return f"as<{cpp}>({SPECIAL[operand]})"
        if match := re.fullmatch(r"0[fFdD]([0-9a-fA-F]+)", operand):
            width = 4 * len(match[1])
            return f"as<{cpp}>(std::bit_cast<f{width}>(u{width}(0x{match[1]})))"
        if re.fullmatch(r"-?(0[xX][0-9a-fA-F]+|\d+)", operand):
            return f"{cpp}(0x{int(operand, 0) % (1 << 64):x}ull)"
        name, offset = re.fullmatch(r"([\w$]+)\s*(?:\+\s*(\d+))?", operand).groups()
        return f"{cpp}({self.address_of(name)} + {offset or 0})"

    def assign(self, register, expression, type):
        """Assigns an expression of the given type, which the register extends by the type's sign."""
        if register == "_":
            return f"(void)({expression});"
        if CPP[self.body.registers[register]] == CPP[type]:
            return f"{self.register(register)} = {expression};"
        return f"set({self.register(register)}, {CPP[type]}({expression}));"

    def memory(self, instruction, operand, bytes, access):
        """The host address of an operand in memory, after the checks of its access."""
        space = next((m for m in instruction.modifiers if m in SPACES), "generic")
        base, offset = re.fullmatch(r"\[\s*([^\]+]+?)\s*(?:\+\s*(-?\w+))?\s*\]", operand).groups()
        address = self.value(base, "u64")
        if self.body.registers.get(base) in ("b32", "u32"):
            address = f"u64({self.value(base, 'u32')})"
        address += f" + {self.value(offset or '0', 'u64')}"
        if space == "param":
            return f"reinterpret_cast<char*>({address})"
        access += "".join(STRONG.get(m, "") for m in instruction.modifiers)
        return f"l.block->{space}_at(l, {address}, {bytes}, {access}, {instruction.line})"

    def statement(self, instruction):
        """One instruction that neither branches nor waits."""
        statement = self.operation(instruction)
        if statement is None:
            own = getattr(self, "write_" + instruction.name, None)
            if own is None and instruction.name in IGNORED:
                self.only(instruction, IGNORED[instruction.name])
                return ""
            if own is None:
                raise Unsupported(instruction.text)
            statement = own(instruction, *instruction.operands)
        guard = instruction.guard
        return f"if ({self.value(guard, 'pred')}) {{ {statement} }}" if guard else statement

    def operation(self, instruction):
        for name, modifiers, kinds, expression, operands in OPERATIONS:
            if instruction.name == name and instruction.type()[0] in kinds \
                    and set(instruction.modifiers[:-1]) == modifiers:
                type = instruction.type()
                unsigned = type if type[0] in "fp" else f"u{WIDTHS[type]}"
                types = [{"t": type, "u": unsigned}.get(t, t) for t in operands.split()]
                values = [self.value(x, t) for x, t in zip(instruction.operands[1:], types, strict=True)]
                return f"set({self.register(instruction.operands[0])}, " \
                       f"{expression.format(*values, T=CPP[type], U=CPP[unsigned])});"
        return None

    @staticmethod
    def only(instruction, modifiers):
        """Throws if the instruction has modifiers that are not implemented."""
        if not set(instruction.modifiers) - set(WIDTHS) <= set(modifiers) - set(WIDTHS):
            raise Unsupported(instruction.text)

    def write_mul(self, i, to, a, b):
        self.only(i, {"wide"})
        wide = i.type()[0] + str(2 * WIDTHS[i.type()])
        return self.assign(to, f"{wide}({wide}({self.value(a, i.type())}) * {self.value(b, i.type())})", wide)

    def write_setp(self, i, to, a, b):
        comparison, type = i.modifiers[0], i.type()
        self.only(i, {comparison})
        a, b = self.value(a, type), self.value(b, type)
        is_nan = f"(std::isnan({a}) || std::isnan({b}))" if type[0] == "f" else "false"
        if comparison == "num":
            test = f"!{is_nan}"
        elif comparison in COMPARISONS:
            test = f"!{is_nan} && {a} {COMPARISONS[comparison]} {b}"
        elif type[0] == "f" and comparison[:-1] in COMPARISONS and comparison[-1] == "u":
            test = f"{is_nan} || {a} {COMPARISONS[comparison[:-1]]} {b}"
        else:
            raise Unsupported(i.text)
        return self.assign(to, test, "pred")

    def write_mov(self, i, to, value):
        self.only(i, ())
        width = WIDTHS[i.type()]
        if to.startswith("{"):
            parts = [part.strip() for part in to[1:-1].split(",")]
            each = width // len(parts)
            assigned = " ".join(self.assign(part, f"u{each}(whole >> {each * k})", f"u{each}")
                                for k, part in enumerate(parts))
            return f"{{ const u64 whole = {self.value(value, f'u{width}')}; {assigned} }}"
        if value.startswith("{"):
            parts = [part.strip() for part in value[1:-1].split(",")]
            each = width // len(parts)
            whole = " | ".join(f"u64({self.value(part, f'u{each}')}) << {each * k}" for k, part in enumerate(parts))
            return self.assign(to, f"u{width}({whole})", f"u{width}")
        return self.assign(to, self.value(value, i.type()), i.type())

    def write_cvt(self, i, to, value):
        result, of = [m for m in i.modifiers if m in WIDTHS]
        exact = of[0] != "f" and result[0] != "f" or (of, result) == ("f32", "f64")
        rounding = "" if exact else "rzi" if result[0] != "f" else "rn"
        if [m for m in i.modifiers if m not in WIDTHS] != [rounding] * (not exact):
            raise Unsupported(i.text)
        value = self.value(value, of)
        value = f"to_integer<{CPP[result]}>({value})" if rounding == "rzi" else f"{CPP[result]}({value})"
        return self.assign(to, value, result)

    def write_cvta(self, i, to, value):
        self.only(i, {"to", "global", "local", "shared"})
        sign = "-" if "to" in i.modifiers else "+"
        base = f" {sign} reinterpret_cast<u64>(l.block->shared)" if "shared" in i.modifiers else ""
        return self.assign(to, self.value(value, "u64") + base, "u64")

    def vector(self, i):
        """The number of elements of a load or a store."""
        self.only(i, {"global", "local", "shared", "param", "nc", "relaxed", "gpu", "volatile", "v2", "v4"})
        return 4 if "v4" in i.modifiers else 2 if "v2" in i.modifiers else 1

    def write_ld(self, i, to, address):
        count, type, bytes = self.vector(i), i.type(), WIDTHS[i.type()] // 8
        targets = [to] if count == 1 else [part.strip() for part in to[1:-1].split(",")]
        loads = " ".join(self.assign(target, f"load<{CPP[type]}>(at + {k * bytes})", type)
                         for k, target in enumerate(targets))
        return f"{{ const char* const at = {self.memory(i, address, count * bytes, 'reads')}; {loads} }}"

    def write_st(self, i, address, value):
        count, type, bytes = self.vector(i), i.type(), WIDTHS[i.type()] // 8
        values = [value] if count == 1 else [part.strip() for part in value[1:-1].split(",")]
        stores = " ".join(f"store<{CPP[type]}>(at + {k * bytes}, {self.value(v, type)});"
                          for k, v in enumerate(values))
        return f"{{ char* const at = {self.memory(i, address, count * bytes, 'writes')}; {stores} }}"

    def write_atom(self, i, to, address, value):
        self.only(i, {"global", "shared", *ATOMICS})
        type = i.type()
        operation = ATOMICS[next(m for m in i.modifiers if m in ATOMICS)]
        return (f"{{ char* const at = {self.memory(i, address, WIDTHS[type] // 8, 'reads | writes | strong')}; "
                f"const {CPP[type]} old = load<{CPP[type]}>(at), x = {self.value(value, type)}; "
                f"store<{CPP[type]}>(at, {operation}); {self.assign(to, 'old', type)} }}")

    def write_trap(self, i):
        return f'fail(l, "trap", 0, 0, {i.line});'

    def write_call(self, i, *operands):
        self.only(i, {"uni"})
        lists = [[name.strip() for name in o[1:-1].split(",") if name.strip()] for o in operands if o[0] == "("]
        target = next(o for o in operands if o[0] != "(")
        if target not in self.module.functions:
            raise Unsupported(f"call of {target}")
        self.called.add(target)
        arguments = ", ".join(["l", *(self.identifier(name) for names in lists for name in names)])
        function = f"f_{self.identifier(target)}"
        return f'resolve(l, {function}, "{target}"); {function}({arguments});'
