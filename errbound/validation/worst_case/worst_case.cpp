// Boxes are bisected, those of the largest bound first.
#include <chrono>
#include <cmath>
#include <optional>

#include "errbound/validation/worst_case/analysis.hpp"

namespace errbound::validation {
namespace {

class branch_and_bound {
  public:
    branch_and_bound(const recording& f, analysis& a, bool relative)
        : f_(f), analysis_(a), relative_(relative) {
        for (const input_range& r : f.inputs) {
            whole_.emplace_back(r.lower, r.upper);
            widths_.push_back(r.upper - r.lower);
        }
    }

    struct box {
        std::vector<range> inputs;
        double most = infinity, reached = 0;
        size_t split = 0;
        range result = range::unknown();
    };

    void run() {
        const auto start = std::chrono::steady_clock::now();
        const auto seconds = [&] {
            return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        };
        add({whole_});
        while (!open_.empty()) {
            const double most = open_.front().most;
            if (most <= std::max(reached_ * (1 + f_.options.gap), done_)) break;
            const bool stalls = boxes_ >= next_check_ && most > (1 - f_.options.gap / 4) * before_;
            if (boxes_ >= next_check_) next_check_ = boxes_ + 20'000, before_ = most;
            if (stalls || boxes_ >= f_.options.boxes || seconds() > f_.options.seconds ||
                (relative_ && reached_ == infinity)) {
                complete_ = false;
                break;
            }
            std::ranges::pop_heap(open_, {}, &box::most);
            box b = std::move(open_.back());
            open_.pop_back();
            const size_t k = b.split;
            const double low = b.inputs.empty() ? 0 : b.inputs[k].lower(),
                         high = b.inputs.empty() ? 0 : b.inputs[k].upper(),
                         middle = middle_of(low, high);
            if (!(low < middle && middle < high)) {
                done_ = std::max(done_, b.most);  // cannot be split
                done_result_ = done_result_ ? hull(*done_result_, b.result) : b.result;
                if (b.most >= worst_.most || worst_.inputs.empty()) worst_ = std::move(b);
                continue;
            }
            for (const range& half : {range(low, middle), range(middle, high)}) {
                box child{b.inputs, b.most, 0, 0, b.result};
                child.inputs[k] = half;
                add(std::move(child));
            }
        }
    }
    double most() const { return open_.empty() ? done_ : std::max(done_, open_.front().most); }
    const box& worst() const {
        return open_.empty() || open_.front().most < done_ ? worst_ : open_.front();
    }
    /// Encloses the exact results; nothing without inputs that satisfy the constraints.
    std::optional<range> result() const {
        std::optional<range> all = done_result_;
        for (const box& b : open_) all = all ? hull(*all, b.result) : b.result;
        return all;
    }
    size_t boxes() const { return boxes_; }
    bool complete() const { return complete_; }
    /// Boxes where the error may be large.
    std::vector<std::vector<input_range>> hot() const {
        std::vector<std::vector<input_range>> all;
        const auto put = [&](const box& b) {
            std::vector<input_range> one;
            for (const range& r : b.inputs) one.push_back({r.lower(), r.upper()});
            all.push_back(std::move(one));
        };
        for (const box& b : best_) put(b);
        for (size_t i = 0; i < std::min<size_t>(open_.size(), 16); ++i) put(open_[i]);
        if (all.empty()) all.push_back(f_.inputs);
        return all;
    }

  private:
    /// The geometric mean of numbers of one sign that differ much in size.
    static double middle_of(double low, double high) {
        if (low > 0 && high > 16 * low) return std::sqrt(low) * std::sqrt(high);
        if (high < 0 && low < 16 * high) return -std::sqrt(-low) * std::sqrt(-high);
        return low / 2 + high / 2;
    }
    void add(box b) {
        ++boxes_;
        const analysis::box_bound found = analysis_.bound_over(b.inputs, widths_, relative_);
        if (found.empty) return;
        b.result = common(b.result, found.result);
        b.most = std::min(b.most, found.most);
        b.reached = found.reached;
        b.split = found.split;
        if (b.reached > reached_ || best_.size() < 16) {
            best_.push_back(b);
            std::ranges::stable_sort(best_, std::greater<>(), &box::reached);
            if (best_.size() > 16) best_.pop_back();
        }
        reached_ = std::max(reached_, b.reached);
        open_.push_back(std::move(b));
        std::ranges::push_heap(open_, {}, &box::most);
    }

    const recording& f_;
    analysis& analysis_;
    bool relative_;
    std::vector<range> whole_;
    std::vector<double> widths_;
    std::vector<box> open_, best_;  ///< a heap by `most`
    box worst_;
    std::optional<range> done_result_;
    double reached_ = 0, done_ = 0;
    size_t boxes_ = 0, next_check_ = 20'000;
    double before_ = infinity;  ///< the bound at the last check for progress
    bool complete_ = true;
};

}  // namespace

recording::recording(number_type format, std::vector<input_range> box,
                     const worst_case_options& limits)
    : type(format), inputs(std::move(box)), options(limits), outer_(current()) {
    for (size_t k = 0; k < inputs.size(); ++k) {
        const input_range& r = inputs[k];
        if (!(r.lower <= r.upper) || !std::isfinite(r.lower) || !std::isfinite(r.upper) ||
            !(r.error >= 0) || !std::isfinite(r.error))
            throw std::invalid_argument("range of input " + std::to_string(k) + " is [" +
                                        std::to_string(r.lower) + ", " + std::to_string(r.upper) +
                                        "] with error " + std::to_string(r.error) +
                                        "; expected finite numbers, lower <= upper, error >= 0");
    }
    current() = this;
}

size_t recording::constant(const std::string& text) {
    mpfr_number checked(53);
    set_constant(checked.get(), text, MPFR_RNDN);
    const auto found = std::ranges::find(constants, text);
    const auto index = static_cast<size_t>(found - constants.begin());
    if (found == constants.end()) constants.push_back(text);
    return add({.kind = leaf::constant, .left = index});
}

sign_type recording::order(size_t left, size_t right) const {
    const sign_type sign = analysis(*this).order(left, right);
    if (certain(sign)) return sign;
    throw undecided_comparison("the result of a comparison depends on the input");
}

worst_case_result worst_case_of(const recording& f) {
    const auto start = std::chrono::steady_clock::now();
    analysis a(f);
    branch_and_bound bound(f, a, false);
    bound.run();
    worst_case_result r;
    r.at_most = bound.most();
    r.boxes = bound.boxes();
    r.complete = bound.complete();
    if (const std::optional<range> result = bound.result()) {
        r.lower = result->lower();
        r.upper = result->upper();
    }
    if (!bound.worst().inputs.empty() || f.inputs.empty())
        r.by_operation = a.by_operation(bound.worst().inputs, r.at_most);
    observed_error found;
    if (f.options.samples > 0) found = largest_error(f, bound.hot());
    for (const rule& one : f.options.rules)
        r.by_rule.push_back(largest_bound(f, one, bound.hot(), found));
    r.at_least = found.at_least;
    r.where = std::move(found.where);
    r.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (f.options.relative) {
        branch_and_bound relative(f, a, true);
        relative.run();
        r.relative_at_most = relative.most();
    }
    return r;
}

}  // namespace errbound::validation
