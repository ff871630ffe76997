#include "examples/simulation/collision/collision_handler.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "examples/simulation/collision/nearest.hpp"
#include "examples/simulation/collision/zones.hpp"

namespace simulation {
namespace {

class stopwatch {
  public:
    explicit stopwatch(double& sum) : sum_(sum) {}
    stopwatch(const stopwatch&) = delete;
    stopwatch& operator=(const stopwatch&) = delete;
    ~stopwatch() {
        sum_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

  private:
    double& sum_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

ccd::vertex_rows way(const rows& before, const rows& after) {
    return {before, after};
}

/// Returns four vertices. A pair with fewer repeats the first one, with weight 0.
template <class Pair>
std::array<vertex_index, 4> four_vertices(const Pair& pair) {
    const auto some = vertices_of(pair);
    std::array<vertex_index, 4> four;
    four.fill(some[0]);
    std::copy(some.begin(), some.end(), four.begin());
    return four;
}

std::array<vec3, 4> at(const std::array<vertex_index, 4>& vertices, const rows& positions) {
    std::array<vec3, 4> x;
    for (std::size_t i = 0; i < 4; ++i) x[i] = positions.row(vertices[i]).transpose();
    return x;
}

template <ccd::kind K>
nearest_points nearest_of_kind(const std::array<vec3, 4>& x) {
    if constexpr (K == ccd::kind::vertex_face) return nearest_vertex_face(x);
    if constexpr (K == ccd::kind::edge_edge) return nearest_edges(x);
    if constexpr (K == ccd::kind::vertex_edge) return nearest_vertex_edge(x);
    return {{1, -1, 0, 0}, x[0] - x[1]};
}

/// True if the nearest points of the features are also those of the surfaces. A vertex above the
/// inside of a face is always a contact.
bool nearest_of_surfaces(const std::array<vertex_index, 4>& vertices, const nearest_points& nearest,
                         const rows& positions, const neighbours& neighbours) {
    struct side {
        std::array<vertex_index, 4> vertices{};
        std::size_t size = 0;
        vec3 on = vec3::Zero();
        std::span<const vertex_index> feature() const { return {vertices.data(), size}; }
    };
    const auto of_sign = [&](double sign) {
        side s;
        for (std::size_t i = 0; i < 4; ++i) {
            if (!(sign * nearest.weights[i] > 0)) continue;
            s.vertices[s.size++] = vertices[i];
            s.on += sign * nearest.weights[i] * positions.row(vertices[i]).transpose();
        }
        return s;
    };
    const side first = of_sign(1), second = of_sign(-1);
    const auto is_nearest = [&](const side& s, const side& other) {
        return neighbours.nearest_of_surface(s.feature(), s.on, other.on, other.feature(),
                                             positions);
    };
    const bool above_face = second.size == 3;
    return above_face || (is_nearest(first, second) && is_nearest(second, first));
}

/// Precondition: the pair does not touch, so that it has a normal.
contact contact_of(const std::array<vertex_index, 4>& vertices, const nearest_points& nearest) {
    return {vertices, nearest.weights, nearest.between / nearest.distance(), 0};
}

struct near_pair {
    double distance;
    bool of_surfaces;  ///< its nearest points are also those of the surfaces
    contact between;
};

double gap(const contact& c, const rows& positions) {
    vec3 sum = vec3::Zero();
    for (std::size_t i = 0; i < 4; ++i) sum += c.weight[i] * positions.row(c.vertex[i]).transpose();
    return c.normal.dot(sum);
}

void require_good(const std::vector<double>& masses, const std::vector<int>& bodies,
                  double time_step, const collision_options& options) {
    const auto require = [](bool good, const std::string& message) {
        if (!good) throw std::invalid_argument("collision_handler: " + message);
    };
    const auto not_negative = [&](const std::string& name, double x) {
        require(std::isfinite(x) && x >= 0,
                name + " is " + std::to_string(x) + "; expected a finite number >= 0");
    };
    for (std::size_t v = 0; v < masses.size(); ++v)
        not_negative("mass of vertex " + std::to_string(v), masses[v]);
    require(bodies.size() == masses.size(), "number of bodies is " + std::to_string(bodies.size()) +
                                                "; expected one for each of " +
                                                std::to_string(masses.size()) + " vertices");
    require(std::isfinite(time_step) && time_step > 0,
            "time step is " + std::to_string(time_step) + "; expected a finite number > 0");
    not_negative("thickness", options.thickness);
    not_negative("friction", options.friction);
    not_negative("push", options.push);
    not_negative("tolerance", options.tolerance);
}

void require_positions(const std::string& name, const rows& x, std::size_t vertices) {
    if (std::size_t(x.rows()) != vertices)
        throw std::invalid_argument("collision_handler: number of " + name + " is " +
                                    std::to_string(x.rows()) + "; expected one for each of " +
                                    std::to_string(vertices) + " vertices");
    for (Eigen::Index v = 0; v < x.rows(); ++v)
        if (!x.row(v).allFinite())
            throw std::invalid_argument("collision_handler: row " + std::to_string(v) + " of " +
                                        name + " is not finite; expected finite numbers");
}

std::size_t uncertain_among(const ccd::pair_lists& pairs, ccd::method method,
                            const ccd::vertex_rows& positions) {
    std::size_t count = 0;
    const auto look = [&](const auto& list) {
        for (const auto& pair : list)
            count +=
                ccd::decide(method, query_of(positions, pair)).outcome == ccd::outcome::uncertain;
    };
    look(pairs.vertex_face);
    look(pairs.edge_edge);
    return count;
}

}  // namespace

collision_handler::collision_handler(const std::vector<ccd::face>& faces,
                                     const std::vector<ccd::edge>& edges,
                                     const std::vector<double>& masses, std::vector<int> bodies,
                                     double time_step, const collision_options& options)
    : steps_(faces, edges, masses.size()),
      neighbours_(faces, edges, masses.size()),
      particles_(masses, time_step),
      masses_(masses),
      bodies_(std::move(bodies)),
      options_(options) {
    require_good(masses, bodies_, time_step, options);
    for (const double mass : masses) pinned_.push_back(mass > 0 ? 0 : 1);
}

ccd::pair_filter collision_handler::filter() const {
    ccd::pair_filter filter;
    filter.pinned = pinned_;
    return filter;
}

std::vector<contact> collision_handler::near_at_start(const rows& before, response_report& report) {
    ccd::step_options options{.threads = options_.threads};
    const double reach = 2 * options_.thickness;
    options.distances.all = reach;
    options.filter = filter();
    std::vector<near_pair> found;
    std::mutex mutex;
    ccd::candidate_visitor visitor;
    ccd::for_each_kind([&]<ccd::kind K>() {
        visitor.of<K>() = [&](std::span<const ccd::pair_of_kind<K>> block) {
            std::vector<near_pair> near;
            for (const auto& pair : block) {
                const auto vertices = four_vertices(pair);
                const nearest_points nearest = nearest_of_kind<K>(at(vertices, before));
                const double distance = nearest.distance();
                if (distance < reach && distance > 0)
                    near.push_back({distance,
                                    nearest_of_surfaces(vertices, nearest, before, neighbours_),
                                    contact_of(vertices, nearest)});
            }
            const std::scoped_lock lock(mutex);
            found.insert(found.end(), near.begin(), near.end());
        };
    });
    steps_.for_each_candidate(way(before, before), visitor, options);
    std::ranges::sort(found, {}, [](const near_pair& f) {
        return std::pair(f.between.vertex, f.between.weight);
    });
    std::vector<contact> contacts;
    report.least_distance = options_.thickness;
    for (auto& [distance, of_surfaces, contact] : found) {
        const double lacks = options_.thickness - distance;
        report.near_at_start += lacks > 0 ? 1 : 0;
        report.least_distance = std::min(report.least_distance, distance);
        if (!of_surfaces) continue;
        contact.least = lacks > 0 ? options_.push * lacks : lacks;
        if (const auto last = last_forces_.find(contact.vertex); last != last_forces_.end())
            contact.force = last->second;
        contacts.push_back(contact);
    }
    return contacts;
}

ccd::pair_lists collision_handler::detect(const rows& before, const rows& after,
                                          response_report& report) {
    ccd::step_options options{.method = options_.method, .threads = options_.threads};
    options.filter = filter();
    ccd::step_result result;
    {
        const stopwatch watch(report.detection_seconds);
        result = steps_.run(way(before, after), options);
    }
    const std::size_t found = number_of(result.pairs);
    if (report.iterations++ == 0) report.contacts = found;
    report.reported += found;
    report.uncertain += uncertain_among(result.pairs, options_.method, way(before, after));
    if (result.candidates) {
        std::size_t candidates = 0;
        ccd::for_each_kind([&]<ccd::kind K>() { candidates += result.candidates->of<K>(); });
        report.candidates = report.candidates.value_or(0) + candidates;
    }
    return std::move(result.pairs);
}

/// Motion along the normal may use the distance beyond the thickness.
void collision_handler::add_contacts(const ccd::pair_lists& pairs, const rows& before,
                                     const rows& after, std::vector<contact>& contacts) const {
    ccd::for_each_kind([&]<ccd::kind K>() {
        for (const auto& pair : pairs.of<K>()) {
            const auto vertices = four_vertices(pair);
            const nearest_points nearest =
                approach(at(vertices, before), at(vertices, after), nearest_of_kind<K>);
            if (!(nearest.distance() > 0)) continue;
            contact c = contact_of(vertices, nearest);
            c.least = std::min(0.0, options_.thickness - gap(c, before));
            contacts.push_back(c);
        }
    });
}

void collision_handler::advance_instead(const rows& before, rows& after, response_report& report) {
    report.converged = false;
    const ccd::advance_options options{
        .groups = bodies_, .threads = options_.threads, .filter = filter()};
    const ccd::advance_result result = ccd::advance(steps_, way(before, after), options);
    report.fraction = result.fraction;
    for (std::size_t v = 0; v < result.positions.size(); ++v) {
        const auto& [x, y, z] = result.positions[v];
        after.row(Eigen::Index(v)) << x, y, z;
    }
}

void collision_handler::push_apart(std::vector<contact>& contacts, const compliance& bodies,
                                   const rows& before, const rows& proposed, rows& after,
                                   int round) const {
    const contact_options options{
        .friction = options_.friction,
        .tolerance = options_.tolerance * options_.thickness,
        .iterations = options_.iterations,
        .relaxations = round == 0 ? options_.relaxations : options_.relaxations / 3};
    after = solve_contacts(contacts, bodies, options, before, proposed);
    if (round > options_.impulse_rounds - options_.finishing_rounds)
        finish_contacts(contacts, particles_, options_.finishing_sweeps, options.tolerance, before,
                        after);
}

/// Returns the number of pairs that collide, by `exact`, which does not repeat its own test.
std::optional<std::size_t> collision_handler::passed_through(const rows& before, const rows& after,
                                                             response_report& report) {
    if (!options_.certify) return {};
    if (options_.method == ccd::method::exact && report.converged) return 0;
    const stopwatch watch(report.certification_seconds);
    ccd::step_options exact{.threads = options_.threads};
    exact.filter = filter();
    return number_of(steps_.run(way(before, after), exact).pairs);
}

response_report collision_handler::resolve(const rows& before, rows& after,
                                           const compliance& bodies) {
    require_positions("positions", before, masses_.size());
    require_positions("proposed positions", after, masses_.size());
    response_report report;
    const rows proposed = after;
    impact_zones zones(masses_.size());
    std::vector<contact> contacts;
    {
        const stopwatch watch(report.response_seconds);
        contacts = near_at_start(before, report);
        push_apart(contacts, bodies, before, proposed, after, 0);
    }
    while (true) {
        const ccd::pair_lists pairs = detect(before, after, report);
        if (number_of(pairs) == 0) break;
        const stopwatch watch(report.response_seconds);
        if (report.iterations >= options_.rounds) {
            advance_instead(before, after, report);
            break;
        }
        if (report.iterations <= options_.impulse_rounds) {
            add_contacts(pairs, before, after, contacts);
            push_apart(contacts, bodies, before, proposed, after, report.iterations);
        } else {
            ccd::for_each_kind([&]<ccd::kind K>() {
                for (const auto& pair : pairs.of<K>()) zones.join(vertices_of(pair));
            });
            zones.move(masses_, before, after);
        }
    }
    report.zones = zones.count();
    last_forces_.clear();
    for (const contact& c : contacts)
        if (!c.force.isZero(0)) last_forces_[c.vertex] = c.force;
    report.passed_through = passed_through(before, after, report);
    return report;
}

}  // namespace simulation
