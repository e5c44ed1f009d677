// Takes photons a number of bounces further, or to their ends; see scatter.glsl. When few are left, many bounces in one
// dispatch cost less than a dispatch each.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "compaction.glsl"
#include "scatter.glsl"
#include "trace_path.glsl"

void main() {
    Queue queue = args.queue.at[0];
    uint place = threadIndex();
    if (place >= queue.count) return;

    uint slot = args.list.at[queue.first + place];
    Path path = args.paths.at[slot];
    uint outcome = OUTCOME_GOES_ON, rays = 0u;
    while (outcome == OUTCOME_GOES_ON && rays < args.bounces) {
        Hit hit = tracePath(args.scene.at[0], path);
        bool arrives;
        PhotonDeposit deposit;
        outcome = scatterPhoton(slot, args.bounce + rays, path, hit, arrives, deposit);
        if (arrives) keep(deposit);
        rays++;
    }
    if (outcome == OUTCOME_GOES_ON) args.paths.at[slot] = path;
    putFlags(args.flags, place, PHOTON_QUEUES, uint(outcome == OUTCOME_GOES_ON) << QUEUE_CONTINUE);
    count(outcome, rays);
}
