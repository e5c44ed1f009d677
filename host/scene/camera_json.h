/// A view as the text that a scene file has for it.
#pragma once
#include "scene/scene.h"
#include <string>

namespace vkpm {

/// The view with places that a scene file can say: far from the world's origin, double precision has fewer digits than
/// a float that is relative to the scene's own.
View inWorldDigits(View view);

/// The value of a scene's "camera"; read again, it is the same view, bit for bit, if it is in world digits.
std::string cameraJson(const View& view);

/// The text of a scene with this value in place of its camera's, or put in front where an import brings the camera.
std::string withCamera(const std::string& sceneText, const View& view);

} // namespace vkpm
