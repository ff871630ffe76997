#include <algorithm>
#include <ccd/reference.hpp>
#include <utility>

#include "errbound/support/hexadecimal.hpp"
#include "tests/soak/parts.hpp"
#include "tests/soak/query_meshes.hpp"

namespace soak {
namespace {

using brute_force::two_frames;
using ccd::vertex_index;
using errbound::support::hexadecimal;
using query_families::families;
using query_families::kind;

constexpr const char* mixture = "mixture on a grid";

void stir(findings& out, const ccd::pair_lists& pairs) {
    ccd::for_each_kind([&]<kind K>() {
        out.stir(pairs.of<K>().size());
        for (const auto& pair : pairs.of<K>())
            for (const vertex_index v : vertices_of(pair)) out.stir(v);
    });
}

void compare(const two_frames& at, const std::string& row, const std::string& name,
             const stepper& step, findings& out) {
    const ccd::step_result expected =
        brute_force::step(at, [](const auto& query) { return ccd::decide_reference(query); });
    stir(out, expected.pairs);
    auto& counts = out.table("meshes")[row];
    ++counts[0];
    ccd::for_each_kind([&]<kind K>() {
        counts[1] += expected.candidates->of<K>();
        counts[2 + static_cast<std::size_t>(K)] += expected.pairs.of<K>().size();
    });
    for (const int threads : {1, 2})
        for (const bool counted : {false, true}) {
            const ccd::step_result found = step(at, threads, counted);
            if (found.pairs == expected.pairs &&
                found.candidates == (counted ? expected.candidates : std::nullopt))
                continue;
            ++counts[6];
            out.differ({name + ", on " + std::to_string(threads) + " threads, candidates " +
                        (counted ? "" : "not ") +
                        "counted: other pairs or candidates than the reference's\n" + text_of(at)});
        }
}

findings compare_block(std::uint64_t seed, std::uint64_t block, const stepper& step) {
    findings out{.blocks = 1,
                 .tables = {{"meshes",
                             {"meshes", "candidates", "vf pairs", "ee pairs", "ve pairs",
                              "vv pairs", "differences"}}}};
    const auto one = [&](const std::string& row, const two_frames& at) {
        compare(at, row, row + " of block " + std::to_string(block), step, out);
    };
    for (const auto& f : families)
        for (std::uint64_t i = family_end(f, block, 1); i < family_end(f, block + 1, 1); ++i)
            one(row_name(f), mesh_of(f, seed, i));
    one(mixture, brute_force::random_mixture(seed * 0x100000001b3 + block));
    return out;
}

}  // namespace

two_frames mesh_of(const query_families::family& family, std::uint64_t seed, std::uint64_t index) {
    two_frames at;
    ccd::mesh& mesh = at.first;
    query_families::source random =
        query_families::source_of(family.name, {seed, index, /*of meshes*/ 4});
    for (std::uint64_t q = 0; q < 3; ++q) {
        const auto which = static_cast<kind>(random.between(0, 3));
        brute_force::add_query(at, which, query_families::make(family, which, seed, 3 * index + q));
    }
    const auto any = [&] {
        return static_cast<vertex_index>(
            random.between(0, static_cast<int>(mesh.vertices.size()) - 1));
    };
    for (int more = random.between(0, 3); more > 0; --more)
        mesh.faces.push_back({any(), any(), any()});
    for (int more = random.between(0, 2); more > 0; --more) mesh.edges.push_back({any(), any()});
    if (random.one_in(4) && !mesh.faces.empty()) {
        const ccd::face f = mesh.faces.front();
        mesh.faces.push_back({f[2], f[1], f[0]});
    }
    at.second.faces = mesh.faces;
    at.second.edges = mesh.edges;
    return at;
}

std::string text_of(const two_frames& at) {
    std::string text;
    const auto add = [&](const char* title, const auto& elements) {
        text += title;
        for (const auto& element : elements) {
            text += " ";
            for (const vertex_index v : element) text += std::to_string(v) + ",";
        }
        text += "\n";
    };
    add("faces", at.first.faces);
    add("edges", at.first.edges);
    for (const ccd::mesh* frame : {&at.first, &at.second})
        for (const auto& p : frame->vertices)
            text += hexadecimal(p.x) + "," + hexadecimal(p.y) + "," + hexadecimal(p.z) + "\n";
    return text;
}

ccd::step_result exact_step(const two_frames& at, int threads, bool counted) {
    return ccd::step(at.first, at.second, {.threads = threads, .count_candidates = counted});
}

part mesh_part(stepper step) {
    part all{.name = "meshes", .unit = "meshes"};
    all.count = [](std::uint64_t blocks) { return blocks + queries_in(blocks, 1); };
    all.compare_block = [step = std::move(step)](std::uint64_t seed, std::uint64_t block) {
        return compare_block(seed, block, step);
    };
    return all;
}

}  // namespace soak
