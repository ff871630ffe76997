// `ccd_mpi stress`: what `ccd stress` does, over ranks, each of which takes values of families'
// knobs.
#include "ccd/program/stress_command.hpp"

#include <cstddef>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "ccd/program/mpi/commands.hpp"
#include "errbound/study/options.hpp"
#include "errbound/support/command_line.hpp"

namespace ccd::program {
namespace {

using nlohmann::ordered_json;

ordered_json packed(const stress::cell& c) {
    ordered_json all{c.queries,         c.collisions,   c.false_positives,
                     c.false_negatives, c.uncertain,    c.wrong_certain,
                     c.from_not_finite, c.ns_per_query, nullptr};
    if (c.broken) all[8] = {c.broken->what, c.broken->index, c.broken->collides};
    return all;
}

/// Adds what is counted to a cell.
void unpack(const ordered_json& from, stress::cell& c) {
    std::size_t* const counts[] = {&c.queries,         &c.collisions, &c.false_positives,
                                   &c.false_negatives, &c.uncertain,  &c.wrong_certain,
                                   &c.from_not_finite};
    for (std::size_t i = 0; i < std::size(counts); ++i) *counts[i] = from.at(i).get<std::size_t>();
    c.ns_per_query = from.at(7).get<double>();
    const ordered_json& broken = from.at(8);
    if (!broken.is_null())
        c.broken = {broken.at(0).get<std::string>(), broken.at(1).get<std::uint64_t>(),
                    broken.at(2).get<bool>()};
}

/// A family at one value of its knob.
struct place {
    const stress::family* family;
    double knob;
};

class distributed_stress final : public stress_run {
  public:
    explicit distributed_stress(CLI::App& program) : stress_run(program) {}

    exit_status run() override {
        const stress::plan plan = checked_plan();
        errbound::study::on_root(MPI_COMM_WORLD, [&] {
            require_good_outputs();
            errbound::support::require_good_outputs({out_.json, journal_.path()}, {});
            stress::prepare(out_);
        });
        std::vector<place> places;
        for (const stress::family* f : plan.families)
            for (const double knob : f->knobs) places.push_back({f, knob});
        const auto cells = [&](std::uint64_t i) {
            auto all = ordered_json::array();
            for (const stress::cell& c : stress::run_at(plan, *places[i].family, places[i].knob))
                all.push_back(packed(c));
            return all.dump();
        };
        errbound::study::study study(MPI_COMM_WORLD,
                                     {.program = "ccd_mpi",
                                      .identity = identity_of(plan),
                                      .chunks = places.size(),
                                      .work = {cells}},
                                     journal_.path());
        return run_study(study, stopped, [&](const std::vector<std::string>& results) {
            return stress::write(joined(results, places, plan), plan, out_,
                                 errbound::support::stream_for_people({out_.json}))
                       ? done
                       : broken_promise;
        });
    }

  private:
    static std::string identity_of(const stress::plan& plan) {
        ordered_json all{{"study", "ccd stress"},
                         {"version", ERRBOUND_VERSION},
                         {"seed", plan.seed},
                         {"queries", plan.queries},
                         {"seconds", plan.seconds}};
        for (const stress::family* f : plan.families) all["families"].push_back(f->name);
        for (const stress::subject& s : plan.subjects) all["methods"].push_back(s.name);
        return all.dump();
    }

    static std::vector<stress::cell> joined(const std::vector<std::string>& results,
                                            const std::vector<place>& places,
                                            const stress::plan& plan) {
        std::vector<stress::cell> cells;
        for (std::size_t i = 0; i < places.size(); ++i) {
            const ordered_json all = ordered_json::parse(results[i]);
            std::size_t next = 0;
            for (const kind k : stored_kinds)
                for (std::size_t s = 0; s < plan.subjects.size(); ++s) {
                    stress::cell c;
                    c.family = places[i].family;
                    c.knob = places[i].knob;
                    c.kind = k;
                    c.subject = s;
                    unpack(all.at(next++), c);
                    cells.push_back(std::move(c));
                }
        }
        return cells;
    }

    errbound::study::journal_option journal_{line_};
};

}  // namespace

std::unique_ptr<command> distributed_stress_command(CLI::App& program) {
    return std::make_unique<distributed_stress>(program);
}

}  // namespace ccd::program
