// Command lines beyond CLI11: lists of names, standard streams, outputs that overwrite no input.
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

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

std::string input_named(const std::string& name);  ///< "-" is standard input

void require_one_standard_input(const std::string& option,
                                const std::vector<std::filesystem::path>& inputs);

/// Returns "is TEXT; expected ..." for CLI11 unless the text is an unsigned integer of 64 bits.
/// (CLI11 itself would convert other numbers.)
std::string checked_seed(const std::string& text);

/// The stream for tables: standard error if an output is standard output.
std::ostream& stream_for_people(const std::vector<std::optional<std::filesystem::path>>& outputs);

/// Throws unless each output is writable and neither an input nor another output.
void require_good_outputs(const std::vector<std::optional<std::filesystem::path>>& outputs,
                          std::vector<std::filesystem::path> taken);

}  // namespace errbound::support
