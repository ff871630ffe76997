// How two simplices meet, by convex combinations: all weights for which a point of one is a point
// of the other. No orientation of points is evaluated.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <errbound/simplices/relation.hpp>
#include <vector>

#include "tests/support/big_integer.hpp"

namespace simplices_oracle {

template <std::size_t D>
using points = std::vector<std::array<big_integer, D>>;

/// Linear equations in integers: the sum of row[i]·x_i is the row's last entry. Each row is solved
/// for one variable, which no other row has; that variable's coefficient is the same in all rows.
class equations {
  public:
    using row = std::vector<big_integer>;

    explicit equations(std::size_t variables) : variables_(variables) {}

    /// Adds an equation. Returns false if there is no solution.
    bool add(const row& added) {
        row r(added.size());
        for (std::size_t i = 0; i < r.size(); ++i) {
            if (sign(added[i]) != 0) r[i] = added[i] * pivot_;
            for (std::size_t k = 0; k < rows_.size(); ++k)
                if (sign(added[solved_[k]]) != 0 && sign(rows_[k][i]) != 0)
                    r[i] = r[i] - added[solved_[k]] * rows_[k][i];
        }
        for (std::size_t i = 0; i < variables_; ++i) {
            if (sign(r[i]) == 0) continue;
            // All entries are determinants, so the divisions are exact (Bareiss 1968).
            for (row& other : rows_) {
                const big_integer factor = other[i];
                for (std::size_t j = 0; j < r.size(); ++j)
                    other[j] = exact_quotient(other[j] * r[i] - factor * r[j], pivot_);
            }
            pivot_ = r[i];
            rows_.push_back(std::move(r));
            solved_.push_back(i);
            return true;
        }
        return sign(r.back()) == 0;
    }
    bool add_zero(std::size_t variable) {
        row r(variables_ + 1);
        r[variable] = 1;
        return add(r);
    }
    std::size_t rank() const { return rows_.size(); }
    /// The unique solution as numerators over a positive divisor, if none is negative.
    bool solution(row& x, big_integer& divisor) const {
        x.assign(variables_, big_integer());
        divisor = abs(pivot_);
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            if (sign(rows_[k].back()) * sign(pivot_) < 0) return false;
            x[solved_[k]] = abs(rows_[k].back());
        }
        return true;
    }

  private:
    std::size_t variables_;
    std::vector<row> rows_;
    std::vector<std::size_t> solved_;
    big_integer pivot_ = 1;
};

template <std::size_t D>
std::size_t rank_of(const points<D>& directions) {
    equations e(D);
    for (const auto& d : directions) {
        equations::row r(D + 1);
        std::copy(d.begin(), d.end(), r.begin());
        e.add(r);
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
            e.add(r);
        };
        unit(0, a.size());
        unit(a.size(), variables);
        for (std::size_t k = 0; k < D; ++k) {
            equations::row r(variables + 1);
            for (std::size_t i = 0; i < a.size(); ++i) r[i] = a[i][k];
            for (std::size_t j = 0; j < b.size(); ++j) r[a.size() + j] = big_integer() - b[j][k];
            if (!e.add(r)) return;
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
        if (!interiors_meet()) return touching;
        const std::size_t rank_a = rank_of<D>(directions(a_)), rank_b = rank_of<D>(directions(b_));
        if (rank_a == rank() && rank_b == rank() && rank() > 0) return overlapping;
        return rank() == D ? crossing : touching;
    }
    /// Without their borders. The mean of all corners' weights is positive where any is.
    bool interiors_meet() const {
        return std::all_of(positive_.begin(), positive_.end(), [](bool p) { return p; });
    }
    /// The dimension that both span.
    std::size_t rank() const {
        points<D> all = directions(a_), of_b = directions(b_);
        all.insert(all.end(), of_b.begin(), of_b.end());
        return rank_of<D>(all);
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

namespace predicate_oracle {

/// The first points and the others: 1 if the simplices meet without their borders and span `rank`
/// dimensions, −1 if they do not meet, else 0.
template <std::size_t First, std::size_t D, std::size_t N>
int simplices_meet(const std::array<std::array<big_integer, D>, N>& p, std::size_t rank = D) {
    const simplices_oracle::points<D> a(p.begin(), p.begin() + First),
        b(p.begin() + First, p.end());
    const simplices_oracle::meeting<D> found(a, b);
    if (found.corners().empty()) return -1;
    return found.interiors_meet() && found.rank() == rank ? 1 : 0;
}
inline constexpr auto point_and_other = [](const auto& p) { return simplices_meet<1>(p); };
inline constexpr auto segments = [](const auto& p) { return simplices_meet<2>(p, 2); };
inline constexpr auto segment_and_triangle = [](const auto& p) { return simplices_meet<2>(p); };
inline constexpr auto triangles = [](const auto& p) { return simplices_meet<3>(p); };

}  // namespace predicate_oracle
