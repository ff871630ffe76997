// First times of many queries at once: when each first touches, or comes within a distance; or the
// earliest of all alone.
//
// The same times as one by one (ccd/contact.hpp, ccd/separation.hpp), on every instruction set and
// with any number of threads. Queries are decided first, as ccd/batch.hpp does, and only those with
// a contact are asked for its time.
#pragma once

#include <algorithm>
#include <ccd/batch.hpp>
#include <ccd/contact.hpp>
#include <ccd/kind.hpp>
#include <ccd/separation.hpp>
#include <cstddef>
#include <optional>
#include <ranges>
#include <span>
#include <vector>

namespace ccd {

/// The distance within which two elements count as in contact: the same for all pairs, or by a
/// thickness of each vertex. Then an element is as thick as the thickest of its vertices, and the
/// distance of a pair is the exact sum of its two elements' thicknesses. Not both. By default 0:
/// contact itself. Finite and not negative, in the unit of the coordinates. Not owned.
struct pair_distances {
    double all = 0;
    std::span<const double> thickness = {};

    /// Whether contact itself is asked for.
    bool ask_for_contact() const { return all == 0 && thickness.empty(); }

    /// At least that of every pair.
    double most() const {
        double most = all;
        for (const double t : thickness) most = (std::max)(most, 2 * t);
        return most;
    }

    /// That of a pair, whose vertices must have a thickness if any has.
    template <class Pair>
    separation of(const Pair& pair) const {
        if (thickness.empty()) return {all, 0};
        const auto vertices = vertices_of(pair);
        const std::span<const vertex_index> both(vertices);
        constexpr std::size_t first = kind_traits<kind_of<Pair>>::first_vertices;
        return {thickest(both.first(first)), thickest(both.subspan(first))};
    }

    /// Of an element, the thickness of the thickest vertex. There must be one of each.
    double thickest(std::span<const vertex_index> vertices) const {
        double most = 0;
        for (const vertex_index v : vertices) most = (std::max)(most, thickness[v]);
        return most;
    }
};

struct time_options {
    double t_max = 1;                         ///< of times; decide_within_batch asks for [0, 1]
    pair_distances distances = {};            ///< of stored queries, the same for all
    int threads = 0;                          ///< at most; 0: one per core
    std::optional<instruction_set> set = {};  ///< by default the strongest
    stop_query stop = {};                     ///< ends the call by throwing ccd::stopped
};

/// The first time of one of many queries.
struct timed_contact {
    std::size_t query;
    first_time time;

    friend bool operator==(const timed_contact&, const timed_contact&) = default;
};

/// The earliest of many first times.
struct earliest_time {
    /// The least of all but those at the start, by `low`, then by `high`; `separate` if there is
    /// none; `uncertain` if some queries have a coordinate that is not finite, which then are all
    /// that is told.
    first_time time;
    std::vector<std::size_t> queries;   ///< whose time that is, or who is uncertain, ascending
    std::vector<std::size_t> at_start;  ///< those in contact at t = 0 already, ascending
};

namespace detail {

/// The calls below, of queries of one kind.
template <kind K>
class timed_batch {
  public:
    using pairs = std::span<const typename kind_traits<K>::pair>;
    using queries = std::span<const typename kind_traits<K>::template query<double>>;

    static std::vector<outcome> decisions(const vertex_rows&, pairs, const time_options&);
    static std::vector<outcome> decisions(queries, const time_options&);
    static std::vector<timed_contact> contacts(const vertex_rows&, pairs, const time_options&);
    static std::vector<timed_contact> contacts(queries, const time_options&);
    static std::vector<first_time> times(const vertex_rows&, pairs, const time_options&);
    static std::vector<first_time> times(queries, const time_options&);
    static earliest_time earliest(const vertex_rows&, pairs, const time_options&);
    static earliest_time earliest(queries, const time_options&);
};
template <class Items>
using timed_batch_of = timed_batch<kind_of<std::ranges::range_value_t<Items>>>;

}  // namespace detail

/// Whether each query is in contact, or its features come within the distance asked for, at some t
/// in [0, 1]: decide_within for many. Throws std::invalid_argument as first_times does.
///
/// Cost: of pairs by index less than twice that of decide_batch, where distances are far below the
/// edges' lengths and few pairs come within them (./run bench --sections contacts).
template <pair_range Pairs>
std::vector<outcome> decide_within_batch(const vertex_rows& positions, const Pairs& pairs,
                                         const time_options& options = {}) {
    return detail::timed_batch_of<Pairs>::decisions(positions, pairs, options);
}
template <query_range Queries>
std::vector<outcome> decide_within_batch(const Queries& queries, const time_options& options = {}) {
    return detail::timed_batch_of<Queries>::decisions(queries, options);
}

/// Those queries that collide in [0, t_max], ascending, with their first times; and those of which
/// it is unknown because a coordinate is not finite, `uncertain`. All others are separate. Of any
/// kind: by index, or stored. Throws std::invalid_argument as decide_batch does, and if t_max is
/// not finite, if a distance is not finite or is negative, if both kinds of distance are given, if
/// there is not a thickness for each vertex, or any for stored queries.
///
/// Cost: that of decide_batch or decide_within_batch, and for those that collide some 0.15 to 0.5
/// µs a vertex/face or edge/edge contact, else that of time_of_impact or time_within.
template <pair_range Pairs>
std::vector<timed_contact> timed_contacts(const vertex_rows& positions, const Pairs& pairs,
                                          const time_options& options = {}) {
    return detail::timed_batch_of<Pairs>::contacts(positions, pairs, options);
}
template <query_range Queries>
std::vector<timed_contact> timed_contacts(const Queries& queries,
                                          const time_options& options = {}) {
    return detail::timed_batch_of<Queries>::contacts(queries, options);
}

/// The same as one time for each query. Of long lists in which few collide, to write 24 bytes for
/// each takes longer than to find the times.
template <pair_range Pairs>
std::vector<first_time> first_times(const vertex_rows& positions, const Pairs& pairs,
                                    const time_options& options = {}) {
    return detail::timed_batch_of<Pairs>::times(positions, pairs, options);
}
template <query_range Queries>
std::vector<first_time> first_times(const Queries& queries, const time_options& options = {}) {
    return detail::timed_batch_of<Queries>::times(queries, options);
}

/// The earliest of them, and which queries have it. With distances cheaper than all: once a time is
/// known, the others are asked only for earlier ones. Throws as first_times.
template <pair_range Pairs>
earliest_time earliest(const vertex_rows& positions, const Pairs& pairs,
                       const time_options& options = {}) {
    return detail::timed_batch_of<Pairs>::earliest(positions, pairs, options);
}
template <query_range Queries>
earliest_time earliest(const Queries& queries, const time_options& options = {}) {
    return detail::timed_batch_of<Queries>::earliest(queries, options);
}

}  // namespace ccd
