/// A view as the text that a scene file has for it.
#pragma once
#include "scene/scene.h"
#include <string>

namespace vkpm {

/// The value of a scene's "camera"; read again, it is the same view, bit for bit.
std::string cameraJson(const View& view);

/// The text of a scene with this value in place of its camera's, else as it was.
std::string withCamera(const std::string& sceneText, const View& view);

} // namespace vkpm
