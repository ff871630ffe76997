"""Steps of tiled scenes distributed over ranks: compares pairs, times and first contacts, and prints the balance.

Arguments: the benchmark program, mpirun, and --ranks-option with mpirun's option for the number of ranks. The status is
1 if results differ. --quick uses only the bundled scene.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
RANKS = (1, 2, 3, 5, 8)
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                   OMPI_MCA_rmaps_base_oversubscribe="1")


def arguments():
    parser = argparse.ArgumentParser(prog="./run bench --mpi",
                                     description="Steps of tiled scenes over the ranks of MPI.")
    for name in ("program", "mpirun"):
        parser.add_argument(name, help=argparse.SUPPRESS)
    parser.add_argument("--ranks-option", default="-n", help=argparse.SUPPRESS)
    parser.add_argument("--quick", action="store_true", help="only the bundled scene")
    parser.add_argument("--faces", type=int, default=10_000_000, metavar="N",
                        help="faces of the largest tiled scenes (default: 10,000,000)")
    parser.add_argument("--data", type=pathlib.Path, default=ROOT.parent / "shared/data/scenes",
                        metavar="DIR", help="stored scenes (default: ../shared/data/scenes)")
    return parser.parse_args()


def scenes(data, quick):
    """Yields each scene's name and its first two frames."""
    folders = [ROOT / "examples/scenes/cloth-over-ball"]
    if not quick and data.is_dir():
        folders += [folder / "frames" for folder in sorted(data.iterdir()) if (folder / "frames").is_dir()]
    elif not quick:
        print(f"skipped: no stored scenes in {data}")
    for folder in folders:
        frames = sorted(folder.glob("*.ply"), key=lambda f: (len(f.name), f.name))
        if len(frames) >= 2:
            yield (folder.parent if folder.name == "frames" else folder).name, frames[:2]


def measured(given, ranks, frames, *options):
    done = subprocess.run([given.mpirun, given.ranks_option, str(ranks), given.program, *map(str, frames),
                           *map(str, options)], capture_output=True, text=True, env=ENVIRONMENT)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, done.args))}: status {done.returncode}\n{done.stderr}")
    return json.loads(done.stdout)


def same(result, expected, what, failures):
    for key in ("hash", "pairs", "first_contact"):
        if result[key] != expected[key]:
            failures.append(f"{what}: {key} {result[key]}, expected {expected[key]}")


def spread(values):
    """Returns the sum over ranks, and the worst rank over the mean."""
    return sum(values), max(values) * len(values) / max(1, sum(values))


def table(rows):
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    for row in rows:
        print("  ".join(cell.rjust(w) if i else cell.ljust(w)
                        for i, (cell, w) in enumerate(zip(row, widths))).rstrip())
    print()


def row_of(name, copies, result):
    columns = {key: [rank[key] for rank in result["ranks"]]
               for key in ("given", "held", "sent", "candidates", "memory")}
    (given, _), (held, held_worst) = spread(columns["given"]), spread(columns["held"])
    (sent, _), (candidates, worst) = spread(columns["sent"]), spread(columns["candidates"])
    return [name, f"{copies:,}", f"{result['faces']:,}", str(len(result["ranks"])),
            f"{result['pairs']:,}", f"{held / max(1, given):.3f}", f"{held_worst:.2f}",
            f"{candidates:,}", f"{worst:.2f}", f"{sent / max(1, given):.0f}",
            f"{max(columns['memory']) / 2**20:.0f}"]


HEADING = ["scene", "copies", "faces", "ranks", "pairs", "held/given", "worst/mean",
           "candidates", "worst/mean", "bytes sent a face", "most MiB of a rank"]


def sizes(faces, largest):
    """Yields 1, 10, 100, ... copies, and the number that has `largest` faces."""
    copies, most = 1, max(1, largest // faces)
    while copies < most:
        yield copies
        copies *= 10
    yield most


def compare_copies(given, name, frames, copies, failures):
    """Yields rows of `copies` copies of a scene."""
    first = measured(given, 1, frames, "--copies", copies)
    if first["hash"] != first["hash_of_whole"]:
        failures.append(f"{name}, {copies} copies: the hash differs from that of the whole mesh")
    for ranks in RANKS:
        result = measured(given, ranks, frames, "--copies", copies)
        same(result, first, f"{name}, {copies} copies, {ranks} ranks", failures)
        yield row_of(name, copies, result)


def main():
    given = arguments()
    failures, rows = [], [HEADING]
    for name, frames in scenes(given.data, given.quick):
        faces = measured(given, 1, frames)["faces"]
        for copies in sizes(faces, 10 * faces if given.quick else given.faces):
            rows += compare_copies(given, name, frames, copies, failures)
    table(rows)
    print("\n".join(failures) if failures else "pairs, times and first contacts: the same in all")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
