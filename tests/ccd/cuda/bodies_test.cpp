// Device code on the host: loops run kernel bodies, queues and indices (ccd/cuda/launch.hpp).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <ccd/exact.hpp>
#include <ccd/io/mesh_file.hpp>
#include <ccd/method.hpp>
#include <ccd/methods/bsc.hpp>
#include <ccd/methods/single_precision.hpp>
#include <ccd/methods/transform.hpp>
#include <ccd/step.hpp>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iostream>
#include <limits>
#include <random>
#include <type_traits>
#include <utility>
#include <vector>

#include "ccd/cuda/exact_stages.hpp"
#include "ccd/cuda/pairs.hpp"
#include "ccd/cuda/step.hpp"
#include "ccd/step/elements.hpp"
#include "tests/ccd/cuda/on_host.hpp"
#include "tests/ccd/cuda/sets.hpp"
#include "tests/ccd/step/expect_steps.hpp"
#include "tests/support/scaled.hpp"

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace {

namespace fs = std::filesystem;
using ccd::outcome;
using ccd::cuda::candidates;
using ccd::cuda::coordinates;
using ccd::cuda::positions;
using ccd::cuda::precision;
using ccd::cuda::detail::host_launcher;
using cuda_on_host::decide_by;
using cuda_on_host::laid_out;
using cuda_sets::batch;
using cuda_sets::positions_of;

template <class Pair>
std::vector<outcome> decide_exact(const positions& at, const candidates<Pair>& all,
                                  precision p = precision::float64,
                                  ccd::cuda::detail::exact_counters* counters = nullptr) {
    host_launcher launcher;
    // Results must not depend on old contents.
    std::vector<outcome> answers(all.count, outcome::collides);
    const laid_out<ccd::cuda::detail::exact_memory> memory(at.vertices, all.count);
    run_rounding(launcher, at, memory->scene, memory->rows);
    run_exact_stages(launcher, at, all, answers.data(), *memory, p);
    // Candidates left to the host must not be `separate` before it decides them.
    for (std::uint32_t k = 0; k < memory->counters->left; ++k)
        EXPECT_EQ(answers[memory->left[k]], outcome::uncertain);
    const auto counted = finish_exact(launcher, at, all, answers.data(), *memory);
    if (counters != nullptr) *counters = counted;
    return answers;
}

std::uint64_t queries_per_family() {
    // With fewer, some stage would have no candidate.
    return std::max(100u, support::scaled(200u));
}

template <class Pair>
const batch<Pair>& difficult() {
    static const auto set = cuda_sets::of_families<Pair>(queries_per_family(), 11);
    return set;
}

template <class Pair>
class device_bodies : public testing::Test {};
using kinds = testing::Types<ccd::vertex_face_pair, ccd::edge_edge_pair>;
TYPED_TEST_SUITE(device_bodies, kinds);

using entered = std::array<std::size_t, 7>;

template <class Pair>
entered expect_exact(const batch<Pair>& set, const std::vector<outcome>& truth, precision p) {
    ccd::cuda::detail::exact_counters c{};
    const auto answers = decide_exact(set.positions(), set.candidates(), p, &c);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < set.size(); ++i) wrong += answers[i] != truth[i];
    EXPECT_EQ(wrong, 0u);
    return {set.size(), c.coplanarity, c.inside, c.subdivision, c.one_word, c.two_words, c.left};
}
template <class Pair>
std::vector<outcome> truth_of(const batch<Pair>& set) {
    std::vector<outcome> truth;
    for (const auto& q : set.queries) truth.push_back(ccd::decide_exact(q).outcome);
    return truth;
}
/// Otherwise a missing stage would go unnoticed, since the next ones would decide its queries.
void expect_every_stage_to_settle_some(const entered& stages) {
    const char* const names[] = {"axes",        "coplanarity",      "inside",
                                 "subdivision", "integers, 1 word", "integers, 2 words"};
    for (std::size_t i = 0; i + 1 < stages.size(); ++i) {
        std::cout << names[i] << ' ' << stages[i] << ", ";
        EXPECT_LT(stages[i + 1], stages[i]) << names[i];
    }
    std::cout << "host " << stages.back() << '\n';
}

TYPED_TEST(device_bodies, exact_is_exact) {
    const auto& set = difficult<TypeParam>();
    const auto truth = truth_of(set);
    expect_every_stage_to_settle_some(expect_exact(set, truth, precision::float64));
    // All families are in one scene. In its units, floats decide almost nothing.
    expect_exact(set, truth, precision::float32);
}

// Each family is a separate scene with its own scale, where floats decide some queries.
TYPED_TEST(device_bodies, exact_is_exact_in_scenes_of_one_scale) {
    for (const precision p : {precision::float64, precision::float32}) {
        entered all{};
        for (const auto& family : query_families::families) {
            SCOPED_TRACE(family.name);
            const auto set = cuda_sets::of_family<TypeParam>(family, queries_per_family(), 12);
            const auto stages = expect_exact(set, truth_of(set), p);
            std::ranges::transform(all, stages, all.begin(), std::plus<>());
        }
        expect_every_stage_to_settle_some(all);
    }
}

TYPED_TEST(device_bodies, exact_is_exact_on_stored_queries) {
    if (!fs::is_directory(stored_data::folder())) GTEST_SKIP() << stored_data::missing;
    const auto set = cuda_sets::stored<TypeParam>(stored_data::folder());
    const auto truth = truth_of(set);
    for (const precision p : {precision::float64, precision::float32})
        expect_every_stage_to_settle_some(expect_exact(set, truth, p));
}

template <class Rule, class Query>
ccd::verdict in_single_precision(ccd::cuda::detail::bsc_method<Rule>, const Query& query) {
    return ccd::decide_bsc_in_single_precision<Rule>(query);
}
template <class Rule, class Query>
ccd::verdict in_single_precision(ccd::cuda::detail::safeccd_method<Rule>, const Query& query) {
    return ccd::decide_safeccd_in_single_precision<Rule>(query);
}

/// In doubles the answers are those of decide(). In floats they are those of floats if these are
/// certain (and then correct), otherwise those of doubles.
template <class Method, class Pair>
void expect_as_on_host(const batch<Pair>& set, ccd::method m) {
    constexpr bool promises = !std::is_same_v<typename Method::rule, errbound::none>;
    const auto at = set.positions();
    const auto all = set.candidates();
    std::size_t decided_in_doubles = 0, uncertain = 0;
    const auto in_doubles = decide_by<Method, double>(at, all);
    const auto in_floats = decide_by<Method, float>(at, all, &decided_in_doubles);
    for (std::size_t i = 0; i < set.size(); ++i) {
        SCOPED_TRACE(i);
        ASSERT_EQ(in_doubles[i], ccd::decide(m, set.queries[i]).outcome);
        const outcome floats_say = in_single_precision(Method(), set.queries[i]).outcome;
        if (!promises) {
            ASSERT_EQ(in_floats[i], floats_say);
        } else if (floats_say == outcome::uncertain) {
            ++uncertain;
            ASSERT_EQ(in_floats[i], in_doubles[i]);
        } else {
            ASSERT_EQ(in_floats[i], floats_say);
            ASSERT_EQ(floats_say, ccd::decide_exact(set.queries[i]).outcome);
        }
    }
    EXPECT_EQ(decided_in_doubles, uncertain);
    EXPECT_LT(uncertain, set.size());
}

template <class Pair>
void expect_methods_as_on_host(const batch<Pair>& set) {
    cuda_on_host::for_each_float_method([&]<class Method>(ccd::method m) {
        SCOPED_TRACE(info(m).name);
        expect_as_on_host<Method>(set, m);
    });
}

TYPED_TEST(device_bodies, methods_decide_as_on_the_host) {
    expect_methods_as_on_host(difficult<TypeParam>());
}

TYPED_TEST(device_bodies, methods_decide_stored_queries_as_on_the_host) {
    if (!fs::is_directory(stored_data::folder())) GTEST_SKIP() << stored_data::missing;
    expect_methods_as_on_host(cuda_sets::stored<TypeParam>(stored_data::folder()));
}

TYPED_TEST(device_bodies, coordinates_that_are_not_finite_are_uncertain) {
    auto set = cuda_sets::of_families<TypeParam>(20, 5);
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const double poisons[] = {infinity, -infinity, std::numeric_limits<double>::quiet_NaN()};
    const auto poisoned = [](std::size_t i) { return i % 7 == 0; };
    for (std::size_t i = 0; i < set.size(); ++i) {
        if (!poisoned(i)) continue;
        const std::size_t number = i / 7 % 24;
        auto& p = (number < 12 ? set.before : set.after)[4 * i + number % 4];
        (number % 3 == 0 ? p.x : number % 3 == 1 ? p.y : p.z) = poisons[i % 3];
    }
    const auto answers = decide_exact(set.positions(), set.candidates());
    EXPECT_EQ(answers, decide_exact(set.positions(), set.candidates(), precision::float32));
    const auto tight = decide_by<ccd::cuda::detail::bsc_method<errbound::tight>, float>(
        set.positions(), set.candidates());
    for (std::size_t i = 0; i < set.size(); ++i) {
        if (poisoned(i)) {
            EXPECT_EQ(answers[i], outcome::uncertain) << i;
            EXPECT_EQ(tight[i], outcome::uncertain) << i;
        } else {
            EXPECT_EQ(answers[i], ccd::decide_exact(set.queries[i]).outcome) << i;
        }
    }
}

/// Vertices with coordinates that floats represent, in every form that device code accepts.
struct grid_positions {
    static constexpr std::size_t vertices = 50;
    std::vector<double> rows[2];
    std::vector<float> float_rows[2], columns[2][3];

    explicit grid_positions(std::mt19937& random) {
        for (std::size_t frame = 0; frame < 2; ++frame)
            for (std::size_t v = 0; v < vertices; ++v)
                for (std::size_t k = 0; k < 3; ++k) {
                    const auto x = static_cast<float>(static_cast<int>(random() % 17) - 8);
                    rows[frame].push_back(x);
                    float_rows[frame].push_back(x);
                    columns[frame][k].push_back(x);
                }
    }
    positions in_doubles() const {
        return positions_of({rows[0].data(), rows[1].data(), vertices});
    }
    positions in_floats() const {
        return {coordinates<float>::rows(float_rows[0].data()),
                coordinates<float>::rows(float_rows[1].data()), vertices};
    }
    positions in_columns() const {
        const auto of = [](const std::vector<float>(&axes)[3]) {
            return coordinates<float>{axes[0].data(), axes[1].data(), axes[2].data(), 1};
        };
        return {of(columns[0]), of(columns[1]), vertices};
    }
};

/// Pairs of vertices, in every form that device code accepts.
template <class Pair>
struct named_pairs {
    using all = candidates<Pair>;
    std::vector<typename all::element> elements{40};
    std::vector<ccd::vertex_index> first, second, column[4];
    std::vector<Pair> named;

    named_pairs(std::mt19937& random, std::size_t vertices, std::size_t count) {
        const auto below = [&](std::size_t n) {
            return static_cast<ccd::vertex_index>(random() % n);
        };
        for (auto& e : elements)
            for (ccd::vertex_index& v : e) v = below(vertices);
        for (std::size_t i = 0; i < count; ++i) {
            first.push_back(below(batch<Pair>::of_faces ? vertices : elements.size()));
            second.push_back(below(elements.size()));
            const auto& b = elements[second[i]];
            if constexpr (batch<Pair>::of_faces)
                named.push_back({first[i], b[0], b[1], b[2]});
            else
                named.push_back({elements[first[i]][0], elements[first[i]][1], b[0], b[1]});
            for (std::size_t k = 0; k < 4; ++k) column[k].push_back(vertices_of(named[i])[k]);
        }
    }
    all by_rows() const { return all::rows(named.data(), named.size()); }
    all by_columns() const {
        return all::of_columns(column[0].data(), column[1].data(), column[2].data(),
                               column[3].data(), named.size());
    }
    all by_elements() const {
        return all::pairs(first.data(), second.data(), elements.data(), named.size());
    }
};

// The type of coordinates, the form of indices and the memory layout make no difference.
TYPED_TEST(device_bodies, every_form_of_input_gives_the_same_answers) {
    std::mt19937 random(3);
    const grid_positions at(random);
    const named_pairs<TypeParam> pairs(random, grid_positions::vertices, 2000);
    const auto expected = decide_exact(at.in_doubles(), pairs.by_rows());
    for (std::size_t i = 0; i < pairs.named.size(); ++i) {
        const auto query = ccd::cuda::detail::query_at<double>(at.in_doubles(), pairs.named[i]);
        ASSERT_EQ(expected[i], ccd::decide_exact(query).outcome);
    }
    EXPECT_GT(std::ranges::count(expected, outcome::collides), 100);
    EXPECT_EQ(decide_exact(at.in_doubles(), pairs.by_columns()), expected);
    EXPECT_EQ(decide_exact(at.in_doubles(), pairs.by_elements()), expected);
    EXPECT_EQ(decide_exact(at.in_floats(), pairs.by_rows()), expected);
    EXPECT_EQ(decide_exact(at.in_columns(), pairs.by_elements()), expected);
    EXPECT_EQ(decide_exact(at.in_columns(), pairs.by_columns(), precision::float32), expected);
}

// Differences of floats leave other queries undecided than rounded differences of doubles.
TYPED_TEST(device_bodies, float_methods_take_positions_in_floats_as_they_are) {
    using tight = ccd::cuda::detail::bsc_method<errbound::tight>;
    const auto to_float = [](double x) { return static_cast<float>(std::clamp(x, -3e38, 3e38)); };
    batch<TypeParam> set;
    for (const auto& q : difficult<TypeParam>().queries)
        set.add(transformed(q, [&](double x) { return double{to_float(x)}; }));
    const auto narrowed = [&](const std::vector<ccd::point<double>>& points) {
        std::vector<float> numbers;
        for (const auto& p : points)
            for (const double x : {p.x, p.y, p.z}) numbers.push_back(to_float(x));
        return numbers;
    };
    const std::vector<float> before = narrowed(set.before), after = narrowed(set.after);
    const positions at(coordinates<float>::rows(before.data()),
                       coordinates<float>::rows(after.data()), set.before.size());
    std::size_t decided_in_doubles = 0, uncertain = 0;
    const auto found = decide_by<tight, float>(at, set.candidates(), &decided_in_doubles);
    for (std::size_t i = 0; i < set.size(); ++i) {
        const auto& query = set.queries[i];
        const outcome floats_say =
            ccd::decide_bsc<errbound::tight>(transformed(query, to_float)).outcome;
        const bool open = floats_say == outcome::uncertain;
        uncertain += open;
        ASSERT_EQ(found[i], open ? ccd::decide(ccd::method::tight, query).outcome : floats_say);
    }
    EXPECT_EQ(decided_in_doubles, uncertain);
}

#if defined(__SSE2__)
// Device code is compiled with -ftz=false, since flushing sets both a product and its bound to
// zero.
TEST(device_flags, flushing_subnormals_would_make_a_certain_sign_wrong) {
    const auto sign_of_square = [] {
        const volatile float tiny = 1e-30f;  // volatile: the compiler must not evaluate it
        const errbound::tracked<float> x(float{tiny});
        return sign_of(x * x);
    };
    EXPECT_EQ(sign_of_square(), errbound::sign_type::uncertain);
    constexpr unsigned flush_results_and_operands = 0x8040;
    const unsigned mode = _mm_getcsr();
    _mm_setcsr(mode | flush_results_and_operands);
    const auto flushed = sign_of_square();
    const bool flushes = !errbound::floating_point_environment().gradual_underflow;
    _mm_setcsr(mode);
    if (!flushes) GTEST_SKIP() << "subnormals cannot be flushed here: valgrind does not";
    EXPECT_EQ(flushed, errbound::sign_type::zero);
}
#endif

TEST(device_select, lists_what_may_collide_and_never_drops_one_silently) {
    const std::size_t n = 1000;
    std::vector<outcome> answers(n, outcome::separate);
    for (std::size_t i = 0; i < n; i += 3)
        answers[i] = i % 2 == 0 ? outcome::collides : outcome::uncertain;
    const std::size_t expected = (n + 2) / 3;
    host_launcher launcher;
    for (const std::size_t room : {n, expected, expected - 1, std::size_t(1), std::size_t(0)}) {
        std::vector<ccd::vertex_index> found(room + 1, 12345);
        std::vector<std::uint32_t> place(n + 1);
        ccd::vertex_index count = 0;
        run_select(launcher, ccd::cuda::detail::may_collide_at{answers.data()}, n, found.data(),
                   room, &count, place.data());
        EXPECT_EQ(count, expected) << "the number needed, whatever the room";
        for (std::size_t k = 0; k < std::min(room, expected); ++k) EXPECT_EQ(found[k], 3 * k);
        EXPECT_EQ(found[room], 12345u) << "nothing is written beyond the room";
    }
    ccd::vertex_index count = 7;
    std::uint32_t place = 0;
    run_select(launcher, ccd::cuda::detail::may_collide_at{answers.data()}, 0, nullptr, 0, &count,
               &place);
    EXPECT_EQ(count, 0u);
}

void expect_step_as_on_host(const ccd::mesh& before, const ccd::mesh& after, std::size_t block,
                            const ccd::cuda::mesh_step_options& options = {}) {
    const auto expected = ccd::step(before, after,
                                    {.count_candidates = true,
                                     .initial_contact = options.initial_contact,
                                     .first_contact = options.first_contact,
                                     .times = options.times,
                                     .t_max = options.t_max});
    const auto found = cuda_on_host::step(before, after, options, block);
    if (options.t_max >= 1) {
        EXPECT_EQ(found.candidates, expected.candidates);
    }
    brute_force::expect_same_results(found, expected);
}

void expect_steps_as_on_host(const ccd::mesh& before, const ccd::mesh& after,
                             std::size_t block = cuda_on_host::default_block) {
    const auto first = ccd::step(before, after, {.first_contact = true}).first_contact;
    for (const double t_max : {1.0, first.high, first.low, 0.5, 0.0, -1.0})
        for (unsigned bits = 0; bits < 8; ++bits) {
            SCOPED_TRACE(testing::Message() << "t_max " << t_max << ", options " << bits);
            expect_step_as_on_host(before, after, block,
                                   {.initial_contact = (bits & 1) != 0,
                                    .first_contact = (bits & 2) != 0,
                                    .times = (bits & 4) != 0,
                                    .t_max = t_max});
        }
}

TEST(device_step, finds_the_pairs_and_times_of_a_scene) {
    const fs::path scene = fs::path(ERRBOUND_SCENES) / "cloth-over-ball";
    const ccd::mesh before = ccd::io::read_mesh(scene / "frame0.ply");
    const ccd::mesh after = ccd::io::read_mesh(scene / "frame1.ply");
    EXPECT_FALSE(ccd::step(before, after).pairs.vertex_face.empty());
    expect_steps_as_on_host(before, after);
    expect_step_as_on_host(before, after, 1000);
}

// On a grid contacts at the start, planar motion and ties abound.
TEST(device_step, finds_the_pairs_and_times_of_soups_on_a_grid) {
    for (const unsigned seed : {1U, 2U, 3U, 4U}) {
        auto [before, after] = brute_force::random_soup(seed, 70, 50);
        expect_steps_as_on_host(before, after, 7);
        // Two parts so far apart that floats do not distinguish the ends of their boxes.
        for (ccd::mesh* m : {&before, &after})
            for (std::size_t i = 0; i < 35; ++i) m->vertices[i].x += 1e12;
        expect_step_as_on_host(before, after, 1 << 20);
    }
}

/// `faces` faces of three vertices each, all of which touch each other.
ccd::mesh heap_of(std::size_t faces) {
    std::mt19937_64 random(faces);
    const auto coordinate = [&random] { return static_cast<double>(random() % 9); };
    ccd::mesh m;
    for (ccd::vertex_index v = 0; v < 3 * faces; v += 3) {
        m.vertices.insert(m.vertices.end(),
                          {{0, 0, coordinate()}, {9, coordinate(), 9}, {coordinate(), 9, 0}});
        m.faces.push_back({v, v + 1, v + 2});
    }
    return m;
}

// The numbers of faces and edges around those of packets; blocks that hold a part of a packet's
// pairs, or a part of those of a packet and a leaf's neighbours.
TEST(device_step, finds_the_pairs_of_heaps_of_every_size) {
    for (const std::size_t faces : {1U, 10U, 11U, 32U, 33U, 65U}) {
        const ccd::mesh before = heap_of(faces);
        ccd::mesh after = before;
        for (auto& p : after.vertices) p = {p.y, p.z, p.x};
        for (const std::size_t block :
             {std::size_t(7), std::size_t(1000), cuda_on_host::default_block})
            expect_step_as_on_host(before, after, block);
    }
}

// In smaller blocks, candidates come in another order.
TEST(device_step, gives_pairs_in_order) {
    const ccd::mesh before = heap_of(50);
    ccd::mesh after = before;
    for (auto& p : after.vertices) p = {p.y, p.z, p.x};
    host_launcher launcher;
    const auto all = [&]<class Pair>(const candidates<Pair>& block, outcome* answers,
                                     ccd::cuda::detail::scene_extent*,
                                     ccd::cuda::detail::rounded_position*) -> std::size_t {
        std::fill_n(answers, block.count, outcome::collides);
        return 0;
    };
    for (const std::size_t block :
         {std::size_t(32), std::size_t(1000), cuda_on_host::default_block}) {
        ccd::cuda::detail::step_memory<host_launcher> memory(block);
        memory.set_mesh(launcher, before.vertices.size(), before.faces,
                        ccd::unique_edges(before.faces));
        const auto found = memory.run(launcher, positions_of({before, after}), all);
        const auto expect_in_order = [](const auto* pairs, std::size_t count,
                                        std::size_t expected) {
            EXPECT_EQ(count, expected);
            EXPECT_GT(count, 100U);
            EXPECT_TRUE(std::is_sorted(pairs, pairs + count));
        };
        expect_in_order(memory.vertex_face().data(), found.vertex_face,
                        found.vertex_face_candidates);
        expect_in_order(memory.edge_edge().data(), found.edge_edge, found.edge_edge_candidates);
    }
}

TEST(device_step, refuses_coordinates_that_are_not_finite) {
    const ccd::mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.25, 0.25, 0}, {5, 5, 5}},
                         {{0, 1, 2}, {1, 2, 3}}};
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        ccd::mesh broken = mesh;
        broken.vertices[4].y = bad;
        host_launcher launcher;
        ccd::cuda::detail::step_memory<host_launcher> memory;
        memory.set_mesh(launcher, 5, mesh.faces, ccd::unique_edges(mesh.faces));
        const positions at = positions_of({mesh, broken});
        const auto never = [](const auto&, outcome*, ccd::cuda::detail::scene_extent*,
                              ccd::cuda::detail::rounded_position*) -> std::size_t {
            ADD_FAILURE() << "nothing is to be decided";
            return 0;
        };
        EXPECT_FALSE(memory.run(launcher, at, never).finite);
    }
}

TEST(device_step, takes_meshes_of_nothing) {
    const ccd::mesh points{{{0, 0, 0}, {1, 0, 0}}, {}};
    const ccd::mesh one{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.25, 0.25, 1}}, {{0, 1, 2}}};
    ccd::mesh moved = one;
    moved.vertices[3].z = -1;
    for (const auto& [before, after] :
         {std::pair(ccd::mesh{}, ccd::mesh{}), {points, points}, {one, one}, {one, moved}})
        expect_steps_as_on_host(before, after, 10);
}

}  // namespace
