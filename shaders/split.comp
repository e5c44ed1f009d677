// Sends a gather ray from each diffuse point that the eye sees, by the cosine law about the shading normal. There are several
// for a path from the eye (splitting, Arvo & Kirk 1990): the eye's own part is traced once for all of them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"
#include "random.glsl"
#include "sampling.glsl"
#include "frame.glsl"

ARGS(SplitArgs)

bool send(uint slot) {
    GatherPoint point = args.gatherPoints.at[slot];
    if (point.flags == NONE) return false;
    Sampler s = pixelSampler(args.firstPixel + slot, args.index, args.seed, SAMPLES_GATHER);
    vec3 direction = toWorld(cosineHemisphere(sample2(s, 0u)), point.shading);
    if (dot(direction, point.normal) <= 0.0) return false;
    args.paths.at[slot] = Path(point.origin, direction, args.share * point.throughput, 0.0, point.from, point.flags);
    return true;
}

void main() {
    uint slot = threadIndex();
    if (slot >= args.count) return;
    args.list.at[slot] = slot;
    args.flags.at[slot] = uint(send(slot)) << QUEUE_CONTINUE;
}
