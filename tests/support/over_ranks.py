"""Programs over the ranks of MPI, for tests. MPIEXEC and MPIEXEC_NUMPROC_FLAG say how they are run."""

import os
import pathlib
import subprocess

ENVIRONMENT = dict(
    os.environ,
    OMPI_ALLOW_RUN_AS_ROOT="1",
    OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
    OMPI_MCA_rmaps_base_oversubscribe="1",
    OMPI_MCA_mpi_yield_when_idle="1",
)


def start(ranks, *command):
    """The running program, whose outputs are pipes."""
    over = [os.environ["MPIEXEC"], os.environ["MPIEXEC_NUMPROC_FLAG"], str(ranks)]
    return subprocess.Popen(
        [*over, *map(str, command)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=ENVIRONMENT,
    )


def run(ranks, *command):
    """Its exit status, output and errors."""
    process = start(ranks, *command)
    out, err = process.communicate(timeout=300)
    return process.returncode, out, err


def pids(process):
    """Those of the ranks, rank 0 first."""
    found = []
    for status in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = status.read_text().rsplit(")", 1)[1].split()
        except OSError:
            continue  # it has ended meanwhile
        if int(fields[1]) == process.pid:
            found.append(int(status.parent.name))
    return sorted(found)
