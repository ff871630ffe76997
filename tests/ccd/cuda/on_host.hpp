// Kernel bodies run on the host, by loops (ccd/cuda/launch.hpp).
#pragma once

#include <ccd/cuda.hpp>
#include <ccd/method.hpp>
#include <ccd/verdict.hpp>
#include <cstddef>
#include <memory>
#include <vector>

#include "ccd/cuda/launch.hpp"
#include "ccd/cuda/method_stages.hpp"

namespace cuda_on_host {

/// Memory for a layout: Memory(arena, sizes...) is made once to count, once to take.
template <class Memory>
class laid_out {
  public:
    template <class... Sizes>
    explicit laid_out(Sizes... sizes) : bytes_(counted(sizes...)), memory_(taken(sizes...)) {}
    const Memory& operator*() const { return memory_; }
    const Memory* operator->() const { return &memory_; }

  private:
    template <class... Sizes>
    static std::size_t counted(Sizes... sizes) {
        ccd::cuda::detail::arena count;
        (void)Memory(count, sizes...);
        return count.used() + ccd::cuda::detail::arena::alignment;
    }
    template <class... Sizes>
    Memory taken(Sizes... sizes) {
        void* start = bytes_.data();
        std::size_t room = bytes_.size();
        std::align(ccd::cuda::detail::arena::alignment, 1, start, room);
        ccd::cuda::detail::arena from(start, room);
        return Memory(from, sizes...);
    }

    std::vector<std::byte> bytes_;
    Memory memory_;
};

/// Answers by a float method's stages. `in_doubles`, if not null, receives how many candidates
/// floats left to doubles.
template <class Method, class T, class Pair>
std::vector<ccd::outcome> decide_by(const ccd::cuda::positions& at,
                                    const ccd::cuda::candidates<Pair>& all,
                                    std::size_t* in_doubles = nullptr) {
    ccd::cuda::detail::host_launcher launcher;
    // Nothing may rely on what was there.
    std::vector<ccd::outcome> answers(all.count, ccd::outcome::collides);
    const laid_out<ccd::cuda::detail::method_memory> memory(all.count);
    ccd::cuda::detail::run_method<Method, T>(launcher, at, all, answers.data(), *memory);
    if (in_doubles != nullptr) *in_doubles = memory->counters->in_doubles;
    return answers;
}

/// Calls visit<Method>(method) for all methods but `exact`.
template <class Visit>
void for_each_float_method(const Visit& visit) {
    using ccd::method, ccd::cuda::detail::bsc_method, ccd::cuda::detail::safeccd_method;
    visit.template operator()<bsc_method<errbound::none>>(method::float_);
    visit.template operator()<bsc_method<errbound::safe>>(method::safe);
    visit.template operator()<bsc_method<errbound::tight>>(method::tight);
    visit.template operator()<safeccd_method<errbound::safe>>(method::safeccd);
    visit.template operator()<safeccd_method<errbound::tight>>(method::safeccd_tight);
}

}  // namespace cuda_on_host
