/// Moving a view as a hand on the mouse wants it; all as functions from view to view.
#pragma once
#include "window/picture.h"

namespace vkpm {

using glm::dvec2, glm::dvec3;

/// Around the target by angles in radians, to the right and up; never over the pole.
View orbit(View view, dvec2 angles);
/// The same around the eye: looks about.
View turn(View view, dvec2 angles);
/// Sideways with the target, in heights of the picture at the target's distance: right, up.
View pan(View view, dvec2 heights);
/// Changes the distance to the target by a factor.
View dolly(View view, double factor);
/// Flies with the target, in distances to it: right, up, forward.
View fly(View view, dvec3 distances);
/// Makes a point the target, and with it the centre of orbits.
View focus(View view, vec3 point);

/// Makes the lens see sharply what is at a depth, world units.
View focusLens(View view, double depth);

/// The depth (world units, along the camera's axis) of what a place of the film sees; places are in [0, 1]^2, y down.
/// Nothing beside the film, or where no surface is.
std::optional<double> depthAt(const Picture& picture, dvec2 place);
/// The point at such a depth.
vec3 pointAt(const View& view, uvec2 size, dvec2 place, double depth);

/// Where on the film a point is seen, and its depth, world units; nothing if it is behind the eye.
struct Seen {
    dvec2 place;
    double depth;
};
std::optional<Seen> seenAt(const View& view, uvec2 size, vec3 point);

} // namespace vkpm
