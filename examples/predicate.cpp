// A predicate from an expression that is written once. Its sign is always correct.
#include <cstdio>
#include <errbound/tracked.hpp>
#include <initializer_list>

// Twice the signed area of the triangle a b c, for any number type.
template <class S>
S orient2d(S ax, S ay, S bx, S by, S cx, S cy) {
    return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
}

int main() {
    using number = errbound::tracked<double>;
    const char* const names[] = {"right", "collinear", "left", "uncertain: use exact arithmetic"};
    for (const double y : {0.5, 0.5 + 1e-12, 0.5 + 0x1p-53, 0.4}) {
        const number area = orient2d<number>(0.1, 0.1, 0.9, 0.9, 0.5, y);
        std::printf("c = (0.5, %.17g): area %g +- %.1g: %s\n", y, area.value(), area.error(),
                    names[static_cast<int>(sign_of(area))]);
    }
}
