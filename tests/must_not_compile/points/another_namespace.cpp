// coordinate_of is not in the namespace of the point's type, so that nobody finds it.
#include <errbound/predicates.hpp>

namespace survey {
struct station {
    double easting, northing;
};
}  // namespace survey
constexpr double coordinate_of(const survey::station& s, int i) {
    return i == 0 ? s.easting : s.northing;
}

int main() {
    const survey::station s{};
    return errbound::orient2d(s, s, s) == errbound::sign_type::zero;
}
