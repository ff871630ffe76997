// A unit that is compiled under flags of its own, and answers for itself.
#include <errbound/environment.hpp>

bool other_unit_is_sound() {
    return errbound::floating_point_environment().sound();
}
