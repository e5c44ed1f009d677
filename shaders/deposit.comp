// Appends the photons of one bounce to the map, in the order of the queue.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "kernel.glsl"

ARGS(DepositArgs)

void main() {
    Queue queue = args.queue.at[0];
    uint place = threadIndex();
    if (place >= queue.count) return;
    if (queue.base + place >= args.capacity) {
        atomicOr(args.status.at[0].overflow, OVERFLOW_PHOTONS);
        return;
    }
    Photon photon = args.pending.at[args.list.at[queue.first + place]];
    if (!isFinite(photon.color) || !isFinite(photon.position)) {
        atomicAdd(args.status.at[0].nonfinite[NONFINITE_PHOTON], 1u);
        photon.color = vec3(0.0);
    }
    args.photons.at[queue.base + place] = photon;
}
