// The program's way to CUDA devices, in builds with CUDA and without.
#pragma once

#include <ccd/contact.hpp>
#include <ccd/cuda.hpp>
#include <ccd/query.hpp>
#include <ccd/step.hpp>
#include <span>
#include <stdexcept>
#include <vector>

namespace ccd::program {

/// Where a command decides.
struct device_choice {
    bool cuda = false;  ///< else on this machine's processor
    cuda::precision precision = cuda::precision::float64;
};

/// The device failed, or there is none.
struct device_error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Throws usage_error if this build has no CUDA, device_error if this machine has no device.
void require_device();

/// The methods that devices run.
std::vector<method> methods_on_device();

/// Of the stored kinds, as the functions of ccd::cuda; throw device_error.
template <class Query>
void decide_on_device(std::span<const Query> queries, std::span<outcome> answers, method m,
                      cuda::precision precision);
template <class Query>
void find_times_on_device(std::span<const Query> queries, std::span<first_time> times,
                          double t_max);
step_result step_on_device(const mesh& before, const mesh& after, const step_options& options,
                           cuda::precision precision);

}  // namespace ccd::program
