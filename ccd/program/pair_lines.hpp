// Pairs as lines of text: vf,v,f0,f1,f2 and so on, with times if `times` is not null.
#pragma once

#include <array>
#include <ccd/kind.hpp>
#include <ccd/step.hpp>
#include <cstddef>
#include <string>

#include "ccd/program/options.hpp"

namespace ccd::program {

template <class Number, std::size_t N>
const std::array<Number, N>& vertices_of(const std::array<Number, N>& numbers) {
    return numbers;
}

template <class Lists>
std::string lines_of_pairs(const Lists& pairs, const time_lists* times = nullptr) {
    std::string lines;
    for_each_kind([&]<kind K>() {
        const auto& of_kind = pairs.template of<K>();
        for (std::size_t i = 0; i < of_kind.size(); ++i) {
            lines += short_name(K);
            for (const auto v : vertices_of(of_kind[i])) lines += ',' + std::to_string(v);
            if (times) lines += ',' + text_of_time(times->of<K>()[i]);
            lines += '\n';
        }
    });
    return lines;
}

}  // namespace ccd::program
