// Errors of forces and positions in an orbit, by the leapfrog method, for two origins.
//
// usage: ode_step [FILE]; FILE is written for `errbound explain`.
#include <cstdio>
#include <errbound/explain/explain.hpp>
#include <exception>

template <class S>
struct body {
    S x, y, vx, vy;
};

// Half a kick, a drift, half a kick. The sun is at (sun, 0).
template <class S>
void step(body<S>& b, const S& h, const S& sun) {
    const errbound::scope s("step");
    const auto kick = [&] {
        const errbound::scope s_kick("kick");
        S dx, inverse;
        {
            const errbound::scope s_distance("distance");
            dx = b.x - sun;
            const S square = dx * dx + b.y * b.y;
            inverse = S(1) / (square * sqrt(square));
        }
        b.vx -= h / S(2) * dx * inverse;
        b.vy -= h / S(2) * b.y * inverse;
    };
    kick();
    {
        const errbound::scope s_drift("drift");
        b.x += h * b.vx;
        b.y += h * b.vy;
    }
    kick();
}

// Positions are relative to the sun.
template <class S>
S x_after(int steps, double sun) {
    body<S> b{S(1 + sun), S(0), S(0), S(1.1)};
    for (int i = 0; i < steps; ++i) step(b, S(0.0625), S(sun));
    const errbound::scope s("relative to the sun");
    return b.x - S(sun);
}

int main(int argc, char** argv) try {
    using number = errbound::tracked<double, errbound::explained<errbound::tight>>;
    const auto centred = errbound::explain(x_after<number>(20, 0), "x, sun at 0");
    const auto far = errbound::explain(x_after<number>(20, 0x1p20), "x, sun at 2^20");
    std::fputs(text_of(centred, 8).c_str(), stdout);
    std::fputs(text_of(far, 8).c_str(), stdout);
    if (argc > 1) errbound::write_explanations(argv[1], {centred, far});
} catch (const std::exception& error) {
    std::fprintf(stderr, "ode_step: %s\n", error.what());
    return 1;
}
