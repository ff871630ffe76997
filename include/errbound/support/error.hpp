// The readers' exception.
#pragma once

#include <stdexcept>

namespace errbound::support {

/// Bad input or output. what() has file, line or element, the value and the expected condition.
struct file_error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

}  // namespace errbound::support
