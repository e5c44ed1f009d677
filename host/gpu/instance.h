/// The Vulkan instance, of the renderer's device and of the window's.
#pragma once
#define VULKAN_HPP_NO_STRUCT_CONSTRUCTORS
#include "error.h"
#include <span>
#include <vulkan/vulkan_raii.hpp>

namespace vkpm {

inline const char* const installHint =
    "install a Vulkan 1.3 driver (on Debian: mesa-vulkan-drivers), or run tools/setup";

/// Whether VKPM_VALIDATION asks for the validation layer.
bool wantsValidation();

/// An instance with extensions by name; with the validation layer, whose messages end the program, if VKPM_VALIDATION
/// asks for it.
struct Instance {
    explicit Instance(std::span<const char* const> extensions = {});

    vk::raii::Context context;
    vk::raii::Instance handle{nullptr};
    vk::raii::DebugUtilsMessengerEXT messenger{nullptr};
};

/// Runs a Vulkan call; its failure becomes a GpuError that names the call, the cause and what helps.
template <class Call> auto attempt(const std::string& what, const std::string& help, Call&& call) {
    try {
        return call();
    } catch (const vk::SystemError& error) {
        const std::string message = what + " failed: " + error.what() + (help.empty() ? "" : "; " + help);
        if (error.code() == vk::Result::eErrorDeviceLost) throw DeviceLost(message);
        throw GpuError(message);
    }
}

} // namespace vkpm
