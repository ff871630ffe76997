// Scopes: names for parts of a program, to distinguish errors (explained.hpp).
//   {
//       const errbound::scope s("mean");   // until the end of the block
//       mean = sum / n;
//   }
//
// Scopes nest in the order of entry, across calls, on each thread. A scope is a local variable: it
// must end before those around it, on its thread (not in a coroutine that resumes elsewhere). Name,
// file, line and outer scopes identify it; recursion into itself is the same scope. Operations of
// one kind in a scope are one source of error.
#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

namespace errbound {

struct place {
    std::string name;
    std::string file;
    std::uint_least32_t line = 0;

    friend bool operator==(const place&, const place&) = default;
};

namespace detail {

/// A source of error: a scope and a kind of operation, as indices in all_sources.
struct source {
    std::uint32_t scope = 0, operation = 0;

    friend auto operator<=>(const source&, const source&) = default;
};

/// Operations of every rule; functions have the indices after them.
struct operations {
    enum : std::uint32_t { input, plus, minus, times, divided_by, scaled, rounded, count };
    static constexpr std::array<const char*, count> names{
        "input", "+", "-", "*", "/", "scale", "rounding to the type"};
};

inline constexpr source the_rest{static_cast<std::uint32_t>(-1), 0};

/// The scopes and operations of all threads. Kept for good: numbers may outlive their scopes.
class all_sources {
  public:
    static all_sources& instance() {
        static all_sources& all = *new all_sources;  // outlives static numbers
        return all;
    }

    /// The scope of that name, file and line in scope `parent`; `parent` if there are too many
    /// scopes.
    std::uint32_t scope_in(std::uint32_t parent, std::string_view name, std::string_view file,
                           std::uint_least32_t line) {
        const std::lock_guard lock(mutex_);
        const key wanted{parent, name, file, line};
        if (const auto found = scopes_.find(wanted); found != scopes_.end()) return found->second;
        for (std::uint32_t s = parent; s != 0; s = nodes_[s].parent)
            if (const place& p = nodes_[s].where;
                p.name == name && p.file == file && p.line == line)
                return s;
        if (nodes_.size() > max_scopes) return parent;
        const auto made = static_cast<std::uint32_t>(nodes_.size());
        const place& p =
            nodes_.emplace_back(node{parent, {std::string(name), std::string(file), line}}).where;
        scopes_.emplace(key{parent, p.name, p.file, line}, made);
        return made;
    }
    std::uint32_t function_named(std::string_view name) {
        const std::lock_guard lock(mutex_);
        if (const auto found = numbers_.find(name); found != numbers_.end()) return found->second;
        const auto made = operations::count + static_cast<std::uint32_t>(functions_.size());
        const std::string& kept = functions_.emplace_back(name);
        numbers_.emplace(kept, made);
        return made;
    }

    /// The scopes around a source, the outermost first.
    std::vector<place> scopes_of(const source& s) const {
        const std::lock_guard lock(mutex_);
        std::vector<place> path;
        if (s == the_rest) return path;
        for (std::uint32_t i = s.scope; i != 0; i = nodes_[i].parent)
            path.push_back(nodes_[i].where);
        std::reverse(path.begin(), path.end());
        return path;
    }
    std::string operation_of(const source& s) const {
        const std::lock_guard lock(mutex_);
        if (s == the_rest) return "the rest";
        return s.operation < operations::count ? operations::names[s.operation]
                                               : functions_[s.operation - operations::count];
    }

  private:
    struct node {
        std::uint32_t parent;
        place where;
    };
    using key = std::tuple<std::uint32_t, std::string_view, std::string_view, std::uint_least32_t>;
    static constexpr std::size_t max_scopes = 100'000;

    mutable std::mutex mutex_;
    std::deque<node> nodes_{node{0, {}}};  // the first is no scope; elements never move
    std::map<key, std::uint32_t> scopes_;
    std::deque<std::string> functions_;
    std::map<std::string_view, std::uint32_t> numbers_;  // of functions
};

/// The calling thread's scope; 0: none.
inline std::uint32_t& current_scope() {
    thread_local std::uint32_t current = 0;
    return current;
}

}  // namespace detail

/// A named part of the program, until the end of the block. Cost: a look-up under a lock shared by
/// all threads; tens of nanoseconds without contention. At most 100,000 scopes are kept; names made
/// at run time each need one. Beyond that, an operation counts for the enclosing scope. Throws
/// std::bad_alloc.
class scope {
  public:
    /// File and line of the caller (clang 14 lacks std::source_location).
    [[nodiscard]] explicit scope(std::string_view name, std::string_view file = __builtin_FILE(),
                                 std::uint_least32_t line = __builtin_LINE())
        : outer_(detail::current_scope()) {
        detail::current_scope() =
            detail::all_sources::instance().scope_in(outer_, name, file, line);
    }
    ~scope() { detail::current_scope() = outer_; }
    scope(const scope&) = delete;
    scope& operator=(const scope&) = delete;

  private:
    std::uint32_t outer_;
};

}  // namespace errbound
