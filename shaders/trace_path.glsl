// Where the ray of a path ends.
#ifndef TRACE_PATH_GLSL
#define TRACE_PATH_GLSL
#include "common.glsl"
#include "shared_paths.h"
#include "traverse.glsl"

Hit tracePath(DeviceScene scene, Path path) {
    vec3 origin = path.origin;
    if (hasSmoothDiffuse && (path.flags & PATH_THROUGH) != 0u)
        origin = beneath(scene, origin, path.direction, path.from);
    return closest(scene, origin, path.direction, path.from);
}

#endif
