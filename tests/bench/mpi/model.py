"""What a step of a mesh over many ranks takes: a model of measured constants.

Run alone, it prints the model for meshes and numbers of ranks that no one machine has; scaling.py
prints it beside what it counts.
"""
import math

# Of `./run bench --mpi` and `./run bench --sections growth` on cloth of triangles of about the same
# size, two-core AMD EPYC: docs/program.md.
HALO = 20.0           # elements that a box shares with others: HALO * sqrt(its own); 6 for flat cloth, 20 for crumpled
VERTICES = 0.52       # a face, of cloth in large parts
BYTES_FACE, BYTES_VERTEX = 24, 56       # sent
BYTES_PAIR, PAIRS = 64, 1.2             # sent back; pairs a face, as in a crumpled cloth
BYTES_SAMPLE = 72
MEMORY_FACE = 600     # of a rank, a face held: what was given, what is on its way, ccd::mesh_steps, pairs
SECONDS_FACE = 1.6e-6  # one thread, a face held: a fresh step with its pairs, the route there and back
SECONDS_SAMPLE = 40e-9  # a sample and cut
BANDWIDTH, LATENCY = 1e9, 20e-6  # assumed: bytes a second of a rank; a message
COLLECTIVES = 60      # of few bytes: counts, checks


def samples(ranks, faces):
    """As ccd/mpi/decomposition.cpp."""
    return min(faces, max(4096, min(256 * ranks, max(2**19, 64 * ranks))))


def held(faces, ranks):
    """Elements held over elements given."""
    return 1 + (HALO / math.sqrt(faces / ranks) if ranks > 1 else 0)


def bytes_sent(faces, ranks, vertices=VERTICES, pairs=PAIRS):
    """A face, at most: that of a mesh none of which is where it belongs."""
    if ranks == 1:
        return 0
    moved = (BYTES_FACE + BYTES_VERTEX * vertices) * held(faces, ranks) + BYTES_PAIR * pairs
    return moved + BYTES_SAMPLE * samples(ranks, faces) * (ranks - 1) / faces


def memory(faces, ranks):
    """Of a rank, in bytes."""
    return MEMORY_FACE * held(faces, ranks) * faces / ranks + BYTES_SAMPLE * samples(ranks, faces)


def seconds(faces, ranks):
    own = faces / ranks
    cuts = SECONDS_SAMPLE * samples(ranks, faces) * math.log2(max(2, ranks))
    messages = LATENCY * (COLLECTIVES * math.log2(max(2, ranks)) + min(ranks, 50)) if ranks > 1 else 0
    return SECONDS_FACE * held(faces, ranks) * own + cuts + bytes_sent(faces, ranks) * own / BANDWIDTH + messages


def check():
    """Beside what `./run bench --mpi` counted of 8 ranks: cloth-over-ball, cloth-ball and cloth-funnel, tiled."""
    print("| | held / given | model | bytes sent a face | model, at most | most MB of a rank | model |")
    print("|---|---:|---:|---:|---:|---:|---:|")
    for name, faces, pairs, counted in (("cloth-over-ball", 9_996_942, 0.11, (1.005, 54, 420)),
                                        ("cloth-ball", 9_960_840, 1.23, (1.012, 110, 704)),
                                        ("cloth-funnel", 9_999_844, 0.007, (1.006, 47, 453))):
        print(f"| {name} | {counted[0]} | {held(faces, 8):.3f} | {counted[1]} | {bytes_sent(faces, 8, pairs=pairs):.0f} | "
              f"{counted[2]} | {memory(faces, 8) / 1e6:.0f} |")
    print()


def main():
    check()
    print("| faces | ranks | faces a rank | held / given | MB of a rank | bytes sent a face | seconds |")
    print("|---:|---:|---:|---:|---:|---:|---:|")
    for faces in (10**8, 10**9):
        for ranks in (1, 10, 100, 1000, 10_000):
            print(f"| {faces:,} | {ranks:,} | {faces // ranks:,} | {held(faces, ranks):.3f} | "
                  f"{memory(faces, ranks) / 1e6:,.0f} | {bytes_sent(faces, ranks):.0f} | {seconds(faces, ranks):.2f} |")


if __name__ == "__main__":
    main()
