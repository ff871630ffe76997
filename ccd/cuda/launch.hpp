// Runs kernel bodies: by loops on the host here, by kernels in ccd/cuda/launch.cuh.
//
// A body is a small copyable object; body(i) does the work for item i. nvcc compiles constexpr
// functions for the device (--expt-relaxed-constexpr), and tests run them on the host.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace ccd::cuda::detail {

/// The 32 lanes of a warp; on the host, each function loops over them. All lanes call a function
/// together.
class warp {
  public:
    static constexpr std::uint32_t lanes = 32;
#ifdef __CUDA_ARCH__
    static constexpr std::uint32_t lanes_here = 1;  ///< lanes that this thread runs
#else
    static constexpr std::uint32_t lanes_here = lanes;
#endif

    /// Calls f(lane) for each lane.
    template <class F>
    static constexpr void each(const F& f) {
        for (std::uint32_t i = 0; i < lanes_here; ++i) f(first_lane() + i);
    }
    /// Bit k of the result is f(k).
    template <class F>
    static constexpr std::uint32_t ballot(const F& f) {
#ifdef __CUDA_ARCH__
        return __ballot_sync(~0u, f(first_lane()));
#else
        std::uint32_t bits = 0;
        each([&](std::uint32_t k) { bits |= std::uint32_t{f(k)} << k; });
        return bits;
#endif
    }
    /// One value per lane, which only that lane accesses.
    template <class T>
    class per_lane {
      public:
        constexpr T& operator[](std::uint32_t lane) { return values_[lane % lanes_here]; }

      private:
        T values_[lanes_here]{};
    };
    /// Precondition: mask != 0.
    static constexpr std::uint32_t lowest(std::uint32_t mask) {
#ifdef __CUDA_ARCH__
        return static_cast<std::uint32_t>(__clz(static_cast<int>(__brev(mask))));
#else
        return static_cast<std::uint32_t>(std::countr_zero(mask));
#endif
    }
    static constexpr std::uint32_t count(std::uint32_t mask) {
#ifdef __CUDA_ARCH__
        return static_cast<std::uint32_t>(__popc(mask));
#else
        return static_cast<std::uint32_t>(std::popcount(mask));
#endif
    }
    /// Reserves entries in a queue of *size items: one for each bit of the lanes' masks. Sets the
    /// index of each lane's first entry, and returns the new *size.
    static constexpr std::uint64_t append(std::uint64_t* size, per_lane<std::uint32_t>& masks,
                                          per_lane<std::uint64_t>& places) {
#ifdef __CUDA_ARCH__
        const std::uint32_t lane = first_lane(), own = count(masks[lane]);
        std::uint32_t sum = own;
        for (std::uint32_t distance = 1; distance < lanes; distance *= 2) {
            const std::uint32_t before = __shfl_up_sync(~0u, sum, distance);
            sum += lane >= distance ? before : 0;
        }
        unsigned long long end = 0;
        if (lane == lanes - 1)
            end = sum + atomicAdd(reinterpret_cast<unsigned long long*>(size),
                                  static_cast<unsigned long long>(sum));
        end = __shfl_sync(~0u, end, lanes - 1);
        places[lane] = end - (__shfl_sync(~0u, sum, lanes - 1) - sum) - own;
        return end;
#else
        each([&](std::uint32_t k) {
            places[k] = *size;
            *size += count(masks[k]);
        });
        return *size;
#endif
    }

    static constexpr std::uint32_t first_lane() {
#ifdef __CUDA_ARCH__
        std::uint32_t lane;
        asm("mov.u32 %0, %%laneid;" : "=r"(lane));
        return lane;
#else
        return 0;
#endif
    }
};

template <class T>
struct queue_of {
    T* items;
    std::uint32_t* size;

    constexpr void push(const T& item) const {
#ifdef __CUDA_ARCH__
        items[atomicAdd(size, 1u)] = item;
#else
        items[(*size)++] = item;
#endif
    }
};
using queue = queue_of<std::uint32_t>;

/// A time that all threads share and that only decreases.
class shared_time {
  public:
    constexpr explicit shared_time(double* value) : value_(value) {}

    /// Returns a current or an earlier value.
    constexpr double get() const {
#ifdef __CUDA_ARCH__
        return *static_cast<volatile double*>(value_);
#else
        return *value_;
#endif
    }
    /// Lowers the value to `time` if that is less. Precondition: time >= 0.
    constexpr void lower(double time) const {
#ifdef __CUDA_ARCH__
        // Non-negative doubles are in the order of their bits.
        if (time < get())
            atomicMin(reinterpret_cast<unsigned long long*>(value_),
                      static_cast<unsigned long long>(__double_as_longlong(time)));
#else
        *value_ = std::min(*value_, time);
#endif
    }

  private:
    double* value_;
};

/// Partitions a block of memory. Without memory, it only counts bytes.
class arena {
  public:
    static constexpr std::size_t alignment = 256;

    arena() = default;
    arena(void* data, std::size_t bytes) : data_(static_cast<std::byte*>(data)), bytes_(bytes) {}

    template <class T>
    T* take(std::size_t count) {
        const std::size_t begin = used_;
        used_ += (count * sizeof(T) + alignment - 1) / alignment * alignment;
        return data_ != nullptr && used_ <= bytes_ ? reinterpret_cast<T*>(data_ + begin) : nullptr;
    }
    std::size_t used() const { return used_; }

  private:
    std::byte* data_ = nullptr;
    std::size_t bytes_ = 0, used_ = 0;
};

/// Runs bodies on the host, sequentially. All launchers have:
///
/// * buffer<T>: memory for bodies, with data(), size(), extend(launcher, n) and
///   resize(launcher, n), which may drop contents
/// * for_each(n, body): body(i) for all i < n, in any order
/// * for_each_packet(n, body): body(i) for all i < n, in any order, each by the lanes of a warp
/// * for_each_queued(queue, body): body(item) for all items in the queue
/// * set(p, value): *p = value, in the order of the other work
/// * reduce(n, of, combine, start, r): *r = combination of all of(i) and `start`
/// * exclusive_scan(in, out, n): out[i] = in(0) + ... + in(i − 1), for i <= n
/// * sort(keys, values, n): by ascending keys, stable
/// * wait(), read(p, n, to), write(p, n, from): wait for all work, then copy to or from the host
/// * ok(): false after an error; then no more work is done
class host_launcher {
  public:
    template <class T>
    class buffer {
      public:
        void resize(const host_launcher&, std::size_t n) { items_.assign(n, T{}); }
        void extend(const host_launcher&, std::size_t n) { items_.resize(n); }
        T* data() { return items_.data(); }
        std::size_t size() const { return items_.size(); }

      private:
        std::vector<T> items_;
    };

    bool ok() const { return true; }
    void wait() const {}

    template <class Body>
    void for_each(std::size_t n, const Body& body) const {
        // Bodies must not depend on the order: the second half comes first.
        for (std::size_t i = n / 2; i < n; ++i) body(static_cast<std::uint32_t>(i));
        for (std::size_t i = 0; i < n / 2; ++i) body(static_cast<std::uint32_t>(i));
    }
    template <class Body>
    void for_each_packet(std::size_t n, const Body& body) const {
        for_each(n, body);
    }
    template <class Body>
    void for_each_queued(const queue& items, const Body& body) const {
        for_each(*items.size, [&](std::uint32_t i) { body(items.items[i]); });
    }
    template <class T>
    void set(T* p, const T& value) const {
        *p = value;
    }
    template <class T, class Of, class Combine>
    void reduce(std::size_t n, const Of& of, const Combine& combine, const T& start, T* r) const {
        T all = start;
        for (std::size_t i = 0; i < n; ++i) all = combine(all, of(static_cast<std::uint32_t>(i)));
        *r = all;
    }
    template <class In, class Out>
    void exclusive_scan(const In& in, Out* out, std::size_t n) const {
        Out sum{};
        for (std::size_t i = 0; i < n; ++i) {
            const Out next = sum + static_cast<Out>(in(static_cast<std::uint32_t>(i)));
            out[i] = sum;
            sum = next;
        }
        out[n] = sum;
    }
    void sort(std::uint32_t* keys, std::uint32_t* values, std::size_t n) const {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs(n);
        for (std::size_t i = 0; i < n; ++i) pairs[i] = {keys[i], values[i]};
        std::ranges::stable_sort(pairs, {}, &std::pair<std::uint32_t, std::uint32_t>::first);
        for (std::size_t i = 0; i < n; ++i) {
            keys[i] = pairs[i].first;
            values[i] = pairs[i].second;
        }
    }
    template <class T>
    void read(const T* p, std::size_t n, T* to) const {
        std::copy_n(p, n, to);
    }
    template <class T>
    void write(T* p, std::size_t n, const T* from) const {
        std::copy_n(from, n, p);
    }
};

}  // namespace ccd::cuda::detail
