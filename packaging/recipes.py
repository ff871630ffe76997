"""Fills the recipes for vcpkg, conda-forge and Spack for a release, in the folders of their registries.

Arguments: source folder, folder of the release with the source archive, address where that will be found.
Where rattler-build's package is installed, the recipe for conda-forge is rendered by it.
"""
import hashlib
import re
import sys
from pathlib import Path

# Files of packaging/, with their paths under recipes/.
PLACES = {"vcpkg/vcpkg.json.in": "vcpkg/ports/errbound/vcpkg.json",
          "vcpkg/portfile.cmake.in": "vcpkg/ports/errbound/portfile.cmake",
          "vcpkg/usage": "vcpkg/ports/errbound/usage",
          "conda/recipe.yaml.in": "conda-forge/recipes/errbound/recipe.yaml",
          "spack/package.py.in": "spack/packages/errbound/package.py"}


def project_version(source):
    return re.search(r"project\(errbound VERSION (\S+)", (source / "CMakeLists.txt").read_text())[1]


def fill(source, url, archive_bytes):
    """Returns a dictionary from files under recipes/ to their texts."""
    version = project_version(source)
    values = {"VERSION": version, "URL": url, "ARCHIVE": f"errbound-{version}.tar.xz",
              "SHA256": hashlib.sha256(archive_bytes).hexdigest(),
              "SHA512": hashlib.sha512(archive_bytes).hexdigest()}
    return {place: re.sub("@([A-Z0-9]+)@", lambda m: values[m[1]], (source / "packaging" / name).read_text())
            for name, place in PLACES.items()}


def render_for_conda(text):
    try:
        from rattler_build import PlatformConfig, RenderConfig, Stage0Recipe, VariantConfig
    except ImportError:
        return "conda-forge: not rendered; rattler-build is not installed"
    recipe = Stage0Recipe.from_yaml(text)
    variants = VariantConfig.from_yaml("python:\n- 3.12.* *_cpython\nc_stdlib:\n- sysroot\n")
    rendered = recipe.render(variants, RenderConfig(platform=PlatformConfig(target_platform="linux-64")))
    return "conda-forge: rendered as " + ", ".join(str(v.recipe.package.name) for v in rendered)


def main():
    source, release, url = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3]
    archive = release / f"errbound-{project_version(source)}.tar.xz"
    for place, text in fill(source, url, archive.read_bytes()).items():
        file = release / "recipes" / place
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
        print(file)
        if file.name == "recipe.yaml":
            print(render_for_conda(text))


if __name__ == "__main__":
    main()
