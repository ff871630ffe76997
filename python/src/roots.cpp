#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <cstdint>
#include <errbound/integers/integer.hpp>
#include <errbound/polynomial.hpp>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "interruptible.hpp"

namespace errbound::python {
namespace {

/// Ascending coefficients: doubles, or integers in hexadecimal digits.
using coefficients = std::variant<input<double, -1>, std::vector<std::string>>;
using roots_type = real_roots<integer>;
using staged_type = roots::staged_polynomial<integer>;
using limit = std::optional<std::uint64_t>;

struct limit_error : std::runtime_error {
    limit_error()
        : std::runtime_error("search of roots is beyond its limits; expected less work") {}
};

integer integer_of(const std::string& hexadecimal) {
    return integer::from_string(hexadecimal, 16);
}
std::string text_of(const integer& x) {
    return to_string(x, 16);
}

polynomial<double> polynomial_of(const input<double, -1>& c) {
    const auto all = items_of<double>(c);
    return polynomial<double>(std::vector<double>(all.begin(), all.end()));
}
polynomial<integer> polynomial_of(const std::vector<std::string>& c) {
    std::vector<integer> all;
    for (const std::string& digits : c) all.push_back(integer_of(digits));
    return polynomial<integer>(std::move(all));
}
staged_type staged_of(const coefficients& c) {
    return std::visit([](const auto& x) { return roots::staged<integer>(polynomial_of(x)); }, c);
}

/// Returns call(limits) without the interpreter's lock. Signals and limits end it.
template <class Call>
auto limited(const Call& call, limit operations = {}, limit bytes = {}) {
    return without_gil([&](const ccd::stop_query& stop) {
        bool stopped = false;
        const root_limits limits{.operations = operations.value_or(root_limits::none),
                                 .bytes = bytes.value_or(root_limits::none),
                                 .stop = [&] { return stopped = stopped || stop(); }};
        try {
            return call(limits);
        } catch (const roots::gave_up&) {
            if (stopped) throw ccd::stopped();
            throw limit_error();
        }
    });
}

std::size_t count_of(const coefficients& p, double a, double b, limit operations, limit bytes) {
    return limited(
        [&](const root_limits& limits) {
            return std::visit(
                [&](const auto& c) {
                    return roots::count_within<integer>(polynomial_of(c), a, b, limits);
                },
                p);
        },
        operations, bytes);
}
/// Returns -1 for the zero polynomial.
std::int64_t number_of(std::size_t count) {
    return count == infinitely_many ? -1 : static_cast<std::int64_t>(count);
}

nb::object count_of_rows(const input<double, -1, -1>& rows, double a, double b, limit operations,
                         limit bytes) {
    std::vector<std::int64_t> counts(rows.shape(0));
    const std::size_t length = rows.shape(1);
    limited(
        [&](const root_limits& limits) {
            for (std::size_t i = 0; i < counts.size(); ++i) {
                if (i % 256 == 0 && limits.stop()) throw roots::gave_up();
                const double* row = rows.data() + i * length;
                const polynomial<double> p(std::vector<double>(row, row + length));
                counts[i] = number_of(roots::count_within<integer>(p, a, b, limits));
            }
        },
        operations, bytes);
    return numbers_of<std::int64_t>(std::move(counts));
}

using exact_point = std::pair<std::string, int>;
exact_point exact_of(const roots_type::point& x) {
    return {text_of(x.numerator()), x.exponent()};
}

std::vector<std::string> common_factor_of(const coefficients& p, const coefficients& q) {
    const auto factor = limited([&](const root_limits& limits) {
        roots::work_meter meter(limits);
        return roots::common_factor(staged_of(p).exact(), staged_of(q).exact(), meter);
    });
    std::vector<std::string> texts;
    for (const integer& c : factor) texts.push_back(text_of(c));
    return texts;
}

/// Roots for one call at a time, since calls narrow the intervals.
class kept_roots {
    template <class Call>
    auto alone(const Call& call) {
        const std::unique_lock held(mutex_, std::try_to_lock);
        if (!held)
            throw std::runtime_error(
                "Roots: another call is under way; expected one call at a time");
        return limited([&](const root_limits& limits) {
            struct polled {
                const std::function<bool()>*& stop;
                ~polled() { stop = nullptr; }
            } const polls{stop_ = &limits.stop};
            return call();
        });
    }

  public:
    kept_roots(const coefficients& p, double a, double b, limit operations, limit bytes)
        : a_(a), b_(b) {
        limited(
            [&](const root_limits& limits) {
                root_limits kept = limits;
                kept.stop = [this] { return stop_ && (*stop_)(); };
                stop_ = &limits.stop;
                roots_.emplace(staged_of(p), a, b, kept);
            },
            operations, bytes);
        stop_ = nullptr;
    }
    kept_roots(const kept_roots&) = delete;
    kept_roots& operator=(const kept_roots&) = delete;

    std::size_t size() const { return roots_->size(); }
    bool everywhere() const { return roots_->everywhere(); }
    nb::object multiplicities() const {
        std::vector<std::int64_t> all;
        for (std::size_t k = 0; k < size(); ++k) all.push_back((*roots_)[k].multiplicity);
        return numbers_of<std::int64_t>(std::move(all));
    }
    nb::object neighbouring_doubles() {
        std::vector<std::array<double, 2>> all(size());
        alone([&] {
            for (std::size_t k = 0; k < all.size(); ++k) {
                const auto [low, high] = roots_->neighbouring_doubles(k);
                all[k] = {low, high};
            }
        });
        return rows_of<double>(std::move(all));
    }
    std::pair<exact_point, exact_point> interval(std::size_t k, std::optional<double> width) {
        return alone([&] {
            if (width) roots_->refine(k, *width);
            const auto& root = (*roots_)[k];
            return std::pair(exact_of(root.low), exact_of(root.high));
        });
    }
    nb::object signs_at(const coefficients& g) {
        std::vector<std::int8_t> signs(size());
        alone([&] {
            staged_type staged = staged_of(g);
            for (std::size_t k = 0; k < signs.size(); ++k)
                signs[k] =
                    static_cast<std::int8_t>(static_cast<int>(roots_->sign_at(staged, k)) - 1);
        });
        return numbers_of<std::int8_t>(std::move(signs));
    }
    std::tuple<bool, bool, bool> occurring_signs() {
        return alone([&] {
            const auto s = roots_->signs_on(a_, b_);
            return std::tuple(s.negative, s.zero, s.positive);
        });
    }

  private:
    double a_, b_;
    std::mutex mutex_;
    const std::function<bool()>* stop_ = nullptr;
    std::optional<roots_type> roots_;
};

}  // namespace

void bind_roots(nb::module_& m) {
    nb::exception<limit_error>(m, "LimitError", PyExc_RuntimeError).attr("__doc__") =
        "The search of roots was given up, since it would exceed max_operations or max_bytes.";
    nb::class_<kept_roots>(m, "Roots")
        .def(nb::init<const coefficients&, double, double, limit, limit>(), nb::arg("p"),
             nb::arg("a"), nb::arg("b"), nb::arg("operations").none(), nb::arg("bytes").none())
        .def("__len__", &kept_roots::size)
        .def("everywhere", &kept_roots::everywhere)
        .def("multiplicities", &kept_roots::multiplicities)
        .def("neighbouring_doubles", &kept_roots::neighbouring_doubles)
        .def("interval", &kept_roots::interval, nb::arg("k"), nb::arg("width").none())
        .def("signs_at", &kept_roots::signs_at)
        .def("occurring_signs", &kept_roots::occurring_signs);
    m.def(
        "count",
        [](const coefficients& p, double a, double b, limit operations, limit bytes) {
            return number_of(count_of(p, a, b, operations, bytes));
        },
        nb::arg("p"), nb::arg("a"), nb::arg("b"), nb::arg("operations").none(),
        nb::arg("bytes").none());
    m.def("count_of_rows", count_of_rows, nb::arg("rows"), nb::arg("a"), nb::arg("b"),
          nb::arg("operations").none(), nb::arg("bytes").none());
    m.def("common_factor", common_factor_of);
}

}  // namespace errbound::python
