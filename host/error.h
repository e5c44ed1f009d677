/// The two kinds of failure that a person is told about.
#pragma once
#include <stdexcept>

namespace vkpm {

/// The user's input is wrong; what() says file, place, what was found and what is allowed. Exit code 2.
struct InputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The environment failed: no device, a failing driver, no memory. Says the call, the cause and what helps. Exit
/// code 1.
struct GpuError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The device has no memory for a buffer.
struct OutOfMemory : GpuError {
    using GpuError::GpuError;
};

/// The device stopped working for good; another one may be opened.
struct DeviceLost : GpuError {
    using GpuError::GpuError;
};

} // namespace vkpm
