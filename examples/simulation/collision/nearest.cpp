#include "examples/simulation/collision/nearest.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace simulation {
namespace {

nearest_points of_weights(const std::array<vec3, 4>& x, const std::array<double, 4>& weights) {
    nearest_points found{weights, vec3::Zero()};
    for (std::size_t i = 0; i < 4; ++i) found.between += weights[i] * x[i];
    return found;
}

/// Returns the parameter in [0, 1] of the point of the segment from a to b that is nearest to p.
double place_on(const vec3& p, const vec3& a, const vec3& b) {
    const double length = (b - a).squaredNorm();
    return length > 0 ? std::clamp((p - a).dot(b - a) / length, 0.0, 1.0) : 0;
}

}  // namespace

nearest_points nearest_vertex_edge(const std::array<vec3, 4>& x) {
    const double t = place_on(x[0], x[1], x[2]);
    return of_weights(x, {1, t - 1, -t, 0});
}

nearest_points nearest_vertex_face(const std::array<vec3, 4>& x) {
    const vec3 &p = x[0], &a = x[1], &b = x[2], &c = x[3];
    const vec3 normal = (b - a).cross(c - a);
    const double area = normal.squaredNorm();
    if (area > 0) {
        const double u = normal.dot((c - b).cross(p - b)) / area;
        const double v = normal.dot((a - c).cross(p - c)) / area;
        const double w = normal.dot((b - a).cross(p - a)) / area;
        if (u >= 0 && v >= 0 && w >= 0) return of_weights(x, {1, -u, -v, -w});
    }
    const double ab = place_on(p, a, b), bc = place_on(p, b, c), ca = place_on(p, c, a);
    nearest_points best = of_weights(x, {1, ab - 1, -ab, 0});
    for (const nearest_points& other :
         {of_weights(x, {1, 0, bc - 1, -bc}), of_weights(x, {1, -ca, 0, ca - 1})})
        if (other.distance() < best.distance()) best = other;
    return best;
}

nearest_points nearest_edges(const std::array<vec3, 4>& x) {
    const vec3 a = x[1] - x[0], b = x[3] - x[2], r = x[0] - x[2];
    const double aa = a.squaredNorm(), bb = b.squaredNorm(), ab = a.dot(b);
    const double gram = aa * bb - ab * ab;
    std::array<nearest_points, 5> found;
    std::size_t count = 0;
    const auto add = [&](double s, double t) {
        found[count++] = of_weights(x, {1 - s, s, t - 1, -t});
    };
    // Nearest points are inside both edges, unless these are parallel, or at an end of one.
    if (gram > 1e-14 * aa * bb) {
        const double s = (ab * b.dot(r) - bb * a.dot(r)) / gram;
        const double t = (aa * b.dot(r) - ab * a.dot(r)) / gram;
        if (s >= 0 && s <= 1 && t >= 0 && t <= 1) add(s, t);
    }
    if (count == 0) {
        add(0, place_on(x[0], x[2], x[3]));
        add(1, place_on(x[1], x[2], x[3]));
        add(place_on(x[2], x[0], x[1]), 0);
        add(place_on(x[3], x[0], x[1]), 1);
    }
    return *std::min_element(
        found.begin(), found.begin() + std::ptrdiff_t(count),
        [](const auto& p, const auto& q) { return p.distance() < q.distance(); });
}

}  // namespace simulation
