"""Checks that the programs use no function that only glibc has, so that they link on macOS and BSDs.

Arguments: nm, the programs, and --beside LIBRARY for each foreign archive in them (CUDA's runtime, for Linux only),
whose functions are not checked.
"""
import argparse
import re
import subprocess
import sys

# Functions of ISO C and of POSIX.1-2008.
C = """abort acos asin atan atan2 acosh asinh atanh calloc cbrt ceil cos cosh exp exp2 expm1 fclose fflush floor
floorf floorl fma fmax fmin fmod fopen fprintf fputc fputs frexp free fwrite getenv gmtime hypot ilogb isalnum isalpha
isspace ldexp llrint llround localeconv log log10 log1p log2 logb lrint lround malloc memchr memcmp
memcpy memmove memset modf nearbyint nextafter pow printf putc putchar puts raise realloc remainder
rename rint round scalbn setlocale signal sin sinh snprintf sqrt stderr stdin stdout strchr strcmp
strcpy strerror strftime strlen strncmp strtod strtol strtold strtoll strtoull tan tanh time trunc
vsnprintf""".split()
POSIX = """access close execlp fchmod fcntl fork fstat fsync ftruncate getpid getrlimit getrusage isatty kill
mkstemp mmap munmap nanosleep open pread pthread_cond_broadcast pthread_cond_signal
pthread_cond_wait pthread_create pthread_join pthread_mutex_lock pthread_mutex_unlock pthread_once
pthread_self realpath sched_yield shmdt sigaction stat sysconf unlink waitpid write _exit""".split()
# Functions of neither that macOS and BSDs also have.
BSD = ["bcmp", "flock", "getloadavg"]
# Functions of glibc that are used only if they exist (include/errbound/validation/expression.hpp).
GLIBC = ["fmaf128", "sqrtf128"]
# Functions that the compiler (sincos for sin and cos) and the C++ library (timed waits, where glibc has it) use.
INTERNAL = re.compile(r"__\w+|sincos[fl]?|syscall|pthread_cond_clockwait")
MATHEMATICS = {f"{name}{suffix}" for name in C for suffix in "fl"}

parser = argparse.ArgumentParser()
parser.add_argument("nm")
parser.add_argument("programs", nargs="+")
parser.add_argument("--beside", action="append", default=[])
options = parser.parse_args()


def undefined(*arguments):
    return subprocess.run([options.nm, "--undefined-only", *arguments], check=True, stdout=subprocess.PIPE,
                          text=True).stdout


known = {*C, *POSIX, *BSD, *GLIBC, *MATHEMATICS}
for library in options.beside:
    known |= set(re.findall(r" U (\w+)$", undefined(library), re.M))
found = set()
for program in options.programs:
    found |= set(re.findall(r" (\w+)@+GLIBC_", undefined("-D", program)))
if not found:
    sys.exit(f"number of glibc functions in {options.programs} is 0; expected some")
others = sorted(name for name in found - known if not INTERNAL.fullmatch(name))
print(f"{len(found)} functions of the C library; neither of C, POSIX.1-2008 nor BSDs: {others or 'none'}")
sys.exit(bool(others))
