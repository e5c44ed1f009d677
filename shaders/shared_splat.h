// Light tracing: photons connected to the camera.
#ifndef SHARED_SPLAT_H
#define SHARED_SPLAT_H
#include "shared.h"
#include "shared_photons.h"

SHARED_BEGIN

/// What a photon adds to the mean radiance of the pixel that sees it.
struct Splat {
    vec3 radiance;
};
BUFFER(Splat)

struct SplatArgs {
    PTR(DeviceScene) scene;
    PTR(Photon) photons;
    PTR(Splat) splats; // by photon
    PTR(uint) pixels;  // by photon; the number of pixels if none sees it
    PTR(uint) order;   // becomes that of the photons
    PTR(uint) rays;    // becomes the number of photons that are before the film, on top of what it was
    uvec2 size;
    uint count;
    uint pass;
    uint seed;
    float photonFlux; // W per photon emitted
};

struct SumSplatsArgs {
    PTR(Splat) splats;
    PTR(uint) pixels;   // sorted
    PTR(uint) order;    // of splats, by pixel
    PTR(float) samples; // [column][stride]
    uint splatCount;
    uint stride;
    uint firstPixel;
    uint count;
};

SHARED_END
#endif
