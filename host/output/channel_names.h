/// Names of channels as other programs give them, brought to ours.
#pragma once
#include <string>
#include <vector>

namespace vkpm {

/// Our names for the channels of a file, in their order: beauty is R, G and B without a name before them, other layers
/// keep theirs. Letters may be R, r or red in the file; beauty may be the combined pass of a Blender view layer
/// ("ViewLayer.Combined.R"), a layer or part named beauty, rgba, RGB_color ... (V-Ray, Mitsuba, Arnold, Karma), or the
/// only colour that there is. What stands before Blender's "Combined" is left away before its other passes, too. A file
/// that has R, G and B without a name keeps all its names.
std::vector<std::string> ourNames(const std::vector<std::string>& names);

} // namespace vkpm
