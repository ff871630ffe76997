// Proof that a first time exists if there is a contact: proofs/times/Curves.v, face_curves_first,
// edges_curves_first, smooth_continuous.
#include <ccd/bodies/motion.hpp>
#include <ccd/curves.hpp>
#include <ccd/kind.hpp>
#include <ccd/methods/transform.hpp>
#include <cmath>
#include <cstddef>
#include <string>

#include "ccd/contact/first_times.hpp"

namespace ccd {

std::string fault_of(const rational_curve& motion) {
    const auto& w = motion.weights;
    if (!w.empty() && w.size() != motion.points.size())
        return "number of weights is " + std::to_string(w.size()) + "; expected " +
               std::to_string(motion.points.size()) + ", one for each control point";
    for (std::size_t i = 0; i < w.size(); ++i)
        if (!(w[i] > 0 && std::isfinite(w[i])))
            return "weight " + std::to_string(i) + " is " + std::to_string(w[i]) +
                   "; expected a finite number > 0";
    return {};
}

template <curve_query Query>
first_time time_within(const Query& query, separation d, double t_max) {
    using motion = typename detail::motion_of_query<Query>::type;
    const auto points = points_of(query);
    return detail::first_within_of<kind_of<Query>, motion>(
        points, d, t_max, detail::arithmetic::floating_point_first);
}

template first_time time_within(const vertex_face_of<curve>&, separation, double);
template first_time time_within(const edge_edge_of<curve>&, separation, double);
template first_time time_within(const vertex_edge_of<curve>&, separation, double);
template first_time time_within(const vertex_vertex_of<curve>&, separation, double);

template first_time time_within(const vertex_face_of<rational_curve>&, separation, double);
template first_time time_within(const edge_edge_of<rational_curve>&, separation, double);
template first_time time_within(const vertex_edge_of<rational_curve>&, separation, double);
template first_time time_within(const vertex_vertex_of<rational_curve>&, separation, double);

template first_time time_within(const vertex_face_of<body_point>&, separation, double);
template first_time time_within(const edge_edge_of<body_point>&, separation, double);
template first_time time_within(const vertex_edge_of<body_point>&, separation, double);
template first_time time_within(const vertex_vertex_of<body_point>&, separation, double);

}  // namespace ccd
