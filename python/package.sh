#!/usr/bin/env bash
# Builds the Python package and installs it in the virtual environment out/python/env.
#
# package.sh            Then runs mypy and the tests. ERRBOUND_VIEWERS=1 adds tests with a browser, VTK,
#                       polyscope and ipctk (1.2 GB).
#
# package.sh --cuda     The same, with errbound.cuda. Device code takes minutes (nvcc).
#
# package.sh --emulated Tests errbound.cuda without a device (tests/ccd/cuda/emulator).
#
# package.sh --bench    Then measures the cost of calls next to C++.
#
# package.sh --site     Builds the site, out/docs/site, with both references, and checks its links.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
# shellcheck source=cmake/packages.sh
source cmake/packages.sh
out=$PWD/out/python
env=$out/env/bin/python
with_cuda=OFF
pip() { "$env" -m pip "$1" -q --disable-pip-version-check "${@:2}"; }

make_environment() { [[ -x $env ]] || "$python" -m venv "$out/env"; }

# Returns 1 if pip's index cannot be reached.
make_package() {
    local with_mpi=OFF
    make_environment
    pip install build mypy numpy pytest || return 1
    if command -v mpirun >/dev/null && pip install mpi4py; then with_mpi=ON; fi
    rm -rf -- "$out/dist"
    {
        "$env" -m build --sdist -o "$out/dist" . &&
            pip wheel --no-deps -w "$out/dist" --config-settings cmake.define.ERRBOUND_WITH_MPI="$with_mpi" \
                --config-settings cmake.define.ERRBOUND_WITH_CUDA="$with_cuda" "$out"/dist/*.tar.gz
    } >"$out/log" 2>&1 || fail_with_log out/python/log 'the Python package cannot be built'
    pip install --force-reinstall --no-deps "$out"/dist/*.whl
    du -h "$out"/dist/*
}

skip() {
    printf 'skipped: %s\n' "$*"
    exit 0
}
make_package_or_skip() { make_package || skip 'the package index of pip cannot be reached'; }

test_emulated() {
    command -v nvcc >/dev/null || skip 'no nvcc'
    need "${test_packages[@]}"
    make_environment
    pip install nanobind numpy || skip 'the package index of pip cannot be reached'
    cmake --preset release -B "$out/emulated" -DERRBOUND_CUDA_CODES=compute_75 -DERRBOUND_EMULATE_CUDA=ON \
        -DERRBOUND_BUILD_PYTHON=ON -DPython_EXECUTABLE="$env" -Dnanobind_DIR="$("$env" -m nanobind --cmake_dir)" \
        >"$out/log"
    "$python" cmake/run_tests.py "$out/emulated" -R '^cuda_python_emulated_test$'
}

install_viewers() {
    if [[ -n $(apt-cache madison chromium-headless-shell 2>/dev/null) ]]; then
        need chromium-headless-shell
    fi
    pip install h5py pillow playwright polyscope vtk ipctk
}

need "${build_packages[@]}" "${python_packages[@]}"
if [[ ${1:-} == --cuda ]]; then
    command -v nvcc >/dev/null || fail 'there is no nvcc; expected it on the PATH for --cuda'
    with_cuda=ON
    shift
fi
case ${1:-} in
    --emulated) test_emulated ;;
    --site)
        need doxygen
        wheel=$(find "$out/dist" -name '*.whl' 2>/dev/null || true)
        if [[ -z $wheel || -n $(find python/errbound python/src -type f ! -name '*.pyc' -newer "$wheel" -print -quit) ]]
        then make_package_or_skip; fi
        pip install mkdocs-material pdoc
        "$env" docs/site/build.py
        ;;
    --bench)
        make_package_or_skip
        cmake --preset bench -DERRBOUND_BUILD_TESTS=OFF >/dev/null
        cmake --build --preset bench --target errbound_python_peer
        "$env" python/bench/compare.py build/rooms/python/errbound_python_peer
        ;;
    '')
        make_package_or_skip
        if [[ ${ERRBOUND_VIEWERS:-0} == 1 ]]; then
            (install_viewers) || printf 'run: viewers cannot be installed; their tests are skipped\n'
        fi
        "$env" -m mypy -p errbound
        "$env" -m pytest -q -rs
        ;;
    *) fail "python is given $*; expected nothing, --cuda, --emulated, --bench or --site" ;;
esac
