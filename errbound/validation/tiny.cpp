// Every rule in every case of tiny formats.
#include "errbound/validation/blocks.hpp"
#include "errbound/validation/validation.hpp"

namespace errbound::validation {

report validate_tiny(std::span<const rule> rules, int threads, const progress& show) {
    std::vector<tiny_findings> found(rules.size() * tiny_format_count);
    struct nothing {};
    in_blocks<nothing>(threads, found.size(), show, [&](nothing&, std::uint64_t block) {
        rules[block / tiny_format_count].check_tiny(block % tiny_format_count, found[block]);
    });
    report result;
    for (std::size_t i = 0; i < found.size(); ++i) {
        tiny_findings& f = found[i];
        if (f.format.empty()) continue;
        const std::string name(rules[i / tiny_format_count].name);
        result.counts.push_back({name, f.format, f.values, f.values, f.violations, 0});
        for (auto& [what, code] : f.first)
            result.violations.push_back({name, f.format, std::move(what), std::move(code)});
    }
    return result;
}

}  // namespace errbound::validation
