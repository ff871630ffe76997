// The error of the cubic whose roots are the times at which a vertex is in a face's plane. Compares
// the shares of arithmetic and of coordinates rounded to floats, near the origin and far from it.
//
// usage: coplanarity [FILE]; FILE is written for `errbound explain`.
#include <ccd/methods/forms.hpp>
#include <ccd/query.hpp>
#include <cmath>
#include <cstdio>
#include <errbound/explain/explain.hpp>
#include <exception>
#include <string>

using number = errbound::tracked<double, errbound::explained<errbound::tight>>;

// A vertex falls through a triangle, `away` from the origin.
ccd::vertex_face<number> query(double away) {
    const errbound::scope s("rounded to float");
    const auto rounded = [](double x) { return number::within(x, std::abs(x) * 0x1p-24); };
    const auto at = [&](double x, double y, double z) {
        return ccd::point<number>{rounded(away + x), rounded(away + y), rounded(away + z)};
    };
    return {{at(0.3, 0.3, 0.1), at(0.3, 0.3, -0.2)},
            {at(0, 0, 0), at(0, 0, 0.01)},
            {at(1, 0.1, 0), at(1, 0.1, 0.02)},
            {at(0.1, 1, 0), at(0.1, 1, -0.01)}};
}

errbound::explanation explain_cubic(double away, const std::string& name) {
    const ccd::vertex_face<number> q = query(away);
    const auto difference = [](const auto& p, const auto& from, const char* what) {
        const errbound::scope s(what);
        return ccd::difference(p, from);
    };
    const auto b = difference(q.f1, q.f0, "b"), c = difference(q.f2, q.f0, "c"),
               p = difference(q.v, q.f0, "p");
    const auto normal = [&] {
        const errbound::scope s("normal");
        return ccd::cross(b, c);
    }();
    const auto y = [&] {
        const errbound::scope s("Y");
        return ccd::dot(normal, p);
    }();
    const errbound::scope s("at a third");
    return errbound::explain(value_at(y, number(1.0 / 3)), name);
}

int main(int argc, char** argv) try {
    const auto near = explain_cubic(0, "Y(1/3), at the origin");
    const auto far = explain_cubic(1000, "Y(1/3), 1000 away");
    std::fputs(text_of(near, 6).c_str(), stdout);
    std::fputs(text_of(far, 6).c_str(), stdout);
    if (argc > 1) errbound::write_explanations(argv[1], {near, far});
} catch (const std::exception& error) {
    std::fprintf(stderr, "coplanarity: %s\n", error.what());
    return 1;
}
