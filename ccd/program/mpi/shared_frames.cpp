#include "ccd/program/mpi/shared_frames.hpp"

#include <algorithm>
#include <boost/crc.hpp>
#include <ccd/io/mesh_file.hpp>
#include <cstddef>
#include <cstdint>
#include <errbound/support/error.hpp>
#include <fstream>
#include <string>
#include <unordered_map>

namespace ccd::program {
namespace {

struct frames {
    io::mesh_share before, after;

    std::size_t first() const { return before.vertices.first; }
    std::size_t last() const { return first() + before.elements.vertices.size(); }
    bool has(vertex_index v) const { return first() <= v && v < last(); }
};

struct file_mark {
    std::uint64_t bytes = 0;
    std::uint32_t checksum = 0;
    bool operator==(const file_mark&) const = default;
};
file_mark mark_of(const std::filesystem::path& path) {
    constexpr std::uint64_t max_bytes = 1 << 16;
    std::ifstream in(path, std::ios::binary | std::ios::ate);
    if (!in) return {};
    file_mark mark{static_cast<std::uint64_t>(in.tellg())};
    boost::crc_32_type sum;
    std::string text(std::min(max_bytes, mark.bytes), '\0');
    for (const std::uint64_t from : {std::uint64_t{0}, mark.bytes - text.size()}) {
        in.seekg(static_cast<std::streamoff>(from));
        in.read(text.data(), static_cast<std::streamsize>(text.size()));
        sum.process_bytes(text.data(), text.size());
    }
    mark.checksum = sum.checksum();
    return mark;
}

/// Throws if the file differs from rank 0's: machines may have different files with one name.
void require_same_file(mpi::detail::exchanger& ranks, const std::filesystem::path& path) {
    const file_mark own = mark_of(path);
    const file_mark first = ranks.gather(std::vector{own}).items.front();
    ranks.agree([&] {
        if (own != first)
            throw errbound::support::file_error(
                path.string() + ": file on rank " + std::to_string(ranks.rank()) +
                " differs from that on rank 0; expected the same file on all ranks");
    });
}

frames read_frames(const std::filesystem::path& before, const std::filesystem::path& after,
                   std::size_t rank, std::size_t ranks) {
    frames own{io::read_mesh_share(before, rank, ranks), io::read_mesh_share(after, rank, ranks)};
    io::require_same_topology(own.before, before.string(), own.after, after.string());
    return own;
}

struct sent_positions {
    point<double> before, after;
};

template <class Visit>
void for_each_corner(const mesh& elements, const Visit& visit) {
    for (const face& f : elements.faces) std::ranges::for_each(f, visit);
    for (const edge& e : elements.edges) std::ranges::for_each(e, visit);
}

std::vector<std::vector<vertex_index>> read_elsewhere(mpi::detail::exchanger& ranks,
                                                      const frames& own) {
    const auto lasts = ranks.gather(std::vector{own.last()}).items;
    std::vector<std::vector<vertex_index>> at(ranks.size());
    for_each_corner(own.before.elements, [&](vertex_index v) {
        if (own.has(v)) return;
        const auto rank = std::ranges::upper_bound(lasts, std::size_t(v)) - lasts.begin();
        at[static_cast<std::size_t>(rank)].push_back(v);
    });
    for (auto& list : at) {
        std::ranges::sort(list);
        list.erase(std::unique(list.begin(), list.end()), list.end());
    }
    return at;
}

}  // namespace

shared_frames read_shared_frames(mpi::detail::exchanger& ranks, const std::filesystem::path& before,
                                 const std::filesystem::path& after) {
    frames own;
    ranks.agree([&] { own = read_frames(before, after, ranks.rank(), ranks.size()); });
    for (const auto& path : {before, after}) require_same_file(ranks, path);
    const auto wanted = read_elsewhere(ranks, own);
    const auto requested = ranks.all_to_all(wanted);
    std::vector<std::vector<sent_positions>> answers(ranks.size());
    std::vector<bool> has_element(own.before.elements.vertices.size());  // here or elsewhere
    for (std::size_t r = 0; r < ranks.size(); ++r)
        for (std::size_t i = requested.starts[r]; i < requested.starts[r + 1]; ++i) {
            const std::size_t v = requested.items[i] - own.first();
            has_element[v] = true;
            answers[r].push_back({own.before.elements.vertices[v], own.after.elements.vertices[v]});
        }
    const auto positions = ranks.all_to_all(answers).items;

    shared_frames result;
    std::unordered_map<vertex_index, vertex_index> places;
    const auto add = [&](vertex_index v, const sent_positions& at) {
        places.emplace(v, static_cast<vertex_index>(result.numbers.size()));
        result.numbers.push_back(v);
        result.before.push_back(at.before);
        result.after.push_back(at.after);
    };
    std::size_t next = 0;
    for (const auto& list : wanted)
        for (const vertex_index v : list) add(v, positions[next++]);
    std::vector<bool> is_used_here(has_element.size());
    for_each_corner(own.before.elements, [&](vertex_index v) {
        if (own.has(v)) is_used_here[v - own.first()] = true;
    });
    // A vertex without elements stays on the rank that reads it.
    std::size_t unused = 0;
    for (std::size_t v = 0; v < has_element.size(); ++v) {
        unused += !is_used_here[v] && !has_element[v];
        if (is_used_here[v] || !has_element[v])
            add(static_cast<vertex_index>(own.first() + v),
                {own.before.elements.vertices[v], own.after.elements.vertices[v]});
    }
    result.vertices = own.before.vertices.all;
    for (const std::size_t count : ranks.gather(std::vector{unused}).items) result.unused += count;
    const auto placed = [&](auto element) {
        for (vertex_index& v : element) v = places.at(v);
        return element;
    };
    std::ranges::transform(own.before.elements.faces, std::back_inserter(result.faces), placed);
    std::ranges::transform(own.before.elements.edges, std::back_inserter(result.edges), placed);
    return result;
}

}  // namespace ccd::program
