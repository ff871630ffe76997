// The query of docs/collision-detection.md#a-query-and-its-proof.
#include <ccd/exact.hpp>
#include <ccd/explain.hpp>
#include <ccd/methods/forms.hpp>
#include <cstdio>

template <int N>
void print(const char* name, const errbound::bernstein<double, N>& form) {
    std::printf("%s:", name);
    for (const double h : form.h) std::printf(" %g", h);
    std::printf("\n");
}

int main() {
    const ccd::vertex_face<double> query{.v = {{0.25, 0.25, 1}, {0.25, 0.25, -1}},
                                         .f0 = {{0, 0, 0}, {0, 0, 0}},
                                         .f1 = {{1, 0, 0}, {1, 0, 0}},
                                         .f2 = {{0, 1, 0}, {0, 1, 0}}};
    const auto forms = forms_of(query);
    print("Y", forms.y());
    for (const auto& g : forms.inside()) print("G", g);

    ccd::stage_report report;
    const ccd::verdict answer = ccd::decide_exact(query, &report);
    for (const ccd::stage_info& s : ccd::exact_stages)
        if (report[s.stage].entered > 0)
            std::printf("%s: %s\n", s.name.data(),
                        report[s.stage].collides > 0 ? "collides" : "not certain");
    std::printf("exact: %s\n", ccd::name(answer.outcome).data());
}
