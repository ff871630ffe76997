// Every call of the runtime fails once. The library must return an error or right answers, and
// throw nothing. Each failure happens in a separate process, since CUB keeps some errors.
#include <sys/wait.h>
#include <unistd.h>

#include <ccd/contact.hpp>
#include <ccd/cuda.hpp>
#include <ccd/exact.hpp>
#include <ccd/step.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "tests/ccd/cuda/emulator/device.hpp"

namespace {

using query = ccd::vertex_face<double>;

/// A vertex that falls through a triangle, one that misses it and one that touches it at the end.
std::vector<query> queries() {
    std::vector<query> all;
    for (const double end : {-1.0, 0.5, 0.0})
        all.push_back({.v = {{0.25, 0.25, 1}, {0.25, 0.25, end}},
                       .f0 = {{0, 0, 0}, {0, 0, 0}},
                       .f1 = {{1, 0, 0}, {1, 0, 0}},
                       .f2 = {{0, 1, 0}, {0, 1, 0}}});
    return all;
}

/// The error and the correctness of one use of the library.
struct result {
    std::string error;
    bool right;
};

result decide() {
    const auto all = queries();
    std::vector<ccd::outcome> found(all.size());
    const auto s = ccd::cuda::decide(all, found, {});
    bool right = true;
    for (std::size_t i = 0; i < all.size(); ++i)
        right &= found[i] == ccd::decide_exact(all[i]).outcome;
    return {s.error, right};
}
result step() {
    ccd::mesh before, after;
    before.vertices = {{0, 0, 0},     {1, 0, 0},         {0, 1, 0},
                       {0.2, 0.2, 1}, {0.4, 0.2, 1.125}, {0.2, 0.4, 1.25}};
    before.faces = {{0, 1, 2}, {3, 4, 5}};
    after = before;
    for (std::size_t i = 3; i < 6; ++i) after.vertices[i].z -= 2;
    const auto found = ccd::cuda::step(before, after, {});
    return {found.error, found.pairs == ccd::step(before, after, {}).pairs};
}

enum ending { passed, wrong, failed_silently, no_such_call };
ending run(result (*use)(), long call) {
    try {
        setenv("PTXEMU_FAIL_CALL", std::to_string(call).c_str(), 1);
        const result r = use();
        if (ptx::runtime_calls() < call) return r.error.empty() && r.right ? no_such_call : wrong;
        return !r.error.empty() || r.right ? passed : failed_silently;
    } catch (const std::exception& e) {
        std::printf("call %ld: %s\n", call, e.what());
        return wrong;
    }
}

/// True if the library handled the failure of every call.
bool every_call(const char* name, result (*use)()) {
    for (long call = 1;; ++call) {
        std::fflush(nullptr);
        const pid_t child = fork();
        if (child == 0) {
            const ending e = run(use, call);
            std::fflush(nullptr);
            _exit(e);
        }
        int status = 0;
        waitpid(child, &status, 0);
        const int e = WIFEXITED(status) ? WEXITSTATUS(status) : int(wrong);
        if (e == no_such_call) {
            std::printf("%s: each of %ld calls failed once\n", name, call - 1);
            return true;
        }
        if (e != passed) {
            std::printf("%s: FAILED where call %ld fails\n", name, call);
            return false;
        }
    }
}

}  // namespace

int main() {
    return every_call("decide", decide) & every_call("step", step) ? 0 : 1;
}
