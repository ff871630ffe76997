// Command lines beyond CLI11: lists of names, standard streams, outputs that overwrite no input.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iostream>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "errbound/support/output_file.hpp"
#include "errbound/support/system/system.hpp"

namespace errbound::support {

/// A command line that CLI11 accepts but that makes no sense.
struct usage_error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Returns named(name) for each name of a list N[,N...]. Throws usage_error for a repeated name.
template <class Named>
auto all_named(const std::string& option, const std::string& list, const Named& named) {
    std::vector<decltype(named(list))> result;
    std::set<std::string> names;
    std::size_t begin = 0;
    for (std::size_t comma = 0; comma != std::string::npos; begin = comma + 1) {
        comma = list.find(',', begin);
        const std::string name = list.substr(begin, comma - begin);
        if (!names.insert(name).second)
            throw usage_error(option + " is '" + list + "', with '" + name +
                              "' twice; expected each name once");
        result.push_back(named(name));
    }
    return result;
}

/// Comma-separated names, for "expected one of ...".
template <class Entries, class Name>
std::string listed(const Entries& entries, const Name& name) {
    std::string list;
    for (const auto& entry : entries)
        list.append(list.empty() ? "" : ", ").append(std::invoke(name, entry));
    return list;
}

/// A reference into `entries`. Throws usage_error with the option's name, and `remark` at the end.
template <class Entries, class Name>
const auto& entry_named(const std::string& option, const std::string& wanted,
                        const Entries& entries, const Name& name, const std::string& remark = "") {
    for (const auto& entry : entries)
        if (std::invoke(name, entry) == wanted) return entry;
    throw usage_error(option + " is '" + wanted + "'; expected one of " + listed(entries, name) +
                      remark);
}

inline std::string input_named(const std::string& name) {
    return name == "-" ? "/dev/stdin" : name;
}

inline void require_one_standard_input(const std::string& option,
                                       const std::vector<std::filesystem::path>& inputs) {
    if (std::ranges::count(inputs, std::filesystem::path(input_named("-"))) > 1)
        throw usage_error(option + ": standard input is given twice; expected at most once");
}

/// Returns an error message for CLI11 unless the text is an unsigned integer of 64 bits. (CLI11
/// itself would convert other numbers.)
inline std::string checked_seed(const std::string& text) {
    std::uint64_t seed = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
    if (error == std::errc() && end == text.data() + text.size()) return {};
    return "seed is '" + text + "'; expected an integer from 0 to 2^64 - 1";
}

/// The stream for tables: standard error if an output is standard output.
inline std::ostream& stream_for_people(
    const std::vector<std::optional<std::filesystem::path>>& outputs) {
    for (const auto& output : outputs)
        if (output && descriptor_of(*output) == 1) return std::cerr;
    return std::cout;
}

inline bool are_of_one_file(const std::filesystem::path& a, const std::filesystem::path& b) {
    std::error_code ignored;
    if (std::filesystem::equivalent(a, b, ignored)) return true;
    const auto without_links = [](const std::filesystem::path& name) {
        std::error_code error;
        auto real = std::filesystem::absolute(name, error);
        if (!error) real = std::filesystem::weakly_canonical(real, error);
        return system::native_name(error ? name.lexically_normal() : real);
    };
    return system::are_one_name(without_links(a), without_links(b));
}

/// Throws unless each output is writable and neither an input nor another output.
inline void require_good_outputs(const std::vector<std::optional<std::filesystem::path>>& outputs,
                                 std::vector<std::filesystem::path> taken) {
    for (const auto& output : outputs) {
        if (!output) continue;
        for (const std::filesystem::path& other : taken) {
            std::error_code ignored;
            const bool same_stream =
                descriptor_of(*output) && descriptor_of(*output) == descriptor_of(other);
            if (same_stream || (are_of_one_file(*output, other) &&
                                std::filesystem::status(*output, ignored).type() !=
                                    std::filesystem::file_type::character))
                throw usage_error("output '" + output->string() +
                                  "' is also an input or another output; expected a separate file");
        }
        require_writable(*output);
        taken.push_back(*output);
    }
}

}  // namespace errbound::support
