// Predicates of errbound/predicates.hpp: as a whole, every stage alone, and in batches, against
// their oracles.
#include <errbound/predicate_batch.hpp>
#include <string>
#include <tuple>
#include <vector>

#include "tests/errbound/predicates/predicate_list.hpp"
#include "tests/support/fuzz_numbers.hpp"

namespace {

using errbound::predicate_stage;
using errbound::sign_type;

template <class Points>
void expect(const std::string& who, const Points& p, sign_type right, sign_type said) {
    if (said != right)
        fuzz::fail(who + " says " + std::to_string(static_cast<int>(said) - 1) + ", right is " +
                   std::to_string(static_cast<int>(right) - 1) + ":" +
                   predicate_inputs::text_of(p));
}

template <class Entry>
void check(const Entry& entry, fuzz::numbers& from) {
    constexpr std::size_t D = Entry::dimension, N = Entry::count;
    predicate_inputs::points<double, D, N> p;
    const std::size_t copies = 1 + from.below(9);
    for (std::size_t axis = 0; axis < D; ++axis)
        for (auto& point : p) point[axis] = from.next();
    const sign_type right = predicate_list::right_sign(entry, p);
    const std::string name(entry.name);
    std::apply(
        [&](const auto&... q) {
            expect(name, p, right, entry.predicate(q...));
            for (std::size_t k = 0; k < errbound::predicate_stage_count; ++k) {
                const sign_type said = entry.predicate.by(static_cast<predicate_stage>(k), q...);
                if (certain(said)) expect(name + ", stage " + std::to_string(k), p, right, said);
            }
            std::vector<sign_type> signs(copies);
            errbound::batch_signs(entry.predicate, signs, std::vector(copies, q)...);
            for (const sign_type said : signs) expect(name + ", in a batch", p, right, said);
        },
        p);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::numbers from(data, size);
    std::size_t left = from.below(std::tuple_size_v<decltype(predicate_list::all)>);
    std::apply([&](const auto&... entry) { ((left-- == 0 ? check(entry, from) : void()), ...); },
               predicate_list::all);
    return 0;
}
