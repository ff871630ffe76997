"""./run everywhere: builds and tests the library for other processors, systems and compilers.

It runs errbound_everywhere, whose hashes must be equal on all targets, and prints one table. The libraries of a target
are built in out/everywhere from the distribution's source: oneTBB, GoogleTest and, for tests, GMP. Headers that are
equal for all targets are copied to a folder there.
"""
import argparse
import dataclasses
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time

import instructions
import zig
from targets import TARGETS

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "cmake"))
import run_tests  # noqa: E402
OUT = ROOT / "out" / "everywhere"
HEADERS = OUT / "headers"
ROW = "{:<18}{:<40}{:>10}{:>8}{:>8}  {}"
# Header-only libraries of Debian: the places of their CMake files in the package and among the targets' headers. Some
# systems have xtl, and xsimd's files outside of the processor's folder.
INCLUDES = ["boost", "xsimd", "CLI", "nlohmann", "eigen3", "xtl", "fast_float"]
CMAKE_FILES = {"share/cmake/CLI11": "share/cmake/CLI11", "share/cmake/nlohmann_json": "share/cmake/nlohmann_json",
               "share/eigen3/cmake": "share/cmake/eigen3", "share/cmake/xsimd": "share/cmake/xsimd",
               "share/cmake/xtl": "share/cmake/xtl", "lib/*/cmake/xsimd": "lib/host/cmake/xsimd"}


# Floating-point instructions of SIMD kernels in objdump's output: packed and scalar.
ARITHMETIC = {
    "aarch64": (r"f(?:add|sub|mul|div|cm[a-z]+|min|max|sqrt|abs|neg)\s+v\d+\.(?:2d|4s)",
                r"f(?:add|sub|mul|div|cmpe?|min|max|sqrt|abd)\s+[sd]\d+"),
    "x86_64": (r"v?(?:add|sub|mul|div|cmp[a-z]*|min|max|sqrt)p[sd]",
               r"v?(?:add|sub|mul|div|cmp[a-z]*|u?comi|min|max|sqrt)s[sd]"),
}
LEAST_PACKED = 0.95
# The scale of random tests under an emulator (tests/support/scaled.hpp), as under valgrind.
EMULATED_SCALE = "0.01"
PROGRAMS = ["errbound_everywhere", "ccd_program"]
# Targets whose baseline kernels have packs of two doubles. Instructions of the second are compared with the first's.
COUNTED = ["x86-64", "aarch64"]


class Failed(Exception):
    """The reason of a failed row."""


class Missing(Failed):
    """The reason why this machine cannot fill a row."""


def link_headers():
    """Makes a folder of headers, since the host's also has those of its C library."""
    if HEADERS.exists():
        return
    (HEADERS / "include").mkdir(parents=True)
    for name in INCLUDES:
        if pathlib.Path("/usr/include", name).exists():
            (HEADERS / "include" / name).symlink_to(f"/usr/include/{name}")
    for source, to in CMAKE_FILES.items():
        for folder in pathlib.Path("/usr").glob(source):
            shutil.copytree(folder, HEADERS / to, dirs_exist_ok=True)


class Build:
    """One target's folder: log, libraries, build."""

    def __init__(self, target, jobs, log=None):
        self.target, self.jobs = target, jobs
        self.folder = OUT / target.name
        self.folder.mkdir(parents=True, exist_ok=True)
        self.log = log or self.folder / "log"
        if log is None:
            self.log.write_text("")
        libraries = OUT / (target.libraries or target.name) / "libraries"
        values = {"SYSTEM": target.system, "PROCESSOR": target.processor, "TRIPLE": target.triple,
                  "CC": target.cc, "CXX": target.cxx, "FLAGS": target.flags, "CXX_FLAGS": target.cxx_flags,
                  "AR": target.ar, "RANLIB": target.ranlib, "EMULATOR": ";".join(target.emulator),
                  "HEADERS": str(HEADERS), "LIBRARIES": str(libraries)}
        self.libraries = libraries
        # Wine needs UTF-8 for names beyond Latin-1; other targets ignore it.
        self.environment = {**os.environ, "WINEDEBUG": "-all", "WINEPREFIX": str(self.folder / "wine"),
                            "LC_ALL": "C.UTF-8",
                            **{"ERRBOUND_" + name: value for name, value in values.items()}}
        if target.emulator:
            self.environment.setdefault("ERRBOUND_TEST_SCALE", EMULATED_SCALE)

    def run(self, *command, why, check=True):
        with self.log.open("ab") as log:
            log.write(f"\n== {' '.join(map(str, command))}\n".encode())
            log.flush()
            begin = log.tell()
            done = subprocess.run(command, env=self.environment, stdout=log, stderr=subprocess.STDOUT)
        text = self.log.read_bytes()[begin:].decode(errors="replace")
        if check and done.returncode != 0:
            raise Failed(f"{why}: {self.log.relative_to(ROOT)}")
        return done.returncode, text

    def cmake(self, source, folder, *options):
        self.run("cmake", "-G", "Ninja", "-S", source, "-B", self.folder / folder,
                 f"-DCMAKE_TOOLCHAIN_FILE={ROOT}/tests/everywhere/toolchain.cmake",
                 "-DCMAKE_BUILD_TYPE=Release", f"-DCMAKE_CXX_FLAGS_RELEASE={self.target.level} -DNDEBUG",
                 "-DERRBOUND_TEST_FLAGS=", *self.target.options, *options, why="cannot be configured")

    def make(self, folder, *targets):
        self.run("cmake", "--build", self.folder / folder, "--target", *targets, "--", f"-j{self.jobs}",
                 why="does not compile")

    def make_library(self, name, source, *options):
        done = self.libraries / f".{name}"
        if not done.exists():
            self.cmake(source, name, f"-DCMAKE_INSTALL_PREFIX={self.libraries}",
                       "-DCMAKE_INSTALL_LIBDIR=lib", "-DBUILD_SHARED_LIBS=OFF", *options)
            self.make(name, "install")
            done.touch()

    def make_gmp(self):
        """Builds GMP for the oracles of tests. The library does not use it."""
        if not self.target.triple:
            multiarch = subprocess.run(["gcc", "-print-multiarch"], check=True, stdout=subprocess.PIPE,
                                       text=True).stdout.strip()
            for folder, file in (("include", "gmp.h"), ("lib", "libgmp.a")):
                to = self.libraries / folder / file
                if not to.exists():
                    to.symlink_to(f"/usr/{folder}/{multiarch}/{file}")
            return
        done = self.libraries / ".gmp"
        if not done.exists():
            folder, source = self.folder / "gmp", source_of("gmp")
            folder.mkdir(exist_ok=True)
            # configure requires the manual, which Debian removes because of its licence.
            (source / "doc").mkdir(exist_ok=True)
            (source / "doc" / "Makefile.in").write_text("all install:\n")
            self.run("env", "-C", folder, source / "configure", f"--host={self.target.triple}",
                     f"--prefix={self.libraries}", "--disable-shared", "--disable-assembly",
                     f"CC={self.target.cc}", f"CFLAGS=-O2 {self.target.flags}", why="GMP cannot be configured")
            self.run("make", "-C", folder, f"-j{self.jobs}", "install", why="GMP does not compile")
            done.touch()

    def make_libraries(self, with_tests):
        if self.target.libraries:
            owner = next(t for t in TARGETS if t.name == self.target.libraries)
            Build(owner, self.jobs, self.log).make_libraries(with_tests)
            return
        self.make_library("onetbb", source_of("onetbb"), "-DTBB_STRICT=OFF", "-DTBB_TEST=OFF",
                          "-DTBBMALLOC_BUILD=OFF", "-DTBB_DISABLE_HWLOC_AUTOMATIC_SEARCH=ON", "-Wno-dev")
        self.make_library("googletest", "/usr/src/googletest", "-DBUILD_GMOCK=OFF")
        if with_tests:
            self.make_gmp()

    def prepare(self, with_tests):
        self.make_libraries(with_tests)
        self.cmake(ROOT, "build", *(f"-DERRBOUND_WITH_{x}=OFF" for x in ("CUDA", "MPI", "HDF5", "MPFR")))

    def refusal(self):
        """Checks the error of the headers for a compiler that they reject."""
        source = self.folder / "headers.cpp"
        source.write_text("#include <errbound/errbound.hpp>\n")
        flags = f"{self.target.flags} {self.target.cxx_flags}".split()
        status, text = self.run(self.target.cxx, "-std=c++20", "-fsyntax-only", *flags, f"-I{ROOT}/include",
                                source, why="", check=False)
        said = re.search(r'error "?errbound: ([^:;\n"]*)', text)
        if status == 0 or not said:
            raise Failed("not refused")
        return "refused: " + said[1]

    def program(self, name):
        self.make("build", name)
        path = self.folder / "build" / "tests" / "everywhere" / name
        return path if path.exists() else path.with_suffix(".exe")

    def hash(self):
        """Returns the hash of all answers, and True if it is the expected one."""
        program = self.program("errbound_everywhere")
        status, text = self.run(*self.target.emulator, program, why="", check=False)
        differing = re.findall(r"^(.*?) +\d+ .*DIFFERS$", text, re.MULTILINE)
        found = re.search(r"^all .* ([0-9a-f]{16}) ", text, re.MULTILINE)
        if found is None:
            raise Failed(f"errbound_everywhere ended with {status}: {self.log.relative_to(ROOT)}")
        if status == 0:
            return found[1] + " equal", True
        return found[1] + " other: " + ", ".join(differing), False

    def packed(self):
        """Returns the packed share of the baseline kernels' arithmetic, as text, and True if it is almost all."""
        patterns = ARITHMETIC.get(self.target.processor)
        objdump = shutil.which(f"{self.target.triple}-objdump") or "objdump"
        if patterns is None or self.target.system != "Linux" or self.target.level == "-O0":
            return "-", True
        folder = self.folder / "build/rooms/ccd/batch/CMakeFiles/errbound_kernels_baseline.dir"
        code = "".join(subprocess.run([objdump, "-d", "--no-show-raw-insn", file], check=True,
                                      stdout=subprocess.PIPE, text=True).stdout for file in folder.rglob("*.o"))
        of_packs, single = (len(re.findall(rf"\t{p}\b", code)) for p in patterns)
        if of_packs == 0 and "lto" in self.target.name:  # no instructions yet
            return "-", True
        part = of_packs / (of_packs + single) if of_packs else 0
        return f"{part:.1%}", part >= LEAST_PACKED

    def make_all(self, label):
        build = self.folder / "build"
        tests = run_tests.chosen(build, chosen_by(label)) if label else []
        self.make("build", *PROGRAMS, *run_tests.targets_of(build, tests))

    def tests(self, label):
        build, chosen = self.folder / "build", chosen_by(label)
        self.make_all(label)
        report = self.folder / "tests.xml"
        self.run("ctest", "--test-dir", build, "--output-on-failure", *chosen, "--output-junit", report,
                 f"-j{self.jobs}", why="", check=False)
        counts = {name: int(number) for name, number in
                  re.findall(r'\b(tests|failures|skipped|disabled)="(\d+)"', report.read_text())}
        run = counts["tests"] - counts["skipped"] - counts["disabled"]
        return f"{run - counts['failures']} of {run}", counts["failures"] == 0 and run > 0


def chosen_by(label):
    return ["-L", label, "-LE", "^sources$"]


def source_of(package):
    folder = OUT / package
    if not any((folder / "source").glob(f"{package}-*/")):
        folder.mkdir(parents=True, exist_ok=True)
        with open(folder / "log", "w") as log:
            subprocess.run([ROOT / "tests/everywhere/fetch_source.sh", package, folder], stdout=log, stderr=log)
    source = next((folder / "source").glob(f"{package}-*/"), None)
    if source is None:
        raise Failed(f"the source of {package} cannot be fetched: {(folder / 'log').relative_to(ROOT)}")
    return source


def with_compiler(target):
    if not target.zig:
        return target
    try:
        tools = zig.make_tools(OUT / "zig", target.zig)
    except subprocess.CalledProcessError as error:
        raise Missing(f"cannot be run: zig cannot be installed ({error})") from error
    return dataclasses.replace(target, cc=str(tools / "zig-cc"), cxx=str(tools / "zig-c++"), ar=str(tools / "zig-ar"),
                               ranlib=str(tools / "zig-ranlib"), options=target.options + zig.options(target.zig))


def compiler_of(target):
    for tool in (target.cxx, *target.emulator[:1]):
        if shutil.which(tool) is None:
            raise Missing(f"cannot be run: no {tool} here (packages {', '.join(target.packages)})")
    first = subprocess.run([target.cxx, "--version"], check=True, stdout=subprocess.PIPE, text=True).stdout
    version = re.search(r"\d+\.\d+\.\d+", first)
    kind = "clang" if "clang" in first else "g++"
    return " ".join(filter(None, [kind, version and version[0], target.flags or target.cxx_flags, target.level]))


def print_row(target, label, jobs, needed):
    """True if the row passes. Parts that this machine lacks may be missing, unless they are required."""
    start = time.monotonic()
    compiler, tests, packed = "", "-", "-"
    try:
        target = with_compiler(target)
        compiler = compiler_of(target)
        build = Build(target, jobs)
        passed = equal = True
        if target.refused:
            text = build.refusal()
        elif target.only_compiled:
            build.prepare(bool(label))
            build.make_all(label)
            text = "compiles: " + target.only_compiled
        else:
            build.prepare(bool(label))
            text, equal = build.hash()
            packed, vectorised = build.packed()
            equal = equal and vectorised
        if label and not target.refused and not target.only_compiled:
            tests, passed = build.tests(label)
    except Missing as why:
        text, equal, passed = str(why), not needed, True
    except Failed as why:
        text, equal, passed = str(why), False, True
    print(ROW.format(target.name, compiler[:39], tests, packed, f"{time.monotonic() - start:.0f} s", text),
          flush=True)
    return equal and passed


def print_instructions(jobs):
    programs = []
    try:
        for target in (next(t for t in TARGETS if t.name == name) for name in COUNTED):
            compiler_of(target)
            build = Build(target, jobs)
            build.prepare(False)
            emulator = target.emulator or (f"qemu-{target.processor}",)
            programs.append((target.name, emulator, build.program("errbound_counted_queries")))
        return instructions.print_table(*programs)
    except (Failed, instructions.Failed) as why:
        print(why)
        return False


def jobs(text):
    most = 1024
    number = int(text) if text.isascii() and text.isdigit() else 0
    if not 1 <= number <= most:
        raise argparse.ArgumentTypeError(f"value is '{text}'; expected a number from 1 to {most}")
    return number


def expression(text):
    try:
        re.compile(text)
    except re.error as error:
        raise argparse.ArgumentTypeError(f"value is '{text}'; expected a regular expression ({error})") from error
    return text


def main():
    names = ", ".join(t.name for t in TARGETS)
    parser = argparse.ArgumentParser(prog="./run everywhere", description=__doc__.split("\n\n")[0],
                                     allow_abbrev=False)
    parser.add_argument("targets", nargs="*", metavar="TARGET", help="by default all; one whose compiler this machine "
                        f"cannot have is a failure only if it is named: {names}")
    parser.add_argument("--tests", metavar="LABEL", type=expression, default="^(unit|property)$",
                        help="of which label, a regular expression; '' for none (%(default)s); those of the "
                        "label `sources`, which are the same for all, are left out")
    parser.add_argument("--jobs", metavar="N", type=jobs, default=os.cpu_count(),
                        help="number of compilers or tests at a time (%(default)s)")
    parser.add_argument("--instructions", action="store_true",
                        help=f"instead of rows, instructions per query of the kernels of {' and '.join(COUNTED)}")
    parser.add_argument("--packages", action="store_true",
                        help="instead of rows, the packages that these targets need, except those of every build")
    arguments = parser.parse_args()
    known = {t.name for t in TARGETS}
    unknown = set(arguments.targets) - known
    if unknown:
        parser.error(f"targets are {', '.join(map(repr, sorted(unknown)))}; expected some of {names}")
    if arguments.tests in known:
        parser.error(f"--tests is the target {arguments.tests}; expected a label of tests, or '' for none")
    if arguments.instructions and arguments.targets:
        parser.error(f"--instructions is given with targets; expected none, since they are {' and '.join(COUNTED)}")
    named = COUNTED if arguments.instructions else arguments.targets
    chosen = [t for t in TARGETS if t.name in named or not named]
    if arguments.packages:
        print(*sorted({p for t in chosen for p in t.packages}), sep="\n")
        return 0
    link_headers()
    if arguments.instructions:
        return 0 if print_instructions(arguments.jobs) else 1
    print(ROW.format("target", "compiler", "tests", "packed", "time", "hash"), flush=True)
    rows = [print_row(t, arguments.tests, arguments.jobs, bool(named)) for t in chosen]
    return 0 if all(rows) else 1


if __name__ == "__main__":
    sys.exit(main())
