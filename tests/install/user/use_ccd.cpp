// The installed library, with names of POSIX in scope: exits with 0 if it finds a head-on
// vertex/face collision.
#include <strings.h>
#include <unistd.h>

#include <ccd/ccd.hpp>
#include <errbound/errbound.hpp>

using namespace ccd;
using namespace errbound;

int main() {
    const vertex_face<double> query{.v = {{0.2, 0.2, 1}, {0.2, 0.2, -1}},
                                    .f0 = {{0, 0, 0}, {0, 0, 0}},
                                    .f1 = {{1, 0, 0}, {1, 0, 0}},
                                    .f2 = {{0, 1, 0}, {0, 1, 0}}};
    const verdict v = decide(method::exact, query);
    const vertex_face_pair pair{.v = 3, .f0 = 0, .f1 = 1, .f2 = 2};
    const vertex_index first = vertices_of(pair)[0];
    const char* const found = index("vertex", 'x');
    return v.outcome == outcome::collides && first == 3 && *found == 'x' ? 0 : 1;
}
