#include "ccd/program/device_run.hpp"

#include "errbound/support/command_line.hpp"

namespace ccd::program {

#ifdef ERRBOUND_HAVE_CUDA
namespace {

void require(const cuda::status& s) {
    if (!s) throw device_error(s.error);
}

}  // namespace

void require_device() {
    require(cuda::device_status());
}

std::vector<method> methods_on_device() {
    const auto all = cuda::device_methods();
    return {all.begin(), all.end()};
}

template <class Query>
void decide_on_device(std::span<const Query> queries, std::span<outcome> answers, method m,
                      cuda::precision precision) {
    require(cuda::decide(queries, answers, {m, precision, nullptr}));
}
template <class Query>
void find_times_on_device(std::span<const Query> queries, std::span<first_time> times,
                          double t_max) {
    require(cuda::first_times(queries, times, {t_max, nullptr}));
}
step_result step_on_device(const mesh& before, const mesh& after, const step_options& options,
                           cuda::precision precision) {
    const cuda::step_result result = cuda::step(before, after, options, precision);
    require(result);
    return result;
}

#else

void require_device() {
    throw errbound::support::usage_error(
        "--device is cuda; expected cpu, since this build has no CUDA (it needs nvcc 12 or later)");
}

std::vector<method> methods_on_device() {
    return {};
}

// Never reached, since require_device() throws before.
template <class Query>
void decide_on_device(std::span<const Query>, std::span<outcome>, method, cuda::precision) {
    require_device();
}
template <class Query>
void find_times_on_device(std::span<const Query>, std::span<first_time>, double) {
    require_device();
}
step_result step_on_device(const mesh&, const mesh&, const step_options&, cuda::precision) {
    require_device();
    return {};
}

#endif

template void decide_on_device(std::span<const vertex_face<double>>, std::span<outcome>, method,
                               cuda::precision);
template void decide_on_device(std::span<const edge_edge<double>>, std::span<outcome>, method,
                               cuda::precision);
template void find_times_on_device(std::span<const vertex_face<double>>, std::span<first_time>,
                                   double);
template void find_times_on_device(std::span<const edge_edge<double>>, std::span<first_time>,
                                   double);

}  // namespace ccd::program
