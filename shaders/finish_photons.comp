// Takes the last photons of a batch to their ends in one dispatch, each in a loop of its own: they are too few for a
// dispatch a bounce. One that has not ended after as many bounces as a dispatch may take stays under way.
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
    uint most = min(FINISH_BOUNCES, MAX_BOUNCES - args.bounce);
    while (outcome == OUTCOME_GOES_ON && rays < most) {
        Hit hit = tracePath(args.scene.at[0], path);
        bool arrives;
        PhotonDeposit deposit;
        outcome = scatterPhoton(slot, args.bounce + rays, path, hit, arrives, deposit);
        if (arrives) keep(deposit);
        rays++;
    }
    putFlags(args.flags, place, PHOTON_QUEUES, uint(outcome == OUTCOME_GOES_ON) << QUEUE_CONTINUE);
    count(outcome);
    atomicAdd(args.status.at[0].rays, rays);
    if (outcome != OUTCOME_GOES_ON) return;
    args.paths.at[slot] = path;
    atomicAdd(args.status.at[0].unfinished, 1u);
}
