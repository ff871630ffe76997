// Queries to rows of points, each once in a chunk.
#include <array>
#include <bit>
#include <ccd/io/query_store.hpp>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <unordered_map>
#include <vector>

#include "ccd/io/store/store_reader.hpp"
#include "ccd/io/store/store_writer.hpp"

namespace ccd::io {
namespace {

using row = std::array<std::uint64_t, 6>;  // bits of a point at t = 0 and t = 1

struct row_hash {
    std::size_t operator()(const row& r) const {
        std::uint64_t sum = 0;
        for (const std::uint64_t word : r) {
            sum =
                (sum ^ word) * 0x9e3779b97f4a7c15u;  // Fibonacci hashing: 2^64 by the golden ratio
            sum ^= sum >> 32;
        }
        return static_cast<std::size_t>(sum);
    }
};

}  // namespace

/// The chunk that is being made, and those written before it.
class query_packer::chunks {
  public:
    chunks(ccd::kind kind, bool with_truth)
        : kind_(kind), with_truth_(with_truth), written_(name(kind), with_truth) {}

    void add(const query_file& queries) {
        if (queries.kind() != kind_)
            throw std::invalid_argument("found queries of kind " +
                                        std::string(name(queries.kind())) + ", expected " +
                                        std::string(name(kind_)));
        if (queries.truth.has_value() != with_truth_)
            throw std::invalid_argument(with_truth_
                                            ? "found queries without truth, expected some with"
                                            : "found queries with truth, expected some without");
        std::visit(
            [&](const auto& all) {
                for (std::size_t i = 0; i < all.size(); ++i) {
                    using type = std::remove_cvref_t<decltype(all[i])>;
                    static_assert(sizeof(type) == 4 * sizeof(row) &&
                                  std::is_trivially_copyable_v<type>);
                    row points[4];
                    std::memcpy(points, &all[i], sizeof points);
                    add(points);
                    if (with_truth_) truth_.push_back((*queries.truth)[i] ? 1 : 0);
                }
            },
            queries.queries);
    }
    std::uint64_t size() const { return size_; }

    const std::filesystem::path& finish() {
        if (size_ == 0) throw std::runtime_error("found no queries, expected at least one");
        if (!queries_.empty()) write(true);
        return written_.path();
    }

  private:
    void add(const row* points) {
        // A chunk that is full is written when it is known not to be the last.
        if (queries_.size() == queries_of_a_chunk) write(false);
        std::array<std::uint32_t, 4> query;
        for (std::size_t i = 0; i < 4; ++i) {
            for (const std::uint64_t bits : points[i])
                if (!std::isfinite(std::bit_cast<double>(bits)))
                    throw std::invalid_argument("found a coordinate that is not finite in query " +
                                                std::to_string(size_));
            const auto next = static_cast<std::uint32_t>(points_.size());
            const auto [place, is_new] = places_.try_emplace(points[i], next);
            if (is_new) points_.push_back(points[i]);
            query[i] = place->second;
        }
        queries_.push_back(query);
        ++size_;
    }

    void write(bool is_last) {
        written_.add({points_, queries_, truth_}, is_last);
        points_.clear();
        queries_.clear();
        truth_.clear();
        places_.clear();
    }

    ccd::kind kind_;
    bool with_truth_;
    store_writer written_;
    std::uint64_t size_ = 0;
    std::vector<row> points_;  // this and what follows: of the chunk
    std::vector<std::array<std::uint32_t, 4>> queries_;
    std::vector<std::uint8_t> truth_;
    std::unordered_map<row, std::uint32_t, row_hash> places_;
};

query_packer::query_packer(ccd::kind kind, bool with_truth)
    : chunks_(std::make_unique<chunks>(kind, with_truth)) {}
query_packer::~query_packer() = default;
query_packer::query_packer(query_packer&&) noexcept = default;
query_packer& query_packer::operator=(query_packer&&) noexcept = default;

void query_packer::add(const query_file& queries) {
    chunks_->add(queries);
}
std::uint64_t query_packer::size() const {
    return chunks_->size();
}
const std::filesystem::path& query_packer::finish() {
    return chunks_->finish();
}

}  // namespace ccd::io
