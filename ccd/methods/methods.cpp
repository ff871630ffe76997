#include <algorithm>
#include <ccd/exact.hpp>
#include <ccd/method.hpp>
#include <ccd/methods/bsc.hpp>
#include <ccd/methods/bsc_exact.hpp>
#include <ccd/methods/provot.hpp>
#include <ccd/methods/root_parity.hpp>
#include <ccd/methods/safeccd.hpp>
#include <errbound/rules/interval.hpp>
#include <errbound/rules/none.hpp>
#include <errbound/rules/residual.hpp>
#include <errbound/rules/safe.hpp>
#include <errbound/rules/sharp.hpp>
#include <errbound/rules/tight.hpp>
#include <iterator>

namespace ccd {
namespace {

constexpr method_info table[] = {
    {method::float_, "float", true, true,
     "no promise: plain double arithmetic, may be wrong either way",
     "BSC-float; Tang, Tong, Wang, Manocha 2014"},
    {method::safe, "safe", false, true,
     "never loses a collision; false positives if SafeBound is uncertain",
     "BSC with SafeBound; Wang 2014; Wang, Tang, Tong, Manocha 2015, Section 4.2"},
    {method::tight, "tight", false, true,
     "never loses a collision; false positives if TightBound is uncertain",
     "TightCCD; Wang, Tang, Tong, Manocha 2015"},
    {method::sharp, "sharp", false, true,
     "never loses a collision, rounding to nearest; false positives if the bound is uncertain",
     "BSC with TightBound's rules at half their unit roundoff (errbound/rules/sharp.hpp)"},
    {method::interval, "interval", false, true,
     "never loses a collision, rounding to nearest; false positives if intervals contain zero",
     "BSC in interval arithmetic, rounded outwards (errbound/rules/interval.hpp)"},
    {method::residual, "residual", false, true,
     "never loses a collision, rounding to nearest; few false positives",
     "BSC with each operation's own rounding error (errbound/rules/residual.hpp)"},
    {method::bsc_exact, "bsc-exact", false, false,
     "no false negative, no false positive, on any finite input",
     "BSC in interval arithmetic, then in unbounded integers; Tang, Tong, Wang, Manocha 2014"},
    {method::safeccd, "safeccd", false, true,
     "never loses a collision; many false positives, from one uniform bound",
     "SafeCCD; Wang 2014, corrected: docs/collision-detection.md"},
    {method::safeccd_tight, "safeccd-tight", false, true,
     "never loses a collision; false positives if TightBound is uncertain",
     "SafeCCD with TightBound; Wang, Tang, Tong, Manocha 2015, Section 6"},
    {method::provot, "provot", true, true,
     "no promise: cubic roots and inside tests in plain double, degenerate contacts lost",
     "Provot 1997"},
    {method::root_parity, "root-parity", true, false,
     "no false positive; loses contacts that come in even numbers within a step",
     "Brochu, Edwards, Bridson 2012; in interval arithmetic, then in unbounded integers"},
    {method::exact, "exact", false, false,
     "no false negative, no false positive, on any finite input",
     "static error bounds, then integers of fixed and of unbounded width (ccd step --explain)"},
};

}  // namespace

std::span<const method_info> methods() {
    return table;
}

std::optional<method> find_method(std::string_view name) {
    const auto found = std::ranges::find(table, name, &method_info::name);
    if (found == std::end(table)) return std::nullopt;
    return found->method;
}

method_info info(method m) {
    const auto found = std::ranges::find(table, m, &method_info::method);
    return found != std::end(table) ? *found
                                    : method_info{m, "unknown", true, true, "none", "none"};
}

template <cubic_query Query>
verdict decide(method m, const Query& query) {
    switch (m) {
        case method::float_:
            return decide_bsc<errbound::none>(query);
        case method::safe:
            return decide_bsc<errbound::safe>(query);
        case method::tight:
            return decide_bsc<errbound::tight>(query);
        case method::sharp:
            return decide_bsc<errbound::sharp>(query);
        case method::interval:
            return decide_bsc<errbound::interval>(query);
        case method::residual:
            return decide_bsc<errbound::residual>(query);
        case method::bsc_exact:
            return decide_bsc_exact(query);
        case method::safeccd:
            return decide_safeccd<errbound::safe>(query);
        case method::safeccd_tight:
            return decide_safeccd<errbound::tight>(query);
        case method::provot:
            return decide_provot(query);
        case method::root_parity:
            return decide_root_parity(query);
        case method::exact:
            return decide_exact(query);
    }
    return {};
}

template verdict decide(method, const vertex_face<double>&);
template verdict decide(method, const edge_edge<double>&);

}  // namespace ccd
