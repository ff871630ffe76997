// Arrays of tracked numbers, float or double, under each bound rule.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <errbound/elementary.hpp>
#include <errbound/explain/explain.hpp>
#include <errbound/functions.hpp>
#include <errbound/rules/affine.hpp>
#include <errbound/rules/relative.hpp>
#include <errbound/tracked.hpp>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "interruptible.hpp"

namespace errbound::python {
namespace {

/// A one-dimensional array. Operands of operations have the same type, rule and length.
class tracked_row {
  public:
    virtual ~tracked_row() = default;
    virtual std::size_t size() const = 0;
    virtual nb::object values() const = 0;
    virtual nb::object errors() const = 0;
    virtual nb::object signs() const = 0;
    virtual std::unique_ptr<tracked_row> function(const std::string& name) const = 0;
    virtual std::unique_ptr<tracked_row> combine(const std::string& name,
                                                 const tracked_row& other) const = 0;
    virtual std::unique_ptr<tracked_row> fused(const tracked_row& factor,
                                               const tracked_row& term) const = 0;
    virtual std::unique_ptr<tracked_row> power(int exponent) const = 0;
    virtual std::unique_ptr<tracked_row> scaled(int exponent) const = 0;
    virtual std::unique_ptr<tracked_row> taken(const input<std::int64_t, -1>& places) const = 0;
    /// Returns sums of consecutive groups of `length` numbers.
    virtual std::unique_ptr<tracked_row> sums(std::size_t length) const = 0;
    /// Returns dot products of each group of `length` numbers with each group of the other row.
    virtual std::unique_ptr<tracked_row> dots(const tracked_row& other,
                                              std::size_t length) const = 0;
    virtual explanation explained_at(std::size_t i, const std::string& name) const = 0;
};
using row_pointer = std::unique_ptr<tracked_row>;

template <class Number>
struct named_function {
    const char* name;
    Number (*apply)(const Number&);
};
template <class Number>
constexpr std::array named_functions{
    named_function<Number>{"negative", [](const Number& x) { return -x; }},
    named_function<Number>{"abs", [](const Number& x) { return abs(x); }},
    named_function<Number>{"sqrt", [](const Number& x) { return sqrt(x); }},
    named_function<Number>{"cbrt", [](const Number& x) { return cbrt(x); }},
    named_function<Number>{"exp", [](const Number& x) { return exp(x); }},
    named_function<Number>{"exp2", [](const Number& x) { return exp2(x); }},
    named_function<Number>{"expm1", [](const Number& x) { return expm1(x); }},
    named_function<Number>{"log", [](const Number& x) { return log(x); }},
    named_function<Number>{"log2", [](const Number& x) { return log2(x); }},
    named_function<Number>{"log10", [](const Number& x) { return log10(x); }},
    named_function<Number>{"log1p", [](const Number& x) { return log1p(x); }},
    named_function<Number>{"sin", [](const Number& x) { return sin(x); }},
    named_function<Number>{"cos", [](const Number& x) { return cos(x); }},
    named_function<Number>{"tan", [](const Number& x) { return tan(x); }},
    named_function<Number>{"asin", [](const Number& x) { return asin(x); }},
    named_function<Number>{"acos", [](const Number& x) { return acos(x); }},
    named_function<Number>{"atan", [](const Number& x) { return atan(x); }},
    named_function<Number>{"sinh", [](const Number& x) { return sinh(x); }},
    named_function<Number>{"cosh", [](const Number& x) { return cosh(x); }},
    named_function<Number>{"tanh", [](const Number& x) { return tanh(x); }},
    named_function<Number>{"asinh", [](const Number& x) { return asinh(x); }},
    named_function<Number>{"acosh", [](const Number& x) { return acosh(x); }},
    named_function<Number>{"atanh", [](const Number& x) { return atanh(x); }}};

template <class Number>
Number quotient_of(const Number& x, const Number& y) {
    if constexpr (detail::rule_divides<typename Number::rule_type, typename Number::value_type>)
        return x / y;
    throw std::invalid_argument(std::string("rule is ") + Number::rule_type::name +
                                ", which has no division; expected another rule");
}

template <class Number>
struct named_operation {
    const char* name;
    Number (*apply)(const Number&, const Number&);
};
template <class Number>
constexpr std::array named_operations{
    named_operation<Number>{"add", [](const Number& x, const Number& y) { return x + y; }},
    named_operation<Number>{"subtract", [](const Number& x, const Number& y) { return x - y; }},
    named_operation<Number>{"multiply", [](const Number& x, const Number& y) { return x * y; }},
    named_operation<Number>{"divide", quotient_of<Number>},
    named_operation<Number>{"minimum", [](const Number& x, const Number& y) { return min(x, y); }},
    named_operation<Number>{"maximum", [](const Number& x, const Number& y) { return max(x, y); }},
    named_operation<Number>{"hypot", [](const Number& x, const Number& y) { return hypot(x, y); }},
    named_operation<Number>{"atan2", [](const Number& x, const Number& y) { return atan2(x, y); }},
    named_operation<Number>{"pow", [](const Number& x, const Number& y) { return pow(x, y); }}};

template <class Table>
auto named(const Table& table, const std::string& name) {
    const auto found = std::find_if(table.begin(), table.end(),
                                    [&](const auto& entry) { return name == entry.name; });
    if (found == table.end()) throw std::invalid_argument("tracked: no function " + name);
    return found->apply;
}

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
    row_pointer function(const std::string& name) const override {
        const auto apply = named(named_functions<number>, name);
        return made(size(), [&](std::size_t i) { return apply(all_[i]); });
    }
    row_pointer combine(const std::string& name, const tracked_row& other) const override {
        const row_of& row = of_same_length(other);
        const auto apply = named(named_operations<number>, name);
        return made(size(), [&](std::size_t i) { return apply(all_[i], row.all_[i]); });
    }
    row_pointer fused(const tracked_row& factor, const tracked_row& term) const override {
        const row_of &b = of_same_length(factor), &c = of_same_length(term);
        return made(size(), [&](std::size_t i) { return fma(all_[i], b.all_[i], c.all_[i]); });
    }
    row_pointer power(int exponent) const override {
        return made(size(), [&](std::size_t i) { return pow(all_[i], exponent); });
    }
    row_pointer scaled(int exponent) const override {
        return made(size(), [&](std::size_t i) { return scale(all_[i], exponent); });
    }
    row_pointer taken(const input<std::int64_t, -1>& places) const override {
        const auto chosen = items_of<std::int64_t>(places);
        return made(chosen.size(),
                    [&](std::size_t i) { return all_.at(static_cast<std::size_t>(chosen[i])); });
    }
    row_pointer sums(std::size_t length) const override {
        return made(length == 0 ? 0 : size() / length, [&](std::size_t i) {
            const auto part = block(i, length);
            number sum = part[0];
            for (const number& x : part.subspan(1)) sum += x;
            return sum;
        });
    }
    row_pointer dots(const tracked_row& other, std::size_t length) const override {
        const row_of& row = alike(other);
        const std::size_t columns = length == 0 ? 0 : row.size() / length;
        return made(length == 0 ? 0 : size() / length * columns, [&](std::size_t i) {
            return dot(block(i / columns, length), row.block(i % columns, length));
        });
    }
    explanation explained_at(std::size_t i, const std::string& name) const override {
        if constexpr (is_explained<Rule>)
            return explain(all_.at(i), name);
        else
            throw std::invalid_argument(
                "x is an array without explanations; expected one of array(..., explained=True)");
    }

  private:
    const row_of& alike(const tracked_row& other) const {
        const auto* row = dynamic_cast<const row_of*>(&other);
        if (row == nullptr)
            throw std::invalid_argument(
                "operands are tracked arrays of two rules or dtypes; expected one");
        return *row;
    }
    const row_of& of_same_length(const tracked_row& other) const {
        const row_of& row = alike(other);
        if (row.size() != size())
            throw std::invalid_argument("lengths of rows differ; expected equal lengths");
        return row;
    }
    std::span<const number> block(std::size_t i, std::size_t length) const {
        return std::span(all_).subspan(i * length, length);
    }
    template <class Number, class Convert>
    nb::object numbers_from(const Convert& convert) const {
        std::vector<Number> found;
        found.reserve(size());
        for (const number& x : all_) found.push_back(convert(x));
        return numbers_of<Number>(std::move(found));
    }
    /// Returns number(0), number(1), ..., computed without the interpreter's lock.
    template <class At>
    static row_pointer made(std::size_t count, const At& at) {
        std::vector<number> all;
        all.reserve(count);
        in_parts(count, 4096, [&](std::size_t first, std::size_t size) {
            for (std::size_t i = first; i < first + size; ++i) all.push_back(at(i));
        });
        return std::make_unique<row_of>(std::move(all));
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
        throw std::invalid_argument("lengths of values and errors differ; expected equal lengths");
    if (rule == "none") return row_within<T, none>(values, errors);
    if (rule == "safe") return row_within<T, safe>(values, errors);
    if (rule == "tight") return row_within<T, tight>(values, errors);
    if (rule == "sharp") return row_within<T, sharp>(values, errors);
    if (rule == "interval") return row_within<T, interval>(values, errors);
    if (rule == "residual") return row_within<T, residual>(values, errors);
    if (rule == "affine") return row_within<T, affine>(values, errors);
    if (rule == "relative") return row_within<T, relative>(values, errors);
    throw std::invalid_argument("rule is '" + rule +
                                "'; expected one of none, safe, tight, sharp, interval, residual, "
                                "affine, relative");
}

row_pointer explained_row(const input<double, -1>& values, const input<double, -1>& errors,
                          const std::string& rule) {
    if (rule == "tight") return row_within<double, explained<tight>>(values, errors);
    if (rule == "residual") return row_within<double, explained<residual>>(values, errors);
    throw std::invalid_argument("rule is '" + rule +
                                "'; expected tight or residual for an explained array");
}

/// Returns name, rule, value, error, table, and rows of amount, known amount, operation and scopes.
nb::tuple explained_at(const tracked_row& row, std::size_t i, const std::string& name) {
    const explanation e = row.explained_at(i, name);
    nb::list contributions;
    for (const contribution& c : e.contributions) {
        nb::list scopes;
        for (const place& s : c.scopes) scopes.append(nb::make_tuple(s.name, s.file, s.line));
        contributions.append(nb::make_tuple(c.amount, c.known, c.operation, scopes));
    }
    return nb::make_tuple(e.name, e.rule, e.value, e.error, text_of(e), contributions);
}

/// A scope from `enter` to `leave`. They are called in pairs on one thread.
class kept_scope {
  public:
    kept_scope(std::string name, std::string file, std::uint32_t line)
        : name_(std::move(name)), file_(std::move(file)), line_(line) {}
    kept_scope(const kept_scope&) = delete;
    kept_scope& operator=(const kept_scope&) = delete;

    void enter() { scopes_.push_back(std::make_unique<scope>(name_, file_, line_)); }
    void leave() {
        if (!scopes_.empty()) scopes_.pop_back();
    }

  private:
    std::string name_, file_;
    std::uint32_t line_;
    std::vector<std::unique_ptr<scope>> scopes_;
};

}  // namespace

void bind_tracked(nb::module_& m) {
    nb::class_<tracked_row>(m, "TrackedRow")
        .def("__len__", &tracked_row::size)
        .def("values", &tracked_row::values)
        .def("errors", &tracked_row::errors)
        .def("signs", &tracked_row::signs)
        .def("function", &tracked_row::function)
        .def("combine", &tracked_row::combine)
        .def("fused", &tracked_row::fused)
        .def("power", &tracked_row::power)
        .def("scaled", &tracked_row::scaled)
        .def("taken", &tracked_row::taken)
        .def("sums", &tracked_row::sums)
        .def("dots", &tracked_row::dots)
        .def("explained_at", explained_at);
    m.def("tracked_row", row_by<double>, nb::arg("values").noconvert(),
          nb::arg("errors").noconvert(), nb::arg("rule"));
    m.def("tracked_row", row_by<float>, nb::arg("values").noconvert(),
          nb::arg("errors").noconvert(), nb::arg("rule"));
    m.def("explained_row", explained_row, nb::arg("values").noconvert(),
          nb::arg("errors").noconvert(), nb::arg("rule"));
    nb::class_<kept_scope>(m, "Scope")
        .def(nb::init<std::string, std::string, std::uint32_t>())
        .def("enter", &kept_scope::enter)
        .def("leave", &kept_scope::leave);
}

}  // namespace errbound::python
