# shellcheck shell=bash disable=SC2034  # its variables are used by those who source it
# Functions for ./run and its scripts, which source this file: errors, headings, packages.

build_packages=(g++ cmake ninja-build libboost-dev libgmp-dev libhdf5-dev libmpfr-dev libcli11-dev
    nlohmann-json3-dev libtbb-dev libxsimd-dev)
test_packages=(libgtest-dev libeigen3-dev libflint-dev python3 libopenmpi-dev openmpi-bin pkg-config)
python_packages=(python3 python3-dev python3-venv)

# Packages of the distribution belong to its Python, which may not be the first on PATH.
python=/usr/bin/python3

fail() {
    printf 'run: %s\n' "$*" >&2
    exit 1
}

# fail_with_log FILE MESSAGE: prints the end of the log first.
fail_with_log() {
    tail -n 40 -- "$1" >&2
    fail "$2: $1"
}

# phase TITLE COMMAND...: runs the command under a heading with the time so far.
phase() {
    printf '\n== %s (%d s so far)\n' "$1" "$SECONDS"
    "${@:2}"
}

# Prints the commit, marked if files differ from it.
commit() { git describe --always --dirty --exclude='*' 2>/dev/null || echo unknown; }

# need PACKAGE...: fails with the names of missing packages, or installs them with ERRBOUND_INSTALL=1.
need() {
    local package missing=() as_root=()
    if ! command -v dpkg-query >/dev/null; then
        printf 'run: not Debian or Ubuntu; assuming that these are installed: %s\n' "$*" >&2
        return
    fi
    for package in "$@"; do
        # shellcheck disable=SC2016  # dpkg-query's own variable
        [[ $(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null) == installed ]] ||
            missing+=("$package")
    done
    ((${#missing[@]})) || return 0
    [[ ${ERRBOUND_INSTALL:-0} == 1 ]] ||
        fail "missing packages; install them, or set ERRBOUND_INSTALL=1: apt-get install ${missing[*]}"
    if ((EUID != 0)); then
        command -v sudo >/dev/null ||
            fail "missing packages, and no sudo to install them; as root: apt-get install ${missing[*]}"
        as_root=(sudo)
    fi
    printf 'installing %s\n' "${missing[*]}" >&2
    as_root+=(env DEBIAN_FRONTEND=noninteractive apt-get -qq -o Dpkg::Use-Pty=0)
    # Lists of other archives may fail to update. The installation decides.
    "${as_root[@]}" update || printf 'run: apt-get update failed; trying to install anyway\n' >&2
    for package in "${missing[@]}"; do
        # apt reads an unknown name as an expression: "g++-13" matches clang-13.
        [[ $package != *[+.]* ]] || apt-cache pkgnames "$package" | grep -xF "$package" >/dev/null ||
            fail "this distribution has no package $package"
    done
    "${as_root[@]}" install --yes --no-install-recommends "${missing[@]}" >/dev/null ||
        fail "apt-get could not install the missing packages: ${missing[*]}"
}
