// The families of `ccd stress` are what they say, and the run sees what is wrong.
#include "ccd/stress/stress.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <boost/multiprecision/gmp.hpp>
#include <ccd/exact.hpp>
#include <ccd/io/query_file.hpp>
#include <ccd/methods/forms.hpp>
#include <ccd/methods/transform.hpp>
#include <ccd/reference.hpp>
#include <cmath>
#include <cstdint>
#include <errbound/support/error.hpp>
#include <filesystem>
#include <functional>
#include <iostream>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ccd/exact/features.hpp"
#include "ccd/stress/output.hpp"
#include "errbound/support/output_file.hpp"

namespace {

namespace fs = std::filesystem;
namespace stress = ccd::stress;
using rational = boost::multiprecision::number<boost::multiprecision::gmp_rational,
                                               boost::multiprecision::et_off>;
using ccd::kind;
using stress::points;

constexpr std::uint64_t few = 60;

const stress::family& family_named(std::string_view name) {
    return *std::ranges::find(stress::families(), name, &stress::family::name);
}

bool collides(kind which, const points& p) {
    return ccd::stress::visit_stored_query(which, p, [](const auto& q) {
        return ccd::decide_reference(q).outcome == ccd::outcome::collides;
    });
}

/// test(kind, points) for some queries of both kinds.
template <class Test>
void for_queries(std::string_view family, double knob, const Test& test) {
    for (const kind which : ccd::stored_kinds) {
        for (std::uint64_t i = 0; i < few; ++i)
            test(which, stress::make(family_named(family), knob, which, 5, i));
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
    for (const stress::family& f : stress::families()) {
        EXPECT_TRUE(names.insert(f.name).second) << f.name;
        EXPECT_EQ(f.knob_name.find(','), f.knob_name.npos) << f.name;
        EXPECT_TRUE(f.description.ends_with('.')) << f.name;
        EXPECT_TRUE(std::ranges::is_sorted(f.knobs, std::less_equal{})) << f.name;
        EXPECT_GE(f.knobs.size(), 5u) << f.name;
    }
}

TEST(families, are_finite_where_they_say_so) {
    for (const stress::family& f : stress::families()) {
        for (const double knob : f.knobs) {
            for (const kind which : ccd::stored_kinds) {
                for (std::uint64_t i = 0; i < 5; ++i) {
                    double not_finite = 0;
                    for_coordinates(stress::make(f, knob, which, 2, i),
                                    [&](double x) { not_finite += !std::isfinite(x); });
                    EXPECT_EQ(not_finite, f.finite ? 0 : knob) << f.name << ' ' << knob;
                }
            }
        }
    }
}

/// Where the knob leaves queries on both sides of the decision, both are there.
TEST(families, hold_collisions_and_misses) {
    for (const stress::family& f : stress::families()) {
        if (!f.finite) continue;
        std::size_t hits = 0, all = 0;
        for (const double knob : f.knobs) {
            if (f.thinning(knob) > 1) continue;
            for (const kind which : ccd::stored_kinds) {
                for (std::uint64_t i = 0; i < 6; ++i, ++all)
                    hits += collides(which, stress::make(f, knob, which, 3, i));
            }
        }
        EXPECT_GT(5 * hits, all) << f.name;
        EXPECT_LT(5 * hits, 4 * all) << f.name;
    }
}

/// The same on every machine: the bits of some queries of every cell, as one number.
TEST(families, are_the_same_everywhere) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const stress::family& f : stress::families()) {
        for (const double knob : f.knobs) {
            for (const kind which : ccd::stored_kinds) {
                for_coordinates(stress::make(f, knob, which, 1, 0), [&hash](double x) {
                    hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * 0x100000001b3;
                });
            }
        }
    }
    EXPECT_EQ(hash, 0x5a8d9203d49e5e06u);
    const stress::family& f = family_named("scale");
    EXPECT_NE(stress::make(f, 0, kind::edge_edge, 1, 0), stress::make(f, 0, kind::edge_edge, 2, 0));
    EXPECT_NE(stress::make(f, 0, kind::edge_edge, 1, 0), stress::make(f, 0, kind::edge_edge, 1, 1));
    EXPECT_NE(stress::make(f, 0, kind::edge_edge, 1, 0),
              stress::make(f, 100, kind::edge_edge, 1, 0));
}

TEST(families, scale_is_that_of_the_largest_coordinate) {
    for (const double knob : {-1070., -1022., 0., 1024.}) {
        for_queries("scale", knob, [knob](kind, const points& p) {
            double largest = 0;
            for_coordinates(p, [&](double x) { largest = std::max(largest, std::abs(x)); });
            EXPECT_GE(largest, std::ldexp(0.5, static_cast<int>(knob)));
            EXPECT_LE(largest / 2, std::ldexp(0.5, static_cast<int>(knob)));
        });
    }
}

TEST(families, resting_gaps_stay) {
    for (const double knob : {stress::exact_zero, -50., -20.}) {
        std::size_t hits = 0;
        for_queries("gap-resting", knob, [&](kind which, const points& p) {
            for (const auto& m : p) {
                EXPECT_EQ(m.t1.x - m.t0.x, p[0].t1.x - p[0].t0.x);
                EXPECT_EQ(m.t1.y - m.t0.y, p[0].t1.y - p[0].t0.y);
                EXPECT_EQ(m.t1.z - m.t0.z, p[0].t1.z - p[0].t0.z);
            }
            hits += collides(which, p);
        });
        if (knob == stress::exact_zero) {
            EXPECT_EQ(hits, 2 * few);
        } else {  // inside the border by the gap, in one of three queries
            EXPECT_GT(hits, few / 3);
            EXPECT_LT(hits, few);
        }
    }
}

/// |B × C|² of the triangle, or |B|² of the shorter edge, at the start.
rational thinness(kind which, const points& p) {
    const auto exact = [](const ccd::point<double>& x) {
        return ccd::point<rational>{rational(x.x), rational(x.y), rational(x.z)};
    };
    if (which == kind::vertex_face) {
        const auto n = ccd::forms_of(ccd::transformed_points(
                                         ccd::stress::as_query<ccd::vertex_face<double>>(p), exact))
                           .n;
        return n.x[0] * n.x[0] + n.y[0] * n.y[0] + n.z[0] * n.z[0];
    }
    const auto forms = ccd::forms_of(
        ccd::transformed_points(ccd::stress::as_query<ccd::edge_edge<double>>(p), exact));
    return std::min(dot(forms.b, forms.b)[0], dot(forms.c, forms.c)[0]);
}

TEST(families, slivers_are_as_thin_as_they_say) {
    for (const double knob : {stress::exact_zero, -60., -30.}) {
        std::size_t thin = 0;
        for_queries("sliver", knob, [&](kind which, const points& p) {
            const rational twice_knob = thinness(which, p);
            if (knob == stress::exact_zero) {
                thin += twice_knob == 0;
            } else {
                const double height = std::sqrt(static_cast<double>(twice_knob));
                thin += height >= std::ldexp(1, static_cast<int>(knob) - 2) &&
                        height <= std::ldexp(1, static_cast<int>(knob));
            }
        });
        EXPECT_GT(3 * thin, 2 * few) << knob;  // the others are in general position
    }
}

TEST(families, touches_are_where_they_say) {
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
        EXPECT_TRUE(ccd::stress::visit_stored_query(which, p, touches_at_start));
    });
    for_queries("touch-start", 1, [&](kind which, const points& p) {
        EXPECT_FALSE(ccd::stress::visit_stored_query(which, p, touches_at_start));
    });
    for_queries("touch-end", 0, [&](kind which, points p) {
        for (auto& m : p) std::swap(m.t0, m.t1);
        EXPECT_TRUE(ccd::stress::visit_stored_query(which, p, touches_at_start));
    });
}

TEST(families, touches_on_borders_are_there) {
    const auto edge_contact = [](const auto& query) {
        return std::ranges::any_of(ccd::vertex_edge_queries(query), [](const auto& q) {
            return ccd::decide_reference(q).outcome == ccd::outcome::collides;
        });
    };
    const auto vertex_contact = [](const points& p, std::size_t i, std::size_t j) {
        return ccd::decide_reference(ccd::vertex_vertex<double>{p[i], p[j]}).outcome ==
               ccd::outcome::collides;
    };
    for (const double knob : {0., 1.}) {
        for_queries("touch-edge", knob, [&](kind which, const points& p) {
            EXPECT_EQ(ccd::stress::visit_stored_query(which, p, edge_contact), knob == 0);
        });
        for_queries("touch-vertex", knob, [&](kind which, const points& p) {
            bool touch = false;
            for (const std::size_t i : {0, 1})
                for (const std::size_t j : {1, 2, 3})
                    if (which == kind::vertex_face ? i == 0 : j >= 2)
                        touch = touch || vertex_contact(p, i, j);
            EXPECT_EQ(touch, knob == 0);
        });
    }
}

/// The exact value of the coplanarity function.
rational coplanarity(kind which, const points& p, const rational& t) {
    const auto exact = [](const ccd::point<double>& x) {
        return ccd::point<rational>{rational(x.x), rational(x.y), rational(x.z)};
    };
    return ccd::stress::visit_stored_query(which, p, [&](const auto& q) -> rational {
        return value_at(ccd::forms_of(ccd::transformed_points(q, exact)).y(), t);
    });
}

TEST(families, roots_are_as_far_apart_as_they_say) {
    const rational tiny(1, 1 << 20);
    for (const double knob : {stress::exact_zero, -60., -4.}) {
        const rational apart =
            knob == stress::exact_zero ? 0 : std::ldexp(1, static_cast<int>(knob));
        std::size_t two = 0, none = 0, three = 0;
        const auto at_an_eighth = [](const auto& test) {
            return std::ranges::any_of(std::array{1, 2, 3, 4, 5, 6, 7},
                                       [&](int i) { return test(rational(i, 8)); });
        };
        for_queries("double-root", knob, [&](kind which, const points& p) {
            const auto y = [&](const rational& t) { return coplanarity(which, p, t); };
            two += at_an_eighth([&](const rational& r) {
                return y(r - apart / 2) == 0 && y(r + apart / 2) == 0 && y(r - tiny) != 0 &&
                       (y(r - apart) > 0) == (y(r + apart) > 0);
            });
            // |y| is least at r, and not zero.
            none += at_an_eighth([&](const rational& r) {
                return y(r) * y(r + 1) > 0 && y(r + tiny) == y(r - tiny) &&
                       abs(y(r)) < abs(y(r + tiny));
            });
        });
        for_queries("triple-root", knob, [&](kind which, const points& p) {
            const auto y = [&](const rational& t) { return coplanarity(which, p, t); };
            three += at_an_eighth([&](const rational& r) {
                return y(r) == 0 && y(r - apart) == 0 && y(r + apart) == 0 &&
                       y(r - 1) * y(r + 1) < 0 && y(r + tiny) == -y(r - tiny);
            });
        });
        EXPECT_GT(10 * three, 8 * few) << knob;
        EXPECT_GT(10 * two, 4 * few) << knob;
        if (knob == stress::exact_zero) {
            EXPECT_EQ(none, 0u);
        } else {
            EXPECT_GT(10 * none, 4 * few) << knob;
        }
    }
}

// ---- The run ----

/// A method that gives one answer to all.
stress::subject always(ccd::verdict said, bool may_lose, bool may_report) {
    const auto decide = [said](auto queries, std::span<ccd::verdict> verdicts) {
        std::fill_n(verdicts.begin(), queries.size(), said);
    };
    return {"always", may_lose, may_report, decide, decide};
}

constexpr ccd::verdict separate{ccd::outcome::separate, ccd::cause::none};
constexpr ccd::verdict hit{ccd::outcome::collides, ccd::cause::none};
constexpr ccd::verdict unsure{ccd::outcome::uncertain, ccd::cause::inside};
constexpr ccd::verdict out_of_range{ccd::outcome::uncertain, ccd::cause::range};

TEST(promises, are_broken_by_what_contradicts_them) {
    const auto broken = [](ccd::verdict said, ccd::outcome truth, bool may_lose, bool may_report) {
        return stress::broken_by(always(said, may_lose, may_report), said, truth).has_value();
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

stress::plan plan_of(std::vector<std::string_view> families,
                     std::vector<stress::subject> subjects) {
    stress::plan plan{.families = {}, .subjects = std::move(subjects), .seed = 4, .queries = 20};
    for (const auto name : families) plan.families.push_back(&family_named(name));
    return plan;
}

std::vector<stress::cell> run(const stress::plan& plan) {
    return stress::run(plan, [](std::size_t, std::size_t, const stress::family&) {});
}

TEST(stress_run, counts_what_a_wrong_method_says) {
    const auto cells = run(plan_of(
        {"touch-start", "not-finite"},
        {always(separate, false, true), always(hit, true, false), always(unsure, false, true)}));
    std::size_t expected = 0;
    for (const auto* name : {"touch-start", "not-finite"})
        expected += family_named(name).knobs.size() * 2 * 3;
    ASSERT_EQ(cells.size(), expected);
    for (const stress::cell& c : cells) {
        EXPECT_EQ(c.queries, 20u);
        if (!c.family->finite) {
            EXPECT_EQ(c.collisions + c.false_positives + c.false_negatives, 0u);
            EXPECT_EQ(c.from_not_finite, c.subject == 2 ? 0u : 20u);
            EXPECT_TRUE(c.broken);
            continue;
        }
        const std::size_t touching = c.knob >= 0 ? 20 : 0, apart = 20 - touching;
        EXPECT_EQ(c.collisions, touching);
        EXPECT_EQ(c.false_negatives, c.subject == 0 ? touching : 0);
        EXPECT_EQ(c.false_positives, c.subject == 0 ? 0 : apart);
        EXPECT_EQ(c.uncertain, c.subject == 2 ? 20u : 0u);
        EXPECT_EQ(c.wrong_certain, c.subject == 0 ? touching : c.subject == 1 ? apart : 0);
        EXPECT_EQ(c.broken.has_value(), c.wrong_certain > 0);
    }
}

TEST(stress_run, no_promise_is_broken) {
    stress::plan plan;
    for (const stress::family& f : stress::families()) plan.families.push_back(&f);
    for (const ccd::method_info& m : ccd::methods()) plan.subjects.push_back(stress::subject_of(m));
    plan.queries = 3;
    std::size_t collisions = 0, by_float = 0;
    for (const stress::cell& c : run(plan)) {
        EXPECT_FALSE(c.broken) << plan.subjects[c.subject].name << ": " << c.broken->what << ", "
                               << c.family->name << ' ' << c.knob << ' ' << c.broken->index;
        collisions += c.collisions;
        if (plan.subjects[c.subject].name == "float") by_float += c.wrong_certain;
    }
    EXPECT_GT(collisions, 0u);
    EXPECT_GT(by_float, 0u);  // so hard are they
}

// ---- What is printed and written ----

class stress_output : public testing::Test {
  protected:
    ~stress_output() override { fs::remove_all(folder); }

    const fs::path folder =
        fs::temp_directory_path() / ("errbound_stress_test." + std::to_string(getpid()));
    std::ostringstream printed;
};

TEST_F(stress_output, names_and_keeps_what_breaks_a_promise) {
    const stress::plan plan =
        plan_of({"touch-end", "not-finite"},
                {always(separate, false, true), stress::subject_of(ccd::methods().back())});
    EXPECT_FALSE(run_and_write(plan, {folder, folder / "cells.json"}, printed));
    const std::string text = printed.str();
    EXPECT_NE(text.find("broken by always: it lost a collision; family touch-end, knob 0, vf"),
              text.npos)
        << text;
    EXPECT_NE(text.find("broken by always: it answered for coordinates that are not finite"),
              text.npos);
    EXPECT_EQ(text.find("broken by " + plan.subjects[1].name), text.npos);
    EXPECT_TRUE(text.ends_with(": BROKEN, as said above\n"));

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
    EXPECT_NE(errbound::support::read_whole(folder / "stress.md").find("broken by always"),
              csv.npos);
}

TEST_F(stress_output, a_folder_that_cannot_be_made_is_refused_at_once) {
    fs::create_directories(folder);
    errbound::support::write_whole(folder / "file", "");
    EXPECT_THROW(run_and_write(plan_of({"touch-end"}, {}), {folder / "file", {}}, printed),
                 errbound::support::file_error);
    EXPECT_EQ(printed.str(), "");
}

}  // namespace
