#include "ccd/batch/batch_worker.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

namespace ccd {
namespace detail {
namespace {

struct instruction_set_entry {
    instruction_set set;
    std::string_view name;
    const batch_kernels* kernels;
    bool (*runs_here)();
};

constexpr instruction_set_entry entries[] = {
    {instruction_set::baseline, "baseline", &baseline::kernels, [] { return true; }},
#ifdef ERRBOUND_HAVE_X86_KERNELS
    {instruction_set::avx2, "avx2", &avx2::kernels,
     [] { return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0; }},
    {instruction_set::avx512, "avx512", &avx512::kernels,
     [] {
         return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
                __builtin_cpu_supports("avx512vl") != 0 &&
                __builtin_cpu_supports("avx512bw") != 0 && __builtin_cpu_supports("avx512cd") != 0;
     }},
#endif
};

struct available_sets {
    std::array<instruction_set, std::size(entries)> sets{};
    std::size_t size = 0;

    available_sets() {
        for (const auto& entry : entries)
            if (entry.runs_here()) sets[size++] = entry.set;
    }
};

}  // namespace
}  // namespace detail

std::span<const instruction_set> instruction_sets() {
    static const detail::available_sets available;
    return {available.sets.data(), available.size};
}

std::string_view name(instruction_set set) {
    constexpr std::string_view names[] = {"baseline", "avx2", "avx512"};
    const auto i = static_cast<std::size_t>(set);
    return i < std::size(names) ? names[i] : "unknown";
}

std::optional<instruction_set> find_instruction_set(std::string_view wanted) {
    for (const auto set :
         {instruction_set::baseline, instruction_set::avx2, instruction_set::avx512})
        if (name(set) == wanted) return set;
    return std::nullopt;
}

namespace detail {

instruction_set runnable(std::optional<instruction_set> set) {
    const auto available = instruction_sets();
    const instruction_set wanted = set.value_or(available.back());
    if (std::ranges::find(available, wanted) == available.end())
        throw std::invalid_argument("ccd: instruction set is " + std::string(name(wanted)) +
                                    "; expected one that this build and machine have");
    return wanted;
}

const batch_kernels& kernels_for(std::optional<instruction_set> set) {
    return *std::ranges::find(entries, runnable(set), &instruction_set_entry::set)->kernels;
}

}  // namespace detail
}  // namespace ccd
