// Film positions of directions.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "camera.glsl"

MAP(CameraCase, vec2, filmPosition(x.camera, 7.0 * cameraDirection(x.camera, x.film)))
