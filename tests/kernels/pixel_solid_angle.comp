// Solid angles of the pixels of a film of 40 x 20, by the directions through their middles.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "camera.glsl"

MAP(CameraCase, float,
    pixelSolidAngle(x.camera, uvec2(40u, 20u), dot(cameraDirection(x.camera, x.film), x.camera.forward)))
