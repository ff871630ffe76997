"""Compares instructions per query of the baseline kernels on two processors: ./run everywhere --instructions.

Emulators cannot measure time, but qemu logs each block of instructions, and with -singlestep each instruction is a
block. The difference between two calls and one gives the instructions of one call.
"""
import re
import subprocess

# Families of tests/support/query_families.hpp: mostly apart; contacts; cloth, mostly almost touching.
FAMILIES = ["uniform", "contact", "sheets"]
# Both have packs of two doubles; scalar code would take about twice as many.
MOST = 1.25
ROW = "{:<12}{:>10}{:>12}{:>12}{:>8}"


class Failed(Exception):
    """The reason why instructions cannot be counted."""


def executed(emulator, program, family, calls):
    command = [emulator[0], "-singlestep", "-d", "exec,nochain", *emulator[1:], program, family, str(calls)]
    run = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    counted = subprocess.run(["grep", "-c", "^Trace "], stdin=run.stderr, stdout=subprocess.PIPE, text=True)
    said = re.fullmatch(r"(\d+) queries, (\d+) collisions\n", run.stdout.read())
    if run.wait() != 0 or not said:
        raise Failed(f"{program} {family} {calls} ended with {run.returncode}")
    return int(counted.stdout), int(said[1]), int(said[2])


def per_query(emulator, program, family):
    once, queries, collisions = executed(emulator, program, family, 1)
    twice, *answers = executed(emulator, program, family, 2)
    if answers != [2 * queries, 2 * collisions]:
        raise Failed(f"{program} {family}: {answers} of two calls, {queries}, {collisions} of one")
    return (twice - once) / queries, queries, collisions


def print_table(first, second):
    """Compares two (name, emulator, program). True if the second never needs more than MOST times the first's."""
    names = [name for name, *_ in (first, second)]
    print(ROW.format("queries", "collide", *names, "ratio"), flush=True)
    good = True
    for family in FAMILIES:
        (of_first, *answers), (of_second, *same) = (per_query(*how, family) for _, *how in (first, second))
        if answers != same:
            raise Failed(f"{family}: {answers} queries and collisions on {names[0]}, {same} on {names[1]}")
        ratio = of_second / of_first
        good = good and ratio <= MOST
        print(ROW.format(family, f"{answers[1] / answers[0]:.1%}", f"{of_first:.0f}", f"{of_second:.0f}",
                         f"{ratio:.2f}"), flush=True)
    return good
