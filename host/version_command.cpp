/// vkpm --version: version, commit, and the Vulkan driver that a render would run on.
#include "commands.h"
#include "gpu/gpu.h"
#include <cstdio>
#include <exception>
#include <fmt/format.h>

namespace vkpm {

int showVersion(const Options& options) {
    fmt::print("{}commit {}\n", options.text, commit);
    std::fflush(stdout); // a driver may crash
    try {
        const DeviceInfo device = defaultDevice();
        fmt::print("driver {}, on {}\n", device.driver, device.name);
    } catch (const std::exception& error) { // the rest is no less true
        fmt::print("driver none: {}\n", error.what());
    }
    return 0;
}

} // namespace vkpm
