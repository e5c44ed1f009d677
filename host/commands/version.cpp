/// vkpm --version: version, commit, and the Vulkan driver that a render would run on.
#include "commands/commands.h"
#include "gpu/gpu.h"
#include <exception>
#include <fmt/format.h>
#include <string>

namespace vkpm {

int execute(const VersionOptions&) {
    std::string driver;
    try {
        const DeviceInfo device = defaultDevice();
        driver = fmt::format("{}, on {}", device.driver, device.name);
    } catch (const std::exception& error) { // the rest is no less true
        driver = fmt::format("none: {}", error.what());
    }
    fmt::print("vkpm {}\ncommit {}\ndriver {}\n", VKPM_VERSION, commit,
               driver); // at once, for readers that stop after the first line
    return 0;
}

} // namespace vkpm
