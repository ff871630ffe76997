"""Compilers for systems whose C library Debian does not have: zig's clang with the headers and libraries that come
with it, from PyPI's package ziglang.
"""
import os
import subprocess
import sys

VERSION = "0.12.1"  # clang 17.0
# What a build calls, and what of zig that is.
COMPILERS = {"zig-cc": "cc", "zig-c++": "c++"}
ARCHIVERS = {"zig-ar": "ar", "zig-ranlib": "ranlib"}


def make_tools(folder, target):
    """The folder of a target's tools, by the names above; makes them once."""
    installed, tools = folder / "env", folder / target
    python = installed / "bin" / "python"
    if not (installed / f".{VERSION}").exists():
        subprocess.run([sys.executable, "-m", "venv", installed], check=True)
        subprocess.run([python, "-m", "pip", "install", "-q", "--disable-pip-version-check", f"ziglang=={VERSION}"],
                       check=True)
        (installed / f".{VERSION}").touch()
    tools.mkdir(exist_ok=True)
    for name, command in {**COMPILERS, **ARCHIVERS}.items():
        of_target = f" -target {target}" if name in COMPILERS else ""
        script = f"""#!/bin/sh
ZIG_GLOBAL_CACHE_DIR={folder}/cache exec {python} -m ziglang {command}{of_target} "$@"
"""
        (tools / name).write_text(script)
        os.chmod(tools / name, 0o755)
    return tools


def options(target):
    """CMake's: of a program for x86-64 __builtin_cpu_supports asks a runtime library for what zig's lacks."""
    if not target.startswith("x86_64-linux"):
        return ()
    libgcc = subprocess.run(["gcc", "-print-libgcc-file-name"], check=True, stdout=subprocess.PIPE,
                            text=True).stdout.strip()
    return (f"-DCMAKE_CXX_STANDARD_LIBRARIES={libgcc}",)
