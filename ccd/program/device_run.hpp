// CUDA devices for the program, in builds with and without CUDA.
#pragma once

#include <ccd/contact.hpp>
#include <ccd/cuda.hpp>
#include <ccd/query.hpp>
#include <ccd/step.hpp>
#include <span>
#include <stdexcept>
#include <vector>

namespace ccd::program {

struct device_choice {
    bool cuda = false;  ///< false: the CPU
    cuda::precision precision = cuda::precision::float64;
};

struct device_error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Throws usage_error if this build has no CUDA, device_error if this machine has no device.
void require_device();

std::vector<method> methods_on_device();

/// The functions of ccd::cuda for the stored kinds. They throw device_error.
template <class Query>
void decide_on_device(std::span<const Query> queries, std::span<outcome> answers, method m,
                      cuda::precision precision);
template <class Query>
void find_times_on_device(std::span<const Query> queries, std::span<first_time> times,
                          double t_max);
step_result step_on_device(const mesh& before, const mesh& after, const step_options& options,
                           cuda::precision precision);

}  // namespace ccd::program
