// The installed library: exits with 0 if a head-on vertex/face collision is found.
#include <ccd/ccd.hpp>

int main() {
    const ccd::vertex_face<double> query{.v = {{0.2, 0.2, 1}, {0.2, 0.2, -1}},
                                         .f0 = {{0, 0, 0}, {0, 0, 0}},
                                         .f1 = {{1, 0, 0}, {1, 0, 0}},
                                         .f2 = {{0, 1, 0}, {0, 1, 0}}};
    const ccd::verdict v = ccd::decide(ccd::method::exact, query);
    return v.outcome == ccd::outcome::collides ? 0 : 1;
}
