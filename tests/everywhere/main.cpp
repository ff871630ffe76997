// The program errbound_everywhere: one hash of answers per section and one of all. They must equal
// those of expected.hpp on every machine, system and compiler.
//
//   errbound_everywhere                  all sections; exit status 1 if a hash differs
//   errbound_everywhere --items SECTION  prints each hashed item with the hash up to it
#include <chrono>
#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <errbound/environment.hpp>
#include <functional>
#include <string>
#include <vector>

#include "tests/everywhere/expected.hpp"
#include "tests/everywhere/sections.hpp"

namespace everywhere {
namespace {

struct section {
    std::string name;
    std::function<void(recorder&)> record;
    std::uint64_t expected;
    bool in_all = true;  ///< true if its hash is in the hash of all
};

std::vector<section> all_sections() {
    std::vector<section> all{
        {"bounds", record_bounds, expected::bounds},
        {"predicates", record_predicates, expected::predicates},
        {"roots", record_roots, expected::roots},
        {"decisions", record_decisions, expected::decisions},
        {"times", record_times, expected::times},
    };
    for (const ccd::instruction_set set : ccd::instruction_sets()) {
        const bool first = set == ccd::instruction_sets().front();
        const std::string by = ' ' + std::string(ccd::name(set));
        all.push_back({"batches" + by, [set](recorder& to) { record_batches(to, set); },
                       expected::batches, first});
        all.push_back(
            {"steps" + by, [set](recorder& to) { record_steps(to, set); }, expected::steps, first});
    }
    return all;
}

bool print_row(const char* name, const recorder& answers, std::uint64_t right, double seconds) {
    const bool equal = answers.hash() == right;
    std::printf("%-18s %9" PRIu64 " %7.2f  %016" PRIx64 "  %s\n", name, answers.size(), seconds,
                answers.hash(), equal ? "equal" : "DIFFERS");
    std::fflush(stdout);
    return equal;
}

int print_hashes() {
    using clock = std::chrono::steady_clock;
    std::printf("%-18s %9s %7s  %-16s\n", "section", "numbers", "seconds", "hash");
    bool equal = true;
    recorder all;
    const auto seconds_since = [](clock::time_point then) {
        return std::chrono::duration<double>(clock::now() - then).count();
    };
    const auto start = clock::now();
    for (const section& s : all_sections()) {
        const auto begin = clock::now();
        recorder answers;
        s.record(answers);
        equal = print_row(s.name.c_str(), answers, s.expected, seconds_since(begin)) && equal;
        if (s.in_all) all.add(answers.hash());
    }
    return print_row("all", all, expected::all, seconds_since(start)) && equal ? 0 : 1;
}

int print_items(const std::string& name) {
    for (const section& s : all_sections())
        if (s.name == name) {
            recorder answers(true);
            s.record(answers);
            return 0;
        }
    std::fprintf(stderr, "errbound_everywhere: no section %s; there are:", name.c_str());
    for (const section& s : all_sections()) std::fprintf(stderr, " '%s'", s.name.c_str());
    std::fprintf(stderr, "\n");
    return 2;
}

}  // namespace
}  // namespace everywhere

int main(int argc, char** argv) {
    if (!errbound::floating_point_environment().sound()) {
        std::fprintf(stderr, "errbound_everywhere: the floating-point environment is not sound\n");
        return 1;
    }
    if (argc == 1) return everywhere::print_hashes();
    if (argc == 3 && std::strcmp(argv[1], "--items") == 0) return everywhere::print_items(argv[2]);
    std::fprintf(stderr, "usage: errbound_everywhere [--items SECTION]\n");
    return 2;
}
