// What the programs' command lines share beyond CLI11: lists of names, standard input and output,
// and outputs that nothing is lost to.
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

/// A command line that CLI11 lets through but that makes no sense.
struct usage_error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// What `named` makes of the names of an option's list N[,N...]. Throws usage_error where one is
/// there twice.
template <class Named>
auto all_named(const std::string& option, const std::string& list, const Named& named) {
    std::vector<decltype(named(list))> result;
    std::set<std::string> names;
    std::size_t begin = 0;
    for (std::size_t comma = 0; comma != std::string::npos; begin = comma + 1) {
        comma = list.find(',', begin);
        const std::string name = list.substr(begin, comma - begin);
        if (!names.insert(name).second)
            throw usage_error(option + ": found '" + name + "' twice in '" + list +
                              "', expected each once");
        result.push_back(named(name));
    }
    return result;
}

/// The names of the entries, for "expected one of ...".
template <class Entries, class Name>
std::string listed(const Entries& entries, const Name& name) {
    std::string list;
    for (const auto& entry : entries)
        list.append(list.empty() ? "" : ", ").append(std::invoke(name, entry));
    return list;
}

/// The entry of that name, a reference into `entries`. Throws usage_error, which names the option.
/// `remark` ends its message.
template <class Entries, class Name>
const auto& entry_named(const std::string& option, const std::string& wanted,
                        const Entries& entries, const Name& name, const std::string& remark = "") {
    for (const auto& entry : entries)
        if (std::invoke(name, entry) == wanted) return entry;
    throw usage_error(option + ": found '" + wanted + "', expected one of " +
                      listed(entries, name) + remark);
}

/// The path of an input on the command line: `-` is standard input.
inline std::string input_named(const std::string& name) {
    return name == "-" ? "/dev/stdin" : name;
}

/// Throws usage_error where standard input is among the inputs twice.
inline void require_one_standard_input(const std::string& option,
                                       const std::vector<std::filesystem::path>& inputs) {
    if (std::ranges::count(inputs, std::filesystem::path(input_named("-"))) > 1)
        throw usage_error(option + ": found standard input twice, expected once");
}

/// For CLI11's checks: what is wrong if that is no whole number of 64 bits, as CLI11 itself would
/// make one of others.
inline std::string checked_seed(const std::string& text) {
    std::uint64_t seed = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
    if (error == std::errc() && end == text.data() + text.size()) return {};
    return "found '" + text + "', expected a whole number up to 2^64 - 1";
}

/// Where tables for people go: standard output, or standard error where an output is the former.
inline std::ostream& stream_for_people(
    const std::vector<std::optional<std::filesystem::path>>& outputs) {
    for (const auto& output : outputs)
        if (output && descriptor_of(*output) == 1) return std::cerr;
    return std::cout;
}

/// Whether two names are of one file, which need not be there yet.
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

/// An output must be neither an input nor another output, so that nothing is lost, and writable,
/// so that no work is.
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
                throw usage_error("found the output '" + output->string() +
                                  "' among the inputs or twice, expected a file of its own");
        }
        require_writable(*output);
        taken.push_back(*output);
    }
}

}  // namespace errbound::support
