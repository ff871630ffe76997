// Threads that are joined at the end of the scope, since libc++ before 20 has no std::jthread.
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

    /// Starts a thread that calls `work`. Throws std::system_error.
    template <class Work>
    void start(Work work) {
        threads_.emplace_back(std::move(work));
    }

  private:
    std::vector<std::thread> threads_;
};

}  // namespace errbound::support
