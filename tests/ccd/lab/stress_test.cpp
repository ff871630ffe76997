// The families of `ccd stress` have their promised properties, and the run finds wrong answers.
#include "ccd/lab/stress.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <ccd/exact.hpp>
#include <ccd/io/query_file.hpp>
#include <ccd/reference.hpp>
#include <cmath>
#include <cstdint>
#include <errbound/support/error.hpp>
#include <filesystem>
#include <functional>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "errbound/support/output_file.hpp"
#include "tests/support/files.hpp"

namespace {

namespace fs = std::filesystem;
namespace lab = ccd::lab;
using ccd::kind;
using lab::points;

constexpr std::uint64_t few = 60;

const lab::family& family_named(std::string_view name) {
    return *std::ranges::find(lab::families(), name, &lab::family::name);
}

bool collides(kind which, const points& p) {
    return lab::visit_stored_query(which, p, [](const auto& q) {
        return ccd::decide_reference(q).outcome == ccd::outcome::collides;
    });
}

template <class Test>
void for_queries(std::string_view family, double knob, const Test& test) {
    for (const kind which : ccd::stored_kinds) {
        for (std::uint64_t i = 0; i < few; ++i)
            test(which, lab::make(family_named(family), knob, which, 5, i));
    }
}

template <class Visit>
void for_coordinates(const points& p, const Visit& visit) {
    for (const auto& m : p) {
        for (const auto& at : {m.t0, m.t1}) {
            for (const double x : {at.x, at.y, at.z}) visit(x);
        }
    }
}

TEST(families, are_well_formed) {
    std::set<std::string_view> names;
    for (const lab::family& f : lab::families()) {
        EXPECT_TRUE(names.insert(f.name).second) << f.name;
        EXPECT_EQ(f.knob_name.find(','), f.knob_name.npos) << f.name;
        EXPECT_TRUE(f.description.ends_with('.')) << f.name;
        EXPECT_TRUE(std::ranges::is_sorted(f.knobs, std::less_equal{})) << f.name;
        EXPECT_GE(f.knobs.size(), 5u) << f.name;
    }
}

/// If the knob leaves queries on both sides of the decision, the family has both.
TEST(families, hold_collisions_and_misses) {
    for (const lab::family& f : lab::families()) {
        if (!f.finite) continue;
        std::size_t hits = 0, all = 0;
        for (const double knob : f.knobs) {
            if (f.thinning(knob) > 1) continue;
            for (const kind which : ccd::stored_kinds) {
                for (std::uint64_t i = 0; i < 6; ++i, ++all)
                    hits += collides(which, lab::make(f, knob, which, 3, i));
            }
        }
        EXPECT_GT(5 * hits, all) << f.name;
        EXPECT_LT(5 * hits, 4 * all) << f.name;
    }
}

/// The bits of some queries of every cell, as one number: they do not depend on the machine, and
/// have not changed since their properties were checked.
TEST(families, are_the_same_everywhere) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const lab::family& f : lab::families()) {
        for (const double knob : f.knobs) {
            for (const kind which : ccd::stored_kinds) {
                for_coordinates(lab::make(f, knob, which, 1, 0), [&hash](double x) {
                    hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * 0x100000001b3;
                });
            }
        }
    }
    EXPECT_EQ(hash, 0x5a8d9203d49e5e06u);
    const lab::family& f = family_named("scale");
    EXPECT_NE(lab::make(f, 0, kind::edge_edge, 1, 0), lab::make(f, 0, kind::edge_edge, 2, 0));
    EXPECT_NE(lab::make(f, 0, kind::edge_edge, 1, 0), lab::make(f, 0, kind::edge_edge, 1, 1));
    EXPECT_NE(lab::make(f, 0, kind::edge_edge, 1, 0), lab::make(f, 100, kind::edge_edge, 1, 0));
}

TEST(families, touch_at_their_declared_times) {
    for (const double knob : {-21., -1., 0., 1., 21.}) {
        for (const auto* family : {"touch-start", "touch-end", "touch-edge", "touch-vertex"})
            for_queries(family, knob, [&](kind which, const points& p) {
                EXPECT_EQ(collides(which, p), knob >= 0) << family << ' ' << knob;
            });
    }
    const auto touches_at_start = [](const auto& q) {
        return ccd::touches_at_start(q).outcome == ccd::outcome::collides;
    };
    for_queries("touch-start", 0, [&](kind which, const points& p) {
        EXPECT_TRUE(lab::visit_stored_query(which, p, touches_at_start));
    });
    for_queries("touch-start", 1, [&](kind which, const points& p) {
        EXPECT_FALSE(lab::visit_stored_query(which, p, touches_at_start));
    });
    for_queries("touch-end", 0, [&](kind which, points p) {
        for (auto& m : p) std::swap(m.t0, m.t1);
        EXPECT_TRUE(lab::visit_stored_query(which, p, touches_at_start));
    });
}

// ---- The run ----

lab::subject always(ccd::verdict said, bool may_lose, bool may_report) {
    const auto decide = [said](auto queries, std::span<ccd::verdict> verdicts) {
        std::fill_n(verdicts.begin(), queries.size(), said);
    };
    return {"always", may_lose, may_report, {decide, decide}};
}

constexpr ccd::verdict separate{ccd::outcome::separate, ccd::cause::none};
constexpr ccd::verdict hit{ccd::outcome::collides, ccd::cause::none};
constexpr ccd::verdict unsure{ccd::outcome::uncertain, ccd::cause::inside};
constexpr ccd::verdict out_of_range{ccd::outcome::uncertain, ccd::cause::range};

TEST(promises, are_broken_by_contradicting_answers) {
    const auto broken = [](ccd::verdict said, ccd::outcome truth, bool may_lose, bool may_report) {
        return lab::broken_by(always(said, may_lose, may_report), said, truth).has_value();
    };
    constexpr auto apart = ccd::outcome::separate, contact = ccd::outcome::collides,
                   no_truth = ccd::outcome::uncertain;
    for (const bool may_lose : {false, true}) {
        for (const bool may_report : {false, true}) {
            EXPECT_EQ(broken(separate, contact, may_lose, may_report), !may_lose);
            EXPECT_EQ(broken(unsure, apart, may_lose, may_report), !may_report);
            EXPECT_EQ(broken(hit, apart, may_lose, may_report), !(may_lose && may_report));
            EXPECT_EQ(broken(unsure, contact, may_lose, may_report), !may_lose && !may_report);
            EXPECT_FALSE(broken(separate, apart, may_lose, may_report));
            EXPECT_FALSE(broken(hit, contact, may_lose, may_report));
            for (const ccd::verdict said : {separate, hit, unsure})
                EXPECT_TRUE(broken(said, no_truth, may_lose, may_report));
            EXPECT_FALSE(broken(out_of_range, no_truth, may_lose, may_report));
        }
    }
}

lab::plan plan_of(std::vector<std::string_view> families, std::vector<lab::subject> subjects) {
    lab::plan plan{.families = {}, .subjects = std::move(subjects), .seed = 4, .queries = 20};
    for (const auto name : families) plan.families.push_back(&family_named(name));
    return plan;
}

std::vector<lab::cell> run(const lab::plan& plan) {
    return lab::run(plan, [](std::size_t, std::size_t, const lab::family&) {});
}

TEST(stress_run, counts_the_answers_of_a_wrong_method) {
    const auto cells = run(plan_of(
        {"touch-start", "not-finite"},
        {always(separate, false, true), always(hit, true, false), always(unsure, false, true)}));
    std::size_t expected = 0;
    for (const auto* name : {"touch-start", "not-finite"})
        expected += family_named(name).knobs.size() * 2 * 3;
    ASSERT_EQ(cells.size(), expected);
    for (const lab::cell& c : cells) {
        EXPECT_EQ(c.queries, 20u);
        if (!c.family->finite) {
            EXPECT_EQ(c.finite.queries, 0u);
            EXPECT_EQ(c.from_not_finite, c.subject == 2 ? 0u : 20u);
            EXPECT_TRUE(c.broken);
            continue;
        }
        const std::size_t touching = c.knob >= 0 ? 20 : 0, apart = 20 - touching;
        EXPECT_EQ(c.finite.colliding, touching);
        EXPECT_EQ(c.finite.false_negatives, c.subject == 0 ? touching : 0);
        EXPECT_EQ(c.finite.false_positives, c.subject == 0 ? 0 : apart);
        EXPECT_EQ(c.uncertain, c.subject == 2 ? 20u : 0u);
        EXPECT_EQ(c.wrong_certain, c.subject == 0 ? touching : c.subject == 1 ? apart : 0);
        EXPECT_EQ(c.broken.has_value(), c.wrong_certain > 0);
    }
}

TEST(stress_run, no_promise_is_broken) {
    lab::plan plan;
    for (const lab::family& f : lab::families()) plan.families.push_back(&f);
    for (const ccd::method_info& m : ccd::methods())
        plan.subjects.push_back(lab::subject_named(m.name));
    plan.subjects.push_back(lab::subject_named(lab::batch_name));
    plan.queries = 3;
    std::size_t collisions = 0, by_float = 0;
    for (const lab::cell& c : run(plan)) {
        EXPECT_FALSE(c.broken) << plan.subjects[c.subject].name << ": " << c.broken->clause << ", "
                               << c.family->name << ' ' << c.knob << ' ' << c.broken->index;
        collisions += c.finite.colliding;
        if (plan.subjects[c.subject].name == "float") by_float += c.wrong_certain;
    }
    EXPECT_GT(collisions, 0u);
    EXPECT_GT(by_float, 0u);  // because they are so hard
}

// ---- Output ----

class stress_output : public testing::Test {
  protected:
    const test_files::temporary_directory directory;
    const fs::path folder = directory.path / "made";
    std::ostringstream printed;
};

TEST_F(stress_output, prints_and_stores_queries_that_break_a_promise) {
    const lab::plan plan =
        plan_of({"touch-end", "not-finite"},
                {always(separate, false, true), lab::subject_named(ccd::methods().back().name)});
    EXPECT_FALSE(run_and_write(plan, {folder, folder / "cells.json"}, printed));
    const std::string text = printed.str();
    EXPECT_NE(text.find("broken by always: it lost a collision; family touch-end, knob 0, vf"),
              text.npos)
        << text;
    EXPECT_NE(text.find("broken by always: it answered for coordinates that are not finite"),
              text.npos);
    EXPECT_EQ(text.find("broken by " + plan.subjects[1].name), text.npos);
    EXPECT_TRUE(text.ends_with(": BROKEN, see above\n"));

    const auto kept = ccd::io::read_queries(folder / "stress-always-touch-end-vf.csv", {}, false);
    const auto& queries = std::get<std::vector<ccd::vertex_face<double>>>(kept.queries);
    ASSERT_EQ(queries.size(), 1u);
    EXPECT_EQ(ccd::decide_reference(queries[0]).outcome, ccd::outcome::collides);
    EXPECT_EQ(kept.truth, std::vector<bool>{true});

    const std::string csv = errbound::support::read_whole(folder / "stress.csv");
    EXPECT_TRUE(csv.starts_with(
        "family,knob_name,knob,kind,method,queries,collisions,false_positives,false_negatives,"
        "uncertain,ns_per_query\n"
        "touch-end,ulps inside: sign(k) 2^(abs(k)-1),-21,vf,always,20,0,0,0,0,"))
        << csv;
}

TEST_F(stress_output, a_folder_that_cannot_be_made_is_refused_at_once) {
    errbound::support::write_whole(directory.path / "file", "");
    EXPECT_THROW(run_and_write(plan_of({"touch-end"}, {}), {directory.path / "file", {}}, printed),
                 errbound::support::file_error);
    EXPECT_EQ(printed.str(), "");
}

}  // namespace
