/// vkpm devices: what this machine has, what each device lacks, and the driver audit.
#include "commands/commands.h"
#include "gpu/audit.h"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace vkpm {

static nlohmann::ordered_json describe(std::size_t index, const DeviceInfo& info) {
    nlohmann::ordered_json device{{"index", index},
                                  {"name", info.name},
                                  {"driver", info.driver},
                                  {"vulkan", info.apiVersion},
                                  {"subgroup_size", info.subgroupSize},
                                  {"memory_bytes", info.memoryBytes},
                                  {"lacks", info.missingRequirements},
                                  {"audit", nlohmann::ordered_json::array()}};
    if (!info.missingRequirements.empty()) return device;
    Gpu gpu(std::to_string(index));
    for (const AuditResult& result : auditDriver(gpu))
        device["audit"].push_back({{"test", result.what}, {"passed", result.passed}, {"found", result.found}});
    return device;
}

static void printDevice(const nlohmann::ordered_json& device) {
    fmt::print("{}: {}\n   driver {}, Vulkan {}, subgroups of {}, {:.1f} GiB\n", device["index"].get<int>(),
               device["name"].get<std::string>(), device["driver"].get<std::string>(),
               device["vulkan"].get<std::string>(), device["subgroup_size"].get<int>(),
               device["memory_bytes"].get<double>() / 1073741824);
    for (const auto& lack : device["lacks"]) fmt::print("   lacks {}\n", lack.get<std::string>());
    for (const auto& test : device["audit"])
        fmt::print("   audit: {}: {}\n", test["test"].get<std::string>(),
                   test["passed"].get<bool>() ? "passed" : "FAILED: " + test["found"].get<std::string>());
}

int execute(const DevicesOptions& options) {
    auto devices = nlohmann::ordered_json::array();
    const std::vector<DeviceInfo> infos = listDevices();
    for (std::size_t i = 0; i < infos.size(); i++) devices.push_back(describe(i, infos[i]));
    if (options.json) fmt::print("{}\n", devices.dump(2));
    else
        for (const auto& device : devices) printDevice(device);
    if (infos.empty()) throw GpuError("no Vulkan device; install a Vulkan 1.3 driver (on Debian: mesa-vulkan-drivers)");
    return 0;
}

} // namespace vkpm
