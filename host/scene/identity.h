/// What makes two renders the same one, so that their passes may be added up.
#pragma once
#include "scene/scene.h"
#include <map>

namespace vkpm {

/// The attributes that a render's file carries for this: version, scene (its text), sceneHash (of what it loads to,
/// meshes included), files (JSON: their names and hashes, if there are any but the scene's), settings as JSON,
/// settingsHash (of all these), seed.
std::map<std::string, std::string> identityOf(const Scene& scene, const Settings& settings);

/// What differs between two such sets of attributes, one line each with what `here` and `there` have; empty if they are
/// of one render. Exposure, numbers of passes and what the scene says about itself do not count.
std::vector<std::string> differences(const std::map<std::string, std::string>& here,
                                     const std::map<std::string, std::string>& there);

} // namespace vkpm
