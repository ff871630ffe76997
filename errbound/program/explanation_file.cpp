#include "errbound/program/explanation_file.hpp"

#include <cstdint>
#include <errbound/support/error.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

namespace errbound::explaining {
namespace {

using nlohmann::json;
using support::file_error;

constexpr const char* format = "errbound explanation";
constexpr int version = 1;

/// A JSON value, and its position for messages: results[0].error
class element {
  public:
    element(const json& value, std::string file, std::string path)
        : value_(value), file_(std::move(file)), path_(std::move(path)) {}

    element member(const char* name) const {
        if (!value_.is_object()) refuse("an object");
        const auto found = value_.find(name);
        const std::string path = path_.empty() ? name : path_ + '.' + name;
        if (found == value_.end())
            throw file_error(file_ + ": " + path + " is missing; expected a value");
        return {*found, file_, path};
    }
    template <class Read>
    auto all(const Read& read) const {
        if (!value_.is_array()) refuse("an array");
        std::vector<decltype(read(*this))> result;
        result.reserve(value_.size());
        for (std::size_t i = 0; i < value_.size(); ++i)
            result.push_back(
                read(element(value_[i], file_, path_ + '[' + std::to_string(i) + ']')));
        return result;
    }
    std::string text() const {
        if (!value_.is_string()) refuse("a string");
        return value_.get<std::string>();
    }
    /// Returns the number; `otherwise` for null.
    double number(double otherwise) const {
        if (value_.is_null()) return otherwise;
        if (!value_.is_number()) refuse("a number or null");
        return value_.get<double>();
    }
    /// Infinities are strings; null is NaN.
    double value() const {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        if (value_ == "inf") return infinity;
        if (value_ == "-inf") return -infinity;
        if (!value_.is_null() && !value_.is_number()) refuse("a number, \"inf\", \"-inf\" or null");
        return number(std::numeric_limits<double>::quiet_NaN());
    }
    /// Returns a number >= 0; null is infinite.
    double amount() const {
        const double x = number(std::numeric_limits<double>::infinity());
        if (!(x >= 0)) refuse("a number that is not negative, or null");
        return x;
    }
    std::uint_least32_t line() const {
        if (!value_.is_number_unsigned() ||
            value_.get<std::uint64_t>() > std::numeric_limits<std::uint32_t>::max())
            refuse("a line's number");
        return value_.get<std::uint32_t>();
    }
    void require(const json& expected) const {
        if (value_ != expected) refuse(expected.dump());
    }

  private:
    [[noreturn]] void refuse(const std::string& expected) const {
        // Structures are not shown: deeply nested ones would overflow the stack.
        const bool shown = !value_.is_structured() || value_.empty();
        std::string found = shown ? value_.dump(-1, ' ', false, json::error_handler_t::replace)
                                  : std::string("an ") + value_.type_name();
        constexpr std::size_t longest = 40;
        if (found.size() > longest) found = std::string("a long ") + value_.type_name();
        throw file_error(file_ + ": " + (path_.empty() ? "content" : path_) + " is " + found +
                         "; expected " + expected);
    }

    const json& value_;
    std::string file_, path_;
};

place read_place(const element& e) {
    return {e.member("name").text(), e.member("file").text(), e.member("line").line()};
}
contribution read_contribution(const element& e) {
    return {e.member("scopes").all(read_place), e.member("operation").text(),
            e.member("amount").amount(), e.member("known").number(0)};
}
explanation read_explanation(const element& e) {
    return {e.member("name").text(), e.member("rule").text(), e.member("value").value(),
            e.member("error").amount(), e.member("contributions").all(read_contribution)};
}

json parsed(std::string_view text, const std::string& name) {
    try {
        return json::parse(text);
    } catch (const json::parse_error& error) {
        throw file_error(name + ": text at byte " + std::to_string(error.byte) +
                         " is not JSON; expected output of errbound::write_explanations");
    } catch (const json::exception&) {
        throw file_error(name + ": a number is out of range; expected numbers of double");
    }
}

}  // namespace

std::vector<explanation> parse_explanations(std::string_view text, const std::string& name) {
    const json all = parsed(text, name);
    const element root(all, name, "");
    root.member("format").require(format);
    root.member("version").require(version);
    return root.member("results").all(read_explanation);
}

}  // namespace errbound::explaining
