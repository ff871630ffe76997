// Threads that end with their scope: std::jthread, which libc++ has from version 20 on, without a
// token.
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

    /// One more, which calls `work`; throws std::system_error where the system has no more.
    template <class Work>
    void start(Work work) {
        threads_.emplace_back(std::move(work));
    }

  private:
    std::vector<std::thread> threads_;
};

}  // namespace errbound::support
