// Photons in the order of the map.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../map.glsl"
#include "shared_photons.h"

MAP(uint, Photon, PhotonPtr(args.photons.photons).at[x])
