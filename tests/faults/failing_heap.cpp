#include "tests/faults/failing_heap.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace {

constexpr std::uint64_t never = 0;
std::atomic<std::uint64_t> first_failure = never, last_failure = never, count = 0;
std::atomic<std::int64_t> in_use = 0;

bool is_over_aligned(std::size_t alignment) {
    return alignment > alignof(std::max_align_t);
}
#ifdef _WIN32
void* allocate_aligned(std::size_t size, std::size_t alignment) {
    return _aligned_malloc(size, alignment);
}
void free_aligned(void* p) {
    _aligned_free(p);
}
#else
void* allocate_aligned(std::size_t size, std::size_t alignment) {
    return std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}
void free_aligned(void* p) {
    std::free(p);
}
#endif

void* counted(std::size_t size, std::size_t alignment) {
    const std::uint64_t first = first_failure.load();
    if (first != never) {
        const std::uint64_t n = ++count;
        if (n >= first && n <= last_failure.load()) throw std::bad_alloc();
    }
    const std::size_t at_least_one = std::max<std::size_t>(size, 1);
    void* const p = is_over_aligned(alignment) ? allocate_aligned(at_least_one, alignment)
                                               : std::malloc(at_least_one);
    if (p == nullptr) throw std::bad_alloc();
    ++in_use;
    return p;
}

void release(void* p, std::size_t alignment) noexcept {
    if (p != nullptr) --in_use;
    if (is_over_aligned(alignment))
        free_aligned(p);
    else
        std::free(p);
}

struct row {
    std::string name;
    std::uint64_t points;
};
std::vector<row>& rows() {
    static std::vector<row> all;
    return all;
}

class table : public ::testing::Environment {
  public:
    void TearDown() override {
        std::uint64_t points = 0;
        for (const row& r : rows()) {
            std::printf("%-60s %8llu\n", r.name.c_str(), static_cast<unsigned long long>(r.points));
            points += r.points;
        }
        std::printf("%zu functions, %llu allocations that failed\n", rows().size(),
                    static_cast<unsigned long long>(points));
    }
};

[[maybe_unused]] const auto* const added = ::testing::AddGlobalTestEnvironment(new table);

}  // namespace

// The forms for arrays and those without exceptions call these.
void* operator new(std::size_t size) {
    return counted(size, 1);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    return counted(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* p) noexcept {
    release(p, 1);
}
void operator delete(void* p, std::size_t) noexcept {
    release(p, 1);
}
void operator delete(void* p, std::align_val_t alignment) noexcept {
    release(p, static_cast<std::size_t>(alignment));
}
void operator delete(void* p, std::size_t, std::align_val_t alignment) noexcept {
    release(p, static_cast<std::size_t>(alignment));
}

namespace faults {

void fail_at(std::uint64_t n, failing which) {
    count = 0;
    last_failure = which == failing::one ? n : UINT64_MAX;
    first_failure = n;
}

bool stop() {
    const std::uint64_t first = first_failure.exchange(never);
    return count.load() >= first;
}

std::int64_t live() {
    return in_use;
}

void add_row(const std::string& name, std::uint64_t points) {
    rows().push_back({name, points});
}

}  // namespace faults
