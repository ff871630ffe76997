#!/usr/bin/env python3
"""translate.py MODULE.ptx NAME OUTPUT.so [ccache] COMPILER: compiles a kernel or a function of a PTX module, and the
functions that it calls, for the host.

A kernel becomes one C++ function for each basic block, which runs it for the lanes of a warp that are there.
Blocks end at branches, and where lanes of a warp or of a thread block meet. A function becomes a C++ function
of one lane.
"""
import concurrent.futures
import fcntl
import os
import pathlib
import subprocess
import sys

from instructions import CPP, Writer
from ptx import Module, Unsupported

FLAGS = ["-std=c++20", "-ffp-contract=off", "-fno-strict-aliasing", "-fPIC", "-fvisibility=hidden"]
LARGE = 200_000  # characters of a C++ file
MEETINGS = {"shfl", "vote", "activemask", "bar"}
ENDS = {"bra", "ret", "exit", "trap"}


def blocks_of(body):
    blocks, labels, open_block = [], {}, False
    for item in body.items:
        if isinstance(item, str):
            labels[item] = len(blocks)
            open_block = False
            continue
        if not open_block or item.name in MEETINGS:
            blocks.append([])
        blocks[-1].append(item)
        open_block = item.name not in ENDS | MEETINGS
    return blocks, labels


def declarations(registers, body):
    by_type = {}
    for name in sorted(registers):
        by_type.setdefault(CPP[body.registers[name]], []).append(Writer.identifier(name))
    return [f"{type} {', '.join(names)};" for type, names in sorted(by_type.items())]


def arguments(variables):
    return [f"alignas(16) char {Writer.identifier(v.name)}[{v.bytes}];" for v in variables]


class Kernel:
    def __init__(self, module, function):
        self.body = function.body
        self.blocks, self.labels = blocks_of(self.body)
        uses = {}
        for index, block in enumerate(self.blocks):
            for instruction in block:
                for name in instruction.registers():
                    if name in self.body.registers:
                        # A meeting reads and writes the registers of all lanes.
                        uses.setdefault(name, set()).update({index, -1} if block[0].name in MEETINGS else {index})
        self.own = [{name for name, where in uses.items() if where == {index}} for index in range(len(self.blocks))]
        members = {name for name, where in uses.items() if len(where) > 1}
        self.writer = Writer(module, function, members)
        self.lines = ["struct registers {", *declarations(members, self.body), "bool carry;", "};"]

    def write(self):
        table = []
        for index, block in enumerate(self.blocks):
            kind, key, test = "plain", "nullptr", "nullptr"
            if block[0].name in MEETINGS:
                kind, key, test = self.meeting(index, block[0])
            else:
                self.plain(index, block)
            table.append(f'{{block{index}, block_kind::{kind}, {key}, {test}, {len(block)}, {block[0].line}, '
                         f'"{block[0].text}"}},')
        function, writer = self.writer.function, self.writer
        parameters = ", ".join(f"{{{writer.parameters[v.name]}, {v.bytes}}}" for v in function.parameters)
        return [*self.lines, "const block blocks[] = {", *table, "};",
                f"const parameter parameters[] = {{{parameters or '{0, 0}'}}};",
                f'extern "C" [[gnu::visibility("default")]] const kernel translated_{hash_of(function.name)} = '
                f'{{"{function.name}", blocks, {len(self.blocks)}, sizeof(registers), {writer.frame_bytes}, '
                f"{writer.shared_bytes}, {writer.parameter_bytes}, parameters, {len(function.parameters)}, "
                f"{function.max_threads}}};"]

    def plain(self, index, block):
        used = {name for instruction in block for name in instruction.registers()}
        body = [*declarations(self.own[index], self.body),
                *arguments(v for v in self.body.arguments if v.name in used)]
        after = index + 1
        for instruction in block:
            if instruction.name in ("bra", "ret", "exit"):
                to = self.labels[instruction.operands[0]] if instruction.name == "bra" else "exited"
                guard = instruction.guard and f"!({self.writer.value(instruction.guard, 'pred')}) ? {after} : "
                body.append(f"l.next = {guard}{to};")
            else:
                body.append(self.writer.statement(instruction))
        if block[-1].name not in ("bra", "ret", "exit"):
            body.append(f"l.next = {after};")
        self.lines += [f"void block{index}(warp& w, u32 lanes) {{", "for_lanes(lanes, [&](u32 k) {",
                       "lane& l = w.lanes[k]; registers& r = registers_of<registers>(w, k); bool& carry = r.carry;",
                       *body, "});", "}"]

    def meeting(self, index, i):
        """A block where lanes meet: its kind, the lanes or the barrier that a lane waits for, what it contributes."""
        if i.guard:
            raise Unsupported(i.text)
        kind, key, test, passes = self.passes(i)
        loops = []
        for code in passes:
            loops += [f"for_lanes(lanes, [&](u32 k) {{ lane& l = w.lanes[k]; "
                      f"registers& r = registers_of<registers>(w, k); {code} }});"]
        self.lines += [f"void block{index}(warp& w, u32 lanes) {{", "u32 all = 0, x[32]; shuffled from[32];", *loops,
                       f"for_lanes(lanes, [&](u32 k) {{ w.lanes[k].next = {index + 1}; }});", "}"]
        names = []
        for name, expression in (("key", key), ("test", test)):
            if expression:
                self.lines.append(f"u32 {name}{index}(warp& w, u32 k) {{ lane& l = w.lanes[k]; registers& r = "
                                  f"registers_of<registers>(w, k); return {expression}; }}")
            names.append(f"{name}{index}" if expression else "nullptr")
        return kind, *names

    def passes(self, i):
        """Returns the result of `meeting`, and the code of each lane, pass after pass over all lanes."""
        value, assign, operands, modifiers = self.writer.value, self.writer.assign, i.operands, set(i.modifiers)
        if i.name == "activemask" and modifiers == {"b32"}:
            return "active", "", "", [assign(operands[0], "lanes", "u32")]
        if i.name == "vote" and modifiers - {"sync", "b32", "pred"} in ({"ballot"}, {"all"}, {"any"}):
            result, type = {"ballot": ("all", "u32"), "all": ("all == lanes", "pred"),
                            "any": ("all != 0", "pred")}[(modifiers - {"sync", "b32", "pred"}).pop()]
            return "warp", value(operands[2], "u32"), "", [f"all |= u32({value(operands[1], 'pred')}) << k;",
                                                           assign(operands[0], result, type)]
        if i.name == "shfl" and modifiers - {"sync", "b32"} in ({"up"}, {"down"}, {"idx"}):
            mode = (modifiers - {"sync", "b32"}).pop()
            to, _, in_range = operands[0].partition("|")
            b, c = f"({value(operands[2], 'u32')} & 31)", value(operands[3], "u32")
            source = {"up": f"int(k) - int({b})", "down": f"int(k) + int({b})",
                      "idx": f"int((k & {c} >> 8 & 31) | ({b} & ~({c} >> 8)))"}[mode]
            read = f'if (!(lanes >> from[k].lane & 1)) fail(l, "shfl reads an absent lane", 0, 0, {i.line}); '
            return "warp", value(operands[4], "u32"), "", [
                f"x[k] = {value(operands[1], 'u32')}; from[k] = shuffle(k, {source}, {c}, {str(mode == 'up').lower()});",
                read + assign(to, "x[from[k].lane]", "u32")
                + (assign(in_range, "from[k].in_range", "pred") if in_range else "")]
        if i.name == "bar" and i.modifiers == ["warp", "sync"]:
            return "sync", value(operands[0], "u32"), "", []
        if i.name == "bar" and i.modifiers == ["sync"] and len(operands) == 1:
            return "barrier", value(operands[0], "u32"), "", []
        if i.name == "bar" and i.modifiers == ["red", "or", "pred"] and len(operands) == 3:
            return "barrier", value(operands[1], "u32"), value(operands[2], "pred"), [
                assign(operands[0], "l.block->any_true", "pred")]
        raise Unsupported(i.text)


def signature(function, name):
    pointers = [f"char* returned{i}" for i in range(len(function.returned))] \
        + [f"char* parameter{i}" for i in range(len(function.parameters))]
    return f"void {name}({', '.join(['lane& l', *pointers])})"


def thread_function(module, function):
    body, writer = function.body, Writer(module, function, set())
    used = {name for item in body.items if not isinstance(item, str) for name in item.registers()}
    lines = ['extern "C" [[gnu::visibility("default")]]',
             signature(function, "translated_" + hash_of(function.name)) + " {",
             *declarations(used & set(body.registers), body), *arguments(body.arguments), "bool carry = false;",
             f"const frame_scope frame(l, {writer.frame_bytes}, {function.line});",
             *(f"std::memcpy(reinterpret_cast<char*>({writer.address_of(v.name)}), {writer.pointers[v.name]}, {v.bytes});"
               for v in writer.addressed)]
    for item in body.items:
        if isinstance(item, str):
            lines.append(f"{Writer.identifier(item)}:;")
        elif item.name in MEETINGS or item.name == "exit":
            raise Unsupported("in a function: " + item.text)
        elif item.name in ("bra", "ret"):
            to = f"goto {Writer.identifier(item.operands[0])};" if item.name == "bra" else "return;"
            lines.append(f"if ({writer.value(item.guard, 'pred')}) {to}" if item.guard else to)
        else:
            lines.append(writer.statement(item))
    return [*lines, "}"], writer


def hash_of(text):
    """The hash of modules.cpp, which names files and symbols."""
    h, data = 0xcbf29ce484222325, text.encode()
    for at in range(0, len(data), 8):
        h = (h ^ int.from_bytes(data[at:at + 8], "little")) * 0x100000001b3 % 2**64
        h ^= h >> 32
    return f"{h:016x}"


def source(module, functions):
    """One C++ file of translated functions: pairs of lines and a writer."""
    bodies = ["\n".join(lines) for lines, _ in functions]
    called = sorted(set().union(*(writer.called for _, writer in functions)))
    head = ['#include "ptx.hpp"', "using namespace ptx;", "namespace {"]
    head += [signature(module.functions[f], f"(*f_{Writer.identifier(f)})").replace(")(", ")(") + ";" for f in called]
    used = [[v for v in module.globals.values() if f"g_{Writer.identifier(v.name)}" in body] for body in bodies]
    for v in {v.name: v for part in used for v in part}.values():
        head.append(f"u64 g_{Writer.identifier(v.name)};")
        if v.initial:
            head.append(f"const unsigned char i_{Writer.identifier(v.name)}[{v.bytes}] = "
                        f"{{{', '.join(map(str, v.initial))}}};")
    head.append("}")
    for (_, writer), part in zip(functions, used):
        rows = [f'{{"{v.name}", {v.bytes}, {"i_" + Writer.identifier(v.name) if v.initial else "nullptr"}, '
                f"&g_{Writer.identifier(v.name)}}}, " for v in part]
        head.append(f'extern "C" [[gnu::visibility("default")]] const variable '
                    f"variables_{hash_of(writer.function.name)}[] = {{{''.join(rows)}{{nullptr, 0, nullptr, nullptr}}}};")
    return "\n".join([*head, *bodies, ""])


def translate(module, name):
    function = module.functions[name]
    if not function.is_kernel:
        return thread_function(module, function)
    kernel = Kernel(module, function)
    return kernel.write(), kernel.writer


def files(module, name, exists):
    """Translates a function and those that it calls, directly or not, and that do not exist yet. Returns their names,
    and C++ files of at most LARGE characters where functions are not larger."""
    names, chunks, size = [name], [], LARGE
    for each in names:
        lines, writer = translate(module, each)
        names += sorted(f for f in writer.called if f not in names and not exists(f))
        characters = sum(map(len, lines))
        if size + characters > LARGE:
            chunks.append([])
            size = 0
        chunks[-1].append((lines, writer))
        size += characters
    return names, [source(module, chunk) for chunk in chunks]


def compile_file(compiler, cpp, text):
    pathlib.Path(cpp).write_text(text)
    level = os.environ.get("PTXEMU_LEVEL", "-O0")
    subprocess.run([*compiler, level, *FLAGS, "-I", os.path.dirname(os.path.abspath(__file__)), "-c", "-o", cpp + ".o",
                    cpp], check=True)
    return cpp + ".o"


def main(ptx_file, name, output, *compiler):
    folder = pathlib.Path(output).parent
    with open(output + ".lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)  # other processes may want the same
        if os.path.exists(output):
            return
        try:
            names, texts = files(Module(pathlib.Path(ptx_file).read_text()), name,
                                 lambda f: (folder / f"{hash_of(f)}.so").exists())
        except Unsupported as why:
            sys.exit(f"{ptx_file}: {name}: not implemented by the emulator: {why}")
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as threads:
            objects = list(threads.map(lambda i: compile_file(compiler, f"{output}.{i}.cpp", texts[i]),
                                       range(len(texts))))
        subprocess.run([compiler[-1], "-shared", "-o", output + ".new", *objects], check=True)
        os.rename(output + ".new", output)
        for other in names[1:]:
            link = folder / f"{hash_of(other)}.so"
            new = f"{link}.{os.getpid()}"
            os.symlink(os.path.basename(output), new)
            os.rename(new, link)


if __name__ == "__main__":
    main(*sys.argv[1:])
