// Signs of a polynomial at the roots of another, by signed remainders in integers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <errbound/roots/integer_polynomial.hpp>
#include <utility>
#include <vector>

#include "tests/errbound/roots/polynomial_families.hpp"

/// Tarski's query, by the sign variations of the signed remainders of p and p'·g, divided by the
/// last of them. Let neither low nor high be a root of p, or let g be 1. Then the variations at low
/// minus those at high are the sum of g's signs at the distinct roots of p in (low, high]. (Basu,
/// Pollack, Roy, Algorithms in Real Algebraic Geometry, Theorem 2.61; g = 1: Sturm.)
class tarski {
  public:
    using integer = polynomial_families::integer;
    using form = std::vector<integer>;
    using point = errbound::dyadic<integer>;

    tarski(form p, const form& g) {
        errbound::roots::trim(p);
        form second = p.size() > 1 ? polynomial_families::generator::product(
                                         errbound::roots::derivative(p), g)
                                   : form{};
        errbound::roots::trim(second);
        chain_.push_back(std::move(p));
        while (!second.empty()) {
            form rest = negative_remainder(chain_.back(), second);
            chain_.push_back(std::move(second));
            second = std::move(rest);
        }
        form last = chain_.back();
        errbound::roots::make_primitive(last);
        for (form& f : chain_) f = errbound::roots::divided(f, last);
    }
    int between(const point& low, const point& high) const {
        return variations_at(low) - variations_at(high);
    }
    /// On the whole line.
    int everywhere() const { return variations_at_end(false) - variations_at_end(true); }
    /// In [low, infinity).
    int from(const point& low) const {
        return variations_at(low) - variations_at_end(true) + is_root(low);
    }
    bool is_root(const point& x) const { return value(chain_[0], x) == 0; }
    int in_closed(const point& low, const point& high) const {
        return between(low, high) + is_root(low);
    }

  private:
    static integer value(const form& p, const point& x) {
        integer sum = 0, power = 1;
        const int e = std::min(x.exponent(), 0);
        const integer m = x.in_units(e);
        for (std::size_t i = 0; i < p.size(); ++i) {
            sum += (p[i] * power) << static_cast<unsigned>(-e * static_cast<int>(p.size() - 1 - i));
            power *= m;
        }
        return sum;
    }
    template <class Value>
    int variations(const Value& value_of) const {
        int count = 0, last = 0;
        for (const form& f : chain_) {
            const int s = integer(value_of(f)).sign();
            if (s == 0) continue;
            if (s == -last) ++count;
            last = s;
        }
        return count;
    }
    int variations_at(const point& x) const {
        return variations([&](const form& f) { return value(f, x); });
    }
    int variations_at_end(bool right) const {
        return variations([&](const form& f) {
            return right || f.size() % 2 == 1 ? f.back() : integer(-f.back());
        });
    }
    static form negative_remainder(form a, const form& b) {
        const integer lead = abs(b.back());
        while (a.size() >= b.size()) {
            const integer factor = b.back() < 0 ? integer(-a.back()) : a.back();
            const std::size_t shift = a.size() - b.size();
            for (integer& c : a) c *= lead;
            for (std::size_t i = 0; i < b.size(); ++i) a[i + shift] -= factor * b[i];
            errbound::roots::trim(a);
        }
        errbound::roots::make_primitive(a);
        for (integer& c : a) c = -c;
        return a;
    }

    std::vector<form> chain_;
};
