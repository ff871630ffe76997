// In which pairs a vertex, an edge or a face takes part.
#pragma once

#include <algorithm>
#include <array>
#include <ccd/io/step_view.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace ccd::io::detail {

class participation {
  public:
    /// The number of pairs, and when the earliest is there: NaN where there is none or no times.
    struct share {
        std::uint32_t pairs = 0;
        double toi = std::numeric_limits<double>::quiet_NaN();

        void add(const share& other) {
            pairs += other.pairs;
            toi = std::fmin(toi, other.toi);  // which prefers numbers to NaN
        }
    };

    explicit participation(const step_view& step) : first_(step.positions.vertices + 1) {
        for_each_kind([&]<kind K>() {
            const auto& times = step.times.of<K>();
            for (std::size_t i = 0; i < step.pairs.of<K>().size(); ++i) {
                const auto v = vertices_of(step.pairs.of<K>()[i]);
                const share one{1, times.empty() ? share{}.toi : times[i].low};
                constexpr std::size_t of_first = kind_traits<K>::first_vertices;
                elements_.push_back({key_of(std::span(v).template first<of_first>()), one});
                elements_.push_back({key_of(std::span(v).template subspan<of_first>()), one});
            }
        });
        merge();
    }

    /// Of what has these vertices: of all elements whose vertices are among them. No pair is
    /// counted twice, since its two elements share no vertex and together have more than a face,
    /// or than the edge whose end a point cannot be.
    share of(std::span<const vertex_index> cell) const {
        share sum;
        for (auto v = cell.begin(); v != cell.end(); ++v) {
            if (std::find(cell.begin(), v, *v) != v) continue;  // a vertex that is repeated
            for (std::size_t i = first_[*v]; i < first_[*v + 1]; ++i)
                if (std::ranges::all_of(elements_[i].key, [cell](vertex_index of_element) {
                        return std::ranges::find(cell, of_element) != cell.end();
                    }))
                    sum.add(elements_[i].of_element);
        }
        return sum;
    }

  private:
    using vertex_key = std::array<vertex_index, 3>;
    struct element {
        vertex_key key;  // ascending; the last is repeated where there are fewer
        share of_element;
    };

    static vertex_key key_of(std::span<const vertex_index> vertices) {
        vertex_key key;
        key.fill(*std::ranges::max_element(vertices));
        std::ranges::copy(vertices, key.begin());
        std::ranges::sort(key);
        return key;
    }

    /// Each element once, sorted; and where those of each least vertex begin.
    void merge() {
        std::ranges::sort(elements_, {}, &element::key);
        std::vector<element> once;
        for (const element& next : elements_) {
            if (!once.empty() && once.back().key == next.key)
                once.back().of_element.add(next.of_element);
            else
                once.push_back(next);
        }
        elements_ = std::move(once);
        for (const element& e : elements_) ++first_[e.key[0] + 1];
        for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
    }

    std::vector<element> elements_;
    std::vector<std::size_t> first_;
};

}  // namespace ccd::io::detail
