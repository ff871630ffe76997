"""Compilers for systems whose C library Debian lacks: zig's clang with its headers and libraries, from PyPI's ziglang."""
import os
import subprocess
import sys

VERSION = "0.12.1"  # clang 17.0
# The names that a build calls, with their commands of zig.
COMPILERS = {"zig-cc": "cc", "zig-c++": "c++"}
ARCHIVERS = {"zig-ar": "ar", "zig-ranlib": "ranlib"}


def make_tools(folder, target):
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
    """Returns options of CMake. __builtin_cpu_supports on x86-64 needs symbols that zig's runtime library lacks."""
    if not target.startswith("x86_64-linux"):
        return ()
    libgcc = subprocess.run(["gcc", "-print-libgcc-file-name"], check=True, stdout=subprocess.PIPE,
                            text=True).stdout.strip()
    return (f"-DCMAKE_CXX_STANDARD_LIBRARIES={libgcc}",)
