// The part of the soak that advances small meshes.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/soak/advance_scenes.hpp"
#include "tests/soak/parts.hpp"

namespace soak {
namespace {

using query_families::families;

const std::vector<std::string> columns{"scenes",   "pairs",       "with a contact",
                                       "touching", "near",        "all the way",
                                       "short",    "differences", "line searches"};

bool is_same(const ccd::advance_result& a, const ccd::advance_result& b) {
    return a.positions == b.positions && a.fraction == b.fraction && a.fractions == b.fractions &&
           a.first_contact == b.first_contact && a.touching_at_start == b.touching_at_start &&
           a.near_at_start == b.near_at_start;
}

/// The difference of both frames, if it is finite.
std::optional<ccd::mesh> direction_of(const advance_scene& scene) {
    ccd::mesh p = scene.at.second;
    bool finite = true;
    for (std::size_t v = 0; v < p.vertices.size(); ++v) {
        const auto& x = scene.at.first.vertices[v];
        auto& d = p.vertices[v];
        d = {d.x - x.x, d.y - x.y, d.z - x.z};
        finite &= std::isfinite(d.x) && std::isfinite(d.y) && std::isfinite(d.z);
    }
    return finite ? std::optional(p) : std::nullopt;
}

void compare(const advance_scene& scene, const std::string& row, const std::string& name,
             const advancer& advance, findings& out) {
    const ccd::advance_result found = advance(scene, 1);
    const advance_check checked = check(scene, found);
    std::string faults = checked.faults;
    if (!is_same(advance(scene, 2), found)) faults += "another result on two threads; ";
    ccd::mesh_steps steps = scene.steps();
    const ccd::vertex_rows way(scene.at.first, scene.at.second);
    ccd::advance_options options = scene.options(1);
    std::vector<int> own(scene.groups.empty() ? way.vertices : 0);
    std::iota(own.begin(), own.end(), 0);
    if (!own.empty()) options.groups = own;
    const ccd::advance_result by_groups = own.empty() ? found : ccd::advance(steps, way, options);
    options.groups = scene.groups;
    options.each_vertex = true;
    faults += each_vertex_faults(scene, by_groups, ccd::advance(steps, way, options));
    const std::optional<ccd::mesh> p = direction_of(scene);
    if (p) {
        options = {.distances = options.distances,
                   .keep = options.keep,
                   .threads = 1,
                   .conservative = scene.groups.empty() ? 1 : 0.8};
        faults +=
            line_search_faults(scene, ccd::free_step(steps, {scene.at.first, *p}, options), *p);
    }
    const bool has_contact = found.first_contact.outcome == ccd::outcome::collides;
    const std::uint64_t counts[] = {1,
                                    checked.pairs,
                                    has_contact,
                                    number_of(found.touching_at_start) > 0,
                                    number_of(found.near_at_start) > 0,
                                    found.fraction == 1,
                                    checked.is_short,
                                    !faults.empty(),
                                    p.has_value()};
    const auto count = [&](const char* table, std::string_view in_row) {
        auto& sums = out.table(table)[in_row];
        for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += counts[i];
    };
    count("scenes", row);
    count("where", scene.in_plane ? "in the plane" : "in space");
    count("distances", scene.distances_name);
    count("groups", scene.groups_name);
    for (const auto& p : found.positions)
        for (const double x : {p.x, p.y, p.z}) out.stir(std::bit_cast<std::uint64_t>(x));
    if (!faults.empty()) out.differ({name + ": " + faults + "\n" + scene.text()});
}

/// The number of scenes of a family of queries in the first `blocks` blocks.
std::uint64_t scenes_in(const query_families::family& family, std::uint64_t blocks) {
    return blocks / family.thinning;
}

findings compare_block(std::uint64_t seed, std::uint64_t block, const advancer& advance) {
    findings out{
        .blocks = 1,
        .tables = {
            {"scenes", columns}, {"where", columns}, {"distances", columns}, {"groups", columns}}};
    for (const std::string_view row : {"in space", "in the plane"}) out.table("where")[row];
    for (const std::string_view row : distances_names) out.table("distances")[row];
    for (const std::string_view row : groups_names) out.table("groups")[row];
    const auto one = [&](const std::string& row, const auto& family, std::uint64_t index) {
        compare(scene_of(family, seed, index), row, row + " " + std::to_string(index), advance,
                out);
    };
    for (const auto& f : families) {
        const std::string row(f.name);
        out.table("scenes")[row];
        for (std::uint64_t i = scenes_in(f, block); i < scenes_in(f, block + 1); ++i)
            one(row, f, i);
    }
    for (const auto& f : advance_families) one(std::string(f.name), f, block);
    return out;
}

}  // namespace

ccd::advance_result library_advance(const advance_scene& scene, int threads) {
    ccd::mesh_steps steps = scene.steps();
    return ccd::advance(steps, {scene.at.first, scene.at.second}, scene.options(threads));
}

part advance_part(advancer advance) {
    part all{.name = "advances", .unit = "scenes"};
    all.count = [](std::uint64_t blocks) {
        std::uint64_t count = blocks * advance_families.size();
        for (const auto& f : families) count += scenes_in(f, blocks);
        return count;
    };
    all.compare_block = [advance = std::move(advance)](std::uint64_t seed, std::uint64_t block) {
        return compare_block(seed, block, advance);
    };
    return all;
}

}  // namespace soak
