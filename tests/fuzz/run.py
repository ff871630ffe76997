"""Runs fuzzers with libFuzzer, each for some minutes, and prints runs, coverage and findings.

Argument: a build folder of the preset `fuzz`; --help lists the options. Fuzzers are the build's
targets fuzz_*. Status 1 if any fuzzer found something: its input is then in out/fuzz/NAME.
"""
import argparse
import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
SAVED = ROOT / "tests/fuzz/corpus"
FOUND = ROOT / "out/fuzz"
# The number of inputs kept in the tree for each fuzzer. Others stay in out/fuzz/NAME/corpus.
SEEDS = 15


def arguments():
    parser = argparse.ArgumentParser(prog="./run fuzz", description="Fuzzers by libFuzzer.")
    parser.add_argument("build", type=pathlib.Path, help=argparse.SUPPRESS)
    parser.add_argument("names", nargs="*", metavar="NAME", help="run the fuzzers with one of these in their names")
    parser.add_argument("--minutes", type=float, default=1, metavar="M", help="minutes for each (1)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), metavar="N",
                        help="fuzzers at a time (one per core)")
    parser.add_argument("--minimise", action="store_true",
                        help=f"keep the {SEEDS} inputs of each that cover most in tests/fuzz/corpus")
    return parser.parse_intermixed_args()  # names also after options


def fuzzers(build, names):
    """Returns the build's targets with one of the names."""
    listed = subprocess.run(["cmake", "--build", build, "--target", "help"], check=True,
                            stdout=subprocess.PIPE, text=True).stdout
    known = sorted(set(re.findall(r"^(?:\.\.\. )?(fuzz_\w+)(?::|$)", listed, re.MULTILINE)))
    chosen = [name for name in known if not names or any(part in name for part in names)]
    if not chosen:
        sys.exit(f"run: fuzzer is {' '.join(names)}; expected one of {', '.join(known)}")
    return chosen


def run(build, name, minutes):
    """Runs a fuzzer; returns its row of the table, from libFuzzer's last lines."""
    folder = FOUND / name
    corpus = folder / "corpus"
    corpus.mkdir(parents=True, exist_ok=True)
    saved = [SAVED / name] if (SAVED / name).is_dir() else []
    with open(folder / "log", "w+") as log:
        status = subprocess.run(
            [build / "fuzz" / name, f"-max_total_time={round(60 * minutes)}", "-timeout=60",
             "-rss_limit_mb=3000", "-print_final_stats=1", f"-artifact_prefix={folder}/", corpus, *saved],
            stdout=log, stderr=subprocess.STDOUT).returncode
        log.seek(0)
        text = log.read()
    progress = re.findall(r"^#(\d+)\s.*?cov: (\d+) ft: (\d+) corp: (\d+)/", text, re.MULTILINE)
    edges = sum(map(int, re.findall(r"\((\d+) inline 8-bit counters\)", text)))
    runs = re.search(r"number_of_executed_units: (\d+)", text)
    _, covered, features, kept = progress[-1] if progress else (0, 0, 0, 0)
    found = re.findall(r"Test unit written to (\S+)", text)
    return [name, f"{int(runs[1]) if runs else 0:,}", f"{int(covered):,} of {edges:,}", f"{int(features):,}",
            kept, found[-1] if found else "nothing" if status == 0 else f"stopped, see {folder}/log"]


def features(build, name):
    """Returns the inputs, old and new, each with the features (edges) that it covers."""
    folder = FOUND / name
    control = folder / "control"
    control.unlink(missing_ok=True)
    shutil.rmtree(folder / "merged", ignore_errors=True)
    (folder / "merged").mkdir()
    subprocess.run([build / "fuzz" / name, "-set_cover_merge=1", "-use_counters=0", f"-merge_control_file={control}",
                    folder / "merged", SAVED / name, folder / "corpus"],
                   check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    lines = control.read_text().splitlines()
    paths = [pathlib.Path(path) for path in lines[2:2 + int(lines[0])]]
    covered = {}
    for line in lines[2 + len(paths):]:
        what, number, *found = line.split()
        if what == "FT":
            covered[paths[int(number)]] = set(found)
    return covered


def minimise(build, name):
    """Keeps at most SEEDS inputs: each adds the most edges, and is the smallest that does."""
    saved = SAVED / name
    saved.mkdir(exist_ok=True)
    left = features(build, name)
    everything = set().union(*left.values())
    seen, kept = set(), []
    while left and len(kept) < SEEDS:
        best = max(left, key=lambda path: (len(left[path] - seen), -path.stat().st_size, path.name))
        if left[best] <= seen:
            break
        seen |= left.pop(best)
        kept.append((best.name, best.read_bytes()))
    shutil.rmtree(saved)
    saved.mkdir()
    for file, content in kept:
        (saved / file).write_bytes(content)
    print(f"{name}: {len(kept)} inputs cover {len(seen)} of {len(everything)} features")


def main():
    options = arguments()
    build = options.build.resolve()
    names = fuzzers(build, options.names)
    subprocess.run(["cmake", "--build", build, "--target", *names], check=True)
    with concurrent.futures.ThreadPoolExecutor(max(options.jobs, 1)) as jobs:
        rows = list(jobs.map(lambda name: run(build, name, options.minutes), names))
    heading = ["fuzzer", "runs", "edges covered", "features", "corpus", "found"]
    widths = [max(len(str(row[i])) for row in [heading, *rows]) for i in range(len(heading))]
    for row in [heading, *rows]:
        print("  ".join(str(cell).ljust(width) for cell, width in zip(row, widths)).rstrip())
    if options.minimise:
        for name in names:
            minimise(build, name)
    return any(row[-1] != "nothing" for row in rows)


if __name__ == "__main__":
    sys.exit(main())
