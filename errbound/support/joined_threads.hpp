// Threads that join at the end of a scope: std::jthread without a token (libc++ has it from 20 on).
#pragma once

#include <thread>
#include <utility>
#include <vector>

namespace errbound::support {

class joined_threads {
  public:
    joined_threads() = default;
    joined_threads(const joined_threads&) = delete;
    joined_threads& operator=(const joined_threads&) = delete;
    ~joined_threads() {
        for (std::thread& t : threads_) t.join();
    }

    /// Starts a thread that calls `work`. Throws std::system_error if there are no more threads.
    template <class Work>
    void start(Work work) {
        threads_.emplace_back(std::move(work));
    }

  private:
    std::vector<std::thread> threads_;
};

}  // namespace errbound::support
