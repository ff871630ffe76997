#include <mpfi.h>

#include <utility>
#include <vector>

#include "tests/bench/predicates/predicate_peers.hpp"

namespace bench {
namespace {

/// With operators, and without allocation once as many have been made as live at a time.
class interval {
  public:
    interval() : value_(taken()) {}
    explicit interval(double x) : value_(taken()) { mpfi_set_d(value_, x); }
    interval(const interval& x) : value_(taken()) { mpfi_set(value_, x.value_); }
    interval(interval&& x) noexcept : value_(std::exchange(x.value_, nullptr)) {}
    interval& operator=(interval x) noexcept {
        std::swap(value_, x.value_);
        return *this;
    }
    ~interval() {
        if (value_ != nullptr) free_values().push_back(value_);
    }
    friend interval operator+(const interval& a, const interval& b) {
        interval r;
        mpfi_add(r.value_, a.value_, b.value_);
        return r;
    }
    friend interval operator-(const interval& a, const interval& b) {
        interval r;
        mpfi_sub(r.value_, a.value_, b.value_);
        return r;
    }
    friend interval operator*(const interval& a, const interval& b) {
        interval r;
        mpfi_mul(r.value_, a.value_, b.value_);
        return r;
    }
    friend errbound::sign_type sign_of(const interval& x) {
        if (mpfi_is_strictly_pos(x.value_) > 0) return errbound::sign_type::positive;
        if (mpfi_is_strictly_neg(x.value_) > 0) return errbound::sign_type::negative;
        return mpfi_is_zero(x.value_) > 0 ? errbound::sign_type::zero
                                          : errbound::sign_type::uncertain;
    }

  private:
    static std::vector<mpfi_ptr>& free_values() {
        static std::vector<mpfi_ptr> values;
        return values;
    }
    static mpfi_ptr taken() {
        auto& values = free_values();
        if (values.empty()) {
            const mpfi_ptr made = new __mpfi_struct;
            mpfi_init2(made, 53);
            return made;
        }
        const mpfi_ptr last = values.back();
        values.pop_back();
        return last;
    }
    mpfi_ptr value_;
};

}  // namespace

template <class Form>
void decide_by_mpfi(const set_of<Form>& set, std::size_t count, signs& out) {
    decide_over<Form>(
        set, count, out, [](double x) { return interval(x); },
        [](const interval& x) { return sign_of(x); });
}
template void decide_by_mpfi<orient2d_form>(const set_of<orient2d_form>&, std::size_t, signs&);
template void decide_by_mpfi<orient3d_form>(const set_of<orient3d_form>&, std::size_t, signs&);
template void decide_by_mpfi<incircle_form>(const set_of<incircle_form>&, std::size_t, signs&);
template void decide_by_mpfi<insphere_form>(const set_of<insphere_form>&, std::size_t, signs&);

}  // namespace bench
