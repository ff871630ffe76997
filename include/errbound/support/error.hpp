// The one error of the readers: a message that names place, found and expected.
#pragma once

#include <stdexcept>

namespace errbound::support {

/// Bad input or output. what() is a full sentence for a person: file, line or element, what was
/// found, what was expected. The program prints it and exits with status 1.
struct file_error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

}  // namespace errbound::support
