"""Exact continuous collision detection, predicates, roots, and numbers that know their rounding error.

* ccd: which features of moving meshes touch, when first, where; steps, and steps that are free
* predicates: signs of geometric expressions, right on every finite input
* roots: real roots of polynomials, counted and isolated exactly
* tracked: arrays of numbers that carry a certified bound on their rounding error
* ipctk: for ipc-toolkit's package; imported by its name alone, since that must be there
* mpi: meshes that are spread over ranks; imported by its name alone, since mpi4py must be there
* io: files of meshes, of queries, and of steps to look at
* show: looks at a step, in polyscope or on a page for a browser

Arrays may be in any memory order and of float64, float32 (each float32 is a double, so nothing is
lost) or whole numbers that doubles hold; they are copied only where they are not C-contiguous
float64, or indices not C-contiguous int32 or uint32. What is wrong with an argument is a ValueError, TypeError or
IndexError that names the argument, the row, what was found and what was expected. Long calls
release the interpreter's lock, and Ctrl-C ends them.
"""
from . import ccd, io, predicates, roots, tracked
from ._native import FileError
from ._show import show

__all__ = ["FileError", "ccd", "io", "predicates", "roots", "show", "tracked"]


def __getattr__(name: str) -> str:
    if name == "__version__":  # asked of the package's metadata, which takes long to import
        from importlib.metadata import version

        return version("errbound")
    raise AttributeError(f"module 'errbound' has no attribute {name!r}")
