// Directions through film positions.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "camera.glsl"

MAP(CameraCase, vec3, cameraDirection(x.camera, x.film))
