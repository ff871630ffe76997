"""Measures the cost of each method in simulations, as in the paper's tables.

Runs `simulate` for every chosen scene, method and seed, each in a separate folder in --out, and continues stopped
runs. Then writes and prints report.md:
 * as the paper's Figure 12, over thirds of a run: looks for contacts per frame, seconds per frame in the solver, in
   detection and in response, frames without convergence, pairs that passed through each other;
 * as its Figure 11: queries, time and false positives of each method on the proposed steps, by `ccd step`.

Wang, Tang, Tong, Manocha: TightCCD: Efficient and Robust Continuous Collision Detection using Tight
Error Bounds, 2015.
"""
import argparse
import csv
import json
import pathlib
import signal
import statistics
import subprocess
import sys
import tempfile

METHODS = ["tight", "bsc-exact", "safeccd", "safe", "exact", "float", "provot"]
STREAMS = ["exact", "bsc-exact", "tight", "safe", "safeccd-tight", "safeccd", "float"]


def arguments():
    parser = argparse.ArgumentParser(prog="./run simulations",
                                     description="The paper's tables of simulations.")
    parser.add_argument("build", type=pathlib.Path, help=argparse.SUPPRESS)
    parser.add_argument("--scenes", default="funnel1,funnel2,funnel3", metavar="NAME,...",
                        help="scenes of the first table (%(default)s)")
    parser.add_argument("--methods", default=",".join(METHODS), metavar="NAME,...")
    parser.add_argument("--streams", default="clothes,twist,funnel1,car-post", metavar="NAME,...",
                        help="scenes of the second table (%(default)s)")
    parser.add_argument("--seeds", type=int, default=3, metavar="N", help="runs of each scene and method (3)")
    parser.add_argument("--resolution", type=int, metavar="R", help="resolution of all scenes; by default theirs")
    parser.add_argument("--frames", type=int, metavar="N", help="maximum number of frames; by default the scenes'")
    parser.add_argument("--minutes", type=float, default=10, metavar="M",
                        help="time limit of a run; the table then shows its last frame (10)")
    parser.add_argument("--steps", type=int, default=20, metavar="N",
                        help="steps of each stream, spread over its run (20)")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/simulations"))
    return parser.parse_args()


def simulated(given, scene, method, seed, proposals=False):
    folder = given.out / f"{scene}-{method}-{seed}{'-stream' if proposals else ''}"
    command = [given.build / "examples/simulation/simulate", scene, "--method", method,
               "--seed", seed, "--out", folder]
    for name in ("resolution", "frames"):
        if getattr(given, name) is not None:
            command += [f"--{name}", getattr(given, name)]
    if proposals:
        command.append("--proposals")
    print(" ".join(map(str, command)), file=sys.stderr, flush=True)
    run = subprocess.Popen(list(map(str, command)), stdout=subprocess.DEVNULL)
    try:
        run.wait(timeout=60 * given.minutes)
    except subprocess.TimeoutExpired:
        run.send_signal(signal.SIGINT)  # it stops after a frame and can be continued
        run.wait()
    if run.returncode != 0:
        sys.exit(f"run: simulate {scene} ended with status {run.returncode}")
    return folder


def frames_of(folder):
    with open(folder / "frames.csv") as table:
        return list(csv.DictReader(table))


def spread(values):
    mean = statistics.mean(values)
    return f"{mean:.2f} ± {max(abs(v - mean) for v in values):.2f}" if len(values) > 1 else f"{mean:.2f}"


def part_of_run(rows, part, whole):
    return [row for row in rows if part * whole // 3 < int(row["frame"]) <= (part + 1) * whole // 3]


def response_row(runs, part, whole):
    """Returns the cells of one method over a third of the run, with one run per seed."""
    parts = [part_of_run(rows, part, whole) for rows in runs]
    parts = [rows for rows in parts if rows]
    if not parts:
        return ["", "", "", "", "", ""]
    mean = lambda rows, name: statistics.mean(float(row[name]) for row in rows)
    milliseconds = lambda name: spread([1e3 * mean(rows, name) for rows in parts])
    return [spread([mean(rows, "iterations") for rows in parts]),
            milliseconds("solver_seconds"), milliseconds("detection_seconds"), milliseconds("response_seconds"),
            str(sum(row["converged"] == "0" for rows in parts for row in rows)),
            str(sum(int(row["passed_through"]) for rows in parts for row in rows))]


def responses(given):
    lines = ["| scene, frames | method | looks | solver, ms | detection, ms | response, ms | not converged | passed through |",
             "|---|---|---:|---:|---:|---:|---:|---:|"]
    for scene in given.scenes.split(","):
        runs = {method: [frames_of(simulated(given, scene, method, seed)) for seed in range(1, given.seeds + 1)]
                for method in given.methods.split(",")}
        whole = max(int(rows[-1]["frame"]) for of_method in runs.values() for rows in of_method if rows)
        for part in range(3):
            for method, of_method in runs.items():
                ended = min((int(rows[-1]["frame"]) if rows else 0) for rows in of_method)
                label = method if ended >= (part + 1) * whole // 3 else f"{method} (to {ended})"
                cells = response_row(of_method, part, whole)
                where = f"{scene}, {part * whole // 3} to {(part + 1) * whole // 3}"
                lines.append(f"| {where} | {label} | " + " | ".join(cells) + " |")
    return lines


def decided(given, before, proposed, method):
    """Returns candidates, seconds of the narrow phase, and pairs of a step by `ccd step`."""
    with tempfile.TemporaryDirectory() as folder:
        pairs, report = pathlib.Path(folder) / "pairs", pathlib.Path(folder) / "report.json"
        command = [given.build / "ccd", "step", before, proposed, "--method", method,
                   "--threads", "1", "--pairs", pairs, "--json", report, "--explain"]
        if method != "exact":
            command.remove("--explain")
        subprocess.run(list(map(str, command)), check=True, stdout=subprocess.DEVNULL)
        result = json.loads(report.read_text())
        return (sum(n for n in result["candidates"].values()), result["seconds"]["narrow"],
                set(pairs.read_text().splitlines()))


def streams(given):
    lines = ["| stream | queries | " + " | ".join(STREAMS) + " |",
             "|---|---:|" + "---:|" * len(STREAMS)]
    for scene in given.streams.split(","):
        folder = simulated(given, scene, "exact", 0, proposals=True)
        proposed = sorted((folder / "proposals").glob("*.ply"))
        chosen = [proposed[i * len(proposed) // given.steps] for i in range(min(given.steps, len(proposed)))]
        queries, cells = 0, {method: [0.0, 0, 0] for method in STREAMS}
        for path in chosen:
            before = folder / "frames" / f"{int(path.stem) - 1:05}.ply"
            found = {method: decided(given, before, path, method) for method in STREAMS}
            queries += found["float"][0]
            for method, (_, seconds, pairs) in found.items():
                cells[method][0] += seconds
                cells[method][1] += len(pairs - found["exact"][2])
                cells[method][2] += len(found["exact"][2] - pairs)
        row = [f"{1e6 * seconds / max(queries, 1):.3f}, {false}" + (f", {lost} lost" if lost else "")
               for seconds, false, lost in cells.values()]
        lines.append(f"| {scene} | {queries:,} | " + " | ".join(row) + " |")
    return lines


def main():
    given = arguments()
    given.out.mkdir(parents=True, exist_ok=True)
    text = "# Simulations, method by method\n\n"
    if given.scenes:
        text += ("In the mean over frames and seeds, ± the largest deviation of a seed; looks: at the step by the\n"
                 "method; passed through: pairs, by `exact`, over all seeds.\n\n"
                 + "\n".join(responses(given)) + "\n\n")
    if given.streams:
        text += ("Steps that the solver proposed, one thread: µs a query, false positives, lost collisions.\n\n"
                 + "\n".join(streams(given)) + "\n")
    (given.out / "report.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
