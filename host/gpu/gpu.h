/// A Vulkan device with one compute queue: what it is, what it lacks, and the handles the other files
/// here use.
#pragma once
#include "error.h"
#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace vkpm {

struct DeviceInfo {
    std::string name;
    std::string driver;
    std::string apiVersion;
    std::uint32_t subgroupSize = 0;
    std::uint64_t memoryBytes = 0;                // of the largest device-local heap
    std::vector<std::string> missingRequirements; // what vkpm needs and the device does not have
};

/// Seconds and dispatches of a kernel over a Gpu's life.
struct KernelTime {
    double seconds = 0;
    std::uint64_t dispatches = 0;
};

/// Thrown out of what a Gpu was doing when it was told to leave it.
struct Cancelled {};

class Gpu {
public:
    /// Opens a device by index or by part of its name; without either the first that lacks nothing, GPUs
    /// before CPUs.
    explicit Gpu(std::string_view wanted = {});
    ~Gpu();
    Gpu(const Gpu&) = delete;
    Gpu& operator=(const Gpu&) = delete;

    const DeviceInfo& info() const;

    /// Bytes now allocated, by the buffers' names.
    std::map<std::string, std::uint64_t> memory;
    /// The most bytes that were ever allocated at one time.
    std::uint64_t peakBytes = 0;
    /// Runs of kernels and, while `timesKernels`, the time they take, by name.
    std::map<std::string, KernelTime> times;
    /// Whether runs are timed; on a CPU the time stamps take some 50 microseconds each, a tenth of a pass.
    bool timesKernels = false;
    /// Drivers that compile kernels when they first run do so as soon as these are made, while the host goes on. They
    /// compile one at a time: for kernels that run soon.
    bool compilesAhead = false;

    /// How often the host waited for the device.
    std::uint64_t waits = 0;
    /// Runs of all kernels.
    std::uint64_t dispatches = 0;

    /// A flag that another thread may set: from then on submissions throw Cancelled, until it is taken back.
    const std::atomic<bool>* cancel = nullptr;

    struct Handles;
    const std::unique_ptr<Handles> handles;
};

/// All devices of this machine, in the order of their indices.
std::vector<DeviceInfo> listDevices();

/// The one that a Gpu opens if none is wanted by name. Throws GpuError if there is none.
DeviceInfo defaultDevice();

} // namespace vkpm
