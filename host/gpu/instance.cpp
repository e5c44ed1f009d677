/// Creating the instance, with or without validation.
#include "gpu/instance.h"
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <vector>

namespace vkpm {

bool wantsValidation() {
    const char* value = std::getenv("VKPM_VALIDATION");
    return value && std::strcmp(value, "0") != 0;
}

// A message of the validation layer is a defect of vkpm: say it and stop, so that no test passes over it.
static VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                                const VkDebugUtilsMessengerCallbackDataEXT* data, void*) {
    std::fprintf(stderr, "vkpm: validation: %s\n", data->pMessage);
    std::abort();
}

static vk::raii::Instance createInstance(const vk::raii::Context& context, std::span<const char* const> wanted,
                                         bool validate) {
    const vk::ApplicationInfo application{.pApplicationName = "vkpm", .apiVersion = VK_API_VERSION_1_3};
    const std::vector<const char*> layers =
        validate ? std::vector{"VK_LAYER_KHRONOS_validation"} : std::vector<const char*>{};
    std::vector<const char*> extensions(wanted.begin(), wanted.end());
    if (validate) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    const auto offered = context.enumerateInstanceExtensionProperties();
    const bool portability = std::ranges::any_of(offered, [](const auto& extension) {
        return std::string_view(extension.extensionName) == "VK_KHR_portability_enumeration";
    });
    if (portability) extensions.push_back("VK_KHR_portability_enumeration");
    const char* of = std::getenv("VKPM_VALIDATION_OF"); // "calls": not of what kernels read and write
    std::vector enabled{vk::ValidationFeatureEnableEXT::eSynchronizationValidation};
    if (!of || std::strcmp(of, "calls") != 0) {
        enabled.push_back(vk::ValidationFeatureEnableEXT::eGpuAssisted);
        enabled.push_back(vk::ValidationFeatureEnableEXT::eGpuAssistedReserveBindingSlot);
    }
    vk::ValidationFeaturesEXT features;
    features.setEnabledValidationFeatures(enabled);
    vk::InstanceCreateInfo create{.pNext = validate ? &features : nullptr, .pApplicationInfo = &application};
    if (portability)
        create.flags = vk::InstanceCreateFlagBits::eEnumeratePortabilityKHR; // or drivers over Metal are not listed
    create.setPEnabledLayerNames(layers).setPEnabledExtensionNames(extensions);
    return attempt("vkCreateInstance", validate ? "VKPM_VALIDATION needs vulkan-validationlayers" : installHint,
                   [&] { return vk::raii::Instance(context, create); });
}

Instance::Instance(std::span<const char* const> extensions) {
    const bool validate = wantsValidation();
    handle = createInstance(context, extensions, validate);
    if (!validate) return;
    vk::DebugUtilsMessengerCreateInfoEXT
        create; // filled as C's, since the type of the callback in vk:: depends on the version of the headers
    create = VkDebugUtilsMessengerCreateInfoEXT{.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
                                                .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                                                                   VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
                                                .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
                                                .pfnUserCallback = onMessage};
    messenger = handle.createDebugUtilsMessengerEXT(create);
}

} // namespace vkpm
