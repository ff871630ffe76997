// Answers that a predicate must not return. Each case is compiled alone, with its name defined.
#include <errbound/predicate.hpp>

#ifdef CASE_asks_nothing
// The answer does not use the points.

constexpr auto predicate =
    errbound::predicate<errbound::points<0, 0>>([](const auto& x, const auto& y) {
        (void)(x - y);
        return errbound::sign_type::positive;
    });

int main() {
    return predicate(1.0, 2.0) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_cancels
// Both products are equal: the difference is zero for all points.

const double a[2]{}, b[2]{};

constexpr auto predicate = errbound::predicate<errbound::points<2, 2>>(
    [](const auto& a, const auto& b) { return a[0] * b[1] - b[1] * a[0]; });

int main() {
    return predicate(a, b) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_endless
// The loop evaluates the sign until it is certain.

constexpr auto predicate =
    errbound::predicate<errbound::points<0, 0>>([](const auto& x, const auto& y) {
        errbound::sign_type s = sign_of(x - y);
        while (!certain(s)) s = sign_of(x - y);
        return s;
    });

int main() {
    return predicate(1.0, 2.0) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_gives_up
// The degenerate case is reported as uncertain.

constexpr auto predicate =
    errbound::predicate<errbound::points<0, 0>>([](const auto& x, const auto& y) {
        using errbound::sign_type;
        const sign_type s = sign_of(x - y);
        return s == sign_type::zero ? sign_type::uncertain : s;
    });

int main() {
    return predicate(1.0, 2.0) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_number_after_signs
// The expression returns a number after it has branched on a sign, so it cannot return `uncertain`.

constexpr auto folded =
    errbound::predicate<errbound::points<0, 0>>([](const auto& x, const auto& y) {
        const auto d = x - y;
        return sign_of(x) == errbound::sign_type::positive ? d : -d;
    });

int main() {
    return folded(1.0, 2.0) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_one_answer
// The answer is the same for all signs.

constexpr auto predicate =
    errbound::predicate<errbound::points<0, 0>>([](const auto& x, const auto& y) {
        using errbound::sign_type;
        const sign_type s = sign_of(x - y);
        if (!certain(s)) return s;
        return s == sign_type::positive ? sign_type::negative : sign_type::negative;
    });

int main() {
    return predicate(1.0, 2.0) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_ordered_signs
// operator< on signs orders `uncertain` last.

constexpr auto predicate =
    errbound::predicate<errbound::points<0, 0>>([](const auto& x, const auto& y) {
        if (sign_of(x - y) > errbound::sign_type::zero) return sign_of(x);
        return errbound::sign_type::negative;
    });

int main() {
    return predicate(1.0, 2.0) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_possibly
// The answer is positive although the sign may be uncertain.

constexpr auto predicate =
    errbound::predicate<errbound::points<0, 0>>([](const auto& x, const auto& y) {
        return possibly_positive(sign_of(x - y)) ? errbound::sign_type::positive
                                                 : errbound::sign_type::negative;
    });

int main() {
    return predicate(1.0, 2.0) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_returns_bool
// An answer of type bool cannot be `uncertain`.

constexpr auto predicate = errbound::predicate<errbound::points<0, 0>>(
    [](const auto& x, const auto& y) { return sign_of(x - y) == errbound::sign_type::positive; });

int main() {
    return predicate(1.0, 2.0) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_returns_int
// An answer of type int cannot be `uncertain`.

constexpr auto predicate =
    errbound::predicate<errbound::points<0, 0>>([](const auto& x, const auto& y) {
        return sign_of(x - y) == errbound::sign_type::positive ? 1 : -1;
    });

int main() {
    return predicate(1.0, 2.0) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_returns_void
// The lambda has no return statement.

constexpr auto predicate = errbound::predicate<errbound::points<0, 0>>(
    [](const auto& x, const auto& y) { (void)sign_of(x - y); });

int main() {
    return predicate(1.0, 2.0) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_without_certain
// The code branches on an uncertain sign: the line with certain is missing.

constexpr auto predicate =
    errbound::predicate<errbound::points<0, 0, 0>>([](const auto& x, const auto& y, const auto& z) {
        using errbound::sign_type;
        const sign_type s = sign_of(x * y - z * z);
        return s == sign_type::positive ? sign_of(x - z) : sign_of(z - y);
    });

int main() {
    return predicate(1.0, 2.0, 3.0) == errbound::sign_type::zero;
}
#endif

#ifdef CASE_without_certain_of_a_multiple
// The code branches on an uncertain sign of a large multiple: the line with certain is missing.

constexpr auto predicate =
    errbound::predicate<errbound::points<0, 0, 0>>([](const auto& x, const auto& y, const auto& z) {
        using errbound::sign_type;
        const sign_type s = sign_of(2147483647 * (x * y - z * z));
        return s == sign_type::positive ? sign_of(x - z) : sign_of(z - y);
    });

int main() {
    return predicate(1.0, 2.0, 3.0) == errbound::sign_type::zero;
}
#endif
