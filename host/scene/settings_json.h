/// Settings as text, for the files that a render writes.
#pragma once
#include "scene/settings.h"
#include <string>

namespace vkpm {

/// One JSON object with the keys of a scene's `settings`, and those of the command line beside them.
std::string settingsJson(const Settings& settings);

} // namespace vkpm
