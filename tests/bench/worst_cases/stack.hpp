// How deep a call's stack gets.
#pragma once

#include <cstddef>
#include <functional>

namespace worst_cases {

/// Bytes of stack that `work` needs on a thread of its own, above those of a thread that does
/// nothing. Throws std::runtime_error if there is no such thread to be had.
std::size_t stack_of(const std::function<void()>& work);

}  // namespace worst_cases
