// Computes a step of copies of two frames side by side, distributed over the ranks of MPI. Prints
// what each rank is given, holds, sends and decides, and a hash of all pairs and times, which does
// not depend on the distribution. tests/bench/mpi/scaling.py runs this program, compares the hashes
// and prints the tables.
#include <mpi.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <bit>
#include <ccd/io/mesh_file.hpp>
#include <ccd/mpi.hpp>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <unordered_map>
#include <vector>

#include "ccd/mpi/exchange.hpp"
#include "errbound/support/program.hpp"
#include "errbound/support/system/system.hpp"

namespace {

using ccd::mpi::vertex_number;
using ccd::mpi::detail::exchanger;

struct arguments {
    std::string before, after;
    std::size_t copies = 1;
};

/// Copies of a frame on a square grid in x and y, numbered consecutively.
class tiles {
  public:
    tiles(const arguments& given)
        : before_(ccd::io::read_mesh(given.before)),
          after_(ccd::io::read_mesh(given.after)),
          copies_(given.copies),
          side_(static_cast<std::size_t>(std::ceil(std::sqrt(double(given.copies))))) {
        ccd::io::require_same_topology(before_, given.before, after_, given.after);
        double least = std::numeric_limits<double>::infinity(), most = -least;
        for (const auto* frame : {&before_, &after_})
            for (const auto& p : frame->vertices)
                for (const double x : {p.x, p.y, p.z}) {
                    least = std::min(least, x);
                    most = std::max(most, x);
                }
        width_ = 1.25 * (most - least);
    }

    std::size_t faces() const { return copies_ * before_.faces.size(); }
    std::size_t vertices() const { return copies_ * size(); }
    std::array<vertex_number, 3> face(std::size_t i) const {
        const vertex_number first = i / before_.faces.size() * size();
        const ccd::face& f = before_.faces[i % before_.faces.size()];
        return {first + f[0], first + f[1], first + f[2]};
    }
    ccd::point<double> before(vertex_number v) const { return at(before_, v); }
    ccd::point<double> after(vertex_number v) const { return at(after_, v); }

  private:
    std::size_t size() const { return before_.vertices.size(); }
    ccd::point<double> at(const ccd::mesh& frame, vertex_number v) const {
        const std::size_t copy = v / size();
        const ccd::point<double>& p = frame.vertices[v % size()];
        return {p.x + width_ * static_cast<double>(copy % side_),
                p.y + width_ * static_cast<double>(copy / side_), p.z};
    }

    ccd::mesh before_, after_;
    std::size_t copies_, side_;
    double width_ = 0;
};

/// A rank's block of the faces.
struct share {
    std::vector<vertex_number> numbers;
    std::vector<ccd::point<double>> before, after;
    std::vector<ccd::face> faces;

    share(const tiles& all, const exchanger& ranks) {
        std::unordered_map<vertex_number, ccd::vertex_index> places;
        const std::size_t block = (all.faces() + ranks.size() - 1) / ranks.size();
        for (std::size_t i = block * ranks.rank();
             i < std::min(block * (ranks.rank() + 1), all.faces()); ++i) {
            ccd::face& f = faces.emplace_back();
            const auto corners = all.face(i);
            for (std::size_t k = 0; k < 3; ++k) {
                const auto [at, is_new] =
                    places.try_emplace(corners[k], static_cast<ccd::vertex_index>(numbers.size()));
                f[k] = at->second;
                if (!is_new) continue;
                numbers.push_back(corners[k]);
                before.push_back(all.before(corners[k]));
                after.push_back(all.after(corners[k]));
            }
        }
    }
};

std::uint64_t mixed(std::uint64_t hash, std::uint64_t with) {
    hash ^= with + 0x9e3779b97f4a7c15 + (hash << 6) + (hash >> 2);
    hash = (hash ^ (hash >> 30)) * 0xbf58476d1ce4e5b9;
    hash = (hash ^ (hash >> 27)) * 0x94d049bb133111eb;
    return hash ^ (hash >> 31);
}

/// A hash of a set of pairs: their order does not matter.
template <class Lists, class VerticesOf>
std::uint64_t hash_of(const Lists& pairs, const ccd::time_lists& times,
                      const VerticesOf& vertices_of) {
    std::uint64_t sum = 0;
    ccd::for_each_kind([&]<ccd::kind K>() {
        for (std::size_t i = 0; i < pairs.template of<K>().size(); ++i) {
            std::uint64_t hash = static_cast<std::uint64_t>(K);
            for (const auto v : vertices_of(pairs.template of<K>()[i])) hash = mixed(hash, v);
            const ccd::first_time& time = times.of<K>()[i];
            for (const double t : {time.low, time.high})
                hash = mixed(hash, std::bit_cast<std::uint64_t>(t));
            sum += hash;
        }
    });
    return sum;
}

struct rank_row {
    ccd::mpi::rank_work work;
    std::uint64_t pairs = 0, decided = 0, hash = 0, vertices = 0;
    std::size_t memory = 0;
};

/// The hash of the same step by ccd::step on the whole mesh.
std::uint64_t hash_of_whole(const tiles& all) {
    std::vector<ccd::point<double>> before, after;
    for (vertex_number v = 0; v < all.vertices(); ++v) {
        before.push_back(all.before(v));
        after.push_back(all.after(v));
    }
    std::vector<ccd::face> faces;
    for (std::size_t i = 0; i < all.faces(); ++i) {
        const auto f = all.face(i);
        faces.push_back({static_cast<ccd::vertex_index>(f[0]), static_cast<ccd::vertex_index>(f[1]),
                         static_cast<ccd::vertex_index>(f[2])});
    }
    const auto found = ccd::step(faces, {}, ccd::vertex_rows(before, after), {.times = true});
    return hash_of(found.pairs, found.times, [](const auto& pair) { return vertices_of(pair); });
}

nlohmann::ordered_json measured(const arguments& given, exchanger& ranks) {
    const tiles all(given);
    nlohmann::ordered_json row{{"faces", all.faces()}, {"ranks", nlohmann::ordered_json::array()}};
    if (ranks.size() == 1) row["hash_of_whole"] = hash_of_whole(all);
    const share own(all, ranks);
    const auto found =
        ccd::mpi::step(MPI_COMM_WORLD, {own.numbers, {own.before, own.after}, own.faces},
                       {.threads = 1, .count_candidates = true, .times = true});
    rank_row mine;
    mine.work = found.work;
    ccd::for_each_kind([&]<ccd::kind K>() {
        mine.pairs += found.pairs.of<K>().size();
        mine.decided += found.decided->of<K>();
    });
    mine.hash = hash_of(found.pairs, found.times, [](const auto& numbers) { return numbers; });
    mine.vertices = own.numbers.size();
    mine.memory = errbound::support::system::peak_memory_bytes();
    std::uint64_t hash = 0, pairs = 0;
    for (const rank_row& r : ranks.gather(std::vector{mine}).items) {
        hash += r.hash;
        pairs += r.pairs;
        row["ranks"].push_back({{"vertices", r.vertices},
                                {"given", r.work.elements_given},
                                {"held", r.work.elements_held},
                                {"sent", r.work.bytes_sent},
                                {"candidates", r.decided},
                                {"seconds", r.work.seconds},
                                {"memory", r.memory}});
    }
    row["hash"] = hash;
    row["pairs"] = pairs;
    row["first_contact"] = {found.first_contact.low, found.first_contact.high};
    return row;
}

int run(int argc, char** argv) {
    arguments given;
    CLI::App app{"A step of copies of two frames, spread over ranks; prints what each did as JSON.",
                 "errbound_mpi_bench"};
    app.add_option("FRAME0", given.before)->required();
    app.add_option("FRAME1", given.after)->required();
    app.add_option("--copies", given.copies, "Copies side by side")->check(CLI::Range(1, 1 << 20));
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    exchanger ranks(MPI_COMM_WORLD);
    const auto row = measured(given, ranks);
    if (ranks.rank() == 0) std::printf("%s\n", row.dump().c_str());
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    MPI_Init(&argc, &argv);
    const int status =
        errbound::support::run_program("errbound_mpi_bench", [&] { return run(argc, argv); });
    if (status != 0) MPI_Abort(MPI_COMM_WORLD, status);
    MPI_Finalize();
    return status;
}
