// Steps until an early contact, for advances: their candidates serve again for shorter ways.
#pragma once

#include <ccd/step.hpp>
#include <string>

namespace ccd::detail {

class short_steps {
  public:
    explicit short_steps(mesh_steps& steps) : steps_(steps) {}

    /// Throws std::invalid_argument unless these are input for a step of this mesh.
    void check(const vertex_rows& way, const step_options& options,
               const std::string& caller) const;

    /// Returns the earliest contact after the start among a sample of the edge/edge pairs on the
    /// whole way, or `separate`. The mesh's first contact is not later.
    first_time first_of_sample(const vertex_rows& way, const step_options& options);

    /// Same as mesh_steps::run with first_contact, for t_max < 1. Pairs and times may be missing.
    /// Keeps the candidates, unless they are many.
    step_result run(const vertex_rows& way, const step_options& options);

    bool has_candidates() const { return has_candidates_; }
    /// Same as mesh_steps::run(way, options).pairs, from the candidates of the last run with these
    /// options. Precondition: `way` goes from the start of the last run to positions of `between`
    /// (ccd/step/advance/advancing.hpp) at one fraction, at most t_max, for all vertices.
    pair_lists pairs_on(const vertex_rows& way, const step_options& options);

  private:
    mesh_steps& steps_;
    pair_lists candidates_;  ///< not sorted
    bool has_candidates_ = false;
};

}  // namespace ccd::detail
