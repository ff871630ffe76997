// Generic code over the kinds that files hold (ccd::stored_kinds).
#pragma once

#include <ccd/kind.hpp>
#include <ccd/query.hpp>

namespace ccd {

template <class Visit>
constexpr decltype(auto) visit_stored_kind(kind k, Visit&& visit) {
    return k == kind::edge_edge ? visit.template operator()<kind::edge_edge>()
                                : visit.template operator()<kind::vertex_face>();
}

/// One member Of<Query> for each stored kind.
template <template <class Query> class Of>
struct by_stored_kind {
    Of<ccd::vertex_face<double>> vertex_face;
    Of<ccd::edge_edge<double>> edge_edge;

    template <kind K>
    auto& of() {
        return member<K>(*this);
    }
    template <kind K>
    const auto& of() const {
        return member<K>(*this);
    }
    template <class Visit>
    void for_each(Visit&& visit) {
        visit(vertex_face);
        visit(edge_edge);
    }
    template <class Visit>
    void for_each(Visit&& visit) const {
        visit(vertex_face);
        visit(edge_edge);
    }

  private:
    template <kind K, class Self>
    static auto& member(Self& self) {
        static_assert(K == kind::vertex_face || K == kind::edge_edge, "not a stored kind");
        if constexpr (K == kind::vertex_face) return self.vertex_face;
        if constexpr (K == kind::edge_edge) return self.edge_edge;
    }
};

}  // namespace ccd
