#pragma once

#include <array>
#include <ccd/kind.hpp>
#include <ccd/query.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <random>
#include <string>
#include <string_view>
#include <utility>

#include "ccd/io/stored_kinds.hpp"
#include "errbound/support/hexadecimal.hpp"

namespace ccd::lab {

/// Points in the order of the query's members; kinds with fewer points use the first three or two.
using points = std::array<moving_point<double>, 4>;

/// Random numbers by integer arithmetic only: std distributions differ between libraries.
class source {
  public:
    explicit source(std::uint64_t seed) : bits_(seed) {}

    std::uint64_t bits() { return bits_(); }
    /// low..high; the modulo's bias is far below what a test could detect.
    int between(int low, int high) {
        return low + static_cast<int>(bits_() % static_cast<std::uint64_t>(high - low + 1));
    }
    bool one_in(int n) { return between(1, n) == 1; }
    /// [0, 1), a multiple of 2^-53.
    double unit() { return std::ldexp(static_cast<double>(bits_() >> 11), -53); }
    /// [-1, 1), a multiple of 2^-52.
    double symmetric() { return 2 * unit() - 1; }

  private:
    std::mt19937_64 bits_;
};

/// The source of one query, so that it can be made again without the others.
inline source source_of(std::string_view family, std::initializer_list<std::uint64_t> words) {
    std::uint64_t hash = 0xcbf29ce484222325;  // FNV-1a
    const auto stir = [&hash](std::uint64_t word) { hash = (hash ^ word) * 0x100000001b3; };
    for (const char c : family) stir(static_cast<unsigned char>(c));
    for (const std::uint64_t word : words) stir(word);
    return source(hash);
}

/// Eight rows as in the benchmark's files, in hexadecimal floats: all points at t = 0, then all at
/// t = 1. `last_column` ends each row.
inline std::string csv(const points& p, std::string_view last_column = {}) {
    std::string rows;
    const auto row = [&](const point<double>& at) {
        using errbound::support::hexadecimal;
        rows += hexadecimal(at.x) + "," + hexadecimal(at.y) + "," + hexadecimal(at.z);
        rows.append(last_column).append("\n");
    };
    for (const auto& m : p) row(m.t0);
    for (const auto& m : p) row(m.t1);
    return rows;
}

template <class Query>
Query as_query(const points& p) {
    using traits = kind_traits<kind_of<Query>>;
    return [&]<std::size_t... I>(std::index_sequence<I...>) {
        return Query{p[I]...};
    }
    (std::make_index_sequence<traits::first_vertices + traits::second_vertices>());
}

template <class Visit>
decltype(auto) visit_query(kind which, const points& p, Visit&& visit) {
    return visit_kind(which, [&]<kind K>() -> decltype(auto) {
        return visit(as_query<typename kind_traits<K>::template query<double>>(p));
    });
}

template <class Visit>
decltype(auto) visit_stored_query(kind which, const points& p, Visit&& visit) {
    return visit_stored_kind(which, [&]<kind K>() -> decltype(auto) {
        return visit(as_query<typename kind_traits<K>::template query<double>>(p));
    });
}

}  // namespace ccd::lab
