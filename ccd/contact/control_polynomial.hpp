// The ring of polynomials on [0, 1] as in errbound/bernstein.hpp, but of run-time degree. Internal.
#pragma once

#include <algorithm>
#include <cstddef>
#include <errbound/sign.hpp>
#include <utility>
#include <vector>

namespace ccd::detail {

/// Σ h_i s^(n−i) t^i at s = 1 − t. Without coefficients h it is identically zero.
template <class S>
class control_polynomial {
  public:
    control_polynomial() = default;
    explicit control_polynomial(std::vector<S> h) : h_(std::move(h)) {}

    /// The common sign of all coefficients, which the polynomial has on [0, 1].
    errbound::sign_type sign_throughout() const {
        if (h_.empty()) return errbound::sign_type::zero;
        const auto first = sign_of(h_[0]);
        const auto differs = [&](const S& h) { return sign_of(h) != first; };
        return std::any_of(h_.begin(), h_.end(), differs) ? errbound::sign_type::uncertain : first;
    }

    friend control_polynomial operator+(const control_polynomial& p, const control_polynomial& q) {
        return combined(p, q, [](const S& a, const S& b) { return a + b; });
    }
    friend control_polynomial operator-(const control_polynomial& p, const control_polynomial& q) {
        return combined(p, q, [](const S& a, const S& b) { return a - b; });
    }
    friend control_polynomial operator*(const control_polynomial& p, const control_polynomial& q) {
        if (p.h_.empty() || q.h_.empty()) return {};
        const std::size_t a = p.h_.size() - 1, b = q.h_.size() - 1;
        std::vector<S> product;
        product.reserve(a + b + 1);
        // The first term of each sum is stored, because even an addition to zero has an error.
        for (std::size_t k = 0; k <= a + b; ++k) {
            std::size_t i = k > b ? k - b : 0;
            product.push_back(p.h_[i] * q.h_[k - i]);
            for (++i; i <= a && i <= k; ++i)
                product.back() = product.back() + p.h_[i] * q.h_[k - i];
        }
        return control_polynomial(std::move(product));
    }

    std::size_t size() const { return h_.size(); }
    /// The coefficients after multiplication with a power of s + t. Precondition: size >= size().
    std::vector<S> elevated_to(std::size_t size) const {
        if (h_.empty()) return std::vector<S>(size, S(0));
        std::vector<S> h = h_;
        while (h.size() < size) {
            h.push_back(h.back());
            for (std::size_t i = h.size() - 2; i > 0; --i) h[i] = h[i] + h[i - 1];
        }
        return h;
    }

  private:
    template <class Combine>
    static control_polynomial combined(const control_polynomial& p, const control_polynomial& q,
                                       const Combine& combine) {
        const std::size_t size = std::max(p.h_.size(), q.h_.size());
        std::vector<S> a = p.elevated_to(size);
        const std::vector<S> b = q.elevated_to(size);
        for (std::size_t i = 0; i < size; ++i) a[i] = combine(a[i], b[i]);
        return control_polynomial(std::move(a));
    }

    std::vector<S> h_;
};

}  // namespace ccd::detail
