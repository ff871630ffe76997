#include "errbound/support/command_line.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <iostream>
#include <system_error>

#include "errbound/support/output_file.hpp"
#include "errbound/support/system/system.hpp"

namespace errbound::support {

std::string input_named(const std::string& name) {
    return name == "-" ? "/dev/stdin" : name;
}

void require_one_standard_input(const std::string& option,
                                const std::vector<std::filesystem::path>& inputs) {
    if (std::ranges::count(inputs, std::filesystem::path(input_named("-"))) > 1)
        throw usage_error(option + ": standard input is given twice; expected at most once");
}

std::string checked_seed(const std::string& text) {
    std::uint64_t seed = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
    if (error == std::errc() && end == text.data() + text.size()) return {};
    return "is '" + text + "'; expected an integer from 0 to 2^64 - 1";
}

std::ostream& stream_for_people(const std::vector<std::optional<std::filesystem::path>>& outputs) {
    for (const auto& output : outputs)
        if (output && descriptor_of(*output) == 1) return std::cerr;
    return std::cout;
}

namespace {

bool are_of_one_file(const std::filesystem::path& a, const std::filesystem::path& b) {
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

}  // namespace

void require_good_outputs(const std::vector<std::optional<std::filesystem::path>>& outputs,
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
