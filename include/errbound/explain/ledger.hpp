// A number's error by its sources, stored by the rule `explained` (explained.hpp). An entry is one
// source's part: `known`, a signed part of exact value − value, and `unknown` >= 0, a bound of the
// rest. With c the rule's correction and e its bound, Σ (|known| + unknown) >= e despite rounding,
// and Σ known = c up to rounding. Infinite entries explain an infinite e.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <errbound/explain/scope.hpp>
#include <errbound/number_traits.hpp>
#include <limits>
#include <vector>

namespace errbound::detail {

/// Contributions are added up in double if it has T's range.
template <class T>
inline constexpr bool fits_double =
    number_traits<T>::digits <= number_traits<double>::digits&& number_traits<T>::max_exponent <=
    number_traits<double>::max_exponent&& number_traits<T>::min_exponent >=
    number_traits<double>::min_exponent&& requires(const T& x) {
    static_cast<double>(x);
};
template <class T>
using amount_of = std::conditional_t<fits_double<T>, double, T>;

template <class A>
struct ledger_entry {
    source from;
    A known = A(0), unknown = A(0);

    A size() const { return number_traits<A>::abs(known) + unknown; }
    bool is_finite() const { return number_traits<A>::is_finite(size()); }
};

template <class A>
class ledger {
  public:
    using entry = ledger_entry<A>;

    const std::vector<entry>& entries() const { return entries_; }

    template <class Times>
    void carry(const ledger& other, const Times& times) {
        if (other.entries_.empty()) return;
        std::vector<entry> all;
        all.reserve(entries_.size() + other.entries_.size() + 1);
        auto mine = entries_.begin();
        for (const entry& o : other.entries_) {
            const entry carried{o.from, times(o.known), number_traits<A>::abs(times(o.unknown))};
            if (!carried.is_finite()) continue;  // overflow; the result's bound is still finite
            while (mine != entries_.end() && mine->from < o.from) all.push_back(*mine++);
            if (mine != entries_.end() && mine->from == o.from)
                all.push_back(sum(*mine++, carried));
            else
                all.push_back(carried);
        }
        all.insert(all.end(), mine, entries_.end());
        entries_.swap(all);
    }
    /// Adds another ledger's entries by size, without sign, scaled to the sum `total`.
    template <class B>
    void carry_sizes(const ledger<B>& other, const A& total) {
        B sizes(0);
        for (const ledger_entry<B>& o : other.entries()) sizes += o.size();
        if (!number_traits<B>::is_finite(sizes)) return;
        for (const ledger_entry<B>& o : other.entries())
            book({o.from, A(0), A(static_cast<A>(o.size() / sizes) * total)});
    }
    template <class B>
    void carry_unknown(const ledger<B>& other) {
        for (const ledger_entry<B>& o : other.entries())
            if (!o.is_finite()) book_unknown(o.from);
    }
    void book(const entry& e) {
        if (e.size() == 0 || !e.is_finite()) return;
        entry& there = at(e.from);
        there = sum(there, e);
    }
    void book_unknown(const source& from) { at(from) = {from, A(0), number_traits<A>::infinity()}; }

    /// Makes entries add up to c, if signs are known, and to at least the error e. Distributes the
    /// bound's part beyond first order by size, or books it to `own` if there are no entries.
    void settle(const source& own, const A& c, const A& e) {
        using traits = number_traits<A>;
        A known(0), unknown(0), sizes(0);
        for (const entry& x : entries_) {
            known += x.known;
            unknown += x.unknown;
            sizes += x.size();
        }
        if (!traits::is_finite(sizes)) {
            entries_.clear();
            known = unknown = sizes = A(0);
        }
        const A off = traits::abs(c - known);
        const A wanted = (traits::max)(A(0), e - traits::abs(c)) + off;
        // Divides first: the sums may exceed the wanted amount by more than a number's range.
        if (wanted > unknown && sizes > 0) {
            const A missing = wanted - unknown;
            for (entry& x : entries_) x.unknown += x.size() / sizes * missing;
        } else if (wanted > unknown) {
            book({own, A(0), wanted});
        } else if (unknown > 0) {
            for (entry& x : entries_) x.unknown = x.unknown / unknown * wanted;
        }
        cover(e);
        std::erase_if(entries_, [](const entry& x) { return x.size() == 0; });
    }
    /// Merges the smallest entries until at most `limit` >= 1 are left.
    void limit(std::size_t limit) {
        while (entries_.size() > limit) {
            entry& rest = at(the_rest);  // the last of all
            const auto smallest = std::min_element(
                entries_.begin(), entries_.end() - 1,
                [](const entry& x, const entry& y) { return x.size() < y.size(); });
            rest = sum(rest, *smallest);
            entries_.erase(smallest);
        }
    }
    void negate() {
        for (entry& x : entries_) x.known = -x.known;
    }

  private:
    /// Adds the part of e that roundings left uncovered to the largest entry. The exact sum of n
    /// sizes is at least Ŝ(1 − u)^(n − 1); three roundings of at most e and two of the entry leave
    /// at least e(1 + 2(n + 4)u − 3u)(1 − u)^(n + 1) >= e for n <= 2^-10/u. Near underflow sums are
    /// exact.
    void cover(const A& e) {
        using traits = number_traits<A>;
        A all(0);
        for (const entry& x : entries_) all += x.size();
        if (entries_.empty() || (entries_.size() == 1 && all >= e)) return;
        const A missing = (e - all) + e * (static_cast<A>(entries_.size() + 4) * traits::epsilon());
        if (!(missing > 0)) return;
        entry& largest =
            *std::max_element(entries_.begin(), entries_.end(),
                              [](const entry& x, const entry& y) { return x.size() < y.size(); });
        const A covered = largest.unknown + missing;
        if (traits::is_finite(covered)) largest.unknown = covered;
    }
    static entry sum(const entry& x, const entry& y) {
        return {x.from, x.known + y.known, x.unknown + y.unknown};
    }
    entry& at(const source& from) {
        const auto place =
            std::lower_bound(entries_.begin(), entries_.end(), from,
                             [](const entry& x, const source& wanted) { return x.from < wanted; });
        if (place != entries_.end() && place->from == from) return *place;
        return *entries_.insert(place, entry{from});
    }

    std::vector<entry> entries_;  // sorted by source
};

}  // namespace errbound::detail
