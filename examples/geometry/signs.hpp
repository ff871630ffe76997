// One algorithm over exact signs and over plain doubles: shared by the examples of this folder.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <errbound/predicates.hpp>
#include <errbound/sign.hpp>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

/// A double as number of an expression: signs are rounded.
struct plain_double {
    double value;
    constexpr plain_double(double x) : value(x) {}
    friend constexpr plain_double operator+(plain_double x, plain_double y) {
        return x.value + y.value;
    }
    friend constexpr plain_double operator-(plain_double x, plain_double y) {
        return x.value - y.value;
    }
    friend constexpr plain_double operator*(plain_double x, plain_double y) {
        return x.value * y.value;
    }
    friend constexpr errbound::sign_type sign_of(plain_double x) {
        using enum errbound::sign_type;
        return x.value > 0 ? positive : x.value < 0 ? negative : zero;
    }
};

/// The predicate, or its expression in plain double.
template <bool Exact>
constexpr auto sign_by(const auto& predicate) {
    return [&predicate](const auto&... p) {
        if constexpr (Exact)
            return predicate(p...);
        else
            return errbound::filters::conclude(predicate.template value<plain_double>(p...));
    };
}

/// Points of some family that are almost degenerate.
template <std::size_t Dimension>
struct family {
    using points = std::vector<std::array<double, Dimension>>;
    const char* name;
    points (*make)(std::mt19937_64&);
};
/// Compares both kinds of signs on all families. `result<Exact>(points)` returns the number of its
/// parts and its flaws, or throws std::runtime_error. True if all exact results have no flaws, and
/// all others have.
template <std::size_t Dimension, class Result>
bool compare_families(const std::vector<family<Dimension>>& families, const char* parts,
                      const Result& result) {
    std::mt19937_64 random(1);
    std::size_t as_expected = 0;
    const auto valid = [&](const char* signs, const auto& compute) {
        std::pair<std::size_t, std::string> found;
        try {
            found = compute();
        } catch (const std::runtime_error& contradiction) {
            found.second = contradiction.what();
        }
        if (found.second.empty())
            std::printf("  %s: valid, %zu %s\n", signs, found.first, parts);
        else
            std::printf("  %s: broken: %s\n", signs, found.second.c_str());
        return found.second.empty();
    };
    for (const auto& [name, make] : families) {
        auto points = make(random);
        std::ranges::sort(points);
        points.erase(std::unique(points.begin(), points.end()), points.end());
        std::ranges::shuffle(points, random);
        std::printf("%s, %zu points\n", name, points.size());
        const bool exact =
            valid("errbound", [&] { return result.template operator()<true>(points); });
        const bool plain =
            valid("plain double", [&] { return result.template operator()<false>(points); });
        as_expected += exact && !plain;
    }
    std::printf("%zu of %zu as expected\n", as_expected, families.size());
    return as_expected == families.size();
}
