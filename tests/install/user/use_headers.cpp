// Only the headers: exits with 0 if a tracked product has the correct sign.
#include <errbound/errbound.hpp>

int main() {
    const errbound::tracked<float> x = -2.0F, y = 3.0F;
    return sign_of(x * y) == errbound::sign_type::negative ? 0 : 1;
}
