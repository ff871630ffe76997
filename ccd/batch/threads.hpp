// Runs parallel work on a given number of threads. Internal. Only threads.cpp includes oneTBB,
// whose headers take a second to compile.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace ccd::detail {

/// Returns the number of threads: one per core if `threads` is 0 or exceeds the cores. Throws
/// std::invalid_argument if it is negative.
int threads_of(int threads);

/// The number of threads of the current arena.
std::size_t threads_here();

/// Calls work() in an arena of threads_of(threads) threads. Returns their number.
int on_threads(int threads, const std::function<void()>& work);

/// In the current arena, calls visit(begin, end) for intervals that partition [0, count). Intervals
/// of at most `few` indices are not divided.
void for_each_range(std::size_t count, std::size_t few,
                    const std::function<void(std::size_t, std::size_t)>& visit);

/// In the current arena, calls act(i) for all i in [0, count).
template <class Act>
void for_each_index(std::size_t count, const Act& act) {
    for_each_range(count, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) act(i);
    });
}

/// The same, each as a task of its own.
void for_each_task(std::size_t count, const std::function<void(std::size_t)>& act);

/// Calls visit(begin, end) for intervals that partition [0, count), on at most `threads` threads.
template <class Visit>
void for_each_part(std::size_t count, int threads, const Visit& visit) {
    constexpr std::size_t few = 64;
    if (threads_of(threads) == 1 || count <= few) return visit(std::size_t{0}, count);
    on_threads(threads, [&] { for_each_range(count, few, std::cref(visit)); });
}
template <class Visit>
void for_each_index(std::size_t count, int threads, const Visit& visit) {
    for_each_part(count, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) visit(i);
    });
}

/// A pointer for each thread.
class pointer_per_thread {
  public:
    pointer_per_thread();
    ~pointer_per_thread();

    std::shared_ptr<void>& local();  ///< null before it is set
    std::vector<void*> all() const;  ///< not null; in order of the first calls of local()

  private:
    struct table;
    std::unique_ptr<table> table_;
};

/// An object for each thread that calls local(). It has its own cache lines.
template <class T>
class per_thread {
  public:
    per_thread() : per_thread([] { return T(); }) {}
    explicit per_thread(std::function<T()> make) : make_(std::move(make)) {}

    /// Thread-safe.
    T& local() {
        std::shared_ptr<void>& mine = pointers_.local();
        if (!mine) mine.reset(new own{make_()});
        return static_cast<own*>(mine.get())->value;
    }
    std::vector<T*> all() const {
        std::vector<T*> values;
        for (void* p : pointers_.all()) values.push_back(&static_cast<own*>(p)->value);
        return values;
    }

  private:
    struct alignas(128) own {
        T value;
    };

    std::function<T()> make_;
    pointer_per_thread pointers_;
};

}  // namespace ccd::detail
