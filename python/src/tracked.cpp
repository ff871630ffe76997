// Arrays of tracked numbers: of float or double, under each bound rule.
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>

#include <cstddef>
#include <cstdint>
#include <errbound/functions.hpp>
#include <errbound/tracked.hpp>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"

namespace errbound::python {
namespace {

/// Numbers in a row. Operations take another of the same type, rule and length.
class tracked_row {
  public:
    virtual ~tracked_row() = default;
    virtual std::size_t size() const = 0;
    virtual nb::object values() const = 0;
    virtual nb::object errors() const = 0;
    virtual nb::object signs() const = 0;
    virtual std::unique_ptr<tracked_row> combine(char operation,
                                                 const tracked_row& other) const = 0;
    virtual std::unique_ptr<tracked_row> fused(const tracked_row& factor,
                                               const tracked_row& term) const = 0;
    virtual std::unique_ptr<tracked_row> negated() const = 0;
    virtual std::unique_ptr<tracked_row> absolute() const = 0;
    virtual std::unique_ptr<tracked_row> root() const = 0;
    virtual std::unique_ptr<tracked_row> scaled(int exponent) const = 0;
    virtual std::unique_ptr<tracked_row> taken(const input<std::int64_t, -1>& places) const = 0;
};
using row_pointer = std::unique_ptr<tracked_row>;

template <class T, class Rule>
class row_of final : public tracked_row {
    using number = tracked<T, Rule>;

  public:
    explicit row_of(std::vector<number> all) : all_(std::move(all)) {}

    std::size_t size() const override { return all_.size(); }
    nb::object values() const override {
        return numbers_from<T>([](const number& x) { return x.value(); });
    }
    nb::object errors() const override {
        return numbers_from<T>([](const number& x) { return x.error(); });
    }
    nb::object signs() const override {
        return numbers_from<std::int8_t>([](const number& x) {
            return static_cast<std::int8_t>(static_cast<int>(sign_of(x)) - 1);
        });
    }
    row_pointer combine(char operation, const tracked_row& other) const override {
        const row_of& row = alike(other);
        switch (operation) {
            case '+':
                return pairwise(row, [](const number& x, const number& y) { return x + y; });
            case '-':
                return pairwise(row, [](const number& x, const number& y) { return x - y; });
            case '*':
                return pairwise(row, [](const number& x, const number& y) { return x * y; });
            case '<':
                return pairwise(row, [](const number& x, const number& y) { return min(x, y); });
            case '>':
                return pairwise(row, [](const number& x, const number& y) { return max(x, y); });
            default:
                if constexpr (!std::is_same_v<Rule, safe>)  // whose division does not compile
                    return pairwise(row, [](const number& x, const number& y) { return x / y; });
                throw std::invalid_argument("tracked: this bound rule has no division");
        }
    }
    row_pointer fused(const tracked_row& factor, const tracked_row& term) const override {
        const row_of &b = alike(factor), &c = alike(term);
        std::vector<number> made;
        for (std::size_t i = 0; i < size(); ++i) made.push_back(fma(all_[i], b.all_[i], c.all_[i]));
        return std::make_unique<row_of>(std::move(made));
    }
    row_pointer negated() const override {
        return each([](const number& x) { return -x; });
    }
    row_pointer absolute() const override {
        return each([](const number& x) { return abs(x); });
    }
    row_pointer root() const override {
        return each([](const number& x) { return sqrt(x); });
    }
    row_pointer scaled(int exponent) const override {
        return each([exponent](const number& x) { return scale(x, exponent); });
    }
    row_pointer taken(const input<std::int64_t, -1>& places) const override {
        std::vector<number> some;
        for (const std::int64_t i : items_of<std::int64_t>(places))
            some.push_back(all_.at(static_cast<std::size_t>(i)));
        return std::make_unique<row_of>(std::move(some));
    }

  private:
    const row_of& alike(const tracked_row& other) const {
        const auto* row = dynamic_cast<const row_of*>(&other);
        if (row == nullptr)
            throw std::invalid_argument("tracked: found arrays of two rules or number types");
        if (row->size() != size())
            throw std::invalid_argument("tracked: found rows of different lengths");
        return *row;
    }
    template <class Number, class Convert>
    nb::object numbers_from(const Convert& convert) const {
        std::vector<Number> found;
        for (const number& x : all_) found.push_back(convert(x));
        return numbers_of<Number>(std::move(found));
    }
    template <class Operation>
    row_pointer each(const Operation& operation) const {
        std::vector<number> made;
        for (const number& x : all_) made.push_back(operation(x));
        return std::make_unique<row_of>(std::move(made));
    }
    template <class Operation>
    row_pointer pairwise(const row_of& other, const Operation& operation) const {
        std::vector<number> made;
        for (std::size_t i = 0; i < size(); ++i) made.push_back(operation(all_[i], other.all_[i]));
        return std::make_unique<row_of>(std::move(made));
    }

    std::vector<number> all_;
};

template <class T, class Rule>
row_pointer row_within(const input<T, -1>& values, const input<T, -1>& errors) {
    std::vector<tracked<T, Rule>> all;
    for (std::size_t i = 0; i < values.size(); ++i)
        all.push_back(errors(i) == 0 ? tracked<T, Rule>(values(i))
                                     : tracked<T, Rule>::within(values(i), errors(i)));
    return std::make_unique<row_of<T, Rule>>(std::move(all));
}

template <class T>
row_pointer row_by(const input<T, -1>& values, const input<T, -1>& errors,
                   const std::string& rule) {
    if (values.size() != errors.size())
        throw std::invalid_argument("tracked: found values and errors of different lengths");
    if (rule == "none") return row_within<T, none>(values, errors);
    if (rule == "safe") return row_within<T, safe>(values, errors);
    if (rule == "tight") return row_within<T, tight>(values, errors);
    if (rule == "sharp") return row_within<T, sharp>(values, errors);
    if (rule == "interval") return row_within<T, interval>(values, errors);
    if (rule == "residual") return row_within<T, residual>(values, errors);
    throw std::invalid_argument("rule: found '" + rule +
                                "', expected one of none, safe, tight, sharp, interval, residual");
}

}  // namespace

void bind_tracked(nb::module_& m) {
    nb::class_<tracked_row>(m, "TrackedRow")
        .def("__len__", &tracked_row::size)
        .def("values", &tracked_row::values)
        .def("errors", &tracked_row::errors)
        .def("signs", &tracked_row::signs)
        .def("add", [](const tracked_row& a, const tracked_row& b) { return a.combine('+', b); })
        .def("subtract",
             [](const tracked_row& a, const tracked_row& b) { return a.combine('-', b); })
        .def("multiply",
             [](const tracked_row& a, const tracked_row& b) { return a.combine('*', b); })
        .def("divide", [](const tracked_row& a, const tracked_row& b) { return a.combine('/', b); })
        .def("minimum",
             [](const tracked_row& a, const tracked_row& b) { return a.combine('<', b); })
        .def("maximum",
             [](const tracked_row& a, const tracked_row& b) { return a.combine('>', b); })
        .def("fused", &tracked_row::fused)
        .def("negated", &tracked_row::negated)
        .def("absolute", &tracked_row::absolute)
        .def("root", &tracked_row::root)
        .def("scaled", &tracked_row::scaled)
        .def("taken", &tracked_row::taken);
    m.def("tracked_row", row_by<double>, nb::arg("values").noconvert(),
          nb::arg("errors").noconvert(), nb::arg("rule"));
    m.def("tracked_row", row_by<float>, nb::arg("values").noconvert(),
          nb::arg("errors").noconvert(), nb::arg("rule"));
}

}  // namespace errbound::python
