// The part of the soak that needs no reference: all images of a query have the same answer.
#include <algorithm>
#include <array>
#include <ccd/explain.hpp>
#include <ccd/reference.hpp>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "tests/soak/images.hpp"
#include "tests/soak/parts.hpp"

namespace soak {
namespace {

using query_families::kind;
using query_families::points;

/// The number of queries of a family. Vertices and edges are fewer, since they are also decided as
/// faces and as pairs of edges.
constexpr std::uint64_t queries_per_block(kind k) {
    return k == kind::vertex_face || k == kind::edge_edge ? 8 : 2;
}

/// The number of images of a query in a call of a decider: maps of space and time, and names for
/// the points of each.
struct image_counts {
    std::size_t maps, names;
    std::size_t all() const { return maps * names; }
};
constexpr std::size_t images_per_decider = 8;
/// Batches treat vertices that many pairs share in another way than those of one pair.
image_counts image_counts_of(std::uint64_t block, const decider& d) {
    if (d.may_be_uncertain) return {1, 1};
    return block % 4 < 2 ? image_counts{images_per_decider, 1}
                         : image_counts{2, images_per_decider / 2};
}

/// The images of a block's queries of one kind as another kind, with their origins.
template <kind As>
struct image_list {
    query_list<As> queries;
    std::vector<image> maps;
};

template <kind K>
class block_of_kind {
  public:
    block_of_kind(std::uint64_t seed, std::uint64_t block, const std::vector<decider>& deciders,
                  findings& out)
        : seed_(seed), block_(block), deciders_(deciders), out_(out) {
        queries_ = block_queries(seed, block, queries_per_block(K), K);
        source random(seed * 0x100000001b3 + block * 4 + static_cast<std::uint64_t>(K));
        query_list<K> themselves;
        for (const family_query& q : queries_) {
            images_.emplace_back(q.at, point_count, random);
            add(themselves, q.at, slot_maps(K, K)[0]);
        }
        right_.resize(queries_.size());
        deciders[0].decide.of<K>()(themselves, right_);
    }

    void compare() {
        count_families();
        ccd::for_each_kind([&]<kind As>() {
            if (slot_maps(K, As).empty()) return;
            for (std::size_t d = 0; d < deciders_.size(); ++d)
                if (deciders_[d].decide.of<As>()) compare<As>(d);
        });
    }

  private:
    static constexpr std::size_t point_count = query_list<K>::point_count;

    template <kind As>
    static void add_pair(query_list<As>& to, ccd::vertex_index first, const slot_map& slots) {
        std::array<ccd::vertex_index, query_list<As>::point_count> at;
        for (std::size_t i = 0; i < at.size(); ++i) at[i] = first + slots[i];
        to.add_pair(at);
    }
    template <kind As>
    static void add(query_list<As>& to, const points& p, const slot_map& slots) {
        const auto first = static_cast<ccd::vertex_index>(to.before.size());
        for (std::size_t i = 0; i < point_count; ++i) to.add_vertex(p[i]);
        add_pair(to, first, slots);
    }

    template <kind As>
    image_list<As> images_for(std::size_t d, const image_counts& counts) const {
        source random(((seed_ * 0x100000001b3 + block_) * 64 + d) * 16 +
                      static_cast<std::uint64_t>(K) * 4 + static_cast<std::uint64_t>(As));
        const auto slots = slot_maps(K, As);
        image_list<As> all;
        for (const query_images& of : images_) {
            for (std::size_t m = 0; m < counts.maps; ++m) {
                all.maps.push_back(of.draw(random));
                const points p = of.of(all.maps.back());
                const auto first = static_cast<ccd::vertex_index>(all.queries.before.size());
                for (std::size_t i = 0; i < point_count; ++i) all.queries.add_vertex(p[i]);
                for (std::size_t n = 0; n < counts.names; ++n)
                    add_pair(all.queries, first,
                             slots[static_cast<std::size_t>(
                                 random.between(0, static_cast<int>(slots.size()) - 1))]);
            }
        }
        return all;
    }

    template <kind As>
    void compare(std::size_t d) {
        const decider& by = deciders_[d];
        const image_counts counts = image_counts_of(block_, by);
        const image_list<As> images = images_for<As>(d, counts);
        // Invalid initial values, so that a skipped query is detected.
        std::vector<ccd::outcome> found(images.queries.pairs.size(),
                                        static_cast<ccd::outcome>(255));
        count_stages(by.decide.of<As>()(images.queries, found));
        auto& row = out_.table("decider")[by.name];
        row[0] += found.size();
        for (std::size_t i = 0; i < found.size(); ++i) {
            if (found[i] == right_[i / counts.all()]) continue;
            if (by.may_be_uncertain && found[i] == ccd::outcome::uncertain) {
                ++row[1];
                continue;
            }
            ++row[2];
            report(i / counts.all(), by.name, images.maps[i / counts.names],
                   images.queries.stored[i], found[i]);
        }
    }

    template <class Query>
    void report(std::size_t q, const std::string& who, const image& as, const Query& of_image,
                ccd::outcome found) {
        const auto text = [](ccd::outcome o) { return std::string(ccd::name(o)); };
        constexpr kind image_kind = ccd::kind_of<Query>;
        points p{};
        std::ranges::copy(ccd::points_of(of_image), p.begin());
        const ccd::outcome truth = ccd::decide_reference(of_image).outcome;
        const bool stored = image_kind == kind::vertex_face || image_kind == kind::edge_edge;
        const std::string rows =
            query_families::csv(p, truth == ccd::outcome::collides ? ",1" : ",0");
        const family_query& of = queries_[q];
        out_.differ({std::string(of.family->name) + " " + std::string(short_name(K)) + " " +
                         std::to_string(of.index) + ": " + deciders_[0].name + " returns " +
                         text(right_[q]) + ", the reference " +
                         text(ccd::decide_reference(
                                  query_families::as_query<typename query_list<K>::query>(of.at))
                                  .outcome) +
                         "\n" + query_families::csv(of.at) + "as " +
                         std::string(short_name(image_kind)) + ", " + text_of(as) + ": " + who +
                         " returns " + text(found) + ", the reference " + text(truth) + "\n" + rows,
                     stored ? "differences-" + std::string(short_name(image_kind)) + ".csv" : "",
                     stored ? rows : ""});
    }

    void count_stages(const ccd::stage_report& report) {
        auto& table = out_.table("decided by");
        for (std::size_t s = 0; s < ccd::stage_count; ++s) {
            auto& row = table[ccd::exact_stages[s].name];
            row[0] += report.stages[s].separate + report.stages[s].collides;
            row[1] += report.stages[s].collides;
        }
    }

    void count_families() {
        std::map<const query_families::family*, std::array<std::uint64_t, 2>> counts;
        for (std::size_t i = 0; i < queries_.size(); ++i) {
            auto& [queries, collisions] = counts[queries_[i].family];
            ++queries;
            collisions += right_[i] == ccd::outcome::collides;
            out_.stir(static_cast<std::uint64_t>(right_[i]));
        }
        for (const auto& [family, count] : counts) {
            auto& row = out_.table("family")[row_name(*family)];
            row[2 * static_cast<std::size_t>(K)] += count[0];
            row[2 * static_cast<std::size_t>(K) + 1] += count[1];
        }
    }

    std::uint64_t seed_, block_;
    const std::vector<decider>& deciders_;
    findings& out_;
    std::vector<family_query> queries_;
    std::vector<query_images> images_;
    std::vector<ccd::outcome> right_;
};

/// Counts how often deciders that are never uncertain answer images of one query.
template <kind K>
std::uint64_t answers_per_query(const std::vector<decider>& deciders) {
    std::uint64_t answers = 0;
    ccd::for_each_kind([&]<kind As>() {
        if (slot_maps(K, As).empty()) return;
        for (const decider& d : deciders)
            if (!d.may_be_uncertain && d.decide.of<As>()) answers += images_per_decider;
    });
    return answers;
}

}  // namespace

part symmetry_part(std::vector<decider> deciders) {
    part all{.name = "symmetries", .unit = "queries"};
    std::uint64_t per_query[4];
    ccd::for_each_kind(
        [&]<kind K>() { per_query[static_cast<std::size_t>(K)] = answers_per_query<K>(deciders); });
    all.count = [per_query = std::to_array(per_query)](std::uint64_t blocks) {
        std::uint64_t count = 0;
        ccd::for_each_kind([&]<kind K>() {
            count +=
                per_query[static_cast<std::size_t>(K)] * queries_in(blocks, queries_per_block(K));
        });
        return count;
    };
    all.compare_block = [deciders = std::move(deciders)](std::uint64_t seed, std::uint64_t block) {
        findings out{
            .blocks = 1,
            .tables = {family_table({"vf queries", "vf collisions", "ee queries", "ee collisions",
                                     "ve queries", "ve collisions", "vv queries", "vv collisions"}),
                       {"decided by", {"answers", "collisions"}},
                       {"decider", {"answers", "uncertain", "differences"}}}};
        ccd::for_each_kind(
            [&]<kind K>() { block_of_kind<K>(seed, block, deciders, out).compare(); });
        return out;
    };
    return all;
}

}  // namespace soak
