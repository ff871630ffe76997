"""The targets of ./run everywhere: processors, systems, compilers and emulators."""
import dataclasses


@dataclasses.dataclass(frozen=True)
class Target:
    name: str
    cxx: str
    cc: str
    processor: str = "x86_64"
    system: str = "Linux"
    triple: str = ""  # of a cross compiler; its C library is in /usr/TRIPLE
    emulator: tuple = ()
    flags: str = ""  # for all languages
    cxx_flags: str = ""
    level: str = "-O2"
    packages: tuple = ()
    options: tuple = ()  # more options of CMake
    refused: bool = False  # the headers must reject it with a message
    libraries: str = ""  # another target whose oneTBB, GoogleTest and GMP it uses
    zig: str = ""  # zig's name for it, if zig compiles it (zig.py)
    ar: str = ""  # ar and ranlib, if not the host's
    ranlib: str = ""
    only_compiled: str = ""  # the reason why its programs are not run


def cross(name, processor, triple, qemu, emulator=None, **more):
    """Returns a target of Debian's cross compiler, run by qemu's user-mode emulation by default."""
    package = "g++-" + triple.replace("_", "-")
    return Target(name, f"{triple}-g++", f"{triple}-gcc", processor, triple=triple,
                  emulator=emulator or (qemu, "-L", f"/usr/{triple}"), packages=(package, "qemu-user"), **more)


def gcc(name, version="", libraries="x86-64", **more):
    return Target(name, "g++" + version, "gcc" + version, packages=("g++" + version,), libraries=libraries, **more)


def clang(name, version="", **more):
    return Target(name, "clang++" + version, "clang" + version, packages=("clang" + version,), libraries="x86-64",
                  **more)


def zig(name, zig, triple, **more):
    """Returns a target of zig's clang, which has libc++ and C libraries that Debian lacks."""
    return Target(name, "zig-c++", "zig-cc", triple=triple, zig=zig, packages=("python3-venv", "libfast-float-dev"),
                  cxx_flags=LIBCXX_FLAGS, **more)


# Boost 1.74 uses a class that C++17 removed.
LIBCXX_FLAGS = "-D_LIBCPP_ENABLE_CXX17_REMOVED_UNARY_BINARY_FUNCTION"
# x86-64 runs programs of i386; qemu 7.2 does not terminate (docs/guarantees.md).
I386_LOADER = ("/usr/i686-linux-gnu/lib/ld-linux.so.2", "--library-path", "/usr/i686-linux-gnu/lib")

TARGETS = [
    cross("aarch64", "aarch64", "aarch64-linux-gnu", "qemu-aarch64"),
    cross("s390x", "s390x", "s390x-linux-gnu", "qemu-s390x"),
    cross("i386-sse2", "i686", "i686-linux-gnu", "qemu-i386", I386_LOADER, flags="-msse2 -mfpmath=sse"),
    cross("i386-x87", "i686", "i686-linux-gnu", "qemu-i386", refused=True),
    cross("armhf", "armv7l", "arm-linux-gnueabihf", "qemu-arm"),
    # Atomic bytes before g++ 13 need a library that a static oneTBB does not link.
    cross("riscv64", "riscv64", "riscv64-linux-gnu", "qemu-riscv64",
          options=("-DCMAKE_CXX_STANDARD_LIBRARIES=-latomic",)),
    cross("ppc64le", "ppc64le", "powerpc64le-linux-gnu", "qemu-ppc64le"),
    Target("x86-64", "g++", "gcc"),
    gcc("x86-64-O0", level="-O0"),
    gcc("x86-64-O3", level="-O3"),
    gcc("x86-64-lto", options=("-DCMAKE_INTERPROCEDURAL_OPTIMIZATION=ON",)),
    gcc("x86-64-v4", flags="-march=x86-64-v4"),
    gcc("x86-64-fast-math", flags="-ffast-math", refused=True),
    gcc("x86-64-contract", cxx_flags="-march=x86-64-v3 -ffp-contract=fast"),
    gcc("x86-64-c++23", options=("-DCMAKE_CXX_STANDARD=23",)),
    # Debian 12's oneTBB passes options to g++ that version 11 rejects.
    gcc("x86-64-g++-11", "-11"),
    # Libraries built by a newer g++ (Debian 13) may need symbols that an older libstdc++ lacks.
    gcc("x86-64-g++-13", "-13", libraries=""),
    gcc("x86-64-g++-14", "-14", libraries=""),
    clang("x86-64-clang"),
    clang("x86-64-clang-15", "-15"),
    clang("x86-64-clang-16", "-16"),
    clang("x86-64-clang-17", "-17"),
    clang("x86-64-clang-18", "-18"),
    clang("x86-64-clang-19", "-19"),
    Target("x86-64-libc++", "clang++-16", "clang-16", cxx_flags="-stdlib=libc++ " + LIBCXX_FLAGS,
           packages=("clang-16", "libc++-16-dev", "libc++abi-16-dev", "libfast-float-dev")),
    Target("windows", "x86_64-w64-mingw32-g++-posix", "x86_64-w64-mingw32-gcc-posix", system="Windows",
           triple="x86_64-w64-mingw32", emulator=("/usr/lib/wine/wine64",),
           # Without -mfma the compiler calls the C library's fma, which rounds twice. The headers reject that.
           flags="-mfma", cxx_flags="-static",
           packages=("g++-mingw-w64-x86-64", "wine64")),
    zig("musl", "x86_64-linux-musl", "x86_64-linux-musl"),
    zig("macos", "aarch64-macos", "aarch64-apple-darwin", processor="arm64", system="Darwin",
        only_compiled="no macOS to run it on"),
]
