#include "examples/simulation/collision/contacts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace simulation {
namespace {

/// One row per contact: a force, or the displacement between its two features.
using by_contact = rows;

by_contact differences(const std::vector<contact>& contacts, const rows& displacements) {
    by_contact u = by_contact::Zero(Eigen::Index(contacts.size()), 3);
    for (std::size_t c = 0; c < contacts.size(); ++c)
        for (std::size_t i = 0; i < 4; ++i)
            u.row(Eigen::Index(c)) +=
                contacts[c].weight[i] * displacements.row(contacts[c].vertex[i]);
    return u;
}

rows forces_on_vertices(const std::vector<contact>& contacts, const by_contact& forces,
                        Eigen::Index vertices) {
    rows f = rows::Zero(vertices, 3);
    for (std::size_t c = 0; c < contacts.size(); ++c)
        if (!forces.row(Eigen::Index(c)).isZero(0))  // most are zero
            for (std::size_t i = 0; i < 4; ++i)
                f.row(contacts[c].vertex[i]) += contacts[c].weight[i] * forces.row(Eigen::Index(c));
    return f;
}

/// Bounds the relative displacement of the features by a unit force of this contact only.
double compliance_at(const contact& c, const compliance& bodies) {
    double first = 0, second = 0;
    for (std::size_t i = 0; i < 4; ++i)
        (c.weight[i] > 0 ? first : second) +=
            std::abs(c.weight[i]) * std::sqrt(bodies.of(c.vertex[i]));
    return first * first + second * second;
}
double particles_at(const contact& c, const compliance& particles) {
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i)
        sum += c.weight[i] * c.weight[i] * particles.of(c.vertex[i]);
    return sum;
}

/// Projects forces: they push, and friction is at most its share of the normal force.
void make_admissible(const std::vector<contact>& contacts, double friction, by_contact& forces) {
    for (std::size_t c = 0; c < contacts.size(); ++c) {
        const vec3 n = contacts[c].normal, f = forces.row(Eigen::Index(c)).transpose();
        const double along = n.dot(f);
        if (!(along > 0)) {
            forces.row(Eigen::Index(c)).setZero();
            continue;
        }
        vec3 across = f - along * n;
        const double max = friction * along, size = across.norm();
        if (size > max) across *= max / size;
        forces.row(Eigen::Index(c)) = (along * n + across).transpose();
    }
}

/// Returns the largest |gap| of contacts with a force, or missing gap of contacts without one.
double violation_of(const std::vector<contact>& contacts, const by_contact& forces,
                    const by_contact& beyond) {
    double most = 0;
    for (std::size_t c = 0; c < contacts.size(); ++c) {
        const double gap = contacts[c].normal.dot(beyond.row(Eigen::Index(c)).transpose());
        most = std::max(most, forces.row(Eigen::Index(c)).isZero(0) ? -gap : std::abs(gap));
    }
    return most;
}

double missing(const contact& c, const rows& before, const rows& after) {
    double moved = 0;
    for (std::size_t i = 0; i < 4; ++i)
        moved += c.weight[i] *
                 c.normal.dot((after.row(c.vertex[i]) - before.row(c.vertex[i])).transpose());
    return c.least - moved;
}

std::vector<std::size_t> active_contacts(const std::vector<contact>& contacts, const rows& before,
                                         const rows& free, const rows& after) {
    std::vector<std::size_t> chosen;
    for (std::size_t c = 0; c < contacts.size(); ++c)
        if (!contacts[c].force.isZero(0) || missing(contacts[c], before, free) > 0 ||
            missing(contacts[c], before, after) > 0)
            chosen.push_back(c);
    return chosen;
}

class projected_gradients {
  public:
    projected_gradients(const std::vector<contact>& contacts, const compliance& bodies,
                        const contact_options& options, const rows& before, const rows& free)
        : contacts_(contacts), bodies_(bodies), options_(options), vertices_(free.rows()) {
        missing_ = differences(contacts, free - before);
        forces_.resize(Eigen::Index(contacts.size()), 3);
        scale_.resize(Eigen::Index(contacts.size()));
        for (std::size_t c = 0; c < contacts.size(); ++c) {
            const auto at = Eigen::Index(c);
            missing_.row(at) -= contacts[c].least * contacts[c].normal.transpose();
            forces_.row(at) = contacts[c].force.transpose();
            const double alone = compliance_at(contacts[c], bodies);
            scale_[at] = alone > 0 ? 1 / alone : 0;
        }
        make_admissible(contacts, options.friction, forces_);
        moved_ = apply(forces_);
    }

    void run() {
        by_contact y = forces_, y_moved = moved_;
        double theta = 1, step = 1;
        double violation = violation_of(contacts_, forces_, moved_ + missing_);
        for (int k = 0; k < options_.iterations && violation > options_.tolerance; ++k) {
            auto [next, next_moved] = descended(y, y_moved, step);
            const bool overshot = ((y - next).cwiseProduct(next - forces_)).sum() > 0;
            const double next_theta = (1 + std::sqrt(1 + 4 * theta * theta)) / 2;
            const double momentum = overshot ? 0 : (theta - 1) / next_theta;
            theta = overshot ? 1 : next_theta;
            y = next + momentum * (next - forces_);
            y_moved = next_moved + momentum * (next_moved - moved_);
            forces_ = next;
            moved_ = next_moved;
            violation = violation_of(contacts_, forces_, moved_ + missing_);
        }
    }

    const by_contact& forces() const { return forces_; }

  private:
    by_contact apply(const by_contact& forces) {
        return differences(contacts_,
                           bodies_.displacements(forces_on_vertices(contacts_, forces, vertices_)));
    }

    /// Takes the longest descent step from y that the quadratic allows. Keeps `step` for the next.
    std::pair<by_contact, by_contact> descended(const by_contact& y, const by_contact& y_moved,
                                                double& step) {
        while (true) {
            by_contact next = y - step * (scale_.asDiagonal() * (y_moved + missing_));
            make_admissible(contacts_, options_.friction, next);
            by_contact moved = apply(next);
            const by_contact d = next - y;
            const double curvature = d.cwiseProduct(moved - y_moved).sum();
            double allowed = 0;
            for (Eigen::Index c = 0; c < d.rows(); ++c)
                if (scale_[c] > 0) allowed += d.row(c).squaredNorm() / scale_[c];
            // Not `<= allowed`: if numbers overflow, no step would be short enough.
            if (!(step * curvature > allowed)) return {std::move(next), std::move(moved)};
            step = std::min(step / 2, 0.9 * allowed / curvature);
        }
    }

    const std::vector<contact>& contacts_;
    const compliance& bodies_;
    const contact_options& options_;
    Eigen::Index vertices_;
    by_contact missing_, forces_, moved_;
    Eigen::VectorXd scale_;
};

}  // namespace

particle_compliance::particle_compliance(const std::vector<double>& masses, double time_step) {
    for (const double mass : masses)
        per_force_.push_back(mass > 0 ? time_step * time_step / mass : 0);
}

rows particle_compliance::displacements(const rows& forces) const {
    rows u = forces;
    for (std::size_t v = 0; v < per_force_.size(); ++v) u.row(Eigen::Index(v)) *= per_force_[v];
    return u;
}

rows solve_contacts(std::vector<contact>& contacts, const compliance& bodies,
                    const contact_options& options, const rows& before, const rows& proposed) {
    rows after = proposed;
    if (contacts.empty()) return after;
    for (int k = 0; k <= options.relaxations; ++k) {
        const rows free = k == 0 ? proposed : bodies.relaxed(after, proposed);
        const std::vector<std::size_t> chosen = active_contacts(contacts, before, free, after);
        std::vector<contact> active;
        for (const std::size_t c : chosen) active.push_back(contacts[c]);
        projected_gradients gradients(active, bodies, options, before, free);
        gradients.run();
        for (std::size_t a = 0; a < active.size(); ++a)
            contacts[chosen[a]].force = gradients.forces().row(Eigen::Index(a)).transpose();
        const rows next = free + bodies.displacements(forces_on_vertices(active, gradients.forces(),
                                                                         proposed.rows()));
        const double changed = (next - after).cwiseAbs().maxCoeff();
        after = next;
        if (k > 0 && changed <= options.tolerance) break;
    }
    return after;
}

double finish_contacts(const std::vector<contact>& contacts, const compliance& particles,
                       int sweeps, double tolerance, const rows& before, rows& after) {
    double violation = 0;
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        violation = 0;
        for (const contact& c : contacts) {
            const double alone = particles_at(c, particles);
            const double lacks = missing(c, before, after);
            if (!(alone > 0) || lacks <= 0) continue;
            violation = std::max(violation, lacks);
            for (std::size_t i = 0; i < 4; ++i)
                after.row(c.vertex[i]) +=
                    lacks / alone * c.weight[i] * particles.of(c.vertex[i]) * c.normal.transpose();
        }
        if (violation <= tolerance) break;
    }
    return violation;
}

}  // namespace simulation
