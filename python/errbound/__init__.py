"""Exact continuous collision detection, predicates, roots, and numbers with certified error bounds.

Modules: ccd, bodies, predicates, roots, tracked, io (mesh, query and view files); show displays a step.
Import errbound.ipctk (needs ipctk), errbound.mpi (needs mpi4py), errbound.cuda (needs a CUDA device) and
errbound.autodiff (needs PyTorch or JAX) explicitly.

Arrays may have any memory order. Numbers are of any type, if doubles represent them exactly.
Arrays are copied unless they are C-contiguous float64, or C-contiguous int32 or uint32 for indices.
Errors: ValueError, TypeError or IndexError with the argument, the row, its value and the expected one.
Long calls release the interpreter's lock. Ctrl-C interrupts them.
"""
from . import bodies, ccd, io, predicates, roots, tracked
from ._native import FileError
from ._show import show

__all__ = ["FileError", "bodies", "ccd", "io", "predicates", "roots", "show", "tracked"]


def __getattr__(name: str) -> str:
    if name == "__version__":  # the metadata module is slow to import
        from importlib.metadata import version

        return version("errbound")
    raise AttributeError(f"module 'errbound' has no attribute {name!r}")
