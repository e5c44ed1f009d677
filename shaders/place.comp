// Puts the photons of a wave into the map's order, whatever order they arrived in.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "shared_paths.h"
#include "shared_photons.h"

ARGS(PlaceArgs)

void main() {
    uint i = threadIndex();
    if (i >= args.count) return;
    Arrival arrival = args.arrivals.at[i];
    Photon photon = arrival.photon;
    if (!isFinite(photon.color) || !isFinite(photon.position)) {
        atomicAdd(args.status.at[0].nonfinite[NONFINITE_PHOTON], 1u);
        photon.color = vec3(0.0);
    }
    args.photons.at[args.first + args.offsets.at[arrival.slot] + arrival.index] = photon;
}
