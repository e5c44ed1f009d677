// Which pixel, path and points a slot has, see LanePaths.
#ifndef LANES_GLSL
#define LANES_GLSL
#include "common.glsl"
#include "random.glsl"
#include "shared_camera.h"
#include "shared_paths.h"

uint pixelOfSlot(LanePaths of, uint slot) { return slot % of.pixels; } // of the batch

uint pathOfSlot(LanePaths of, uint slot) { return of.first + slot / of.pixels; }

// Points of the first path of a pixel complement each other over all passes, and so do those of the others.
uint eyeIndex(LanePaths of, uint path) {
    return path == 0u ? of.pass : FURTHER_PATHS + of.pass * (of.each - 1u) + path - 1u;
}

// Of the path of a slot, or, in SAMPLES_GATHER, of what it sends from where it ends.
Sampler eyeSampler(LanePaths of, uint slot, uint sequence) {
    return pixelSampler(of.firstPixel + pixelOfSlot(of, slot), eyeIndex(of, pathOfSlot(of, slot)), of.seed, sequence);
}

// Of a gather ray, and of the light sample that is sent with it.
Sampler gatherSampler(LanePaths of, uint slot) {
    return pixelSampler(of.firstPixel + pixelOfSlot(of, slot), of.pass * of.each + pathOfSlot(of, slot), of.seed,
                        SAMPLES_GATHER);
}

// Of the paths or gather rays of a pixel.
float shareOfEach(LanePaths of) { return 1.0 / float(of.each); }

#endif
