// Rounds: rank 0 names each rank's chunks, and gathers and keeps their results.
#include "errbound/study/rounds.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <deque>
#include <exception>
#include <iterator>
#include <limits>
#include <mutex>
#include <new>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <utility>

#include "errbound/support/command_line.hpp"
#include "errbound/support/joined_threads.hpp"

namespace errbound::study {
namespace {

using clock = std::chrono::steady_clock;
constexpr std::chrono::seconds round_time(2);
/// Of a rank's results in one round; MPI counts a message's bytes in an int.
constexpr std::size_t round_bytes = std::size_t{1} << 28;

/// What a rank did in a round.
struct share {
    std::vector<chunk_result> results;
    std::optional<chunk_result> failure;  ///< of the least chunk that failed: its message
    bool stopped = false;
};

class packer {
  public:
    void add(std::uint64_t n) { bytes_.append(reinterpret_cast<const char*>(&n), sizeof n); }
    void add(const chunk_result& r) {
        add(r.first);
        add(r.second.size());
        bytes_ += r.second;
    }
    std::string bytes() { return std::move(bytes_); }

  private:
    std::string bytes_;
};

class unpacker {
  public:
    explicit unpacker(std::string_view bytes) : rest_(bytes) {}
    std::uint64_t number() {
        std::uint64_t n = 0;
        std::memcpy(&n, rest_.data(), sizeof n);
        rest_.remove_prefix(sizeof n);
        return n;
    }
    chunk_result result() {
        const std::uint64_t chunk = number(), size = number();
        chunk_result r{chunk, rest_.substr(0, size)};
        rest_.remove_prefix(size);
        return r;
    }

  private:
    std::string_view rest_;
};

std::string packed(const share& s) {
    packer bytes;
    bytes.add(s.stopped);
    bytes.add(s.failure.has_value());
    if (s.failure) bytes.add(*s.failure);
    bytes.add(s.results.size());
    for (const chunk_result& r : s.results) bytes.add(r);
    return bytes.bytes();
}

share unpacked(std::string_view bytes) {
    unpacker from(bytes);
    share s;
    s.stopped = from.number() != 0;
    if (from.number() != 0) s.failure = from.result();
    for (std::uint64_t left = from.number(); left > 0; --left) s.results.push_back(from.result());
    return s;
}

/// Computes chunks, on several threads, until the round is over.
class sharer {
  public:
    sharer(const std::vector<std::uint64_t>& chunks, const work& what, const std::atomic<int>& stop)
        : chunks_(chunks), what_(what), stop_(stop) {}

    share run(std::size_t threads) {
        if (threads == 1) {
            compute();
        } else {
            support::joined_threads running;
            for (std::size_t i = 0; i < std::min(threads, chunks_.size()); ++i)
                running.start([this] { compute(); });
        }
        done_.stopped = stop_ != 0;
        return std::move(done_);
    }

  private:
    /// The first chunk is begun whatever the time, so that every round gets on.
    bool is_over(std::size_t next) const {
        return next >= chunks_.size() || stop_ != 0 || full_ ||
               (next > 0 && clock::now() - start_ > round_time);
    }
    void compute() {
        for (std::size_t i = next_++; !is_over(i); i = next_++) {
            chunk_result r{chunks_[i], {}};
            bool failed = false;
            try {
                r.second = what_.result_of(r.first);
                constexpr std::size_t most = std::numeric_limits<int>::max() - 2 * round_bytes;
                if (r.second.size() > most)
                    throw std::length_error("a chunk's result is too large");
            } catch (const std::exception& error) {
                failed = true;
                r.second = error.what();
            }
            const std::scoped_lock lock(mutex_);
            if (failed) {
                if (!done_.failure || r.first < done_.failure->first) done_.failure = std::move(r);
                full_ = true;
                return;
            }
            bytes_ += r.second.size();
            if (bytes_ > round_bytes) full_ = true;
            done_.results.push_back(std::move(r));
        }
    }

    const std::vector<std::uint64_t>& chunks_;
    const work& what_;
    const std::atomic<int>& stop_;
    const clock::time_point start_ = clock::now();
    std::atomic<std::size_t> next_ = 0;
    std::atomic<bool> full_ = false;
    std::mutex mutex_;  // of what follows
    share done_;
    std::size_t bytes_ = 0;
};

/// Every rank's share, on rank 0.
std::vector<share> gathered(MPI_Comm comm, int rank, int ranks, share own) {
    std::vector<share> all;
    if (rank > 0) {
        const std::string bytes = packed(own);
        MPI_Send(bytes.data(), static_cast<int>(bytes.size()), MPI_CHAR, 0, 0, comm);
        return all;
    }
    all.push_back(std::move(own));
    for (int from = 1; from < ranks; ++from) {
        MPI_Status status;
        MPI_Probe(from, 0, comm, &status);
        int size = 0;
        MPI_Get_count(&status, MPI_CHAR, &size);
        std::string bytes(static_cast<std::size_t>(size), '\0');
        MPI_Recv(bytes.data(), size, MPI_CHAR, from, 0, comm, MPI_STATUS_IGNORE);
        all.push_back(unpacked(bytes));
    }
    return all;
}

/// What rank 0 says before each round.
struct order {
    enum what : std::uint64_t { compute, done, stopped, failed } next = compute;
    std::vector<std::uint64_t>
        chunks;           ///< to compute; rank r takes each that is r modulo the ranks
    std::string message;  ///< of what failed

    void share_out(MPI_Comm comm) {
        packer bytes;
        bytes.add(next);
        bytes.add(chunk_result{0, message});
        for (const std::uint64_t c : chunks) bytes.add(c);
        const std::string all = broadcast(comm, bytes.bytes());
        unpacker from(all);
        next = static_cast<what>(from.number());
        message = from.result().second;
        chunks.resize((all.size() - message.size()) / sizeof(std::uint64_t) - 3);
        for (std::uint64_t& c : chunks) c = from.number();
    }
};

/// Rank 0's list of what is left to do.
class schedule {
  public:
    schedule(std::vector<std::uint64_t> chunks, std::size_t ranks, std::size_t threads)
        : left_(chunks.begin(), chunks.end()), ranks_(ranks), per_rank_(threads) {}

    order next() {
        order o;
        if (failure_) {
            o.next = order::failed;
            o.message = failure_->second;
        } else if (left_.empty()) {
            o.next = order::done;
        } else if (stopped_) {
            o.next = order::stopped;
        } else {
            const std::size_t count = std::min(left_.size(), ranks_ * per_rank_);
            o.chunks.assign(left_.begin(), left_.begin() + static_cast<std::ptrdiff_t>(count));
            left_.erase(left_.begin(), left_.begin() + static_cast<std::ptrdiff_t>(count));
        }
        return o;
    }

    /// What was not done goes back; what was is kept.
    void take(const order& ordered, std::vector<share> shares, const keeper& keep) {
        std::vector<chunk_result> results;
        std::size_t most = 1;
        for (share& s : shares) {
            most = std::max(most, s.results.size());
            stopped_ |= s.stopped;
            if (s.failure && (!failure_ || s.failure->first < failure_->first))
                failure_ = s.failure;
            std::ranges::move(s.results, std::back_inserter(results));
        }
        std::ranges::sort(results);
        std::vector<std::uint64_t> undone;
        for (const std::uint64_t c : ordered.chunks)
            if (!std::ranges::binary_search(results, c, {}, &chunk_result::first))
                undone.push_back(c);
        left_.insert(left_.begin(), undone.begin(), undone.end());
        per_rank_ = undone.empty() ? 2 * per_rank_ : most;
        try {
            keep(std::move(results));
        } catch (const std::exception& error) {
            failure_ = {0, error.what()};
        }
    }

  private:
    std::deque<std::uint64_t> left_;
    std::size_t ranks_, per_rank_;
    bool stopped_ = false;
    std::optional<chunk_result> failure_;
};

}  // namespace

ending in_rounds(MPI_Comm comm, std::vector<std::uint64_t> chunks, const work& what,
                 const keeper& keep, const std::atomic<int>& stop) {
    int rank = 0, ranks = 1;
    MPI_Comm_rank(comm, &rank);
    MPI_Comm_size(comm, &ranks);
    const std::size_t threads = what.threads > 0
                                    ? static_cast<std::size_t>(what.threads)
                                    : std::max(1U, std::thread::hardware_concurrency());
    schedule plan(std::move(chunks), static_cast<std::size_t>(ranks), threads);
    for (;;) {
        order o;
        if (rank == 0) o = plan.next();
        o.share_out(comm);
        if (o.next == order::done) return ending::done;
        if (o.next == order::stopped) return ending::stopped;
        if (o.next == order::failed) throw std::runtime_error(o.message);
        std::vector<std::uint64_t> own;
        for (std::size_t i = static_cast<std::size_t>(rank); i < o.chunks.size();
             i += static_cast<std::size_t>(ranks))
            own.push_back(o.chunks[i]);
        auto shares = gathered(comm, rank, ranks, sharer(own, what, stop).run(threads));
        if (rank == 0) plan.take(o, std::move(shares), keep);
    }
}

std::string broadcast(MPI_Comm comm, std::string text) {
    std::uint64_t size = text.size();
    MPI_Bcast(&size, 1, MPI_UINT64_T, 0, comm);
    text.resize(size);
    constexpr std::size_t most = std::size_t{1} << 30;
    for (std::size_t begin = 0; begin < size; begin += most)
        MPI_Bcast(text.data() + begin, static_cast<int>(std::min(most, size - begin)), MPI_CHAR, 0,
                  comm);
    return text;
}

void on_root(MPI_Comm comm, const std::function<void()>& act) {
    enum kind : char { none, usage, no_memory, other };
    std::string failure(1, none);
    int rank = 0;
    MPI_Comm_rank(comm, &rank);
    if (rank == 0) {
        try {
            act();
        } catch (const support::usage_error& error) {
            failure = char{usage} + std::string(error.what());
        } catch (const std::bad_alloc&) {
            failure[0] = no_memory;
        } catch (const std::exception& error) {
            failure = char{other} + std::string(error.what());
        }
    }
    failure = broadcast(comm, failure);
    if (failure[0] == usage) throw support::usage_error(failure.substr(1));
    if (failure[0] == no_memory) throw std::bad_alloc();
    if (failure[0] == other) throw std::runtime_error(failure.substr(1));
}

}  // namespace errbound::study
