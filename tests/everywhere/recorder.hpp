// A hash of answers that does not depend on the machine.
#pragma once

#include <bit>
#include <ccd/contact.hpp>
#include <ccd/kind.hpp>
#include <ccd/verdict.hpp>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>

namespace everywhere {

/// Hashes numbers by their bits, independent of the byte order. All NaNs are equal, since their
/// sign and payload depend on the processor.
class recorder {
  public:
    /// With `prints_items`, prints each item's name and the hash up to it. The first different line
    /// of two machines shows the item that differs.
    explicit recorder(bool prints_items = false) : prints_items_(prints_items) {}

    template <std::integral T>
    void add(T x) {
        add_word(static_cast<std::uint64_t>(x));
    }
    void add(double x) {
        add_word(std::bit_cast<std::uint64_t>(
            std::isnan(x) ? std::numeric_limits<double>::quiet_NaN() : x));
    }
    template <class T>
    requires std::is_enum_v<T>
    void add(T x) { add(static_cast<std::uint64_t>(x)); }
    void add(const ccd::verdict& v) {
        add(v.outcome);
        add(v.cause);
    }
    void add(const ccd::first_time& t) {
        add(t.outcome);
        add(t.low);
        add(t.high);
    }
    void add(const ccd::point<double>& p) {
        for (const double x : {p.x, p.y, p.z}) add(x);
    }
    void add(const ccd::first_contact& c);
    template <class List>
    requires requires(const List& list) { list.begin(), list.size(); }
    void add(const List& list) {
        add(list.size());
        for (const auto& x : list) add(x);
    }

    void end_item(const std::string& name);

    std::uint64_t hash() const { return hash_; }
    std::uint64_t size() const { return size_; }

  private:
    void add_word(std::uint64_t word) {
        hash_ = (hash_ ^ word) * 0x9e3779b97f4a7c15;
        hash_ ^= hash_ >> 32;
        ++size_;
    }

    std::uint64_t hash_ = 0xcbf29ce484222325, size_ = 0;
    bool prints_items_;
};

}  // namespace everywhere
