#pragma once

#include <mpi.h>

#include <algorithm>
#include <ccd/verdict.hpp>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "ccd/mpi/agreement.hpp"

namespace ccd::mpi::detail {

/// An item's bytes as one element of a message, because MPI counts elements by an int.
template <class T>
class item_type {
  public:
    static_assert(std::is_trivially_copyable_v<T>);
    item_type() {
        MPI_Type_contiguous(sizeof(T), MPI_BYTE, &type_);
        MPI_Type_commit(&type_);
    }
    ~item_type() { MPI_Type_free(&type_); }
    item_type(const item_type&) = delete;
    item_type& operator=(const item_type&) = delete;
    operator MPI_Datatype() const { return type_; }

  private:
    MPI_Datatype type_;
};

/// Items in the order of their source ranks: rank r sent those from starts[r] to starts[r + 1].
template <class T>
struct received {
    std::vector<T> items;
    std::vector<std::size_t> starts;
};

template <class Count>
std::vector<std::size_t> starts_of(const std::vector<Count>& counts) {
    std::vector<std::size_t> starts(counts.size() + 1);
    std::inclusive_scan(counts.begin(), counts.end(), starts.begin() + 1, std::plus<>(),
                        std::size_t(0));
    return starts;
}

class exchanger {
  public:
    explicit exchanger(MPI_Comm comm) : comm_(comm) {
        MPI_Comm_rank(comm, &rank_);
        MPI_Comm_size(comm, &size_);
    }
    MPI_Comm comm() const { return comm_; }
    std::size_t rank() const { return static_cast<std::size_t>(rank_); }
    std::size_t size() const { return static_cast<std::size_t>(size_); }
    /// Bytes of items sent to other ranks so far, without their counts.
    std::uint64_t bytes() const { return bytes_; }

    template <class Check>
    void agree(const Check& check) {
        detail::agree(comm_, check);
    }

    template <class T>
    received<T> all_to_all(const std::vector<std::vector<T>>& lists) {
        std::vector<int> to(size()), from(size());
        agree([&] {
            std::size_t all = 0;
            for (std::size_t r = 0; r < size(); ++r) {
                to[r] = static_cast<int>(lists[r].size());
                all += lists[r].size();
            }
            require_int(all, "send to others");
        });
        MPI_Alltoall(to.data(), 1, MPI_INT, from.data(), 1, MPI_INT, comm_);
        received<T> result{{}, starts_of(from)};
        agree([&] {
            require_int(result.starts.back(), "receive");
            result.items.resize(result.starts.back());
        });
        const std::vector<std::size_t> sent = starts_of(to);
        std::vector<T> items;
        items.reserve(sent.back());
        for (const auto& list : lists) items.insert(items.end(), list.begin(), list.end());
        const auto offsets = [](const std::vector<std::size_t>& starts) {
            return std::vector<int>(starts.begin(), starts.end() - 1);
        };
        const item_type<T> type;
        MPI_Alltoallv(items.data(), to.data(), offsets(sent).data(), type, result.items.data(),
                      from.data(), offsets(result.starts).data(), type, comm_);
        bytes_ += sizeof(T) * (sent.back() - lists[rank()].size());
        return result;
    }

    template <class T>
    received<T> gather(const std::vector<T>& list) {
        std::vector<std::uint64_t> sizes(size());
        const std::uint64_t mine = list.size();
        MPI_Allgather(&mine, 1, MPI_UINT64_T, sizes.data(), 1, MPI_UINT64_T, comm_);
        received<T> result{{}, starts_of(sizes)};
        agree([&] {
            require_int(result.starts.back(), "receive");
            result.items.resize(result.starts.back());
        });
        const std::vector<int> counts(sizes.begin(), sizes.end());
        const std::vector<int> offsets(result.starts.begin(), result.starts.end() - 1);
        const item_type<T> type;
        MPI_Allgatherv(list.data(), static_cast<int>(mine), type, result.items.data(),
                       counts.data(), offsets.data(), type, comm_);
        bytes_ += sizeof(T) * list.size() * (size() - 1);
        return result;
    }

    /// The time of the earliest contact of all ranks; `own` if there is none.
    first_time earliest(const first_time& own) {
        first_time earliest = own;
        for (const first_time& time : gather(std::vector{own}).items) {
            if (time.outcome != outcome::collides) continue;
            if (earliest.outcome != outcome::collides ||
                std::pair(time.low, time.high) < std::pair(earliest.low, earliest.high))
                earliest = time;
        }
        return earliest;
    }

    double least(double own) {
        double least = own;
        MPI_Allreduce(&own, &least, 1, MPI_DOUBLE, MPI_MIN, comm_);
        return least;
    }

  private:
    static void require_int(std::size_t count, const char* what) {
        if (count > static_cast<std::size_t>(std::numeric_limits<int>::max()))
            throw std::length_error("ccd::mpi: number of items to " + std::string(what) + " is " +
                                    std::to_string(count) +
                                    "; expected fewer than 2^31 (use more ranks)");
    }

    MPI_Comm comm_;
    int rank_ = 0, size_ = 1;
    std::uint64_t bytes_ = 0;
};

}  // namespace ccd::mpi::detail
