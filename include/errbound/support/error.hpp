// The readers' exception.
#pragma once

#include <stdexcept>

namespace errbound::support {

/// Bad input or output. what() is a full sentence with file, line or element, found and expected.
/// The program prints it and exits with status 1.
struct file_error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

}  // namespace errbound::support
