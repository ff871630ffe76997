"""Checks that the recipes in packaging/ agree with the project: version, options, licence, installed files.

Arguments: source folder, cmake. Recipes are filled as for a release. CMake runs vcpkg's and Python runs Spack's, with
substitutes for their functions that record the arguments.
"""
import hashlib
import importlib.util
import json
import re
import subprocess
import sys
import tempfile
import types
from pathlib import Path

ROOT = Path(sys.argv[1])
CMAKE = sys.argv[2]
ARCHIVE = b"the source archive"
URL = "https://example.org/errbound"


def load(name, path):
    spec = importlib.util.spec_from_file_location(name, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


sys.dont_write_bytecode = True
RECIPES = load("recipes", ROOT / "packaging/recipes.py")
VERSION = RECIPES.project_version(ROOT)
ARCHIVE_URL = f"{URL}/errbound-{VERSION}.tar.xz"
FILLED = RECIPES.fill(ROOT, URL, ARCHIVE)
CMAKE_TEXT = (ROOT / "CMakeLists.txt").read_text()
OPTIONS = set(re.findall(r"^(?:option|set)\((ERRBOUND_\w+)", CMAKE_TEXT, re.MULTILINE))
LICENCE = re.search(r'^license = "(.*)"', (ROOT / "pyproject.toml").read_text(), re.MULTILINE)[1]

wrong = []


def same(what, found, expected):
    if found != expected:
        wrong.append(f"{what} is {found!r}; expected {expected!r}")


def known_options(recipe, names):
    same(f"{recipe}: options that CMakeLists.txt does not have", sorted(set(names) - OPTIONS), [])
    same(f"{recipe}: sets options", bool(names), True)


RESTATED_VCPKG = """
cmake_minimum_required(VERSION 3.22)
function(note)
  string(REPLACE ";" " " said "${ARGN}")
  message(STATUS "NOTE ${said}")
endfunction()
function(vcpkg_check_linkage)
endfunction()
function(vcpkg_download_distfile out)
  note(download ${ARGN})
  set(${out} archive PARENT_SCOPE)
endfunction()
function(vcpkg_extract_source_archive out)
  set(${out} SOURCE PARENT_SCOPE)
endfunction()
function(vcpkg_check_features)
  cmake_parse_arguments(arg "" "OUT_FEATURE_OPTIONS" "FEATURES" ${ARGN})
  set(options)
  while(arg_FEATURES)
    list(POP_FRONT arg_FEATURES feature option)
    note(feature ${feature})
    list(APPEND options -D${option}=ON)
  endwhile()
  set(${arg_OUT_FEATURE_OPTIONS} ${options} PARENT_SCOPE)
endfunction()
function(vcpkg_cmake_configure)
  note(configure ${ARGN})
endfunction()
function(vcpkg_cmake_config_fixup)
  note(config ${ARGN})
endfunction()
function(vcpkg_copy_tools)
  note(tools ${ARGN})
endfunction()
function(vcpkg_install_copyright)
  note(licence ${ARGN})
endfunction()
function(vcpkg_cmake_install)
endfunction()
set(FEATURES ccd gmp tools)
set(PORT errbound)
"""


def check_vcpkg(folder):
    port = folder / "vcpkg/ports/errbound"
    manifest = json.loads((port / "vcpkg.json").read_text())
    same("vcpkg: version", manifest["version-semver"], VERSION)
    same("vcpkg: licence", manifest["license"], LICENCE)
    (folder / "run.cmake").write_text(
        RESTATED_VCPKG + f'set(CURRENT_PACKAGES_DIR "{folder}/packages")\ninclude("{port}/portfile.cmake")\n')
    ran = subprocess.run([CMAKE, "-P", folder / "run.cmake"], capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr
    notes = [line.split("NOTE ")[1] for line in ran.stdout.splitlines() if "NOTE" in line]
    said = " ".join(notes)
    same("vcpkg: features", sorted(n.split()[1] for n in notes if n.startswith("feature ")),
         sorted(manifest["features"]))
    known_options("vcpkg", re.findall(r"-D(\w+)=", said))
    same("vcpkg: address", ARCHIVE_URL in said, True)
    same("vcpkg: sum", hashlib.sha512(ARCHIVE).hexdigest() in said, True)
    same("vcpkg: usage installed", (folder / "packages/share/errbound/usage").exists(), True)
    same("vcpkg: licence file", (ROOT / re.search(r"SOURCE/(\S+)", said)[1]).exists(), True)


def check_conda(text):
    """Reads lines, since Python's library has no YAML reader. ./run release renders the recipe by rattler-build."""
    def one(pattern):
        return re.search(pattern, text, re.MULTILINE)[1]
    same("conda: version", one(r'^  version: "(.*)"'), VERSION)
    same("conda: address", one(r"^  url: (.*)"), ARCHIVE_URL)
    same("conda: sum", one(r"^  sha256: (.*)"), hashlib.sha256(ARCHIVE).hexdigest())
    same("conda: licence", one(r"^  license: (.*)"), LICENCE)
    same("conda: licence file", (ROOT / one(r"^  license_file: (.*)")).exists(), True)
    known_options("conda", re.findall(r"-D(ERRBOUND_\w+)=", text))
    same("conda: headers that are not there",
         [h for h in re.findall(r"^ +- (\S+\.hpp)$", text, re.MULTILINE) if not (ROOT / "include" / h).exists()], [])
    project = (ROOT / "pyproject.toml").read_text()
    for name in re.findall(r'"(scikit-build-core|nanobind|numpy)>=', project):
        same(f"conda: {name}", one(rf"^ +- {name} >=(.*)"), re.search(rf'"{name}>=(.*?)"', project)[1])


class Package:
    """Substitutes for the base of Spack's package."""

    def define(self, name, value):
        return name

    def define_from_variant(self, name, variant):
        assert variant in self.noted["variant"], f"Spack: no variant {variant}"
        return name


class Nested:
    def __enter__(self):
        return self

    def __exit__(self, *_):
        return None


def restated_spack():
    """Returns modules for the recipe's imports, with directives that record their arguments."""
    Package.noted = {name: {} for name in ("version", "variant", "depends_on", "license")}
    module = types.ModuleType("spack.package")
    for name, into in Package.noted.items():
        setattr(module, name, lambda first, _into=into, **named: _into.setdefault(first, named))
    module.when = lambda condition: Nested()
    base = types.ModuleType("spack_repo.builtin.build_systems.cmake")
    base.CMakePackage = Package
    for full in "spack", "spack_repo", "spack_repo.builtin", "spack_repo.builtin.build_systems":
        sys.modules[full] = types.ModuleType(full)
    sys.modules[module.__name__], sys.modules[base.__name__] = module, base


def check_spack(folder):
    restated_spack()
    recipe = load("package", folder / "spack/packages/errbound/package.py").Errbound
    noted = recipe.noted
    same("Spack: version", noted["version"], {VERSION: {"sha256": hashlib.sha256(ARCHIVE).hexdigest()}})
    same("Spack: address", recipe.url, ARCHIVE_URL)
    same("Spack: licence", list(noted["license"]), [LICENCE])
    needed = re.search(r"cmake_minimum_required\(VERSION (\S+)\)", CMAKE_TEXT)[1]
    same("Spack: CMake", f"cmake@{needed}:" in noted["depends_on"], True)
    known_options("Spack", recipe().cmake_args())


def check_dependencies():
    """Checks that each library that CMake looks for is in each recipe, under its name there."""
    names = {"Boost": ("boost-multiprecision", "libboost-headers", "boost@"), "TBB": ("tbb", "tbb-devel", "tbb"),
             "xsimd": ("xsimd",) * 3, "CLI11": ("cli11",) * 3,
             "nlohmann_json": ("nlohmann-json", "nlohmann_json", "nlohmann-json")}
    looked_for = set(re.findall(r"find_package\((\w+)", (ROOT / "cmake/dependencies.cmake").read_text()))
    same("libraries without a name in recipes", sorted(looked_for - set(names) - {"Threads", "MPI"}), [])  # MPI: they do without
    recipes = [next(text for place, text in FILLED.items() if place.endswith(name))
               for name in ("vcpkg.json", "recipe.yaml", "package.py")]
    for name in looked_for & set(names):
        for text, there in zip(recipes, names[name]):
            if there not in text:
                wrong.append(f"{name}: no {there} in {text[:60]!r}")


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for place, text in FILLED.items():
            (folder / place).parent.mkdir(parents=True, exist_ok=True)
            (folder / place).write_text(text)
        check_vcpkg(folder)
        check_spack(folder)
    check_conda(FILLED["conda-forge/recipes/errbound/recipe.yaml"])
    check_dependencies()
    print(*wrong or [f"recipes of errbound {VERSION} agree with the project"], sep="\n")
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main())
