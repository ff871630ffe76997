// Device code for tests/ccd/cuda/flags_test.sh, which reads its instructions.
#include <errbound/tracked.hpp>

__global__ void plain_sum(const double* x, double* r) {
    *r = x[0] * x[1] + x[2];
}

__global__ void tracked_sum(const double* x, double* r) {
    using number = errbound::tracked<double>;
    *r = (number(x[0]) * number(x[1]) + number(x[2])).value();
}

__global__ void plain_product(const float* x, float* r) {
    *r = x[0] * x[1];
}
