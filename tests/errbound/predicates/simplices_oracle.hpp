// How two simplices meet, by convex combinations: all weights for which a point of one is a point
// of the other. No orientation of points is evaluated.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <errbound/simplices.hpp>
#include <vector>

#include "tests/support/big_integer.hpp"

namespace simplices_oracle {

template <std::size_t D>
using points = std::vector<std::array<big_integer, D>>;

/// Linear equations in integers: the sum of row[i]·x_i is the row's last entry. Each row is solved
/// for one variable, which no other row has.
class equations {
  public:
    using row = std::vector<big_integer>;

    explicit equations(std::size_t variables) : variables_(variables) {}

    /// Adds an equation. Returns false if there is no solution.
    bool add(row r) {
        for (std::size_t k = 0; k < rows_.size(); ++k) eliminate(r, k);
        for (std::size_t i = 0; i < variables_; ++i) {
            if (sign(r[i]) == 0) continue;
            rows_.push_back(std::move(r));
            solved_.push_back(i);
            for (std::size_t k = 0; k + 1 < rows_.size(); ++k)
                eliminate(rows_[k], rows_.size() - 1);
            return true;
        }
        return sign(r.back()) == 0;
    }
    bool add_zero(std::size_t variable) {
        row r(variables_ + 1);
        r[variable] = 1;
        return add(std::move(r));
    }
    std::size_t rank() const { return rows_.size(); }
    /// The solution as numerators over a common divisor, if it is unique and not negative.
    bool solution(row& x, big_integer& divisor) const {
        divisor = 1;
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            const int s = sign(rows_[k][solved_[k]]) * sign(rows_[k].back());
            if (s < 0) return false;
            if (s > 0) divisor = divisor * abs(rows_[k][solved_[k]]);
        }
        x.assign(variables_, big_integer());
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            if (sign(rows_[k].back()) == 0) continue;
            big_integer others = abs(rows_[k].back());
            for (std::size_t l = 0; l < rows_.size(); ++l)
                if (l != k && sign(rows_[l].back()) != 0)
                    others = others * abs(rows_[l][solved_[l]]);
            x[solved_[k]] = others;
        }
        return true;
    }

  private:
    void eliminate(row& r, std::size_t k) const {
        const row& by = rows_[k];
        const big_integer factor = r[solved_[k]], pivot = by[solved_[k]];
        if (sign(factor) == 0) return;
        for (std::size_t i = 0; i < r.size(); ++i) {
            if (sign(r[i]) != 0) r[i] = r[i] * pivot;
            if (sign(by[i]) != 0) r[i] = r[i] - by[i] * factor;
        }
    }

    std::size_t variables_;
    std::vector<row> rows_;
    std::vector<std::size_t> solved_;
};

template <std::size_t D>
std::size_t rank_of(const points<D>& directions) {
    equations e(D);
    for (const auto& d : directions) {
        equations::row r(D + 1);
        std::copy(d.begin(), d.end(), r.begin());
        e.add(std::move(r));
    }
    return e.rank();
}

/// A point as numerators over a divisor.
template <std::size_t D>
struct fraction_point {
    std::array<big_integer, D> numerators;
    big_integer divisor;
};

template <std::size_t D>
class meeting {
  public:
    meeting(const points<D>& a, const points<D>& b) : a_(a), b_(b), positive_(a.size() + b.size()) {
        const std::size_t variables = a.size() + b.size();
        equations e(variables);
        const auto unit = [&](std::size_t first, std::size_t last) {
            equations::row r(variables + 1);
            std::fill(&r[first], &r[last], big_integer(1));
            r.back() = 1;
            e.add(std::move(r));
        };
        unit(0, a.size());
        unit(a.size(), variables);
        for (std::size_t k = 0; k < D; ++k) {
            equations::row r(variables + 1);
            for (std::size_t i = 0; i < a.size(); ++i) r[i] = a[i][k];
            for (std::size_t j = 0; j < b.size(); ++j) r[a.size() + j] = big_integer() - b[j][k];
            if (!e.add(std::move(r))) return;
        }
        find_corners(e, 0);
    }

    /// Points whose hull is the intersection.
    const std::vector<fraction_point<D>>& corners() const { return corners_; }

    /// The first `common` points of both are the same.
    errbound::relation relation(const points<D>& common) const {
        using enum errbound::relation;
        if (std::all_of(corners_.begin(), corners_.end(),
                        [&](const auto& p) { return is_between(p, common); }))
            return disjoint;
        // The mean of all corners' weights is positive where any is.
        if (!std::all_of(positive_.begin(), positive_.end(), [](bool p) { return p; }))
            return touching;
        points<D> of_a = directions(a_), of_b = directions(b_), all = of_a;
        all.insert(all.end(), of_b.begin(), of_b.end());
        const std::size_t rank_a = rank_of<D>(of_a), rank_b = rank_of<D>(of_b),
                          rank = rank_of<D>(all);
        if (rank_a == rank && rank_b == rank && rank > 0) return overlapping;
        return rank == D ? crossing : touching;
    }

  private:
    /// Sets variables to zero until the solution is unique.
    void find_corners(const equations& e, std::size_t first) {
        if (e.rank() == positive_.size()) {
            equations::row x;
            fraction_point<D> p;
            if (!e.solution(x, p.divisor)) return;
            for (std::size_t i = 0; i < x.size(); ++i)
                if (sign(x[i]) != 0) positive_[i] = true;
            for (std::size_t k = 0; k < D; ++k)
                for (std::size_t i = 0; i < a_.size(); ++i)
                    p.numerators[k] = p.numerators[k] + x[i] * a_[i][k];
            corners_.push_back(std::move(p));
            return;
        }
        for (std::size_t i = first; i < positive_.size(); ++i) {
            equations next = e;
            if (next.add_zero(i) && next.rank() > e.rank()) find_corners(next, i + 1);
        }
    }
    /// True if p is the point, or in the segment of the two points.
    static bool is_between(const fraction_point<D>& p, const points<D>& ends) {
        if (ends.empty()) return false;
        // p is ends[0] + t·(ends[1] − ends[0]) for each coordinate.
        big_integer above, below(1);  // t
        bool found = false;
        for (std::size_t k = 0; k < D; ++k) {
            const big_integer offset = p.numerators[k] - ends[0][k] * p.divisor;
            const big_integer step = (ends.back()[k] - ends[0][k]) * p.divisor;
            if (sign(step) == 0) {
                if (sign(offset) != 0) return false;
                continue;
            }
            if (found && sign(above * step - offset * below) != 0) return false;
            above = offset, below = step, found = true;
        }
        return !found || (sign(above) * sign(below) >= 0 && !(abs(below) < abs(above)));
    }
    static points<D> directions(const points<D>& p) {
        points<D> d;
        for (std::size_t i = 1; i < p.size(); ++i) {
            d.emplace_back();
            for (std::size_t k = 0; k < D; ++k) d.back()[k] = p[i][k] - p[0][k];
        }
        return d;
    }

    const points<D>&a_, &b_;
    std::vector<bool> positive_;  ///< variables with a positive value in some corner
    std::vector<fraction_point<D>> corners_;
};

}  // namespace simplices_oracle
